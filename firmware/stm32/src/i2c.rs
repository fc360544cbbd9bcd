//! The bus of the IMU on the base: interrupts and direct memory access carry a transaction out, and wake its task once,
//! at the end.
//!
//! embassy sets up pins, clock and timing; from then on the registers are used here (RM0351, chapter 39), since its own
//! transactions, in which the task does each part, take several thousand instructions.
//!
//! **Each transaction ends.** One that has not ended within its time limit is given up. After any that has failed the
//! interface is started anew, which releases the bus, so that the next one finds it as new.
//!
//! **A device may hold the data line.** Where the clock stops amid a byte that is read, as by a reset of the controller,
//! the device drives its bit until the clock goes on. So before the interface starts, the clock is given by hand until the
//! line is free.

use core::mem::forget;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use drivers::lsm6dsl;
use embassy_stm32::Peri;
use embassy_stm32::gpio::{AfType, Flex, OutputType, Speed};
use embassy_stm32::i2c::{Config, I2c, SclPin, SdaPin};
use embassy_stm32::pac::i2c::I2c as Registers;
use embassy_stm32::pac::i2c::regs::Cr2;
use embassy_stm32::pac::i2c::vals::{Autoend, Dir};
use embassy_stm32::pac::{DMA1, I2C2};
use embassy_stm32::peripherals::{self, DMA1_CH5};
use embassy_stm32::time::Hertz;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, block_for, with_timeout};
use embedded_hal_async::i2c::{self, Error, ErrorKind, ErrorType, Operation};

/// The interface.
const BUS: Registers = I2C2;
/// The channel of direct memory access that takes what it receives: the fifth (RM0351, table 41).
const CHANNEL: usize = 4;
/// Number of the interface's request on that channel (RM0351, 11.6.7).
const REQUEST: u8 = 3;

/// Longest transaction before the bus counts as broken; the usual ones take 0.4 ms.
const LONGEST: Duration = Duration::from_millis(5);
/// Most bytes that a transaction sends.
const MOST_SENT: usize = size_of::<u32>();
/// Most bytes that a transaction receives.
const MOST_RECEIVED: usize = 16;

/// Most pulses that free the data line: those of a byte and its acknowledge (UM10204, 3.1.16).
const PULSES: usize = 9;
/// Time for a line to rise that the interface has held: 1 µs at most (UM10204, table 10), and that in the midst of which a
/// wait begins.
const RISING: Duration = Duration::from_micros(2);
/// Half a period of these, and the pause behind a stop: 5 µs at least, those of the standard mode (UM10204, table 10: 4.7 µs),
/// and the microsecond in the midst of which a wait begins. Nine pulses take 0.16 ms.
const HALF: Duration = Duration::from_micros(6);

/// Bytes that are still to be sent, the next one lowest.
static TO_SEND: AtomicU32 = AtomicU32::new(0);
/// What `I2C_CR2` is to hold once all are sent, where bytes are to be received then.
static THEN: AtomicU32 = AtomicU32::new(0);
/// The bytes that were received.
static RECEIVED: [AtomicU8; MOST_RECEIVED] = [const { AtomicU8::new(0) }; MOST_RECEIVED];
/// A transaction has ended: whether all went well.
static ENDED: Signal<CriticalSectionRawMutex, bool> = Signal::new();

/// Does what the interface asks for by one of its two interrupts.
pub fn serve() {
    let status = BUS.isr().read();
    if status.txis() {
        let bytes = TO_SEND.load(Ordering::Relaxed);
        TO_SEND.store(bytes >> 8, Ordering::Relaxed);
        BUS.txdr().write(|next| next.set_txdata(bytes as u8));
    } else if status.tc() {
        BUS.cr2().write_value(Cr2(THEN.load(Ordering::Relaxed)));
    } else {
        BUS.icr().write(|clear| {
            clear.set_stopcf(true);
            clear.set_nackcf(true);
            clear.set_berrcf(true);
            clear.set_arlocf(true);
            clear.set_ovrcf(true);
        });
        let has_failed = status.nackf() || status.berr() || status.arlo() || status.ovr();
        ENDED.signal(status.stopf() && !has_failed);
    }
}

/// A transaction has failed, or is not one of those that this bus does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failed;

impl Error for Failed {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// A wire of the bus: its pin, and the number of its function as one of the interface.
struct Wire(Flex<'static>, u8);

impl Wire {
    /// Takes the wire from the interface, and lets it go.
    fn take(&mut self) {
        self.0.set_high();
        self.0.set_as_input_output(Speed::Medium);
    }

    /// Gives it back to the interface.
    fn give_back(&mut self) {
        let function = AfType::output(OutputType::OpenDrain, Speed::Medium);
        self.0.set_as_af_unchecked(self.1, function);
    }
}

/// The bus of the IMU on the base.
pub struct BaseBus {
    clock: Wire,
    data: Wire,
}

impl BaseBus {
    /// Connects the bus with its pins for clock and data, and the channel for what it receives.
    #[must_use]
    pub fn connected(
        interface: Peri<'static, peripherals::I2C2>,
        mut clock: Peri<'static, impl SclPin<peripherals::I2C2>>,
        mut data: Peri<'static, impl SdaPin<peripherals::I2C2>>,
        _: Peri<'static, DMA1_CH5>,
    ) -> Self {
        let mut settings = Config::default();
        settings.frequency = Hertz(lsm6dsl::BUS_HERTZ);
        let set_up = I2c::new_blocking(interface, clock.reborrow(), data.reborrow(), settings);
        // To drop it would take pins and clock away.
        forget(set_up);
        DMA1.cselr().modify(|requests| requests.set_cs(CHANNEL, REQUEST));
        let functions = [clock.af_num(), data.af_num()];
        let clock = Wire(Flex::new(clock), functions[0]);
        let mut bus = Self { clock, data: Wire(Flex::new(data), functions[1]) };
        bus.start();
        bus
    }

    /// Starts the interface anew, which releases the bus (RM0351, 39.4.6). It must be off for three clocks, which the reads
    /// of registers until it is on again take.
    fn start(&mut self) {
        BUS.cr1().modify(|control| control.set_pe(false));
        block_for(RISING);
        if self.data.0.is_low() {
            self.free();
        }
        BUS.cr1().modify(|control| {
            control.set_pe(true);
            control.set_txie(true);
            control.set_tcie(true);
            control.set_stopie(true);
            control.set_errie(true);
            control.set_rxdmaen(true);
        });
    }

    /// Has a device that holds the data line let it go, by pulses of the clock (UM10204, 3.1.16). The data line rises after
    /// the clock in each, so that the one in which the device lets it rise ends with a stop.
    fn free(&mut self) {
        self.clock.take();
        self.data.take();
        let freed = (1..=PULSES).find(|_| {
            self.clock.0.set_low();
            self.data.0.set_low();
            block_for(HALF);
            self.clock.0.set_high();
            block_for(HALF);
            self.data.0.set_high();
            block_for(HALF);
            self.data.0.is_high()
        });
        self.clock.give_back();
        self.data.give_back();
        if let Some(pulses) = freed {
            defmt::warn!("base: its data line was held, and let go after {} pulse(s)", pulses);
        }
    }
}

/// Has the next bytes that are received put into their place.
fn receive(count: usize) {
    let channel = DMA1.ch(CHANNEL);
    channel.cr().write(|control| control.set_en(false));
    channel.ndtr().write(|left| left.set_ndt(count as u16));
    channel.par().write_value(BUS.rxdr().as_ptr().expose_provenance() as u32);
    channel.mar().write_value(RECEIVED.as_ptr().expose_provenance() as u32);
    channel.cr().write(|control| {
        control.set_minc(true);
        control.set_en(true);
    });
}

/// What `I2C_CR2` holds to begin a part of a transaction with so many bytes; the last part ends it.
fn part(address: u8, direction: Dir, bytes: usize, is_last: bool) -> Cr2 {
    let mut control = Cr2::default();
    control.set_sadd(u16::from(address) << 1);
    control.set_dir(direction);
    control.set_nbytes(bytes as u8);
    control.set_autoend(if is_last { Autoend::AUTOMATIC } else { Autoend::SOFTWARE });
    control.set_start(true);
    control
}

/// Sends bytes, then receives others, and waits for the end of it; whether all went well.
async fn transact(address: u8, sent: &[u8], received: &mut [u8]) -> bool {
    ENDED.reset();
    let bytes = sent.iter().rev().fold(0, |bytes, byte| bytes << 8 | u32::from(*byte));
    TO_SEND.store(bytes, Ordering::Relaxed);
    let second = part(address, Dir::READ, received.len(), true);
    THEN.store(second.0, Ordering::Relaxed);
    receive(received.len());
    BUS.cr2().write_value(part(address, Dir::WRITE, sent.len(), received.is_empty()));
    let is_well = with_timeout(LONGEST, ENDED.wait()).await == Ok(true);
    for (byte, taken) in received.iter_mut().zip(&RECEIVED) {
        *byte = taken.load(Ordering::Acquire);
    }
    is_well && DMA1.ch(CHANNEL).ndtr().read().ndt() == 0
}

impl ErrorType for BaseBus {
    type Error = Failed;
}

impl i2c::I2c for BaseBus {
    /// Sends bytes, at most four, and perhaps receives others behind them, at most sixteen; the driver of the IMU asks
    /// for nothing else.
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Failed> {
        let (sent, received): (&[u8], &mut [u8]) = match operations {
            [Operation::Write(sent)] => (sent, &mut []),
            [Operation::Write(sent), Operation::Read(received)] => (sent, received),
            _ => return Err(Failed),
        };
        if sent.is_empty() || sent.len() > MOST_SENT || received.len() > MOST_RECEIVED {
            return Err(Failed);
        }
        // One that was given up when its task ended is still under way, or a device holds the data line.
        if BUS.isr().read().busy() {
            self.start();
        }
        if transact(address, sent, received).await {
            return Ok(());
        }
        self.start();
        Err(Failed)
    }
}
