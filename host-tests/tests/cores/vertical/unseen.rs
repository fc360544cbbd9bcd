//! Turns of which a part is not seen, by gaps or by gyros at the limit of their range: what is not seen is in σ.

use orientation::signal::InertialSample;
use orientation::units::{AngleIncrement, DEGREE};

use super::world::{Body, Known, coarse, keep, precise};

/// When the azimuth is handed over, and about when something is not seen, s.
const HANDED: f64 = 40.0;
const UNSEEN: f64 = 60.0;

/// Attitude at a time, s: course, pitch, roll, rad.
type Attitude = fn(f64) -> [f64; 3];

/// Whether the sample of this time is one in so many.
fn is_one_of(time: f64, count: u64) -> bool {
    ((time * 100.0).round() as u64).is_multiple_of(count)
}

/// The greatest error of the azimuth after its handing over, in its σ, at moments of which there is a sample.
fn worst(known: &[Known]) -> f64 {
    let is_fresh = |known: &&Known| known.time - known.report.time.seconds() < 1e-3;
    let after = known.iter().filter(|known| known.time > HANDED + 1.0).filter(is_fresh);
    let error = |known: &Known| {
        known.azimuth.zip(known.report.azimuth).map(|(error, it)| error.abs() / it.sigma.0)
    };
    after.filter_map(error).fold(0.0, f64::max)
}

/// A body with this attitude, precise or coarse, of which `spoil` changes samples, or loses them.
fn worst_of(attitude: Attitude, spoil: impl Fn(f64, &mut InertialSample) -> bool) -> [f64; 2] {
    [precise(90.0), coarse(90.0)].map(|body| {
        let body = Body { attitude, handed: Some(HANDED), ..body };
        worst(&keep(&body, |time, sample| spoil(time, sample)))
    })
}

/// Holds that no error is beyond its σ.
fn assert_within(errors: [f64; 2], what: &str) {
    assert!(errors.iter().all(|error| *error < 3.5), "{what}: {errors:?} σ");
}

/// A body that rests, but for a turn at 0.2 rad/s from some ms before a gap until some ms into it.
fn sets_off<const BEFORE: u32, const WITHIN: u32>(time: f64) -> [f64; 3] {
    let [before, within] = [BEFORE, WITHIN].map(|ms| 1e-3 * f64::from(ms));
    [0.5 + 0.2 * (time - UNSEEN + before).clamp(0.0, before + within), 0.0, 0.0]
}

#[test]
fn a_body_that_sets_off_before_a_gap_and_stands_after_it_has_its_turn_in_sigma() {
    let turns: [Attitude; 6] = [
        sets_off::<300, 800>,
        sets_off::<200, 300>,
        sets_off::<100, 500>,
        sets_off::<50, 500>,
        sets_off::<300, 500>,
        sets_off::<20, 850>,
    ];
    for (index, attitude) in turns.into_iter().enumerate() {
        let gap = UNSEEN + 0.005..UNSEEN + 0.9;
        let errors = worst_of(attitude, |time, _| !gap.contains(&time));
        assert_within(errors, &format!("turn {index}"));
    }
}

#[test]
fn a_body_that_sets_off_while_few_samples_come_has_its_turn_in_sigma() {
    let attitude = |time: f64| [0.5 + 0.1 * (time - UNSEEN - 1.0).clamp(0.0, 10.0), 0.0, 0.0];
    for each in [2, 5, 10, 50, 90] {
        let errors = worst_of(attitude, |time, _| {
            !(UNSEEN..UNSEEN + 15.0).contains(&time) || is_one_of(time, each)
        });
        assert_within(errors, &format!("every {each}th"));
    }
}

/// Of a scale error the turn counts, whatever rest detection knows of it.
#[test]
fn the_scale_error_of_a_turn_is_in_sigma_where_samples_are_missing_again_and_again() {
    let attitude = |time: f64| [0.5 + 0.1 * (time - UNSEEN).max(0.0), 0.0, 0.0];
    // 1.5 of the coarse gyros' σ.
    let scaled = |sample: &mut InertialSample| {
        let [.., down] = &mut sample.turned;
        *down = AngleIncrement((f64::from(down.0) * (1.0 + 3e-3)) as i32);
    };
    for each in [u64::MAX, 60, 48, 40, 7] {
        let body = Body { attitude, handed: Some(HANDED), ..coarse(300.0) };
        let known = keep(&body, |time, sample| {
            scaled(sample);
            !is_one_of(time, each) || time < HANDED
        });
        assert!(worst(&known) < 3.5, "one of {each}: {} σ", worst(&known));
    }
}

/// A turn that reaches the gyro's limit of 2.2 rad/s within a second, is at so many tenths of the limit for some ms, and ends as
/// it began.
fn swings<const TENTHS: u32, const MS: u32>(time: f64) -> [f64; 3] {
    let [beyond, lasts] = [0.1 * f64::from(TENTHS), 1e-3 * f64::from(MS)];
    let at = time - UNSEEN;
    let rising = at.clamp(0.0, 1.0);
    let falling = 1.0 - (at - 1.0 - lasts).clamp(0.0, 1.0);
    let ramps = 1.1 * (rising * rising + 1.0 - falling * falling);
    [0.5 + ramps + 2.2 * beyond * (at - 1.0).clamp(0.0, lasts), 0.0, 0.0]
}

#[test]
fn what_a_body_turns_beyond_the_range_of_its_gyros_is_in_sigma() {
    let swung: [Attitude; 6] = [
        swings::<13, 200>,
        swings::<20, 100>,
        swings::<20, 200>,
        swings::<30, 50>,
        swings::<30, 200>,
        swings::<11, 1000>,
    ];
    for (index, attitude) in swung.into_iter().enumerate() {
        let limit = AngleIncrement::from_rad(2.21 * 0.01, &mut 0.0);
        let errors = worst_of(attitude, |_, sample| {
            let [.., down] = &mut sample.turned;
            if down.0 > limit.0 {
                *down = AngleIncrement(i32::MAX);
            }
            true
        });
        assert_within(errors, &format!("swing {index}"));
    }
}

/// A body that weaves gently, and turns by 6° within some ms.
fn swerves<const MS: u32>(time: f64) -> [f64; 3] {
    let part = ((time - UNSEEN - 0.05) / (1e-3 * f64::from(MS) - 0.1)).clamp(0.0, 1.0);
    let turn =
        6.0 * DEGREE * (part - (core::f64::consts::TAU * part).sin() / core::f64::consts::TAU);
    let weave = if time > HANDED { 0.01 * (3.0 * (time - HANDED)).sin() } else { 0.0 };
    [0.5 + weave + turn, 0.0, 0.0]
}

#[test]
fn a_swerve_within_a_gap_is_in_sigma() {
    let swerved: [(f64, Attitude); 3] =
        [(0.5, swerves::<500>), (0.9, swerves::<900>), (1.5, swerves::<1500>)];
    for (missing, attitude) in swerved {
        let gap = UNSEEN..UNSEEN + missing;
        let errors = worst_of(attitude, |time, _| !gap.contains(&time));
        assert_within(errors, &format!("{missing} s"));
    }
}
