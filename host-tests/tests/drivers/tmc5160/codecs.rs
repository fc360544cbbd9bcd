//! The driver's pure parts against the data sheet's formulas and tables.

use core::time::Duration;

use drivers::tmc5160::codec::{self, DriverError, Guard, Scales, Status};
use drivers::tmc5160::configuration::{
    Configuration, Currents, MICROSTEPS_PER_TURN, Ramp, Stall, Switches,
};
use drivers::tmc5160::registers;
use drivers::tmc5160::units::{Acceleration, Clock, Velocity};
use drivers::tmc5160::{MOTION_BYTES, STATUS_BYTES, bus_time};
use proptest::prelude::*;

const CLOCKS: [Clock; 2] = [Clock::Internal, Clock::External16MHz];

/// Data sheet, 4.1.1 and 23.1.
#[test]
fn datagrams_are_those_of_the_data_sheet() {
    assert_eq!(codec::read(registers::XACTUAL), [0x21, 0, 0, 0, 0]);
    assert_eq!(codec::write(registers::VMAX, 200_000), [0xA7, 0x00, 0x03, 0x0D, 0x40]);
    let target = codec::write(registers::XTARGET, (-51_200_i32).cast_unsigned());
    assert_eq!(target, [0xAD, 0xFF, 0xFF, 0x38, 0x00]);
    assert_eq!(codec::reply([0x39, 0, 0xAB, 0xCD, 0xEF]), (0x39, 0x00AB_CDEF));
}

/// v·f/2/2²³ and a·f²/(512·256)/2²⁴ (data sheet, 12.1), by hand for round numbers.
#[test]
fn units_are_those_of_the_data_sheet() {
    assert_eq!(Clock::External16MHz.velocity_units(Velocity(1_000_000)), 1_048_576);
    assert_eq!(Clock::External16MHz.velocity(1_048_576), Velocity(1_000_000));
    assert_eq!(Clock::Internal.velocity_units(Velocity(-6_000_000)), 8_388_096);
    assert_eq!(Clock::Internal.velocity(0x00FF_FFFF), Velocity(-1));
    // 1000 units at 16 MHz are 116 415.3 microsteps/s².
    assert_eq!(Clock::External16MHz.acceleration_units(Acceleration(116_415)), 1000);
    assert_eq!(Clock::Internal.acceleration_units(Acceleration(u32::MAX)), 65_535);
    assert_eq!(Clock::Internal.acceleration_units(Acceleration(0)), 1);
    // The example of 23.1: TPWMTHRS 500 is about 35 000 units, 24 000 microsteps/s at 12 MHz.
    assert_eq!(Clock::Internal.step_time(Velocity(24_000)), 500);
    assert_eq!(Clock::Internal.step_time(Velocity(1)), 1_048_575);
    assert_eq!(Clock::Internal.step_time(Velocity(0)), 0);
}

proptest! {
    #[test]
    fn a_velocity_survives_its_units(velocity in -5_999_000_i32..=5_999_000, clock in 0_usize..2) {
        let clock = CLOCKS[clock];
        let units = clock.velocity_units(Velocity(velocity));
        let exact = f64::from(velocity.unsigned_abs()) * 16_777_216.0 / f64::from(clock.hertz());
        prop_assert!((f64::from(units) - exact).abs() <= 0.5);
        prop_assert_eq!(units == 0, velocity == 0);
        let signed = if velocity < 0 { units.wrapping_neg() & 0x00FF_FFFF } else { units };
        prop_assert!((clock.velocity(signed).0 - velocity).abs() <= 1);
    }

    #[test]
    fn an_acceleration_is_rounded_to_the_nearest(value in 100_u32..4_290_000, clock in 0_usize..2) {
        let hertz = f64::from(CLOCKS[clock].hertz());
        let exact = f64::from(value) * 2_199_023_255_552.0 / (hertz * hertz);
        let units = CLOCKS[clock].acceleration_units(Acceleration(value));
        prop_assert!((f64::from(units) - exact.max(1.0)).abs() <= 0.5 + 1e-9);
    }

    #[test]
    fn no_motion_slower_than_the_threshold_passes_it(velocity in 20_i32..6_000_000) {
        let time = f64::from(Clock::Internal.step_time(Velocity(velocity)));
        prop_assert!(12e6 / time >= f64::from(velocity));
        prop_assert!(12e6 / (time + 1.0) < f64::from(velocity));
    }

    #[test]
    fn currents_are_those_of_the_formula(
        run_ma in 300_u16..3000, part in 0.1_f64..1.0, sense_milliohm in 50_u16..100,
    ) {
        let hold_ma = (f64::from(run_ma) * part) as u16;
        let scales = Scales::new(Currents { run_ma, hold_ma, sense_milliohm });
        let full = 0.325 / (f64::from(sense_milliohm) * 1e-3) / 2_f64.sqrt() * 1000.0;
        let current = |scale: u8| {
            f64::from(scales.global) / 256.0 * (f64::from(scale) + 1.0) / 32.0 * full
        };
        prop_assert!((32..=256).contains(&scales.global));
        prop_assert!(scales.hold <= scales.run && scales.run <= 31);
        if f64::from(run_ma) < full && scales.global >= 128 {
            prop_assert!((current(scales.run) / f64::from(run_ma) - 1.0).abs() < 0.005);
            prop_assert!((current(scales.hold) - f64::from(hold_ma)).abs() < full / 64.0 + 5.0);
        }
    }
}

/// Data sheet, chapter 9, table: sense resistor and largest current, which it rounds to 0.1 A.
#[test]
fn the_sense_resistors_of_the_table_give_its_currents() {
    for (milliohm, ampere) in [(220, 1.1), (150, 1.6), (100, 2.3), (75, 3.1), (50, 4.7), (33, 7.1)]
    {
        let currents = |run_ma| Currents { run_ma, hold_ma: run_ma, sense_milliohm: milliohm };
        let full = Scales { global: 256, run: 31, hold: 31 };
        assert_eq!(Scales::new(currents((ampere * 1000.0) as u16)), full, "{milliohm} mΩ");
        let less = Scales::new(currents((ampere * 930.0) as u16));
        assert!(less.run == 31 && less.global < 256, "{milliohm} mΩ: {less:?}");
    }
}

#[test]
fn the_default_currents_use_the_recommended_ranges() {
    let scales = Scales::new(Configuration::default().currents);
    assert_eq!(scales, Scales { global: 134, run: 19, hold: 9 });
}

#[test]
fn soft_stop_and_stall_stop_exclude_each_other() {
    let configuration = Configuration::default();
    let [soft, stall] =
        [Guard::Soft, Guard::Stall].map(|guard| codec::switch_mode(&configuration, guard));
    assert_eq!((soft, stall), (0x821, 0x421));
    let limit = Some(Stall { threshold: 0, above: Velocity(1000) });
    assert_eq!(Guard::at(limit, Velocity(1000)), Guard::Soft);
    assert_eq!(Guard::at(limit, Velocity(-1001)), Guard::Stall);
    assert_eq!(Guard::at(None, Velocity(i32::MIN)), Guard::Soft);
    let switches = Switches { left: None, right: None, do_stop: true };
    let bare = Configuration { switches, ..configuration };
    assert_eq!(codec::switch_mode(&bare, Guard::Stall), 0x400);
    let switches = Switches { do_stop: false, ..configuration.switches };
    let mark = Configuration { switches, ..configuration };
    assert_eq!(codec::switch_mode(&mark, Guard::Stall), 0x420);
}

#[test]
fn the_gravest_error_is_reported() {
    let error = |velocity, driver, global| {
        Status::new(Clock::Internal, [0, 0, velocity, driver, global]).driver_error
    };
    assert_eq!(error(0, 0, 0), None);
    assert_eq!(error(0, 1 << 12 | 1 << 25, 6), Some(DriverError::Short));
    assert_eq!(error(0, 1 << 28, 2), Some(DriverError::Short));
    assert_eq!(error(0, 1 << 25, 2), Some(DriverError::OverTemperature));
    assert_eq!(error(0, 0, 2), Some(DriverError::OverTemperature));
    assert_eq!(error(0, 1 << 26, 0), None, "the prewarning is none");
    assert_eq!(error(0, 0, 4), Some(DriverError::ChargePump));
    assert_eq!(error(100, 1 << 29, 0), Some(DriverError::OpenLoad));
    assert_eq!(error(0, 1 << 29, 0), None, "not reported in standstill");
    assert_eq!(error(200_000, 1 << 30, 0), None, "nor in fast motion");
}

#[test]
fn the_bus_budget_is_as_stated() {
    assert_eq!((STATUS_BYTES, bus_time(STATUS_BYTES)), (40, Duration::from_micros(160)));
    assert_eq!((MOTION_BYTES, bus_time(MOTION_BYTES)), (65, Duration::from_micros(260)));
}

#[test]
fn the_default_ramp_takes_the_stated_times() {
    let ramp = Ramp::default();
    let seconds = |degrees| ramp.time(MICROSTEPS_PER_TURN as u32 * degrees / 360).as_secs_f64();
    assert!((seconds(15) - 1.20).abs() < 0.005, "{}", seconds(15));
    assert!((seconds(360) - 18.41).abs() < 0.005, "{}", seconds(360));
    let peak =
        f64::from(ramp.peak.0) / f64::from(MICROSTEPS_PER_TURN) * 2.0 * core::f64::consts::PI;
    assert!((peak - 0.35).abs() < 1e-6, "{peak} rad/s");
}
