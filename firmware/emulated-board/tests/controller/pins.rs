//! Pins, and the peripherals that they are given to (RM0351, chapter 8).

use emulated_board::controller::Refused;
use emulated_board::time::Time;
use emulated_board::wiring::Pin;

use super::{Bench, GPIO, SIGNALS, registers};

/// The interfaces SPI1 and SPI2.
const SPI: [u32; 2] = [0x4001_3000, 0x4000_3800];
/// The interface I2C2.
const I2C: u32 = 0x4000_5800;
/// The serial port USART1.
const PORT: u32 = 0x4001_3800;

#[test]
fn a_port_begins_with_the_pins_of_the_debugger_in_use_and_all_others_analogue() {
    let mut bench = Bench::clocked();
    // 8.4.1 to 8.4.4: GPIOx_MODER, OTYPER, OSPEEDR, PUPDR.
    for (port, expected) in [
        (0, [0xABFF_FFFF, 0, 0x0C00_0000, 0x6400_0000]),
        (1, [0xFFFF_FEBF, 0, 0, 0x100]),
        (2, [0xFFFF_FFFF, 0, 0, 0]),
        (7, [0xF, 0, 0, 0]),
    ] {
        let held = [0, 4, 8, 12].map(|offset| bench.read(GPIO + 0x400 * port + offset));
        assert_eq!(held, expected, "port {port}");
    }
}

#[test]
fn a_reset_of_a_port_alone_lets_its_pins_go() {
    let mut bench = Bench::clocked();
    bench.set_mode(Pin::named(b"PC3"), 1);
    bench.wires.0.borrow_mut().driven.clear();
    bench.write(super::RCC + 0x2C, 1 << 2);
    assert_eq!(bench.read(GPIO + 0x800), 0xFFFF_FFFF);
    let wires = bench.wires.0.borrow();
    assert!(wires.driven.contains(&(Pin::named(b"PC3"), None)), "{:?}", wires.driven);
}

#[test]
fn bits_of_an_output_are_set_and_reset_and_the_set_wins() {
    let mut bench = Bench::clocked();
    // 8.4.7: where both are asked for, the set has priority; 8.4.11 resets alone.
    bench.write(GPIO + 0x18, 0b0011 | 0b0110 << 16);
    assert_eq!(bench.read(GPIO + 0x14), 0b0011);
    bench.write(GPIO + 0x18, 0b0001 << 16);
    assert_eq!(bench.read(GPIO + 0x14), 0b0010);
    bench.write(GPIO + 0x28, 0b0010);
    assert_eq!(bench.read(GPIO + 0x14), 0);
    assert_eq!([0x18, 0x28].map(|offset| bench.read(GPIO + offset)), [0, 0], "they read as zero");
}

#[test]
fn an_output_drives_both_levels_and_an_open_drain_only_the_low_one() {
    let pin = Pin::named(b"PA2");
    for (is_open_drain, is_high, expected) in [
        (false, false, Some(false)),
        (false, true, Some(true)),
        (true, false, Some(false)),
        (true, true, None),
    ] {
        let mut bench = Bench::clocked();
        bench.write(GPIO + 4, u32::from(is_open_drain) << 2);
        bench.write(GPIO + 0x14, u32::from(is_high) << 2);
        bench.set_mode(pin, 1);
        let driven = bench.wires.0.borrow().driven.iter().rfind(|(own, _)| *own == pin).copied();
        assert_eq!(driven, Some((pin, expected)), "open drain: {is_open_drain}, high: {is_high}");
        bench.wires.0.borrow_mut().low.push(pin);
        // An open drain that is not low reads its wire (8.3.10).
        assert_eq!(bench.read(GPIO + 0x10) >> 2 & 1 != 0, expected.unwrap_or(false));
    }
}

#[test]
fn an_input_reads_its_wire_and_an_analogue_pin_reads_as_zero() {
    let mut bench = Bench::clocked();
    for (mode, expected) in [(0, 0b10), (2, 0b10), (3, 0)] {
        // PC0 is low, PC1 is high.
        bench.wires.0.borrow_mut().low = vec![Pin::named(b"PC0")];
        for pin in [b"PC0", b"PC1"] {
            bench.set_mode(Pin::named(pin), mode);
        }
        assert_eq!(bench.read(GPIO + 0x810) & 0b11, expected, "mode {mode}");
    }
}

#[test]
fn a_lock_of_a_port_is_refused() {
    let mut bench = Bench::clocked();
    assert_eq!(bench.try_write(GPIO + 0x1C, 1, 4), Err(Refused::Unknown));
}

/// Has the peripheral of a signal use its pin.
fn use_pin(bench: &mut Bench, signal: &str) -> Result<(), Refused> {
    match &signal[..4] {
        "SPI1" | "SPI2" => {
            let spi = SPI[usize::from(signal.starts_with("SPI2"))];
            bench.write(spi + 4, 0x1700);
            bench.write(spi, 0x345);
            bench.try_write(spi + 0x0C, 0x5A, 1)
        }
        "I2C2" => {
            bench.write(I2C + 0x10, 0x0010_0408);
            bench.write(I2C, 1);
            bench.try_write(I2C + 4, 0xD4 | 1 << 16 | 1 << 13, 4)
        }
        _ => {
            bench.write(PORT + 0x0C, 400);
            bench.write(PORT, 0xD);
            if signal.ends_with("RX") {
                bench.controller.hear(b"x", bench.now);
                return bench.try_read(PORT + 0x1C, 4).map(|_| ());
            }
            bench.try_write(PORT + 0x28, b'A'.into(), 4)
        }
    }
}

#[test]
fn a_peripheral_that_is_not_connected_to_its_pin_is_refused_with_signal_and_pin() {
    for (signal, name, function) in SIGNALS {
        let pin = Pin::named(name);
        assert_eq!(use_pin(&mut Bench::new(), signal), Ok(()), "{signal}");
        for what in ["another function", "an output", "analogue"] {
            let mut bench = Bench::new();
            match what {
                "another function" => bench.connect(pin, function + 1),
                "an output" => bench.set_mode(pin, 1),
                _ => bench.set_mode(pin, 3),
            }
            let refused = use_pin(&mut bench, signal).expect_err(what).to_string();
            let expected = format!(
                "{signal} is not connected: {pin} is not in the mode of alternate function {function}"
            );
            assert!(refused.starts_with(&expected), "{what}: {refused}");
        }
    }
}

#[test]
fn the_two_wire_bus_asks_for_open_drains() {
    let mut bench = Bench::new();
    bench.write(registers(Pin::named(b"PB10")) + 4, 1 << 10);
    let refused = use_pin(&mut bench, "I2C2").expect_err("the data pin drives both levels");
    assert_eq!(
        refused.to_string(),
        "I2C2_SDA is not connected: PB11 is not in the mode of alternate function 4 with an open drain"
    );
}

#[test]
fn a_pin_that_is_taken_away_amid_a_byte_is_told() {
    let mut bench = Bench::new();
    assert_eq!(use_pin(&mut bench, "SPI1"), Ok(()));
    bench.pass(Time::microseconds(1));
    let mode = bench.read(GPIO);
    let refused = bench.try_write(GPIO, mode | 3 << 10, 4);
    assert!(matches!(refused, Err(Refused::NotConnected(_))), "{refused:?}");
}
