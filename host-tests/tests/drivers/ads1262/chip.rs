//! The simulated chip alone, against the data sheet (SBAS661C) and a public start-up sequence.

use embassy_time::Instant;
use hal_mock::chip::{Rig as _, Select};

use super::rig::{Input, Rig, exchange, rig, run, until, violations};

/// Supply and reference have settled.
const SETTLED: u64 = 50_000;

/// What a chip shows for a voltage with these registers from MODE1 on, by a read command.
async fn converted(rig: &Rig, mode1: u8, mode2: u8, inputs: u8, wait: u64) -> Vec<u8> {
    until(SETTLED).await;
    exchange(rig, &[0x44, 2, mode1, mode2, inputs]).await;
    exchange(rig, &[0x08]).await;
    until(Instant::now().as_micros() + wait).await;
    exchange(rig, &[0x12, 0, 0, 0, 0, 0, 0]).await
}

/// Start-up routine of TI's example code for ADS1262 and ADS1263 (`ads1263.c`, 2018), as bytes: write
/// all registers from POWER on with their defaults, read all of them, start, read a conversion by
/// command; the defaults from its register definitions.
#[test]
fn the_start_up_of_the_makers_example_code_is_answered() {
    const DEFAULTS: [u8; 20] =
        [0x11, 0x05, 0x00, 0x80, 0x04, 0x01, 0, 0, 0, 0, 0, 0x40, 0xBB, 0, 0, 0, 0, 0, 0, 0];
    let rig = rig(Input::steady(2.5 * f64::from(0x1234_5678) / 2_147_483_648.0));
    let (registers, conversion) = run(async {
        until(SETTLED).await;
        exchange(&rig, &[&[0x41, 19][..], &DEFAULTS].concat()).await;
        let registers = exchange(&rig, &[&[0x20, 20][..], &[0; 21]].concat()).await;
        exchange(&rig, &[0x08]).await;
        // FIR at 20 SPS, the defaults: 52.22 ms (table 9-13).
        until(SETTLED + 53_000).await;
        (registers, exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await)
    });
    assert_eq!(registers[2], 0, "an ADS1262 of revision A");
    assert_eq!(registers[3..], DEFAULTS);
    // New, reset flag not cleared; sum AFh (TI, e2e.ti.com thread 634263).
    assert_eq!(conversion[1..], [0x41, 0x12, 0x34, 0x56, 0x78, 0xAF]);
    assert_eq!(violations(&rig), 0);
}

/// Figures 9-56 and 9-57: 25h 01h reads MODE2 and INPMUX, 45h 01h writes them.
#[test]
fn two_registers_are_read_and_written_as_in_the_data_sheets_figures() {
    let rig = rig(Input::default());
    run(async {
        until(SETTLED).await;
        assert_eq!(exchange(&rig, &[0x25, 0x01, 0, 0]).await[2..], [0x04, 0x01]);
        exchange(&rig, &[0x45, 0x01, 0x18, 0x23]).await;
        assert_eq!(exchange(&rig, &[0x25, 0x01, 0, 0]).await[2..], [0x18, 0x23]);
    });
    assert_eq!(violations(&rig), 0);
}

/// Table 9-19.
#[test]
fn codes_are_those_of_the_data_sheets_table() {
    let lsb = 2.5 / 2_147_483_648.0;
    for (volts, code) in [
        (2.5, i32::MAX),
        (2.7, i32::MAX),
        (lsb, 1),
        (0.0, 0),
        (-lsb, -1),
        (-2.5, i32::MIN),
        (-2.6, i32::MIN),
    ] {
        let rig = rig(Input::steady(volts));
        let reply = run(converted(&rig, 0x00, 0x08, 0x01, 3000));
        assert_eq!(reply[2..6], code.to_be_bytes(), "{volts}");
    }
}

#[test]
fn gain_reversed_inputs_and_calibration_act_as_described() {
    let rig = rig(Input::steady(0.125));
    run(async {
        let gained = converted(&rig, 0x00, 0x28, 0x01, 3000).await;
        assert_eq!(gained[2..6], (0x1999_999A_i32).to_be_bytes(), "0.125 V · 4 of 2.5 V");
        let reversed = converted(&rig, 0x00, 0x28, 0x10, 3000).await;
        assert_eq!(reversed[2..6], (-0x1999_999A_i32).to_be_bytes());
        // Offset 000100h counts 256-fold and is subtracted; full scale 200000h is one half.
        exchange(&rig, &[0x47, 5, 0x00, 0x01, 0x00, 0x00, 0x00, 0x20]).await;
        let calibrated = converted(&rig, 0x00, 0x28, 0x01, 3000).await;
        assert_eq!(calibrated[2..6], ((0x1999_999A_i32 - 0x1_0000) / 2).to_be_bytes());
    });
}

/// The sum and the CRC against the data sheet's words: 9Bh and the bytes; the remainder that makes
/// data and checksum together divisible by 100000111b.
#[test]
fn checksums_are_those_that_the_data_sheet_describes() {
    let rig = rig(Input::steady(2.5 * f64::from(0x1234_5678) / 2_147_483_648.0));
    run(async {
        until(SETTLED).await;
        exchange(&rig, &[0x42, 0, 0x06]).await;
        let reply = converted(&rig, 0x00, 0x08, 0x01, 3000).await;
        let mut rest = reply[2..7].iter().fold(0_u64, |whole, byte| whole << 8 | u64::from(*byte));
        for bit in (8..40).rev() {
            rest ^= if rest >> bit & 1 == 1 { 0x107 << (bit - 8) } else { 0 };
        }
        assert_eq!(rest, 0);
        exchange(&rig, &[0x42, 0, 0x00]).await;
        let bare = exchange(&rig, &[0x12, 0, 0, 0, 0]).await;
        assert_eq!(bare[1..], [0x12, 0x34, 0x56, 0x78], "neither status nor checksum");
    });
}

/// Register tables of TDACP, TDACN and INPMUX.
#[test]
fn test_voltages_shorts_and_monitors_do_not_ask_the_gyro() {
    let rig = rig(Input::steady(1.0));
    run(async {
        for (inputs, positive, negative, volts) in [
            (0xEE, 0x09, 0x00, 2.0),
            (0xEE, 0x07, 0x17, 1.0),
            (0xEE, 0x12, 0x02, -0.031_25),
            (0xEE, 0x00, 0x00, 0.0),
            (0x11, 0x00, 0x00, 0.0),
            (0xFF, 0x00, 0x00, 0.0),
            (0xCC, 0x00, 0x00, 1.25_f64),
        ] {
            exchange(&rig, &[0x00]).await;
            until(SETTLED).await;
            exchange(&rig, &[0x50, 1, positive, negative]).await;
            let reply = converted(&rig, 0x00, 0x08, inputs, 3000).await;
            let code = i32::from_be_bytes([reply[2], reply[3], reply[4], reply[5]]);
            let expected = volts / 2.5 * 2_147_483_648.0;
            assert!((f64::from(code) - expected).abs() <= 1.0, "{inputs:x} {positive:x}: {code}");
        }
    });
    assert_eq!(rig.borrow().environment.asked, 0);
}

/// Table 9-13, and then the nominal rate: 16⅔ SPS is the one whose period is no whole microsecond.
#[test]
fn conversions_come_after_the_latency_and_then_exactly_at_the_rate() {
    let rig = rig(Input::default());
    let times = run(async {
        until(SETTLED).await;
        exchange(&rig, &[0x44, 2, 0x00, 0x0C, 0x01]).await;
        exchange(&rig, &[0x08]).await;
        let start = Instant::now();
        let mut times = Vec::new();
        for _ in 0..7201 {
            let next = rig.borrow_mut().ready_line(Select::Gyro, Instant::now()).next;
            let next = next.expect("it runs");
            times.push((next - start).as_micros());
            until(next.as_micros()).await;
        }
        times
    });
    assert_eq!(times[0], 494);
    assert_eq!(times[1], 494 + 139);
    assert_eq!(times[7200], 1_000_494, "no error adds up");
    // The last one has just ended and the one before it was the last to be overwritten.
    rig.borrow_mut().ready_line(Select::Gyro, Instant::from_micros(SETTLED + 1_100_000));
    assert!(rig.borrow().chip.overwritten >= 7200);
}

/// Figures 9-43 and 9-44: either way of reading, and what an unread conversion gives way to.
#[test]
fn a_conversion_is_read_directly_once_or_by_command_at_any_time() {
    let rig = rig(Input { volts: 0.0, volts_per_s: 1.0, asked: 0 });
    run(async {
        until(SETTLED).await;
        exchange(&rig, &[0x41, 0, 0x01]).await;
        let by_command = converted(&rig, 0x00, 0x08, 0x01, 2860).await;
        assert_eq!(by_command[1] & 0x41, 0x40, "new, and no reset flag");
        assert_eq!(by_command[0], by_command[1], "the shift register was loaded as well");
        let again = exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await;
        assert_eq!(again[0], 0, "the clock has moved since data-ready");
        assert_eq!(again[1] & 0x40, 0, "not new");
        assert_eq!(again[2..], by_command[2..]);
        until(Instant::now().as_micros() + 2500).await;
        let direct = exchange(&rig, &[0; 8]).await;
        assert_eq!(direct[0] & 0x40, 0x40);
        assert_ne!(direct[1..5], by_command[2..6], "a later one");
        assert_eq!(direct[6..], direct[..2], "it is repeated");
        let after = exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await;
        assert_eq!(after[1] & 0x40, 0, "read directly is read");
    });
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_reset_restores_registers_and_stops_conversions() {
    let rig = rig(Input::default());
    run(async {
        converted(&rig, 0x00, 0x08, 0x01, 3000).await;
        exchange(&rig, &[0x41, 0, 0x01]).await;
        exchange(&rig, &[0x06]).await;
        until(Instant::now().as_micros() + 2).await;
        assert_eq!(exchange(&rig, &[0x21, 1, 0, 0]).await[2..], [0x11, 0x05]);
        until(Instant::now().as_micros() + 1_000_000).await;
        let reply = exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await;
        assert_eq!(reply[1..], [0x01, 0, 0, 0, 0, 0x9B]);
    });
    assert_eq!(violations(&rig), 0);
}

#[test]
fn one_shot_gives_one_conversion_and_a_written_mode_begins_anew() {
    let rig = rig(Input::default());
    run(async {
        until(SETTLED).await;
        exchange(&rig, &[0x43, 0, 0x40]).await;
        let first = converted(&rig, 0x00, 0x08, 0x01, 10_000).await;
        assert_eq!(first[1] & 0x40, 0x40);
        until(Instant::now().as_micros() + 10_000).await;
        assert_eq!(exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await[1] & 0x40, 0);
        exchange(&rig, &[0x43, 0, 0x00]).await;
        exchange(&rig, &[0x08]).await;
        until(Instant::now().as_micros() + 2000).await;
        exchange(&rig, &[0x45, 0, 0x08]).await;
        until(Instant::now().as_micros() + 2000).await;
        assert_eq!(exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await[1] & 0x40, 0);
        until(Instant::now().as_micros() + 860).await;
        assert_eq!(exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await[1] & 0x40, 0x40);
        exchange(&rig, &[0x0A]).await;
        until(Instant::now().as_micros() + 10_000).await;
        assert_eq!(exchange(&rig, &[0x12, 0, 0, 0, 0, 0, 0]).await[1] & 0x40, 0, "stopped");
    });
}

/// Table 9-18: 105 % of the range, 0.2 V from a supply, a reference of 0.4 V.
#[test]
fn alarms_are_raised_where_the_data_sheet_draws_the_lines() {
    for (volts, reference, alarms) in [
        (2.6, 2.5, 0x00),
        (2.63, 2.5, 0x02),
        (4.7, 2.5, 0x0E),
        (-4.7, 2.5, 0x0E),
        (0.0, 0.41, 0x00),
        (0.0, 0.39, 0x10),
    ] {
        let rig = rig(Input::steady(volts));
        rig.borrow_mut().chip.voltages.reference = reference;
        let reply = run(converted(&rig, 0x00, 0x08, 0x01, 3000));
        assert_eq!(reply[1] & 0x3E, alarms, "{volts} {reference}");
    }
}
