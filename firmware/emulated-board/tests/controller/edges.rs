//! Interrupts by edges of pins (RM0351, chapter 14), and the ports that they come from (chapter 9).

use emulated_board::controller::Refused;
use emulated_board::time::Time;
use emulated_board::wiring::Pin;

use super::{Bench, RCC};

/// The interrupt controller of edges.
const EXTI: u32 = 0x4001_0400;
/// The system configuration.
const CONFIGURATION: u32 = 0x4001_0000;

/// An edge at a pin.
fn edge(bench: &mut Bench, pin: Pin, rises: bool) {
    bench.wires.0.borrow_mut().edge = Some((bench.now + Time::microseconds(1), pin, rises));
    bench.pass(Time::microseconds(1));
}

/// A controller whose line 14 is PD14, an input, and interrupts at its falling edge.
fn listening() -> Bench {
    let mut bench = Bench::clocked();
    bench.set_mode(Pin::named(b"PD14"), 0);
    // EXTICR4: the third line of four is 14; port D is 3 (9.2.6).
    bench.write(CONFIGURATION + 0x14, 3 << 8);
    bench.write(EXTI + 0x0C, 1 << 14);
    bench.write(EXTI, 1 << 14);
    bench
}

#[test]
fn registers_begin_as_the_manual_has_them() {
    let mut bench = Bench::clocked();
    // 14.5.1 to 14.5.6: IMR1, EMR1, RTSR1, FTSR1, PR1.
    let held = [0x00, 0x04, 0x08, 0x0C, 0x14].map(|offset| bench.read(EXTI + offset));
    assert_eq!(held, [0xFF82_0000, 0, 0, 0, 0]);
    let ports = [0x08, 0x0C, 0x10, 0x14].map(|offset| bench.read(CONFIGURATION + offset));
    assert_eq!(ports, [0; 4]);
}

#[test]
fn a_falling_edge_interrupts_until_its_flag_is_cleared() {
    let mut bench = listening();
    edge(&mut bench, Pin::named(b"PD14"), false);
    assert_eq!(bench.read(EXTI + 0x14), 1 << 14);
    assert!(bench.interrupts(40));
    bench.write(EXTI + 0x14, 1 << 13);
    assert!(bench.interrupts(40), "the flag of another line was cleared");
    bench.write(EXTI + 0x14, 1 << 14);
    assert!(!bench.interrupts(40));
}

#[test]
fn a_line_that_is_masked_keeps_its_flag_and_interrupts_when_it_is_unmasked() {
    let mut bench = listening();
    bench.write(EXTI, 0);
    edge(&mut bench, Pin::named(b"PD14"), false);
    assert_eq!(bench.read(EXTI + 0x14), 1 << 14);
    assert!(!bench.interrupts(40));
    bench.write(EXTI, 1 << 14);
    assert!(bench.interrupts(40));
}

#[test]
fn an_edge_of_another_direction_or_port_or_at_an_analogue_pin_is_none() {
    let mut bench = listening();
    edge(&mut bench, Pin::named(b"PD14"), true);
    assert_eq!(bench.read(EXTI + 0x14), 0, "it rises");
    let other = Pin::named(b"PC14");
    bench.set_mode(other, 0);
    edge(&mut bench, other, false);
    assert_eq!(bench.read(EXTI + 0x14), 0, "of another port");
    bench.set_mode(Pin::named(b"PD14"), 3);
    edge(&mut bench, Pin::named(b"PD14"), false);
    assert_eq!(bench.read(EXTI + 0x14), 0, "analogue");
}

#[test]
fn an_edge_that_comes_while_its_flag_is_set_is_counted_as_missed() {
    let mut bench = listening();
    edge(&mut bench, Pin::named(b"PD14"), false);
    assert_eq!(bench.controller.exti.missed, 0);
    edge(&mut bench, Pin::named(b"PD14"), false);
    assert_eq!(bench.controller.exti.missed, 1);
}

#[test]
fn each_line_has_the_interrupt_of_the_manual() {
    for line in 0..16 {
        // Table 57: five of their own, then two for several lines.
        let interrupt = match line {
            0..5 => 6 + line as usize,
            5..10 => 23,
            _ => 40,
        };
        let mut bench = Bench::clocked();
        let pin = Pin { port: 1, number: line };
        bench.set_mode(pin, 0);
        bench.write(CONFIGURATION + 8 + line / 4 * 4, 1 << (4 * (line % 4)));
        bench.write(EXTI + 0x08, 1 << line);
        bench.write(EXTI, 1 << line);
        edge(&mut bench, pin, true);
        let active: Vec<usize> = (0..82).filter(|number| bench.interrupts(*number)).collect();
        assert_eq!(active, [interrupt], "line {line}");
    }
}

#[test]
fn the_port_of_a_line_has_three_bits_and_a_reset_of_the_configuration_clears_it() {
    let mut bench = Bench::clocked();
    bench.write(CONFIGURATION + 0x08, 0xFFFF_FFFF);
    assert_eq!(bench.read(CONFIGURATION + 0x08), 0x7777);
    bench.write(RCC + 0x40, 1);
    bench.write(RCC + 0x40, 0);
    assert_eq!(bench.read(CONFIGURATION + 0x08), 0);
}

#[test]
fn events_and_edges_by_software_are_refused() {
    let mut bench = Bench::clocked();
    bench.write(EXTI + 0x04, 0);
    let refused = bench.try_write(EXTI + 0x04, 1 << 3, 4);
    assert_eq!(refused, Err(Refused::NotModelled("lines that wake as events")));
    assert_eq!(bench.try_write(EXTI + 0x10, 1, 4), Err(Refused::Unknown));
}

#[test]
fn the_map_of_memory_and_the_switches_of_the_configuration_are_refused() {
    let mut bench = Bench::clocked();
    for offset in [0x00, 0x04, 0x18, 0x1C] {
        assert_eq!(bench.try_read(CONFIGURATION + offset, 4), Err(Refused::Unknown), "{offset:#x}");
    }
}
