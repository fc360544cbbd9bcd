//! A board that is executed step by step, with its log, its link and its faults.

use std::cell::RefCell;
use std::rc::Rc;

use emulated_board::controller::Controller;
use emulated_board::run::{Execution, Order};
use emulated_board::wiring::board::Carrier;
use emulated_board::world::World;
use firmware::platform::Platform;
use simulated::executed;
use simulated::fault::Injection;

use crate::images::image;

/// A board that is executed.
pub struct Board {
    /// The execution.
    pub execution: Execution,
    /// Lines of the log with the time at which the probe took them, s after the supply came up first.
    pub log: Vec<(f64, String)>,
    /// Its lines as the probe prints them: the time that the board states, to a tenth of a second, level and words.
    pub printed: Vec<String>,
    /// Status lines of the link with the time at which each was complete, s.
    pub link: Vec<(f64, String)>,
    /// The beginning of a status line.
    begun: Vec<u8>,
}

impl Board {
    /// The board of a carrier in its usual world.
    pub fn new(carrier: Platform) -> Self {
        Self::within(carrier, World::new(carrier, 1).expect("its settings are possible"))
    }

    /// The board of a carrier in this world.
    pub fn within(carrier: Platform, world: World) -> Self {
        let execution = Execution::new(&image(carrier), &Order::usual(carrier, 1), world);
        let execution = execution.expect("the image has a log");
        Self {
            execution,
            log: Vec::new(),
            printed: Vec::new(),
            link: Vec::new(),
            begun: Vec::new(),
        }
    }

    /// Time since the supply came up first, s.
    pub fn seconds(&self) -> f64 {
        self.execution.processor.now().as_seconds()
    }

    /// What is done with the microcontroller, as by someone who injects faults.
    pub fn controller<T>(&self, task: impl FnOnce(&mut Controller) -> T) -> T {
        self.execution.processor.with_controller(task)
    }

    /// Goes on for a millisecond.
    fn step(&mut self) {
        let lines = self.execution.step().unwrap_or_else(|error| panic!("{error}\n{self}"));
        let now = self.seconds();
        self.printed.extend(lines.iter().map(|line| {
            let seconds = line.time.parse::<f64>().unwrap_or(f64::NAN);
            format!("{seconds:6.1} {} {}", line.level.unwrap_or("-"), line.words)
        }));
        self.log.extend(lines.into_iter().map(|line| (now, line.words)));
        let sent = self.controller(|controller| std::mem::take(&mut controller.usart.sent));
        for byte in sent {
            if byte == b'\n' {
                let line =
                    String::from_utf8_lossy(&std::mem::take(&mut self.begun)).trim().to_owned();
                self.link.push((now, line));
            } else {
                self.begun.push(byte);
            }
        }
    }

    /// Goes on for some seconds.
    pub fn run(&mut self, seconds: f64) {
        let end = self.seconds() + seconds;
        while self.seconds() < end {
            self.step();
        }
    }

    /// Goes on until a line of the log that contains these words, from now on; the time at which it came, s.
    ///
    /// # Panics
    /// Where none comes within so many seconds.
    pub fn until(&mut self, words: &str, longest: f64) -> f64 {
        let (end, mut seen) = (self.seconds() + longest, self.log.len());
        while self.seconds() < end {
            self.step();
            if let Some((at, _)) = self.log[seen..].iter().find(|(_, line)| line.contains(words)) {
                return *at;
            }
            seen = self.log.len();
        }
        panic!("no {words:?} within {longest} s:\n{self}");
    }

    /// Lines of the log from a moment on, s, until another.
    pub fn lines(&self, from: f64, until: f64) -> Vec<&str> {
        let within = self.log.iter().filter(|(at, _)| (from..until).contains(at));
        within.map(|(_, line)| line.as_str()).collect()
    }

    /// Status lines of the link from a moment on, s, until another.
    pub fn sent(&self, from: f64, until: f64) -> Vec<&str> {
        let within = self.link.iter().filter(|(at, _)| (from..until).contains(at));
        within.map(|(_, line)| line.as_str()).collect()
    }
}

impl std::fmt::Display for Board {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.log.iter().try_for_each(|(at, line)| writeln!(f, "{at:11.6} {line}"))?;
        self.link.iter().try_for_each(|(at, line)| writeln!(f, "{at:11.6} link: {line}"))
    }
}

/// A turntable amid its rate-modulated turns, of 72 °/s in the mean.
pub struct TurningBoard {
    /// The board, four seconds after the platform began to turn.
    pub board: Board,
    /// The rate of the platform, °/s.
    pub turning: Box<dyn Fn(&Board) -> f64>,
}

impl TurningBoard {
    /// Has a turntable begin.
    pub fn new() -> Self {
        let mut world = World::new(Platform::Turntable, 1).expect("its settings are possible");
        let chips = executed::turntable(1).board(None, Box::leak(Box::new(Injection::NONE)));
        let chips = Rc::new(RefCell::new(chips));
        world.carrier = Rc::clone(&chips) as Rc<RefCell<dyn Carrier>>;
        let mut board = Board::within(Platform::Turntable, world);
        board.until("stage: turns at 72.0 °/s", 10.0);
        board.run(4.0);
        let turning = move |board: &Board| {
            let mut chips = chips.borrow_mut();
            chips.advance(board.execution.processor.now().instant());
            chips.plant.truth().stage.rate_rad_s.to_degrees()
        };
        Self { board, turning: Box::new(turning) }
    }
}
