//! A spinning body in closed form: `a_y = q cos γ − ρω²`, `a_z = −q sin γ − ρ_z ω²`.

use std::f64::consts::TAU;

use hal_mock::noise::Generator;
use orientation::roll::{Condition, Setting, Spin, State};
use orientation::signal::SpinSample;
use orientation::units::{AngleIncrement, Instant, RadiansPerRootSecond, Seconds, SpinForce};

/// Sample period, s.
const PERIOD: f64 = 1e-4;

/// A body; turns and rates as functions of time, s.
pub struct Body {
    /// Turns since the start, and turns a second.
    pub turns: fn(f64) -> f64,
    pub rate: fn(f64) -> f64,
    /// m/s².
    pub lift: fn(f64) -> f64,
    /// Gyro shown over true less one, and what the core is reported of it.
    pub scale: f64,
    pub scale_sigma: f64,
    /// 1σ of each force, m/s².
    pub noise: f64,
    pub seconds: f64,
    pub seed: u64,
}

impl Default for Body {
    fn default() -> Self {
        Self {
            turns: |time| 100.0 * time,
            rate: |_| 100.0,
            lift: |_| 20.0,
            scale: 1e-3,
            scale_sigma: 0.01,
            noise: 0.5,
            seconds: 2.0,
            seed: 1,
        }
    }
}

/// What was known after a sample.
pub struct Known {
    pub time: f64,
    /// Error of the roll within its turn, rad.
    pub error: f64,
    pub sigma: Option<f64>,
    /// Scale error left, and its 1σ.
    pub scale: [f64; 2],
    pub state: State,
    pub lift: Option<f64>,
}

impl Known {
    pub fn in_sigmas(&self) -> f64 {
        self.sigma.map_or(0.0, |sigma| self.error.abs() / sigma)
    }
}

/// Follows the body; samples that `spoil` refuses are lost.
pub fn follow(body: &Body, mut spoil: impl FnMut(usize, &mut SpinSample) -> bool) -> Vec<Known> {
    let mut spin = Spin::new(&Setting {
        angle_random_walk: RadiansPerRootSecond(1e-6),
        scale_sigma: body.scale_sigma,
        ..Setting::new(Seconds(PERIOD))
    });
    let mut noise = Generator::new(body.seed);
    let mut carried = 0.0;
    let mut known = Vec::new();
    for place in 0..(body.seconds / PERIOD) as usize {
        let time = place as f64 * PERIOD;
        let roll = 0.4 + TAU * (body.turns)(time);
        let before = 0.4 + TAU * (body.turns)((time - PERIOD).max(0.0));
        let mut sample = SpinSample {
            time: Instant(100 * (place as u64 + 1)),
            turned: [AngleIncrement(0); 3],
            force: Some(forces(body, time, roll, &mut noise)),
        };
        let shown = (roll - before) * (1.0 + body.scale);
        sample.turned[0] = AngleIncrement::from_rad(shown, &mut carried);
        if !spoil(place, &mut sample) {
            continue;
        }
        spin.push(&sample);
        let off = spin.roll().rad() - roll;
        let [scale, scale_sigma] = spin.scale().expect("a lock tells the scale");
        known.push(Known {
            time,
            error: off - TAU * (off / TAU).round(),
            sigma: spin.sigma().map(|sigma| sigma.0),
            scale: [(1.0 + scale) / (1.0 + body.scale) - 1.0, scale_sigma],
            state: spin.state(),
            lift: spin.lift().map(|lift| lift.0),
        });
    }
    known
}

fn forces(body: &Body, time: f64, roll: f64, noise: &mut Generator) -> [SpinForce; 2] {
    let (sine, cosine) = roll.sin_cos();
    let (lift, rate) = ((body.lift)(time), TAU * (body.rate)(time));
    let pull = 0.008 * rate * rate;
    let [y, z] = [lift * cosine - pull, -lift * sine - 0.5 * pull];
    [y, z].map(|force| SpinForce::from_m_per_s2(force + body.noise * noise.gaussian()))
}

/// Greatest error in σ from a time on.
pub fn worst(known: &[Known], from: f64) -> f64 {
    known.iter().filter(|known| known.time >= from).map(Known::in_sigmas).fold(0.0, f64::max)
}

/// Whether the roll is followed at the end: locked, good to a tenth of a degree and within 4 σ.
#[track_caller]
pub fn assert_followed(known: &[Known]) {
    let last = known.last().expect("there were samples");
    assert_eq!(last.state.condition, Condition::Locked);
    assert!(last.error.abs() < 2e-3, "{}° off", last.error.to_degrees());
    assert!(last.in_sigmas() < 4.0, "{} σ off", last.in_sigmas());
    assert!(last.scale[0].abs() < 4.0 * last.scale[1], "scale {:?}", last.scale);
}
