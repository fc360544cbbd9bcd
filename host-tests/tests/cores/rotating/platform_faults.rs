//! What goes wrong with the platform and its encoder is refused by name.

use hal_mock::turntable::{EncoderSlip, Segment, TurntableConfiguration};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating;
use orientation::alignment::rotating::session::Procedure;
use orientation::units::{RadiansPerSecond, Seconds};

use super::outcome::{
    SPEED, TURNS, assert_never_wrong, assert_refused, assert_right, between_s, changed_at,
    clockwise_s, counter_s, healthy, plain, turns_s, with,
};
use super::rig::{both_senses, driven};

#[test]
fn a_healthy_platform_has_an_azimuth() {
    assert_right(|seed, case| plain(seed, &case));
}

#[test]
fn unequal_speeds_are_refused_from_one_per_cent_on() {
    for part in [0.012, 0.02, 0.031, 0.1, 0.5] {
        for quicker in [1.0 + part, 1.0 - part] {
            assert_refused(&["SpeedsUnequal"], |seed, mut case| {
                let counter = Segment::steady(-SPEED * quicker, turns_s(TURNS) / quicker);
                case.segments[2] = counter.after(2.0);
                plain(seed, &case)
            });
        }
    }
    assert_right(|seed, mut case| {
        case.segments[2] = Segment::steady(-SPEED * 1.005, turns_s(TURNS)).after(2.0);
        plain(seed, &case)
    });
}

#[test]
fn a_missing_sense_and_less_than_two_turns_are_refused() {
    assert_refused(&["TurnsTooFew"], |seed, mut case| {
        case.segments.pop();
        plain(seed, &case)
    });
    assert_refused(&["TurnsTooFew"], |seed, mut case| {
        case.segments.remove(1);
        plain(seed, &case)
    });
    for turns in [0.5, 1.1, 1.7] {
        assert_refused(&["TurnsTooFew"], |seed, mut case| {
            case.segments = both_senses(SPEED, turns);
            plain(seed, &case)
        });
        assert_refused(&["TurnsTooFew"], |seed, mut case| {
            case.segments[2] = Segment::steady(-SPEED, turns_s(turns)).after(2.0);
            plain(seed, &case)
        });
    }
    assert_refused(&["TurnsTooFew"], |seed, mut case| {
        case.segments = vec![Segment::steady(0.0, 100.0)];
        plain(seed, &case)
    });
}

#[test]
fn a_platform_that_stands_for_a_while_loses_turns_and_no_truth() {
    assert_right(|seed, mut case| {
        case.segments[1] = Segment::steady(SPEED, turns_s(5.3)).after(2.0);
        case.segments.insert(2, Segment::steady(0.0, 30.0).after(1.0));
        case.segments.insert(3, Segment::steady(SPEED, turns_s(4.2)).after(2.0));
        plain(seed, &case)
    });
}

/// Runs a session whose motor stops obeying at a time, s.
fn stalled_at(time_s: f64) -> Result<f64, Refusal> {
    let case = healthy(1, 0.002);
    let procedure =
        Procedure { turns: 5, ..Procedure::new(&[RadiansPerSecond(SPEED)], Seconds(0.02)) };
    let driven = driven(&case, procedure, 1, |sample, rate| {
        if sample.time_s > time_s {
            *rate = 0.0;
        }
    });
    assert!(driven.seconds < 1000.0, "it gave up after {} s", driven.seconds);
    driven.session.conclusion().expect("the session has ended").verdict.map(|good| good.sigma.0)
}

#[test]
fn a_session_whose_platform_stops_ends_and_says_so() {
    // Before anything, in the rate-modulated turns, in the clockwise and in the counter-clockwise ones.
    for time_s in [0.0, 10.0, 110.0, 150.0] {
        let refused = stalled_at(time_s).expect_err("it did not turn");
        assert!(
            matches!(refused, Refusal::Rotating(rotating::Refusal::PlatformStopped { .. })),
            "{refused:?} at {time_s}"
        );
    }
    assert!(stalled_at(1e9).is_ok());
}

/// Where in a run an encoder may slip, s: in the rate-modulated turn, in the ramps, at both ends of a stretch, in
/// the middle of a turn.
fn places() -> [f64; 8] {
    [
        turns_s(4.0),
        clockwise_s(0.0) - 1.0,
        clockwise_s(0.1),
        clockwise_s(6.3),
        clockwise_s(TURNS - 0.4),
        between_s(),
        counter_s(0.2),
        counter_s(6.3),
    ]
}

#[test]
fn a_slip_of_the_encoder_is_refused_wherever_it_happens() {
    for by_deg in [0.5_f64, -5.0, 90.0] {
        for place in places() {
            assert_refused(&["EncoderSlipped"], |seed, case| {
                let from_s = place + 0.05 * seed as f64;
                let slip = EncoderSlip { from_s, by_rad: by_deg.to_radians(), rad_per_s: 0.0 };
                with(seed, &case, |configuration| TurntableConfiguration { slip, ..configuration })
            });
        }
    }
}

#[test]
fn a_slip_while_a_session_turns_the_platform_is_refused() {
    for time_s in [1.0, 30.0, 103.0, 140.0] {
        let case = healthy(2, 0.002);
        let procedure =
            Procedure { turns: 5, ..Procedure::new(&[RadiansPerSecond(SPEED)], Seconds(0.02)) };
        let driven = driven(&case, procedure, 2, |sample, _| {
            if sample.time_s > time_s {
                sample.stage_rad += 0.5_f64.to_radians();
            }
        });
        let verdict = driven.session.conclusion().expect("the session has ended").verdict;
        assert!(
            matches!(verdict, Err(Refusal::Rotating(rotating::Refusal::EncoderSlipped { .. }))),
            "{verdict:?} {time_s}"
        );
    }
}

#[test]
fn a_creeping_encoder_is_refused_once_it_shows_above_the_noise() {
    let creep = |rate_deg_s: f64| {
        move |seed: u64, case: super::rig::Case| {
            let rad_per_s = rate_deg_s.to_radians();
            let slip = EncoderSlip { from_s: clockwise_s(0.0), by_rad: 0.0, rad_per_s };
            let run =
                with(seed, &case, |configuration| TurntableConfiguration { slip, ..configuration });
            // The zero moves: any azimuth that it went through is one.
            let crept = rad_per_s * (2.0 * turns_s(TURNS) + 5.0);
            run.map(|(error, sigma)| (error - error.clamp(-crept, 0.0), sigma))
        }
    };
    let names = [
        "TiltChanged",
        "DirectionDrifts",
        "HeadingStepped",
        "TurnsDisagree",
        "TurnsDisturbed",
        "SpeedsUnequal",
        "ResidualsNotWhite",
        "SensesDisagree",
    ];
    for rate in [1e-5, 1e-4, 1e-3, 1e-2] {
        assert_never_wrong(&names, creep(rate));
    }
    for rate in [0.1, 0.3, 1.0, 3.0] {
        let names = [&names[..], &["TurnsTooFew"]].concat();
        assert_refused(&names, creep(rate));
    }
}

#[test]
fn a_tilt_that_changes_is_refused_or_leaves_the_azimuth_right() {
    for change in [0.003, 0.03, 0.3] {
        for place in [between_s(), clockwise_s(6.0)] {
            let names = ["TiltChanged", "DirectionDrifts", "ResidualsNotWhite", "TurnsDisturbed"];
            assert_never_wrong(&names, |seed, case| {
                let mut after = case.clone();
                after.instruments.pitch_deg += change;
                changed_at(place, &case, &after, seed)
            });
        }
    }
    for change in [0.01, 0.03, 0.1, 0.3] {
        assert_refused(&["TiltChanged"], |seed, case| {
            let mut after = case.clone();
            after.instruments.roll_deg += change;
            changed_at(between_s(), &case, &after, seed)
        });
    }
}

#[test]
fn a_base_that_turned_is_refused_or_stood_where_the_azimuth_says() {
    let names = [
        "TiltChanged",
        "DirectionDrifts",
        "HeadingStepped",
        "ResidualsNotWhite",
        "TurnsDisagree",
        "TurnsDisturbed",
        "SensesDisagree",
    ];
    for change in [0.1, 1.0, 3.0_f64] {
        for place in [between_s(), clockwise_s(6.0)] {
            assert_never_wrong(&names, |seed, case| {
                let mut after = case.clone();
                after.instruments.azimuth_deg += change;
                let run = changed_at(place, &case, &after, seed);
                let turned = change.to_radians();
                run.map(|(error, sigma)| (error - error.clamp(0.0, turned), sigma))
            });
        }
    }
}
