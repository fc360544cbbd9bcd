//! Recordings spoilt in one place are refused with the reason, whatever the sensor.

use orientation::alignment::rotating;
use orientation::device::{Device, Trouble};

use super::{BACK_S, GYRO, MET, MODULATED_S, Recorded, Refusal, conclusion, recorded};
use host::output::azimuth_error;
use host::recording::RotatingRow;

/// The gyro's recording with its rows changed.
fn gyro(change: impl FnOnce(&mut Vec<RotatingRow>)) -> Recorded {
    let mut recorded = recorded(GYRO);
    change(&mut recorded.rows);
    recorded
}

/// Changes the rows from a time on.
fn from(rows: &mut [RotatingRow], seconds: f64, change: impl Fn(&mut RotatingRow)) {
    rows.iter_mut().filter(|row| row.time_s >= seconds).for_each(change);
}

#[test]
fn half_a_turn_back_is_refused() {
    let half = gyro(|rows| rows.retain(|row| row.time_s < BACK_S + 0.5 / 0.137));
    assert!(
        matches!(half.refusal(), Refusal::Rotating(rotating::Refusal::TurnsTooFew { .. })),
        "{}",
        half.refusal()
    );
}

#[test]
fn one_sense_alone_is_refused() {
    let clockwise = gyro(|rows| rows.retain(|row| row.time_s < BACK_S));
    let reason = clockwise.refusal();
    assert_eq!(
        reason.to_string(),
        "0 whole even turn(s) counter-clockwise: two are needed in either sense"
    );
}

#[test]
fn speeds_that_differ_are_refused() {
    for faster in [1.02, 1.1] {
        let unequal = gyro(|rows| {
            from(rows, BACK_S, |row| {
                row.time_s = BACK_S + (row.time_s - BACK_S) / faster;
                row.stage_rate_rad_s *= faster;
            });
        });
        assert!(
            matches!(unequal.refusal(), Refusal::Rotating(rotating::Refusal::SpeedsUnequal { .. })),
            "{}",
            unequal.refusal()
        );
    }
}

#[test]
fn a_platform_that_stops_is_refused() {
    let stopped = gyro(|rows| {
        let at = BACK_S + 10.0;
        let stands = rows.iter().find(|row| row.time_s >= at).map_or(0.0, |row| row.stage_rad);
        from(rows, at, |row| {
            row.stage_rad = stands;
            row.stage_rate_rad_s = 0.0;
        });
    });
    assert!(
        matches!(stopped.refusal(), Refusal::Rotating(rotating::Refusal::TurnsTooFew { .. })),
        "{}",
        stopped.refusal()
    );
}

#[test]
fn an_encoder_that_slips_is_refused() {
    for slip_deg in [1.0_f64, -2.0, 10.0] {
        let slipped = gyro(|rows| from(rows, 130.0, |row| row.stage_rad += slip_deg.to_radians()));
        let Refusal::Rotating(rotating::Refusal::EncoderSlipped { angle }) = slipped.refusal()
        else {
            panic!("{slip_deg}°: {}", slipped.refusal());
        };
        assert!((angle.0 - slip_deg).abs() < 0.3, "{}° of {slip_deg}°", angle.0);
    }
}

#[test]
fn a_slow_slip_gives_no_wrong_north() {
    for degrees_a_minute in [0.5_f64, 2.0, 10.0, 60.0] {
        let crept = gyro(|rows| {
            from(rows, 130.0, |row| {
                row.stage_rad += (degrees_a_minute / 60.0).to_radians() * (row.time_s - 130.0);
            });
        });
        let replay = crept.replayed();
        if let Ok(azimuth) = conclusion(&replay).verdict {
            let error = azimuth_error(azimuth.angle.degrees(), crept.truth_deg);
            let sigma = azimuth.sigma.degrees();
            assert!(error.abs() < 5.0 * sigma, "{degrees_a_minute}° a minute: {error}° ± {sigma}°");
        }
    }
}

#[test]
fn an_accelerometer_that_is_stuck_or_saturated_is_refused() {
    for (force_m_s2, trouble) in
        [(0.031, Trouble::Stuck), (20.08, Trouble::Saturated), (-20.08, Trouble::Saturated)]
    {
        for begin in [0.0, 130.0, 200.0] {
            let spoilt = gyro(|rows| from(rows, begin, |row| row.force_m_s2 = force_m_s2));
            let reason = spoilt.refusal();
            let Refusal::Device { device, trouble: reported } = reason else {
                panic!("{force_m_s2} from {begin} s: {reason}");
            };
            assert_eq!(
                (device, reported),
                (Device::Accelerometer, trouble),
                "{force_m_s2} from {begin} s"
            );
        }
    }
}

#[test]
fn without_the_modulated_stretch_there_is_no_north_of_an_uneven_platform() {
    for name in [GYRO, MET] {
        let mut even = recorded(name);
        let modulated_s = if name == GYRO { MODULATED_S } else { 122.0 };
        even.rows.retain(|row| row.time_s > modulated_s);
        let replay = even.replayed();
        if let Ok(azimuth) = conclusion(&replay).verdict {
            let error = azimuth_error(azimuth.angle.degrees(), even.truth_deg);
            assert!(error.abs() < 3.5 * azimuth.sigma.degrees(), "{name}: {error}°");
        }
    }
}

#[test]
fn a_molecular_sensor_at_one_speed_gives_what_its_sigma_says() {
    let mut one = recorded(MET);
    one.rows.retain(|row| row.time_s < 280.0);
    let replay = one.replayed();
    let found = conclusion(&replay);
    let fit = found.fit.expect("there is a fit");
    let error = azimuth_error(fit.azimuth.degrees(), one.truth_deg);
    assert!(error.abs() < 3.5 * fit.sigma().degrees(), "{error}° ± {}°", fit.sigma().degrees());
    assert!(fit.sigma().0 > 3.0 * fit.plain_limit.0, "one speed cannot be so good");
}
