//! What goes wrong with the gyro and the accelerometer, or what is wrongly declared.

use hal_mock::disturbance::Disturbance;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::turntable::TurntableConfiguration;
use orientation::earth::Latitude;
use orientation::units::Radians;

use super::outcome::{
    assert_never_wrong, assert_refused, assert_right, clockwise_s, counter_s, edited, plain, with,
};

#[test]
fn bumped_turns_are_left_out() {
    let bumps = [Disturbance::door_slam(clockwise_s(3.3)), Disturbance::door_slam(counter_s(2.2))];
    let overload = [Disturbance::overload(clockwise_s(3.3), 0.2)];
    let leant = |rate_deg_h: f64| {
        [Disturbance {
            start_s: clockwise_s(3.3),
            seconds: 20.0,
            rate_deg_h,
            ..Disturbance::default()
        }]
    };
    let (little, more, much) = (leant(0.3), leant(5.0), leant(60.0));
    for disturbances in [&bumps[..], &overload, &little, &more] {
        assert_right(|seed, case| {
            with(seed, &case, |configuration| TurntableConfiguration {
                disturbances,
                ..configuration
            })
        });
    }
    assert_never_wrong(&["TurnsDisturbed"], |seed, case| {
        with(seed, &case, |configuration| TurntableConfiguration {
            disturbances: &much,
            ..configuration
        })
    });
}

#[test]
fn a_platform_that_is_bumped_in_every_turn_is_refused() {
    let bumps: Vec<Disturbance> = (0..200)
        .map(|number| Disturbance {
            start_s: f64::from(number) * 2.9 + f64::from(number % 5) * 0.3,
            seconds: 1.0,
            rate_deg_h: 20.0 + 10.0 * f64::from(number % 7),
            ..Disturbance::default()
        })
        .collect();
    assert_refused(&["TurnsDisturbed", "ResidualsNotWhite"], |seed, case| {
        with(seed, &case, |configuration| TurntableConfiguration {
            disturbances: &bumps,
            ..configuration
        })
    });
}

#[test]
fn an_accelerometer_that_saturates_sticks_or_is_dead_is_refused() {
    let pushed = [Disturbance::force_overload(clockwise_s(0.0), 60.0)];
    assert_refused(&["Device"], |seed, case| {
        with(seed, &case, |mut configuration| {
            configuration.instruments.accelerometer.full_scale_m_s2 = Some(20.08);
            TurntableConfiguration { disturbances: &pushed, ..configuration }
        })
    });
    assert_refused(&["Device"], |seed, case| {
        edited(seed, &case, |samples| {
            let middle = samples.len() / 2;
            let force = samples[middle].force_m_s2;
            for sample in &mut samples[middle..] {
                sample.force_m_s2 = force;
            }
        })
    });
    // At the lower limit of its range in every other sample.
    assert_refused(&["Device"], |seed, case| {
        edited(seed, &case, |samples| {
            for sample in samples.iter_mut().step_by(2) {
                sample.force_m_s2[0] = f64::from(i32::MIN) * 1e-6;
            }
        })
    });
    assert_refused(&["Device"], |seed, case| {
        edited(seed, &case, |samples| {
            for sample in samples {
                sample.force_m_s2 = [0.0; 3];
            }
        })
    });
    // Vertical where it should be level.
    assert_refused(&["AccelerometerImplausible"], |seed, case| {
        edited(seed, &case, |samples| {
            for sample in samples {
                sample.force_m_s2.swap(0, 2);
            }
        })
    });
}

#[test]
fn a_molecular_sensor_that_is_declared_a_gyro_is_refused_or_right() {
    let names = [
        "SensesDisagree",
        "HeadingStepped",
        "TurnsDisturbed",
        "TurnsDisagree",
        "ResidualsNotWhite",
        "EarthRateMismatch",
    ];
    let sensors = [
        (0.0, 0.05, 0.0),
        (0.0, 0.3, 0.0),
        (0.03, 0.0, 0.0),
        (0.03, 0.2, 0.0),
        (0.0, 0.0, 1e-3),
        (0.03, 0.1, 1e-3),
        (0.1, 0.3, 1e-4),
    ];
    for (high_pass_hz, lag_s, g) in sensors {
        assert_never_wrong(&names, |seed, mut case| {
            let force_rad_s2_g = [g, 0.5 * g];
            case.instruments.gyro.molecular =
                Some(MolecularConfiguration { force_rad_s2_g, high_pass_hz, lag_s });
            plain(seed, &case)
        });
    }
}

#[test]
fn a_wrong_scale_or_latitude_is_refused_and_turns_no_azimuth() {
    for scale_error in [0.1, -0.1, 0.01, -0.004] {
        assert_never_wrong(&["EarthRateMismatch"], |seed, mut case| {
            case.instruments.gyro.scale_error = scale_error;
            plain(seed, &case)
        });
    }
    for latitude_deg in [10.0, 50.0, 60.0] {
        assert_refused(&["EarthRateMismatch"], |seed, mut case| {
            case.setting.site.latitude = Latitude::from_degrees(latitude_deg).expect("one");
            plain(seed, &case)
        });
    }
    assert_refused(&["LatitudeTooHigh"], |seed, mut case| {
        case.setting.site.latitude = Latitude::from_degrees(86.0).expect("one");
        plain(seed, &case)
    });
}

#[test]
fn a_sensor_that_stands_badly_is_to_be_aligned_mechanically() {
    for alpha_deg in [5.0_f64, -5.0, 2.1, -2.1] {
        assert_refused(&["Misaligned"], |seed, mut case| {
            case.instruments.gyro.axis_elevation_rad = alpha_deg.to_radians();
            plain(seed, &case)
        });
    }
    assert_refused(&["Misaligned", "SensesDisagree"], |seed, mut case| {
        case.instruments.gyro.axis_elevation_rad = 0.4;
        plain(seed, &case)
    });
}

#[test]
fn a_platform_too_steep_is_refused() {
    assert_refused(&["TiltTooGreat"], |seed, mut case| {
        case.instruments = case.instruments.leaning(16.0, 100.0);
        case.setting.site.allowed_tilt = Radians::from_degrees(10.0);
        plain(seed, &case)
    });
}

#[test]
fn without_a_modulated_turn_or_a_stored_misalignment_the_sigma_says_so() {
    assert_never_wrong(&["SensesDisagree"], |seed, mut case| {
        case.segments.remove(0);
        plain(seed, &case)
    });
}

#[test]
fn an_encoder_that_counts_the_other_way_is_refused() {
    assert_refused(
        &["AccelerometerDisagrees", "EarthRateMismatch", "SensesDisagree"],
        |seed, case| {
            edited(seed, &case, |samples| {
                for sample in samples {
                    sample.stage_rad = -sample.stage_rad;
                    sample.stage_rate_rad_s = -sample.stage_rate_rad_s;
                }
            })
        },
    );
}

#[test]
fn an_accelerometer_with_a_wrong_axis_is_refused() {
    let wrong: [fn([f64; 3]) -> [f64; 3]; 3] =
        [|[x, y, z]| [-x, y, z], |[x, y, z]| [y, x, z], |[x, y, z]| [x, -y, z]];
    for axes in wrong {
        assert_refused(&["AccelerometerDisagrees"], |seed, case| {
            edited(seed, &case, |samples| {
                for sample in samples {
                    sample.force_m_s2 = axes(sample.force_m_s2);
                }
            })
        });
    }
}
