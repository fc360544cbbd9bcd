//! Pins, DMA channels and interrupts: from the controller's peripherals to the wires of each carrier.

use core::mem;

use embassy_stm32::dma::{ReadableRingBuffer, TransferOptions};
use embassy_stm32::gpio::{Level, Output, Pull, Speed};
use embassy_stm32::interrupt::{Interrupt, InterruptExt};
use embassy_stm32::peripherals::{
    DMA1_CH5, DMA2_CH6, DMA2_CH7, EXTI0, EXTI1, EXTI3, EXTI4, I2C2, PA2, PA3, PA4, PA15, PB0, PB1,
    PB2, PB4, PB6, PB7, PB10, PB11, PC3, PC4, PD0, PD2, PD5, USART1,
};
use embassy_stm32::spi::Spi;
use embassy_stm32::usart::{self, ConfigError, Uart};
use embassy_stm32::{Peri, Peripherals, bind_interrupts, dma, interrupt, pac};
use firmware::platform::Platform;
use firmware::ports::Frames;
use static_cell::StaticCell;
use stm32::edges::{self, Line};
use stm32::flash;
use stm32::i2c::{BaseBus, serve};
use stm32::link::{self, Link};
use stm32::spi::Bus;
use stm32::wiring::{
    AxisPlatformWires, Buses, Clock, FramesWires, Outlets, PlatformWires, SpinWires, VehicleWires,
    sensor_settings, stage_settings,
};
use stm32::{BoardLog, PLATFORM, UpperBank, chain};

use crate::clock;

bind_interrupts!(struct Interrupts {
    DMA2_CHANNEL6 => dma::InterruptHandler<DMA2_CH6>;
    DMA2_CHANNEL7 => dma::InterruptHandler<DMA2_CH7>;
    USART1 => usart::InterruptHandler<USART1>;
});

/// The events of the bus of the base.
#[interrupt]
fn I2C2_EV() {
    serve();
}

/// The errors of the bus of the base.
#[interrupt]
fn I2C2_ER() {
    serve();
}

/// The edges of the data-ready line on pin 0 of its port.
#[interrupt]
fn EXTI0() {
    edges::take(0);
}

/// The edges of the data-ready line on pin 1 of its port.
#[interrupt]
fn EXTI1() {
    edges::take(1);
}

/// The edges of the data-ready line on pin 3 of its port.
#[interrupt]
fn EXTI3() {
    edges::take(3);
}

/// The edges of the data-ready line on pin 4 of its port.
#[interrupt]
fn EXTI4() {
    edges::take(4);
}

/// The edges of the data-ready lines on pins 10 to 15.
#[interrupt]
fn EXTI15_10() {
    edges::take_pending(0x3F << 10);
}

/// Wakes the tasks that wait for edges.
#[interrupt]
fn LPTIM2() {
    edges::notify();
}

/// The end of a transfer of the converters' bus, on a spinning body.
#[interrupt]
fn DMA1_CHANNEL2() {
    if PLATFORM == Platform::Spin {
        chain::transferred();
    }
}

/// Select pins of encoder and motor driver of the axis, or of the outer one.
type AxisPins = (Peri<'static, PD0>, Peri<'static, PD5>);
/// Select pins of what only some carriers have.
type Selects = (Peri<'static, PB2>, Peri<'static, PA4>, Peri<'static, PA3>, Peri<'static, PB4>);

/// The connections that several carriers have, and the pins of the others, which stay unconnected until
/// they are needed: a pin takes no memory.
pub struct Board {
    buses: Buses,
    converter: (Peri<'static, PA2>, Line),
    outlets: Outlets,
    accelerometer: Peri<'static, PA15>,
    axis: AxisPins,
    motor_enable: Peri<'static, PD2>,
    base: BasePins,
    selects: Selects,
    ready: (Peri<'static, PB0>, Peri<'static, PB1>, Peri<'static, PC4>, Peri<'static, PC3>),
    lines: (Peri<'static, EXTI0>, Peri<'static, EXTI1>, Peri<'static, EXTI4>, Peri<'static, EXTI3>),
}

impl Board {
    /// Connects all that several carriers have, and the link.
    ///
    /// # Errors
    /// An invalid configuration of the serial port.
    pub fn new(
        p: Peripherals,
        log: &'static BoardLog,
        timing: Clock,
    ) -> Result<(Self, Link), ConfigError> {
        let sensors = Spi::new_blocking(p.SPI1, p.PA5, p.PA7, p.PA6, sensor_settings());
        let stage = Spi::new_blocking(p.SPI2, p.PD1, p.PD4, p.PD3, stage_settings());
        let buses = Buses {
            sensors: Bus::First.taken(sensors),
            stage: Bus::Second.taken(stage),
            clock: clock::SYSTEM,
        };
        let ready = Line::new(p.PD14, p.EXTI14);
        #[expect(unsafe_code, reason = "an interrupt is enabled by hand where no driver does")]
        // SAFETY: its handler wakes tasks, as that of any driver, and no mutex relies on its being off.
        unsafe {
            edges::NOTIFIER.enable();
        }
        let flash = flash::take(p.FLASH);
        let port = LinkPins {
            port: p.USART1,
            pins: (p.PB7, p.PB6),
            sender: p.DMA2_CH6,
            receiver: p.DMA2_CH7,
        };
        let link = port.connect(programs::output(flash).baud)?;
        let board = Self {
            buses,
            converter: (p.PA2, ready),
            outlets: Outlets { flash, log, clock: timing },
            accelerometer: p.PA15,
            axis: (p.PD0, p.PD5),
            motor_enable: p.PD2,
            base: BasePins { bus: p.I2C2, pins: (p.PB10, p.PB11), receiver: p.DMA1_CH5 },
            selects: (p.PB2, p.PA4, p.PA3, p.PB4),
            ready: (p.PB0, p.PB1, p.PC4, p.PC3),
            lines: (p.EXTI0, p.EXTI1, p.EXTI4, p.EXTI3),
        };
        Ok((board, link))
    }

    /// Flash of the controller.
    pub const fn flash(&self) -> UpperBank {
        self.outlets.flash
    }

    /// Connections of a stage or a turntable.
    pub fn axis(self) -> AxisPlatformWires {
        self.platform(|buses, (encoder, motor), _| buses.axis(encoder, motor))
    }

    /// Connections of two frames; the inner one has the select pins of a vehicle's further gyros.
    pub fn two_frames(self) -> FramesWires {
        self.platform(|buses, (encoder, motor), (inner_encoder, inner_motor, ..)| Frames {
            outer: buses.axis(encoder, motor),
            inner: buses.axis(inner_encoder, inner_motor),
        })
    }

    /// Connections of a platform that turns the gyro, with these axes.
    fn platform<A>(self, axes: impl FnOnce(Buses, AxisPins, Selects) -> A) -> PlatformWires<A> {
        PlatformWires {
            converter: self.buses.converter(self.converter.0, self.converter.1),
            accelerometer: self.buses.accelerometer(self.accelerometer),
            axes: axes(self.buses, self.axis, self.selects),
            base: self.base.connect(),
            // Off until the motors are known to rest.
            motor_enable: Output::new(self.motor_enable, Level::High, Speed::Low),
            outlets: self.outlets,
        }
    }

    /// Connections in a vehicle.
    pub fn vehicle(self) -> VehicleWires {
        let Self { buses, converter, accelerometer, outlets, selects, ready, lines, .. } = self;
        let forward = buses.converter(converter.0, converter.1);
        let line = Line::new(ready.0, lines.0);
        let right = buses.converter(selects.0, line);
        let line = Line::new(ready.1, lines.1);
        let down = buses.converter(selects.1, line);
        let accelerometer = buses.accelerometer(accelerometer);
        VehicleWires { converters: [forward, right, down], accelerometer, outlets }
    }

    /// Connections on a spinning body, with the interrupt of the transfers that read its converters.
    pub fn spinning_body(self) -> SpinWires {
        let Self { buses, converter, outlets, selects, ready, lines, .. } = self;
        let (select, line) = converter;
        let converters = buses.chained([
            (select.into(), line),
            (selects.1.into(), Line::new(ready.1, lines.1)),
            (selects.0.into(), Line::new(ready.0, lines.0)),
            (selects.2.into(), Line::new(ready.2, lines.2)),
            (selects.3.into(), Line::new(ready.3, lines.3)),
        ]);
        #[expect(unsafe_code, reason = "an interrupt is enabled by hand where no driver does")]
        // SAFETY: its handler touches the channels of the chain and words that are atomic, and no mutex relies on its
        // being off.
        unsafe {
            Interrupt::DMA1_CHANNEL2.enable();
        }
        SpinWires { converters, outlets }
    }
}

/// Pins of the link, and its direct memory access both ways.
struct LinkPins {
    port: Peri<'static, USART1>,
    pins: (Peri<'static, PB7>, Peri<'static, PB6>),
    sender: Peri<'static, DMA2_CH6>,
    receiver: Peri<'static, DMA2_CH7>,
}

impl LinkPins {
    /// Opens the port at this rate, baud: eight bits, no parity, one stop bit. A pull-up has a line that nothing drives read
    /// as one at rest.
    ///
    /// # Errors
    /// A rate that the port does not have.
    fn connect(self, baud: u32) -> Result<Link, ConfigError> {
        static RING: StaticCell<[u8; link::RECEIVED]> = StaticCell::new();
        let Self { port, pins: (receive, send), sender, receiver } = self;
        let mut settings = usart::Config::default();
        settings.baudrate = baud;
        settings.rx_pull = Pull::Up;
        #[expect(unsafe_code, reason = "the channel that embassy's receiver has is used by hand")]
        // SAFETY: the receiver that has it is never used, and never dropped.
        let channel = unsafe { receiver.clone_unchecked() };
        let port = Uart::new(port, receive, send, sender, receiver, Interrupts, settings)?;
        let (sender, receiver) = port.split();
        mem::forget(receiver);
        let channel = dma::Channel::new(channel, Interrupts);
        let data = pac::USART1.rdr().as_ptr().cast::<u8>();
        let ring = RING.init([0; link::RECEIVED]);
        #[expect(unsafe_code, reason = "a channel is set up by hand")]
        // SAFETY: the request of this channel and the register are those of the port's received bytes (RM0351, table 45),
        // and nothing else reads them.
        let mut ring = unsafe {
            ReadableRingBuffer::new(channel, REQUEST, data, ring, TransferOptions::default())
        };
        ring.start();
        pac::USART1.cr3().modify(|control| control.set_dmar(true));
        Ok(Link::new(ring, sender))
    }
}

/// Request of direct memory access by received bytes of USART1 on channel 7 of DMA2 (RM0351, table 45).
const REQUEST: u8 = 2;

/// Pins of the IMU on the base.
struct BasePins {
    bus: Peri<'static, I2C2>,
    pins: (Peri<'static, PB10>, Peri<'static, PB11>),
    receiver: Peri<'static, DMA1_CH5>,
}

impl BasePins {
    /// Connects the IMU.
    fn connect(self) -> BaseBus {
        let Self { bus, pins: (clock, data), receiver } = self;
        BaseBus::connected(bus, clock, data, receiver)
    }
}
