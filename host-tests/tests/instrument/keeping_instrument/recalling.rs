//! The heading of before a restart, input by input, where the body turns before it is decided on, and where it is
//! contradicted.

use orientation::alignment::Azimuth;
use orientation::attitude::restart::{RecallRefusal, Remembered};
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::navigation::{Input, Motion, Navigator, Output, Policy, Progress};
use orientation::signal::InertialSample;
use orientation::units::{
    AngleIncrement, DEGREE, Instant, Radians, RadiansPerSecond, Seconds, SpecificForce,
};

use super::handing::{azimuth, policy};

/// North and down parts of the Earth's rate at 45° of latitude, rad/s.
const EARTH: f64 = 7.292_115e-5 * core::f64::consts::FRAC_1_SQRT_2;
/// Samples a second.
pub const RATE: u64 = 100;
/// The azimuth in which the body stood, °.
const STOOD: f64 = 100.0;
/// By what the body turns, °, and in which samples.
const TURNED: f64 = 0.3;
const TURNING: core::ops::Range<u64> = 600..750;

/// Gyros that come back to 0.03 °/h.
fn gyro() -> Gyro {
    let bias_sigma = RadiansPerSecond(0.03 * DEGREE / 3600.0);
    Gyro { scale_sigma: 1e-4, bias_sigma, ..Gyro::default() }
}

/// The moment of a sample.
pub fn at(index: u64) -> Instant {
    Instant(index * 1_000_000 / RATE)
}

/// The rates of the Earth about the axes of a level body in an azimuth, °, rad/s.
fn earth(azimuth: f64) -> [f64; 3] {
    let (sine, cosine) = (azimuth * DEGREE).sin_cos();
    [EARTH * cosine, -EARTH * sine, -EARTH]
}

/// A body on the turning Earth, level or pitched, °, with a bias of its gyro about down, rad/s, and what is left of its
/// increments.
#[derive(Default)]
pub struct Body {
    pub azimuth: f64,
    pub pitch: f64,
    pub bias: f64,
    pub left: [f64; 3],
}

impl Body {
    /// Its sample after it has turned by so many degrees.
    pub fn moved(&mut self, index: u64, degrees: f64) -> Input {
        self.azimuth += degrees;
        let mut level = earth(self.azimuth).map(|rate| rate / RATE as f64);
        level[2] += degrees * DEGREE;
        let mut shown = self.pitched(level);
        shown[2] += self.bias / RATE as f64;
        let turned = core::array::from_fn(|axis| {
            AngleIncrement::from_rad(shown[axis], &mut self.left[axis])
        });
        let force = Some(self.pitched([0.0, 0.0, -9.81]).map(SpecificForce::from_m_per_s2));
        Input::Motion(Motion::Moved(InertialSample { time: at(index), turned, force }))
    }

    /// Parts forward, right, down of what has these on level axes.
    fn pitched(&self, [forward, right, down]: [f64; 3]) -> [f64; 3] {
        let (sine, cosine) = (self.pitch * DEGREE).sin_cos();
        [cosine * forward - sine * down, right, sine * forward + cosine * down]
    }
}

/// Outputs with their samples' numbers of a navigator in a body that stands level for so many samples, but for a turn in
/// [`TURNING`] where it does turn; the samples of `missing` are none, and inputs are given before samples.
fn outputs(
    (count, turns): (u64, bool),
    missing: core::ops::Range<u64>,
    given: &[(u64, Input)],
) -> Vec<(u64, Output)> {
    outputs_of(Body { azimuth: STOOD, ..Body::default() }, (count, turns), missing, given)
}

/// The same in any body.
fn outputs_of(
    mut body: Body,
    (count, turns): (u64, bool),
    missing: core::ops::Range<u64>,
    given: &[(u64, Input)],
) -> Vec<(u64, Output)> {
    let latitude = Latitude::from_degrees(45.0).expect("a latitude");
    let mut keeper = Keeper::new(&Setting::precise(latitude, Seconds(1.0 / RATE as f64), gyro()));
    let policy = Policy { beside: gyro(), precise: gyro(), ..policy() };
    let mut navigator = Navigator::new(&mut keeper, &policy);
    let mut outputs = Vec::new();
    for index in 0..count {
        for (_, input) in given.iter().filter(|(at, _)| *at == index) {
            navigator.take(input, &mut |output| outputs.push((index, output)));
        }
        let part = 1.0 / (TURNING.end - TURNING.start) as f64;
        let degrees = if turns && TURNING.contains(&index) { TURNED * part } else { 0.0 };
        let moved = body.moved(index, degrees);
        if !missing.contains(&index) {
            navigator.take(&moved, &mut |output| outputs.push((index, output)));
        }
    }
    outputs
}

/// The heading in which a body stands, as it is saved with this 1σ, °.
fn saved(body: &Body, sigma: f64) -> (u64, Input) {
    let [azimuth, sigma, pitch, roll] =
        [body.azimuth, sigma, body.pitch, 0.0].map(Radians::from_degrees);
    let rates = body.pitched(earth(body.azimuth)).map(RadiansPerSecond);
    let rest = Seconds(60.0);
    (0, Input::Remembered(Remembered { azimuth, sigma, pitch, roll, rates, rest }))
}

/// The heading in which the level body stood.
fn remembered() -> (u64, Input) {
    saved(&Body { azimuth: STOOD, ..Body::default() }, 0.03)
}

/// What is decided on the heading: the azimuth that is recalled, or why none is.
fn decided(outputs: &[(u64, Output)]) -> Result<Azimuth, RecallRefusal> {
    let decision = outputs.iter().find_map(|(_, output)| match output {
        Output::Progress(Progress::HeadingRecalled(azimuth)) => Some(Ok(*azimuth)),
        Output::Progress(Progress::RecallRefused(reason)) => Some(Err(*reason)),
        _ => None,
    });
    decision.expect("it is decided on")
}

#[test]
fn a_body_that_stands_has_its_heading_recalled() {
    let found = decided(&outputs((4000, false), 0..0, &[remembered()])).expect("it stands");
    assert!((found.angle.degrees() - STOOD).abs() < 1e-3, "{}°", found.angle.degrees());
}

#[test]
fn a_turn_before_the_decision_refuses_the_heading_whatever_is_computed_meanwhile() {
    let moments: [&[u64]; 4] = [&[], &[800], &[650, 800], &[300, 700, 900, 1100, 1300]];
    for computed in moments {
        let mut given = vec![remembered()];
        given.extend(computed.iter().map(|index| (*index, Input::Concluding(at(index - 1)))));
        let Err(RecallRefusal::TurnedSince { degrees }) =
            decided(&outputs((4000, true), 0..0, &given))
        else {
            panic!("computed at {computed:?}");
        };
        assert!((degrees.0 - TURNED).abs() < 1e-3, "computed at {computed:?}: {degrees:?}");
    }
}

/// All of the turn, most of it, and little of it is not measured.
#[test]
fn what_a_body_turns_in_a_gap_before_the_decision_refuses_the_heading_or_is_in_its_sigma() {
    for missing in [600..750, 580..790, 600..690, 600..620, 740..760, 500..1000] {
        let found = decided(&outputs((4000, true), missing.clone(), &[remembered()]));
        let Ok(Azimuth { angle, sigma }) = found else { continue };
        let error = angle.degrees() - STOOD - TURNED;
        assert!(error.abs() < 3.0 * sigma.degrees(), "{missing:?}: {error}° of {sigma:?}");
    }
}

#[test]
fn a_heading_that_is_contradicted_is_forgotten_at_once() {
    let found = |index: u64, angle| (index, Input::Found(at(index - 1), azimuth(angle, 0.01)));
    let given = [found(3000, STOOD + 0.5), found(8000, STOOD)];
    let outputs = outputs((20_000, false), 0..0, &given);
    let when = |is: fn(&Output) -> bool| {
        outputs.iter().filter(|(_, output)| is(output)).map(|(index, _)| *index).collect::<Vec<_>>()
    };
    let (saved, forgotten) =
        (when(|it| matches!(it, Output::Save(_))), when(|it| matches!(it, Output::Forget)));
    assert_eq!(saved.len(), 1, "saved at {saved:?}");
    let [forgotten] = forgotten[..] else { panic!("forgotten at {forgotten:?}") };
    assert!((8000..8000 + RATE).contains(&forgotten), "forgotten at {forgotten}");
}

/// Whatever comes between it and the navigator's next look.
#[test]
fn a_heading_that_is_contradicted_is_forgotten_where_another_comes_at_once() {
    let given = [
        (3000, Input::Found(at(2999), azimuth(STOOD + 0.5, 0.01))),
        (8000, Input::Found(at(7999), azimuth(STOOD, 0.01))),
        (8000, Input::Settled),
        (8000, Input::Aided(None, Some(azimuth(STOOD, 0.5)))),
    ];
    let outputs = outputs((8100, false), 0..0, &given);
    let forgets = outputs.iter().filter(|(_, output)| matches!(output, Output::Forget)).count();
    assert_eq!(forgets, 1, "{:?}", outputs.last());
}

/// What a vehicle that stands on a slope is told of its saved heading after it was turned by so many degrees.
fn recalled_on_a_slope(pitch: f64, turned: f64) -> Result<Azimuth, RecallRefusal> {
    let stood = Body { azimuth: 90.0, pitch, ..Body::default() };
    let given = [saved(&stood, 0.01)];
    let stands = Body { azimuth: 90.0 + turned, ..stood };
    decided(&outputs_of(stands, (4000, false), 0..0, &given))
}

/// The Earth's horizontal rate is 10.64 °/h at 45°, and both starts' biases are 0.042 °/h: 0.229°, whatever the slope.
#[test]
fn a_turn_shows_on_a_slope_as_on_the_level() {
    for pitch in [0.0, 30.0, -60.0, 75.0] {
        let found = recalled_on_a_slope(pitch, 0.0).expect("it stands");
        let sigma = found.sigma.degrees();
        assert!((0.225..0.240).contains(&sigma), "pitch {pitch}°: {sigma}°");
        for turned in [0.3, -0.4] {
            assert!(recalled_on_a_slope(pitch, turned).is_ok(), "pitch {pitch}°: {turned}°");
        }
        for turned in [0.6, -0.6, 1.6, -3.0] {
            let refused = recalled_on_a_slope(pitch, turned);
            let is_turned = matches!(refused, Err(RecallRefusal::Turned { .. }));
            assert!(is_turned, "pitch {pitch}°, {turned}°: {refused:?}");
        }
    }
}
