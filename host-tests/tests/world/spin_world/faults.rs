//! What goes wrong with the sensors of a spinning body shows where it is, for as long as stated.

use hal_mock::sensor_fault::{SensorFailure, SensorFault};
use hal_mock::spin::profile::Profile;
use hal_mock::spin::{SpinConfiguration, SpinSample, SpinWorld};

use super::{G, at, flown};

/// What the sensors show with a fault, and without.
fn both(faults: &[SensorFault]) -> [Vec<SpinSample>; 2] {
    let body = SpinConfiguration { seconds: 0.1, ..SpinConfiguration::default() };
    [faults, &[]].map(|faults| SpinWorld::new(&SpinConfiguration { faults, ..body }, 1).collect())
}

/// The channels of a sample.
fn channels(sample: &SpinSample) -> [f64; 5] {
    let ([x, y, z], [up, right]) = (sample.rate_rad_s, sample.force_m_s2);
    [x, y, z, up, right]
}

#[test]
fn samples_of_a_gap_are_missing_and_no_other_changes() {
    let [lost, all] =
        both(&[SensorFault { failure: SensorFailure::Gap, from_s: 0.05, until_s: 0.052 }]);
    assert_eq!((all.len(), lost.len()), (1000, 980));
    let kept = all.iter().filter(|sample| !(0.05..0.052).contains(&sample.time_s));
    assert!(kept.eq(&lost));
}

#[test]
fn one_channel_is_no_number_for_as_long_as_stated() {
    for channel in 0..5 {
        let [spoilt, all] = both(&[SensorFault {
            failure: SensorFailure::NotANumber(channel),
            from_s: 0.05,
            until_s: 0.06,
        }]);
        for (sample, clean) in spoilt.iter().zip(&all) {
            let (shown, expected) = (channels(sample), channels(clean));
            for other in 0..5 {
                let is_spoilt = other == channel && (0.05..0.06).contains(&sample.time_s);
                assert_eq!(shown[other].is_nan(), is_spoilt);
                assert!(is_spoilt || shown[other] == expected[other]);
            }
        }
    }
}

#[test]
fn a_channel_sticks_at_its_last_value_and_comes_back() {
    let [stuck, all] =
        both(&[SensorFault { failure: SensorFailure::Stuck(3), from_s: 0.05, until_s: 0.06 }]);
    assert!(stuck[500..600].iter().all(|sample| sample.force_m_s2[0] == all[499].force_m_s2[0]));
    assert_eq!(stuck[600], all[600]);
}

#[test]
fn sensors_clip_at_their_full_scale_and_at_an_overload() {
    let mut body = SpinConfiguration {
        seconds: 0.02,
        gyro_full_scale_rad_s: [600.0, 1.0, 1.0],
        ..SpinConfiguration::default()
    };
    body.accelerometer.full_scale_m_s2 = Some(5000.0);
    let samples: Vec<_> = SpinWorld::new(&body, 1).collect();
    assert!(samples.iter().all(|sample| sample.rate_rad_s[0] == 600.0));
    assert!(samples.iter().all(|sample| sample.force_m_s2[0] == -5000.0));
    assert!(samples.iter().all(|sample| sample.force_m_s2[1].abs() < 5000.0));
    let faults = [SensorFault { failure: SensorFailure::Saturated(1), from_s: 0.0, until_s: 0.01 }];
    let samples: Vec<_> =
        SpinWorld::new(&SpinConfiguration { faults: &faults, ..body }, 1).collect();
    assert_eq!((samples[0].rate_rad_s[1], samples[100].rate_rad_s[1]), (1.0, 0.0));
}

#[test]
fn a_lift_that_fades_or_turns_round_leaves_the_centripetal_part_alone() {
    let lift = [(0.0, G), (0.3, G), (0.32, 0.0), (0.6, 0.0), (0.62, -G)];
    let mut body = SpinConfiguration::default();
    body.forces.lift_m_s2 = Profile(&lift);
    let samples = flown(&body, 1);
    let swing = |time_s: f64| {
        let (sample, truth) = at(&samples, time_s);
        let centred = sample.force_m_s2[0] + 0.02 * sample.rate_rad_s[0].powi(2);
        (centred - truth.lift_m_s2 * truth.roll_rad.cos(), truth.lift_m_s2)
    };
    for (time_s, lift) in [(0.1, G), (0.31, 0.5 * G), (0.4, 0.0), (0.61, -0.5 * G), (0.9, -G)] {
        let (rest, found) = swing(time_s);
        assert!(rest.abs() < 1e-9 && (found - lift).abs() < 1e-9, "{time_s} s: {rest}, {found}");
    }
}

#[test]
fn a_spin_that_stops_leaves_the_roll_where_it_is() {
    let body = SpinConfiguration {
        spin_rad_s: Profile(&[(0.2, 600.0), (0.4, 0.0)]),
        ..SpinConfiguration::default()
    };
    let samples = flown(&body, 1);
    // 0.2 s at 600 rad/s, and half as fast on average for another 0.2 s.
    for time_s in [0.4, 0.7, 0.99] {
        let (sample, truth) = at(&samples, time_s);
        assert!((truth.roll_rad - 180.0).abs() < 1e-9, "{}", truth.roll_rad);
        assert_eq!((sample.rate_rad_s[0], truth.spin_rad_s), (0.0, 0.0));
    }
}
