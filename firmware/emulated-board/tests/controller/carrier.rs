//! The wires of a board to the chips of its carrier.

use std::cell::RefCell;
use std::rc::Rc;

use embassy_time::Instant;
use emulated_board::time::Time;
use emulated_board::wiring::board::{Board, Carrier, ONE_LINE, SPIN, SPIN_LINES, STAGE};
use emulated_board::wiring::{Pin, Wiring};
use hal_mock::chip::{BusLimits, Exchange, ReadyLine, Rig, Select, Transaction};

use super::{Bench, registers};

/// The serial port USART1.
const PORT: u32 = 0x4001_3800;

/// A carrier whose chips do nothing: how often, and to what, its motor drivers were switched.
#[derive(Default)]
struct Quiet(Vec<bool>);

impl Rig for Quiet {
    fn transact(&mut self, _: Select, _: &Transaction, _: &mut [u8]) {}

    fn select(&mut self, _: Select, _: Instant) {}

    fn exchange(&mut self, _: Select, _: &Exchange) -> u8 {
        0xFF
    }

    fn deselect(&mut self, _: Select, _: Instant, _: Instant, _: bool) {}

    fn limits(&mut self, _: Select) -> BusLimits {
        BusLimits::default()
    }

    fn ready_line(&mut self, _: Select, _: Instant) -> ReadyLine {
        ReadyLine::default()
    }

    fn power_cycle(&mut self, _: Select, _: Instant) {}
}

impl Carrier for Quiet {
    fn violations(&mut self) -> Vec<String> {
        Vec::new()
    }

    fn lost(&self) -> u64 {
        0
    }

    fn enable_motors(&mut self, is_enabled: bool) {
        self.0.push(is_enabled);
    }
}

/// A board with such a carrier, which has the wires of a stage.
fn board() -> (Board, Rc<RefCell<Quiet>>) {
    let carrier = Rc::new(RefCell::new(Quiet::default()));
    (Board::new(carrier.clone(), (STAGE, ONE_LINE), None), carrier)
}

#[test]
fn motors_run_only_while_their_enable_pin_is_driven_low() {
    // DRV_ENN, which a resistor pulls up.
    let enable = Pin::named(b"PD2");
    for level in [None, Some(true)] {
        let (mut board, carrier) = board();
        for driven in [level, Some(false), level, level] {
            board.drive(enable, driven, Time::ZERO);
        }
        assert_eq!(carrier.borrow().0, [false, true, false], "{level:?}");
    }
}

#[test]
fn a_link_at_another_rate_than_that_of_the_virtual_com_port_is_told_once() {
    // 4 MHz / 35 and / 34 are 0.8 % below and 2.1 % above 115 200 baud, / 33 and / 36 5.2 % above and 3.5 % below; the last
    // is 9600 baud.
    for (divider, told) in [
        (35, None),
        (34, None),
        (33, Some("the link: 121212 baud, where 115200 are meant")),
        (36, Some("the link: 111111 baud, where 115200 are meant")),
        (417, Some("the link: 9592 baud, where 115200 are meant")),
    ] {
        let mut bench = Bench::wired(board().0);
        bench.connect_all();
        bench.write(PORT + 0x0C, divider);
        bench.write(PORT, 0xD);
        for _ in 0..2 {
            bench.write(PORT + 0x28, b'A'.into());
            bench.pass(Time::microseconds(2000));
        }
        // Another one that is wrong is not told beside it.
        bench.write(PORT + 0x0C, if told.is_some() { 400 } else { divider });
        bench.write(PORT + 0x28, b'A'.into());
        assert_eq!(bench.controller.wiring.faults(), told.as_slice(), "4 MHz / {divider}");
    }
}

#[test]
fn an_output_against_that_of_a_chip_is_told_once_with_its_pin() {
    let outputs: [(&[u8], &str); 6] = [
        (b"PB0", "GyroRight"),
        (b"PB1", "GyroUp"),
        (b"PB7", "the virtual COM port"),
        (b"PC3", "ForceRight"),
        (b"PC4", "ForceUp"),
        (b"PD14", "Gyro"),
    ];
    for (name, chip) in outputs {
        let pin = Pin::named(name);
        let told = format!("{pin}: the controller drives it against {chip}");
        // As an open drain that is high it drives nothing.
        for (is_open_drain, is_high) in [(false, false), (false, true), (true, false), (true, true)]
        {
            let carrier = Rc::new(RefCell::new(Quiet::default()));
            let mut bench = Bench::wired(Board::new(carrier, (SPIN, SPIN_LINES), None));
            bench.write(registers(pin) + 4, u32::from(is_open_drain) << pin.number);
            bench.write(registers(pin) + 0x14, u32::from(is_high) << pin.number);
            for mode in [0, 2, 3] {
                bench.set_mode(pin, mode);
            }
            assert!(bench.controller.wiring.faults().is_empty(), "{pin} is no output");
            for mode in [1, 0, 1] {
                bench.set_mode(pin, mode);
            }
            let expected = if is_open_drain && is_high { vec![] } else { vec![told.clone()] };
            let faults = bench.controller.wiring.faults();
            assert_eq!(faults, expected, "open drain: {is_open_drain}, high: {is_high}");
        }
    }
}

#[test]
fn outputs_at_pins_that_no_chip_drives_are_not_told() {
    let mut bench = Bench::wired(board().0);
    let outputs = (0..8).flat_map(|port| (0..16).map(move |number| Pin { port, number }));
    for pin in outputs.filter(|pin| ![Pin::named(b"PD14"), Pin::named(b"PB7")].contains(pin)) {
        bench.set_mode(pin, 1);
    }
    let faults = bench.controller.wiring.faults();
    let opposed: Vec<&String> = faults.iter().filter(|fault| fault.contains("drives")).collect();
    assert!(opposed.is_empty(), "{opposed:?}");
}
