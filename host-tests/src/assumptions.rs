//! What a recording cannot show, in words: every azimuth from it assumes that.

pub mod unseen;

use std::f64::consts::TAU;

use orientation::alignment::rotating::conclusion::Conclusion as PlatformConclusion;
use orientation::alignment::rotating::solution::{Fit, Pair};
use orientation::alignment::rotating::{misalignment, session as rotating};
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::session::Session;
use orientation::alignment::stepwise::setting::Setting;
use orientation::alignment::stepwise::tilt::Tilt;
use orientation::math::Complex;

/// Dwells from which drift and motion show beside the Earth rate, where none is a repeat.
const ENOUGH: usize = 8;
/// Angle within which two dwells stand at one position, rad.
const SAME_POSITION: f64 = 0.01;
/// Tilt in its σ below which a stage is as good as level.
const LEVEL: f64 = 5.0;
/// Tilt of a platform that shows its sense at the least, g.
const LEAST_TILT: f64 = 1e-5;
/// How far the Earth-rate ratio may be off and still pass every test, in its σ.
const UNNOTICED: f64 = 5.0;
/// Tolerance of the Earth-rate ratio beyond its σ, where the gyro's scale is exact.
const TOLERANCE: f64 = 0.005;
/// Part of σ from which on an error that does not show is worth stating.
const WORTH_STATING: f64 = 0.3;

/// How far the frequency of a modulation may be from the speed that it stands for, relative.
const SAME_SPEED: f64 = 0.3;
/// Sine of the tilt below which an accelerometer in g instead of m/s² shows no impossible one: 1.5°.
const NEARLY_LEVEL: f64 = 0.026;

/// What is assumed of a platform whose accelerometer does not show its sense.
const SENSE_OF_A_PLATFORM: &str =
    "sense of the platform, which neither one axis of an accelerometer nor a level platform shows";
/// What is assumed of a platform that is nearly level.
const UNIT_OF_A_PLATFORM: &str =
    "accelerometer in m/s², which a platform that is nearly level does not show";
/// What is assumed of a sensor of unknown lag that turns at one speed.
const LAG_OF_ONE_SPEED: &str = "no turn of the base and no slip between the senses, which one speed of a sensor whose \
                                lag is not known does not show";
/// What is assumed of the gyros and accelerometers of a vehicle, whose mounting a vehicle at rest does not show.
pub const AXES_OF_A_VEHICLE: &str = "axes forward, right and down, as the columns say";
/// What is assumed of displacements whose size the forces on the way do not show.
pub const WAY_OF_A_VEHICLE: &str =
    "displacements in metres north and east: the forces on the way show them too badly";

/// What the azimuth of a stage's session assumes that none of its data show; nothing where there is none.
pub fn of_stage(session: &Session) -> Vec<String> {
    let found = session.conclusion().filter(|conclusion| conclusion.verdict.is_ok());
    let Some((conclusion, fit)) = found.and_then(|found| Some((found, found.fit.as_ref()?))) else {
        return Vec::new();
    };
    let setting = &session.setting;
    let tilt = &conclusion.tilt;
    let is_level =
        tilt.magnitude() < LEVEL * tilt.covariance[0][0].max(tilt.covariance[1][1]).sqrt();
    let few = session.dwells().len() < ENOUGH && !is_repeated(session);
    let assumed = [
        (true, "no drift in step with the turn"),
        (true, "no turn of the base or slip of the encoder in the last quarter of the dwells"),
        (is_level, "sense of the stage, which no level stage shows"),
        (!fit.earth_rate_is_free(), "scale of the gyro, which no arc shows"),
        (!fit.earth_rate_is_free(), "no lag of the gyro, which an arc shows badly"),
        (few, "no drift and no motion beyond what is stated, which few positions do not show"),
    ];
    let shown = shown_by_stage(setting, conclusion);
    let level = (!tilt.measured).then(|| {
        let each = setting.site.latitude.rad().tan().abs();
        format!("a level platform, for there are no forces: by each degree of tilt north is {each:.2}° off")
    });
    let unseen = unseen::of_stage(session);
    let unseen = level.into_iter().chain(unseen.iter().map(ToString::to_string));
    words_of(&assumed).chain(unseen).chain(shown.iter().flat_map(Shown::assumptions)).collect()
}

/// The words of what is assumed.
fn words_of(assumed: &[(bool, &str)]) -> impl Iterator<Item = String> {
    assumed.iter().filter(|(is_assumed, _)| *is_assumed).map(|(_, words)| (*words).to_owned())
}

/// What the azimuth of a turning platform assumes that none of its data show; nothing where there is none.
pub fn of_platform(session: &rotating::Session) -> Vec<String> {
    let Some(conclusion) = session.conclusion() else { return Vec::new() };
    let (Some(fit), Ok(azimuth)) = (conclusion.fit, conclusion.verdict) else { return Vec::new() };
    let shown = Shown {
        azimuth: azimuth.angle.0,
        sigma: azimuth.sigma.0,
        ratio: fit.ratio,
        unnoticed: UNNOTICED * fit.ratio_sigma + TOLERANCE,
        felt: felt(&session.setting.site, fit.tilt),
    };
    let is_one_lag = !session.setting.sensor.is_flat && conclusion.pairs.len() < 2;
    let assumed = [
        (is_one_lag, LAG_OF_ONE_SPEED),
        (!shows_sense(conclusion, &fit), SENSE_OF_A_PLATFORM),
        (fit.tilt.size() < NEARLY_LEVEL, UNIT_OF_A_PLATFORM),
    ];
    let unseen = unseen::of_platform(session);
    let unseen = unseen.iter().map(ToString::to_string);
    words_of(&assumed)
        .chain(pole(session, conclusion))
        .chain(unseen)
        .chain(shown.assumptions())
        .collect()
}

/// What it rests on that a sensor of unknown lag lags at a speed without a rate-modulated turn as one pole does.
fn pole(session: &rotating::Session, conclusion: &PlatformConclusion) -> Option<String> {
    let setting = &session.setting;
    let horizontal = setting.site.latitude.horizontal_rate();
    let off = |pair: &Pair| {
        let misalignment = misalignment::nearest(&conclusion.misalignments, pair.speed())?;
        let is_there = (misalignment.frequency.0 / pair.speed() - 1.0).abs() < SAME_SPEED;
        let [clockwise, counter] = pair.senses().map(|average| average.turning);
        let felt = misalignment.sine.abs() * (clockwise - counter).size() * 0.5;
        (!is_there).then_some(felt / horizontal.0)
    };
    let most = conclusion.pairs.iter().filter_map(off).reduce(f64::max);
    most.filter(|_| !setting.sensor.is_flat).map(|off| {
        format!(
            "the lag of one pole at the speed without a rate-modulated turn: by each degree of another one north is up to \
             {off:.2}° off"
        )
    })
}

/// Whether the forces show which way a platform turns: on two axes, and by its tilt.
fn shows_sense(conclusion: &PlatformConclusion, fit: &Fit) -> bool {
    let averages = conclusion.pairs.iter().flat_map(Pair::senses);
    let has_both_axes = averages.into_iter().any(|average| average.across != Complex::default());
    has_both_axes && fit.tilt.size() > 2.0 * LEVEL * fit.tilt_sigma + LEAST_TILT
}

/// Whether the stage came to any position twice.
fn is_repeated(session: &Session) -> bool {
    let dwells = session.dwells();
    let is_same = |one: usize, other: usize| {
        (dwells[one].stage - dwells[other].stage).signed_rad().abs() < SAME_POSITION
    };
    (0..dwells.len()).any(|one| (0..one).any(|other| is_same(one, other)))
}

/// The Earth rate as a gyro on a tilted platform shows it, in units of its horizontal part.
struct Shown {
    /// Azimuth and its σ, rad.
    azimuth: f64,
    sigma: f64,
    /// Earth rate found over the one expected, and by how much it may be another one unnoticed.
    ratio: f64,
    unnoticed: f64,
    /// What the tilt lets the gyro feel in either hemisphere.
    felt: [Complex; 2],
}

/// What a tilt, g, lets the gyro feel of the vertical Earth rate and by its g-sensitivity, over the horizontal Earth rate;
/// in this hemisphere and in the other.
fn felt(site: &Site, tilt: Complex) -> [Complex; 2] {
    let [along, across] = site.g_sensitivity;
    let latitude = site.latitude;
    let vertical = latitude.vertical_rate().0;
    [vertical, -vertical].map(|vertical| {
        let per_tilt = Complex::new(vertical + along.0, across.0);
        (per_tilt * tilt).scaled(1.0 / latitude.horizontal_rate().0)
    })
}

fn shown_by_stage(setting: &Setting, conclusion: &Conclusion) -> Option<Shown> {
    let (fit, azimuth) = (conclusion.fit.as_ref()?, conclusion.verdict.ok()?);
    let Tilt { real, imaginary, .. } = conclusion.tilt;
    let tolerance = if setting.site.scale_sigma > 0.0 { 0.0 } else { TOLERANCE };
    // Two positions take the Earth rate for granted.
    let sigma = if fit.model.is_single_axis { f64::INFINITY } else { fit.ratio_sigma };
    Some(Shown {
        azimuth: azimuth.angle.0,
        sigma: azimuth.sigma.0,
        ratio: fit.direction.amplitude,
        unnoticed: UNNOTICED * sigma + tolerance,
        felt: felt(&setting.site, Complex::new(real, imaginary)),
    })
}

impl Shown {
    /// What the Earth rate does not show about how the sensors are built in, with what it would change.
    fn assumptions(&self) -> impl Iterator<Item = String> {
        let [here, mirrored] = self.felt;
        let reversed = self.change(-1.0, here).map(|change| {
            format!("sign of the gyro: with the other one {:.1}° away", change.to_degrees())
        });
        let turns = (0..360_u16).map(|degrees| Complex::unit(f64::from(degrees).to_radians()));
        let others = turns.flat_map(|turn| [here, mirrored].map(|felt| turn * felt));
        let changes = others.filter_map(|felt| self.change(1.0, felt));
        let worth_stating = changes.filter(|change| *change > WORTH_STATING * self.sigma);
        let axes = worth_stating.reduce(f64::max).map(|change| {
            format!(
                "axes of the accelerometer and the hemisphere: turned about the vertical, or in the other one, up to \
                 {:.2}° away",
                change.to_degrees()
            )
        });
        reversed.into_iter().chain(axes)
    }

    /// How far away the azimuth would be, rad, were the gyro's sign this one and what the tilt lets it feel that; nothing
    /// where the Earth rate would show it.
    fn change(&self, sign: f64, felt: Complex) -> Option<f64> {
        let shown = Complex::unit(self.azimuth).scaled(self.ratio) + self.felt[0];
        let north = shown.scaled(sign) - felt;
        let change = (north.angle() - self.azimuth + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        ((north.size() - 1.0).abs() <= self.unnoticed).then_some(change.abs())
    }
}

/// What is stated; where nothing is, what is usual, which the words say to be assumed.
pub(crate) fn or_assumed<T>(
    stated: Option<T>,
    usual: T,
    assumed: &mut Vec<String>,
    words: impl FnOnce() -> String,
) -> T {
    stated.unwrap_or_else(|| {
        assumed.push(words());
        usual
    })
}
