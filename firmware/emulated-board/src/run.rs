//! A board that is executed, from power-on to its result and beyond.

use std::rc::Rc;

use execution::report::Report;
use firmware::platform::Platform;

use crate::controller::flash::STORE;
use crate::controller::rcc::Oscillators;
use crate::controller::{Controller, ResetReason};
use crate::image::Image;
use crate::observation::Observation;
use crate::probe::{Line, Probe};
use crate::processor::memory::RAM_FILL;
use crate::processor::{Processor, Unknown};
use crate::time::Time;
use crate::world::World;

/// How often the probe looks, and the link is served.
pub const LOOK: Time = Time::microseconds(1000);

/// What the start of an image paints the stack with, where it does (cortex-m-rt, `STACK_PAINT_VALUE`).
const PAINT: u8 = 0xCC;

/// What is executed.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    /// The carrier.
    pub carrier: Platform,
    /// Seed of the world.
    pub seed: u64,
    /// Cycles that an instruction takes, flash wait states included.
    pub cycles: f64,
    /// How long it goes on after its result, s.
    pub afterwards: f64,
    /// The longest time until a result, s.
    pub longest: f64,
    /// Whether the crystal of 32 768 Hz oscillates, and how wrong the internal oscillator is without it.
    pub oscillators: Oscillators,
}

impl Order {
    /// The usual order for a carrier: 1.4 cycles an instruction, ten seconds after the result.
    #[must_use]
    pub fn usual(carrier: Platform, seed: u64) -> Self {
        // A spinning body has no result; its flight takes two seconds after the start of its converters.
        let longest = if carrier == Platform::Spin { 5.0 } else { 240.0 };
        let oscillators = Oscillators { has_crystal: true, msi_error: 0.0 };
        Self { carrier, seed, cycles: 1.4, afterwards: 10.0, longest, oscillators }
    }
}

/// A board that is executed.
pub struct Execution {
    /// The core with its controller.
    pub processor: Processor,
    /// The world around it.
    pub world: World,
    /// The image.
    pub image: Rc<Image>,
    probe: Probe,
}

impl Execution {
    /// A board in a world whose supply comes up.
    ///
    /// # Errors
    /// An image without a log, or what Unicorn says.
    pub fn new(image: &Rc<Image>, order: &Order, mut world: World) -> Result<Self, String> {
        let probe = Probe::new(&image.elf, image.log)?;
        let mut controller =
            Controller::new(order.oscillators, order.seed, Box::new(world.board()));
        controller.flash.array.burn(STORE.start, &world.store);
        let processor = Processor::new(Rc::clone(image), controller, order.cycles);
        let processor = processor.map_err(|error| format!("Unicorn: {error:?}"))?;
        Ok(Self { processor, world, image: Rc::clone(image), probe })
    }

    /// Goes on for a millisecond; the log's lines of it.
    ///
    /// # Errors
    /// What the model does not know.
    pub fn step(&mut self) -> Result<Vec<Line>, Unknown> {
        let until = self.processor.now() + LOOK;
        self.processor.run(until)?;
        let mut lines = Vec::new();
        self.probe.poll(&mut self.processor, |line| lines.push(line));
        Ok(lines)
    }

    /// Takes the bytes that the link has sent.
    pub fn take_sent(&mut self) -> Vec<u8> {
        self.processor.with_controller(|controller| std::mem::take(&mut controller.usart.sent))
    }

    /// Sends bytes to the board over its link.
    pub fn send(&mut self, bytes: &[u8]) {
        let now = self.processor.now();
        self.processor.with_controller(|controller| controller.hear(bytes, now));
    }

    /// Bytes that the stack took at its deepest.
    #[must_use]
    pub fn stack_bytes(&self) -> u32 {
        let Image { stack_start, stack_end, .. } = *self.image;
        let mut stack = vec![0; (stack_start - stack_end) as usize];
        self.processor.peek(stack_end, &mut stack);
        let untouched = stack.iter().take_while(|byte| [RAM_FILL, PAINT].contains(byte)).count();
        stack_start - stack_end - untouched as u32
    }

    /// Has the supply of the controller break down for a moment: below the level at which it is reset, where it is set
    /// above the lowest one not below the least at which RAM keeps its content. What is written into the flash is torn.
    /// The chips keep theirs.
    pub fn lose_supply(&mut self) {
        self.processor.reset(ResetReason::Supply);
    }

    /// Takes the supply of the controller away for good, and gives it again: RAM is lost, too.
    pub fn switch_off(&mut self) {
        self.processor.switch_off();
    }
}

/// Executes an image in a world to its result and some time beyond; lines of the log go to `on_line`, bytes of the link
/// to `on_link`, which may return what the other side sends.
///
/// # Errors
/// What the model does not know, or an image that is none.
pub fn execute(
    image: &Rc<Image>,
    order: &Order,
    world: World,
    mut on_line: impl FnMut(&Line),
    mut on_link: impl FnMut(&[u8]) -> Vec<u8>,
) -> Result<Report, String> {
    let mut execution = Execution::new(image, order, world)?;
    let mut observation = Observation::default();
    while execution.processor.now() < observation.end(order) {
        let lines = execution.step().map_err(|error| error.to_string())?;
        observation.look(&execution);
        for line in &lines {
            on_line(line);
            observation.read(line, &execution);
        }
        let sent = execution.take_sent();
        let received = on_link(&sent);
        execution.send(&received);
        observation.hear(&sent);
    }
    Ok(observation.report(order, &execution))
}
