//! Converters in step that are read one after the other by direct memory access, whatever the tasks do meanwhile.
//!
//! ```text
//!  edge of the last line ─▶ transfer 1 ─▶ transfer 2 ─▶ … ─▶ transfer 5 ─▶ a full set ─▶ acquisition, eight sets at a time
//! ```
//!
//! A spinning body's five converters leave 69 µs for a set of conversions, of which the wires take 35 µs: there is no
//! time to wake a task for each. So the interrupt of the edge that completes a set begins the first transfer, and the
//! interrupt at the end of a transfer the next one. Both have one priority, so that neither interrupts the other.
//!
//! **Lines take turns.** Each interrupt of an edge takes a fiftieth of the time between two sets. So the line of the last
//! converter, which was begun last and ends last, is watched always, and the others one after the other: how long before the
//! last one each ends changes only where a converter is out of step, or silent, and no set is then read until it is found. A
//! driver that uses the bus meanwhile, to start a converter, stops the chain; acquisition begins it again.

mod reader;
mod set;

use core::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};

use cortex_m::asm::delay;
use cortex_m::interrupt;
use drivers::ads1262::BYTES_PER_SAMPLE;
use drivers::ads1262::registers::RDATA1;
use embassy_stm32::Peri;
use embassy_stm32::gpio::{AnyPin, Pin};
use embassy_stm32::pac::bdma::regs::{Cr, Isr, Ndtr};
use embassy_stm32::pac::bdma::vals::{Dir, Pl};
use embassy_stm32::pac::exti::regs::Lines;
use embassy_stm32::pac::gpio::Gpio;
use embassy_stm32::pac::gpio::regs::Bsrr;
use embassy_stm32::pac::spi::regs::Cr1;
use embassy_stm32::pac::{DMA1, EXTI, GPIOA, GPIOB, GPIOC, GPIOD, GPIOE, SPI1};
use embassy_sync::once_lock::OnceLock;
use embassy_sync::waitqueue::AtomicWaker;
use firmware::spin::configuration::CHANNELS;

use crate::edges::{self, Line};
use crate::spi::Bus;
use set::Set;

pub use reader::ChainReader;

/// Sets that wait for acquisition at most: two milliseconds at 14 400 Hz.
const SETS: usize = 32;
/// Sets for which acquisition is woken once: to wake it costs half as much as to take a sample.
const WOKEN: u32 = 8;
/// Channel 2 of the controller DMA1, counted from zero, for what SPI1 receives (RM0351, table 41).
const RECEIVING: usize = 1;
/// Channel 3 of it for what SPI1 sends.
const SENDING: usize = 2;
/// The request of these channels that is SPI1's.
const REQUEST: u8 = 1;
/// Cycles that pass after the fall of a select line, at least, before the controllers of a transfer are written: with these
/// writes the 50 ns until the first edge of the clock that an ADS1262 asks for (SBAS661C, section 7.6).
const SELECTED: u32 = 1;
/// The converter that is begun last.
const LAST: usize = CHANNELS - 1;
/// The bus of the converters.
const BUS: Bus = Bus::First;
/// What is sent for a reading: the command, and zeros while the frame comes back.
static COMMAND: [u8; BYTES_PER_SAMPLE] = {
    let mut bytes = [0; BYTES_PER_SAMPLE];
    bytes[0] = RDATA1;
    bytes
};

/// The chain of this controller.
static CHAIN: Chain = Chain::new();

/// What interrupts and acquisition share: words that are read and written each by itself. While the chain runs, the
/// interrupts alone write them.
struct Chain {
    /// Wires of the converters, known before the chain is begun.
    wires: OnceLock<[Wires; CHANNELS]>,
    /// Lines whose edge the next set still waits for, as bits; none while the chain is stopped.
    awaited: AtomicU32,
    /// The converter whose line is watched beside the last one's.
    watched: AtomicUsize,
    /// How long before the last one's the conversion of each converter ends, µs; it wraps.
    before: [AtomicU32; CHANNELS],
    /// The converter that is being read; [`CHANNELS`] between two sets.
    place: AtomicUsize,
    /// Whether the conversions of the next set have ended while one is being read.
    is_next_complete: AtomicBool,
    /// Number of sets that were filled; it wraps.
    filled: AtomicU32,
    /// The latest sets.
    sets: [Set; SETS],
    /// Acquisition, while it waits.
    waiting: AtomicWaker,
}

/// Wires of a converter.
struct Wires {
    /// Port of the select line, and its bit there.
    select: (Gpio, u32),
    /// The data-ready line.
    line: usize,
}

impl Wires {
    /// Wires of a converter with this select pin, by port and number.
    fn new([port, pin]: [u8; 2], ready: &Line) -> Self {
        let port = match port {
            0 => GPIOA,
            1 => GPIOB,
            2 => GPIOC,
            3 => GPIOD,
            _ => GPIOE,
        };
        Self { select: (port, 1 << (pin & 0xF)), line: ready.number().into() }
    }

    /// The data-ready line as a bit.
    const fn bit(&self) -> u32 {
        1 << self.line
    }

    /// Selects the converter.
    fn select(&self) {
        let (port, bit) = self.select;
        // The upper half of the register drives a pin low.
        port.bsrr().write_value(Bsrr(bit << 16));
    }

    /// Selects the converter no longer.
    fn release(&self) {
        let (port, bit) = self.select;
        port.bsrr().write_value(Bsrr(bit));
    }
}

impl Chain {
    /// A chain that is stopped, without wires.
    const fn new() -> Self {
        Self {
            wires: OnceLock::new(),
            awaited: AtomicU32::new(0),
            watched: AtomicUsize::new(0),
            before: [const { AtomicU32::new(0) }; CHANNELS],
            place: AtomicUsize::new(CHANNELS),
            is_next_complete: AtomicBool::new(false),
            filled: AtomicU32::new(0),
            sets: [const { Set::new() }; SETS],
            waiting: AtomicWaker::new(),
        }
    }

    /// The wires; none before they are known.
    fn wires(&self) -> &[Wires] {
        self.wires.try_get().map_or(&[], |wires| wires)
    }

    /// The data-ready lines of all, as bits.
    fn lines(&self) -> u32 {
        self.wires().iter().fold(0, |lines, wires| lines | wires.bit())
    }

    /// The set of a number.
    fn set(&self, number: u32) -> &Set {
        &self.sets[number as usize % SETS]
    }

    /// Whether conversions are read as they end.
    fn runs(&self) -> bool {
        self.awaited.load(Ordering::Relaxed) != 0
    }

    /// Begins to read, from the next conversion of each converter on, with these settings of the bus.
    fn begin(&self, control: Cr1) {
        BUS.configure_for_memory_access(control);
        DMA1.cselr().modify(|requests| {
            requests.set_cs(RECEIVING, REQUEST);
            requests.set_cs(SENDING, REQUEST);
        });
        for channel in [RECEIVING, SENDING] {
            DMA1.ch(channel).par().write_value(SPI1.dr8().as_ptr() as u32);
        }
        DMA1.ch(SENDING).mar().write_value(COMMAND.as_ptr() as u32);
        self.before.iter().for_each(|before| before.store(0, Ordering::Relaxed));
        interrupt::free(|_| self.watch(0));
    }

    /// Stops reading. A transfer that is under way is given up.
    fn stop(&self) {
        interrupt::free(|_| {
            self.awaited.store(0, Ordering::Relaxed);
            self.place.store(CHANNELS, Ordering::Relaxed);
            self.is_next_complete.store(false, Ordering::Relaxed);
            for channel in [RECEIVING, SENDING] {
                DMA1.ch(channel).cr().write_value(Cr(0));
            }
            clear();
            BUS.reset();
            self.wires().iter().for_each(Wires::release);
            // Edges of before, which were not watched, are no edges of now.
            EXTI.pr(0).write_value(Lines(self.lines()));
            EXTI.imr(0).modify(|lines| lines.0 |= self.lines());
        });
    }

    /// Takes note of a set whose conversions have all ended, and begins to read it, or once the one before was read: a
    /// critical section may have delayed that. One that comes while another waits is lost, which the counts show.
    #[inline(never)]
    fn complete(&self) {
        let watched = self.watched.load(Ordering::Relaxed);
        let [Some(last), Some(other)] = [LAST, watched].map(|place| self.wires().get(place)) else {
            return;
        };
        let (end, [other, ..]) = (edges::words(last.line), edges::words(other.line));
        self.before[watched].store(end[0].wrapping_sub(other), Ordering::Relaxed);
        self.watch(if watched + 1 < LAST { watched + 1 } else { 0 });
        let is_reading = self.place.load(Ordering::Relaxed) != CHANNELS;
        if is_reading && self.is_next_complete.load(Ordering::Relaxed) {
            return;
        }
        let filled = self.filled.load(Ordering::Relaxed);
        let set = self.set(if is_reading { filled.wrapping_add(1) } else { filled });
        set.set_ends(end, &self.before);
        if is_reading {
            self.is_next_complete.store(true, Ordering::Relaxed);
        } else {
            self.read(0, set);
        }
    }

    /// Watches the line of a converter beside that of the last one. What its edges left while it was not watched is old.
    fn watch(&self, place: usize) {
        let all = self.lines();
        let bits = [LAST, place].map(|place| self.wires().get(place).map_or(0, Wires::bit));
        let watched = bits[0] | bits[1];
        EXTI.pr(0).write_value(Lines(bits[1]));
        EXTI.imr(0).modify(|lines| lines.0 = lines.0 & !all | watched);
        self.watched.store(place, Ordering::Relaxed);
        self.awaited.store(watched, Ordering::Relaxed);
    }

    /// Begins to read a converter, where there is one at that place.
    fn read(&self, place: usize, set: &Set) {
        let Some(wires) = self.wires().get(place) else { return };
        self.place.store(place, Ordering::Relaxed);
        wires.select();
        delay(SELECTED);
        DMA1.ch(RECEIVING).mar().write_value(set.address(place));
        for (channel, control) in [(RECEIVING, received()), (SENDING, sent())] {
            DMA1.ch(channel).ndtr().write_value(Ndtr(BYTES_PER_SAMPLE as u32));
            DMA1.ch(channel).cr().write_value(control);
        }
    }

    /// Ends the transfer of a converter, and begins that of the next one.
    fn go_on(&self) {
        let place = self.place.load(Ordering::Relaxed);
        let Some(wires) = self.wires().get(place) else { return };
        wires.release();
        let filled = self.filled.load(Ordering::Relaxed);
        if place + 1 < CHANNELS {
            return self.read(place + 1, self.set(filled));
        }
        self.place.store(CHANNELS, Ordering::Relaxed);
        let filled = filled.wrapping_add(1);
        self.filled.store(filled, Ordering::Release);
        if self.is_next_complete.load(Ordering::Relaxed) {
            self.is_next_complete.store(false, Ordering::Relaxed);
            self.read(0, self.set(filled));
        }
        if filled.is_multiple_of(WOKEN) {
            edges::wake(edges::CHAIN);
        }
    }
}

/// Notes the wires of the converters, in the order in which they are read: select pins and data-ready lines.
pub(crate) fn connect(wires: &[(Peri<'static, AnyPin>, Line); CHANNELS]) {
    CHAIN.wires.get_or_init(|| {
        wires.each_ref().map(|(select, ready)| Wires::new([select.port(), select.pin()], ready))
    });
}

/// Wakes acquisition.
pub(crate) fn wake() {
    CHAIN.waiting.wake();
}

/// Leaves the bus to a driver: where the chain runs, it stops.
pub(crate) fn make_way(bus: Bus) {
    if bus == BUS && CHAIN.runs() {
        CHAIN.stop();
    }
}

/// Takes edges of lines, as bits, after their stamps; called from the interrupts of the lines.
pub(crate) fn noted(lines: u32) {
    let awaited = CHAIN.awaited.load(Ordering::Relaxed);
    let left = awaited & !lines;
    if left != 0 {
        CHAIN.awaited.store(left, Ordering::Relaxed);
    } else if awaited != 0 {
        CHAIN.complete();
    }
}

/// Takes the end of a transfer; called from the interrupt of channel 2 of the controller DMA1, which has the priority
/// of the lines' interrupts.
pub fn transferred() {
    for channel in [RECEIVING, SENDING] {
        DMA1.ch(channel).cr().write_value(Cr(0));
    }
    clear();
    CHAIN.go_on();
}

/// Clears all flags of both channels.
fn clear() {
    let mut flags = Isr(0);
    flags.set_gif(RECEIVING, true);
    flags.set_gif(SENDING, true);
    DMA1.ifcr().write_value(flags);
}

/// Bytes from the interface to memory, of which the last one interrupts.
fn received() -> Cr {
    let mut control = sent();
    control.set_dir(Dir::FROM_PERIPHERAL);
    control.set_tcie(true);
    control
}

/// Bytes from memory to the interface.
fn sent() -> Cr {
    let mut control = Cr(0);
    control.set_dir(Dir::FROM_MEMORY);
    control.set_minc(true);
    control.set_pl(Pl::VERY_HIGH);
    control.set_en(true);
    control
}
