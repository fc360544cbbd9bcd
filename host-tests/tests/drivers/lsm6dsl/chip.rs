//! The simulated chip against transcripts from other hands and against the data sheet's rules.

use embassy_time::{Instant, Timer};
use embedded_hal_async::i2c::{ErrorKind, I2c, NoAcknowledgeSource};
use hal_mock::i2c::I2cPort;
use hal_mock::lsm6dsl::{BOOT_TIME, RESET_TIME};
use hal_mock::violation::Misuse;

use super::rig::Row::{Read, Write};
use super::rig::{level, port, rig_with, run, transcript, violations};

/// The byte sequence of `st_lsm6dsx_init_device` in Linux' `st_lsm6dsx_core.c`: reset, 50 ms, boot,
/// 50 ms, block data update; then 208 Hz, 8750 µ°/s and 61 µg a count as its tables have them.
#[test]
fn the_chip_starts_as_the_linux_driver_starts_it() {
    let rig = rig_with([0.5, 0.0, -1.0], [90.0, 0.0, -1.0]);
    run(async {
        Timer::after(BOOT_TIME).await;
        transcript(&rig, &[Read(0x0F, &[0x6A]), Read(0x12, &[0x04]), Write(&[0x12, 0x05])]).await;
        Timer::after_millis(50).await;
        transcript(&rig, &[Read(0x12, &[0x04]), Write(&[0x12, 0x84])]).await;
        Timer::after_millis(50).await;
        transcript(&rig, &[Read(0x12, &[0x04]), Write(&[0x12, 0x44])]).await;
        let switch = [Read(0x10, &[0, 0]), Write(&[0x10, 0x50]), Write(&[0x11, 0x50])];
        transcript(&rig, &switch).await;
        Timer::after_millis(100).await;
        // 90 °/s over 8.75 m°/s is 10 286 = 0x282E, −1 °/s is −114; 0.5 g over 0.061 mg is 8197.
        let rates = [0x2E, 0x28, 0, 0, 0x8E, 0xFF];
        let forces = [0x05, 0x20, 0, 0, 0xF7, 0xBF];
        transcript(&rig, &[Read(0x1E, &[0x07 & 0x03]), Read(0x22, &rates), Read(0x28, &forces)])
            .await;
        transcript(&rig, &[Read(0x1E, &[0x00])]).await;
    });
    assert_eq!(violations(&rig), []);
}

/// The byte sequence of ST's `lsm6dsl_self_test.c` with the register writes that its driver makes of
/// each call; five samples less one, its limits 90 … 1700 mg and 150 … 700 °/s.
#[test]
fn the_chip_passes_the_makers_own_self_test() {
    let rig = rig_with([0.1, 0.0, -1.0], [0.0; 3]);
    run(async {
        Timer::after_millis(15).await;
        transcript(&rig, &[Read(0x0F, &[0x6A]), Read(0x12, &[0x04]), Write(&[0x12, 0x05])]).await;
        Timer::after(RESET_TIME).await;
        let bdu = [Read(0x12, &[0x04]), Write(&[0x12, 0x44])];
        transcript(&rig, &bdu).await;
        let slow = [Read(0x10, &[0x00]), Write(&[0x10, 0x30]), Read(0x10, &[0x30])];
        transcript(&rig, &slow).await;
        transcript(&rig, &[Write(&[0x10, 0x38])]).await;
        Timer::after_millis(100).await;
        // 0.1 g over 0.122 mg is 820, −1 g is −8197.
        transcript(&rig, &[Read(0x28, &[0x34, 0x03, 0x00, 0x00, 0xFB, 0xDF])]).await;
        transcript(&rig, &[Read(0x14, &[0x00]), Write(&[0x14, 0x02])]).await;
        Timer::after_millis(100).await;
        let pushed = answer(&rig, 0x28).await.map(|count| f64::from(count) * 0.122);
        for (pushed, rest) in pushed.into_iter().zip([100.0, 0.0, -1000.0]) {
            assert!((90.0..=1700.0).contains(&(pushed - rest).abs()), "{pushed} mg");
        }
        transcript(&rig, &[Write(&[0x14, 0x00]), Write(&[0x10, 0x08])]).await;
        let fast = [Read(0x11, &[0x00]), Write(&[0x11, 0x50]), Write(&[0x11, 0x5C])];
        transcript(&rig, &fast).await;
        Timer::after_millis(150).await;
        assert_eq!(answer(&rig, 0x22).await, [0; 3]);
        transcript(&rig, &[Write(&[0x14, 0x04])]).await;
        Timer::after_millis(50).await;
        for count in answer(&rig, 0x22).await {
            assert!((150.0..=700.0).contains(&(f64::from(count) * 0.07)), "{count}");
        }
    });
    assert_eq!(violations(&rig), []);
}

async fn answer(rig: &super::rig::Rig, first: u8) -> [i16; 3] {
    let mut bytes = [0; 6];
    port(rig).write_read(0x6A, &[first], &mut bytes).await.expect("it answers");
    [0, 2, 4].map(|i| i16::from_le_bytes([bytes[i], bytes[i + 1]]))
}

/// The data sheet's table of registers: what is not zero after a reset.
#[test]
fn a_chip_holds_the_documented_values_after_power_up() {
    let rig = level();
    run(async {
        Timer::after(BOOT_TIME).await;
        transcript(&rig, &[Read(0x0F, &[0x6A]), Read(0x10, &[0, 0, 4, 0, 0, 0, 0, 0, 0xE0, 0])])
            .await;
    });
    assert_eq!(violations(&rig), []);
}

#[test]
fn nobody_acknowledges_another_address_or_too_early() {
    let rig = level();
    run(async {
        let silent = Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        assert_eq!(port(&rig).write_read(0x6A, &[0x0F], &mut [0]).await, silent);
        Timer::after(BOOT_TIME).await;
        assert_eq!(port(&rig).write_read(0x6B, &[0x0F], &mut [0]).await, silent);
        port(&rig).write(0x6A, &[0x12, 0x84]).await.expect("it answers");
        assert_eq!(port(&rig).write_read(0x6A, &[0x0F], &mut [0]).await, silent);
        let mut control = [0];
        port(&rig).write_read(0x6A, &[0x12], &mut control).await.expect("it answers");
        assert_eq!(control, [0x84], "still booting");
    });
    assert_eq!(violations(&rig), [Misuse::TooEarly; 2]);
}

#[test]
fn every_kind_of_misuse_is_recorded() {
    let rig = level();
    run(async {
        Timer::after(BOOT_TIME).await;
        let write = async |bytes: &[u8]| port(&rig).write(0x6A, bytes).await.expect("it answers");
        write(&[0x0F, 0]).await;
        write(&[0x1F, 0]).await;
        write(&[0x11, 0x51]).await;
        write(&[0x11, 0xB0]).await;
        write(&[0x14, 0x03]).await;
        write(&[0x12, 0x06]).await;
        port(&rig).write_read(0x6A, &[0x1F], &mut [0]).await.expect("it answers");
        let mut fast = I2cPort::new(&rig, 400_001);
        fast.write_read(0x6A, &[0x0F], &mut [0]).await.expect("it answers");
        port(&rig).read(0x6A, &mut [0]).await.expect("it answers");
    });
    let expected = [
        Misuse::ReadOnly,
        Misuse::UnknownRegister,
        Misuse::ReservedBits,
        Misuse::ForbiddenValue,
        Misuse::ForbiddenValue,
        Misuse::ForbiddenValue,
        Misuse::UnknownRegister,
        Misuse::ClockTooFast,
        Misuse::Length,
    ];
    assert_eq!(violations(&rig), expected);
}

#[test]
fn samples_come_at_the_output_rate_and_are_new_once() {
    for (control, hertz) in [(0x40, 104), (0x50, 208), (0x60, 416)] {
        let rig = level();
        run(async {
            Timer::after(BOOT_TIME).await;
            transcript(&rig, &[Write(&[0x11, control])]).await;
            let (begin, mut count) = (Instant::now(), 0);
            while (Instant::now() - begin).as_millis() < 1000 {
                let mut status = [0];
                port(&rig).write_read(0x6A, &[0x1E], &mut status).await.expect("it answers");
                if status[0] & 0x02 != 0 {
                    count += 1;
                    answer(&rig, 0x22).await;
                }
            }
            assert!((hertz - 1..=hertz + 1).contains(&count), "{count} of {hertz}");
        });
    }
}

/// A burst that a sample lands in must show both bytes of an axis from one sample with block data
/// update, and here does not without it.
#[test]
fn block_data_update_holds_an_axis_together() {
    for (control, may_tear) in [(0x44, false), (0x04, true)] {
        let mut torn = 0;
        for early in 0..60 {
            let rig = rig_with([0.0, 0.0, -1.0], [0.0; 3]);
            run(async {
                Timer::after(BOOT_TIME).await;
                transcript(&rig, &[Write(&[0x12, control]), Write(&[0x11, 0x50])]).await;
                let begin = Instant::now();
                Timer::at(begin + embassy_time::Duration::from_millis(100)).await;
                // What was due until now is taken before the rate changes, by this look.
                assert_eq!(answer(&rig, 0x22).await, [0; 3]);
                // From 0 to 300 counts: bytes 0x00 0x00 and 0x2C 0x01.
                rig.borrow_mut().environment.rate = [300.0 * 8.75e-3; 3];
                let next = begin.as_micros() + 21 * 1_000_000 / 208 - 40 - 9;
                Timer::at(Instant::from_micros(next - 5 * early)).await;
                for count in answer(&rig, 0x22).await {
                    torn += u32::from(count != 0 && count != 300);
                }
            });
        }
        assert_eq!(torn > 0, may_tear, "{torn}");
    }
}
