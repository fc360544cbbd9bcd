//! Whatever the data sheet forbids is recorded by the simulated chip.

use embedded_hal_async::spi::SpiDevice;
use hal_mock::chip::SpiChip;
use hal_mock::violation::Misuse;

use super::rig::{HERTZ, Input, exchange, port, rig, run, until};

/// What is recorded when a settled chip is sent this.
fn recorded(sent: &[u8]) -> Vec<(Misuse, u8)> {
    after(50_000, HERTZ, sent)
}

fn after(micros: u64, hertz: u32, sent: &[u8]) -> Vec<(Misuse, u8)> {
    let rig = rig(Input::default());
    run(async {
        until(micros).await;
        port(&rig, hertz).write(sent).await.expect("the simulated bus does not fail");
    });
    let single = rig.borrow();
    let violations = SpiChip::<Input>::violations(&single.chip);
    violations.first.iter().map(|violation| (violation.misuse, violation.address)).collect()
}

#[test]
fn every_kind_of_misuse_is_recorded() {
    assert_eq!(recorded(&[0x40, 0, 0x00]), [(Misuse::ReadOnly, 0x00)]);
    assert_eq!(recorded(&[0x54, 1, 0, 0]), [(Misuse::UnknownRegister, 0x15)]);
    assert_eq!(recorded(&[0x34, 1, 0, 0]), [(Misuse::UnknownRegister, 0x15)]);
    assert_eq!(recorded(&[0x0C]), [(Misuse::UnknownCommand, 0x0C)], "of an ADS1263");
    assert_eq!(recorded(&[0xFF]), [(Misuse::UnknownCommand, 0xFF)]);
    assert_eq!(recorded(&[0x41, 2, 0x01]), [(Misuse::Length, 0x02)]);
    assert_eq!(recorded(&[0x41]), [(Misuse::Length, 0x01)]);
    assert_eq!(recorded(&[0x12, 0, 0, 0, 0, 0]), [(Misuse::Length, 0x12)]);
    assert_eq!(after(50_000, HERTZ + 1, &[0x00]), [(Misuse::ClockTooFast, 0x00)]);
    assert_eq!(after(8888, HERTZ, &[0x06]), [(Misuse::TooEarly, 0x06)]);
    assert_eq!(after(8889, HERTZ, &[0x06]), []);
    assert_eq!(recorded(&[0x06, 0x08]), [(Misuse::TooEarly, 0x08)], "within 8 clocks of a reset");
    assert_eq!(after(49_000, HERTZ, &[0x08]), [(Misuse::TooEarly, 0x08)], "the reference");
}

#[test]
fn reserved_bits_and_values_are_refused_register_by_register() {
    for (address, bits) in [(0x01, 0xEC), (0x02, 0xF0), (0x0F, 0xC0), (0x10, 0x60), (0x11, 0x60)] {
        for bit in (0..8).map(|place| 1 << place).filter(|bit| bits & bit != 0) {
            assert_eq!(recorded(&[0x40 | address, 0, bit]), [(Misuse::ReservedBits, address)]);
        }
    }
    for (address, value) in [
        (0x02, 0x07),
        (0x03, 0x0C),
        (0x03, 0x10),
        (0x04, 0xA0),
        (0x04, 0x10),
        (0x04, 0x07),
        (0x05, 0x64),
        (0x0D, 0x0C),
        (0x0E, 0xB0),
        (0x0F, 0x05),
        (0x10, 0x0A),
        (0x11, 0x10),
    ] {
        assert_eq!(recorded(&[0x40 | address, 0, value]), [(Misuse::ForbiddenValue, address)]);
    }
    // The FIR filter has no 400 SPS.
    assert_eq!(recorded(&[0x45, 0, 0x08, 0x08]), [(Misuse::ForbiddenValue, 0x05)]);
}

#[test]
fn what_may_not_be_written_is_not() {
    let rig = rig(Input::default());
    run(async {
        until(50_000).await;
        exchange(&rig, &[0x41, 3, 0xF1, 0x07, 0x0F, 0x60]).await;
        assert_eq!(exchange(&rig, &[0x21, 3, 0, 0, 0, 0]).await[2..], [0x11, 0x05, 0x00, 0x60]);
    });
}

#[test]
fn a_chip_that_is_not_up_yet_does_nothing() {
    let rig = rig(Input::default());
    run(async {
        until(5000).await;
        assert_eq!(exchange(&rig, &[0x21, 0, 0]).await, [0, 0, 0]);
    });
}
