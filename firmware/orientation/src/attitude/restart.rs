//! Azimuth across a loss of supply: it remains valid where the vehicle has not moved, which is
//! checked.
//!
//! A vehicle that was moved has another pitch or roll, and the Earth rate is distributed otherwise
//! on its gyros. Gravity alone does not show a rotation about the vertical, so gyros whose biases
//! do not repeat cannot confirm the heading, and then the azimuth is rejected. Where they do repeat, the 1σ with which
//! they determine such a rotation is in the σ of what is recalled: a body that was turned by less passes the check. What it
//! turns from the start on, the gyros do show, but for gaps in what they measure; a body that has set off before it could
//! be checked is not checked any more.

use super::report::Report;
use super::setting::Setting;
use crate::checksum::{numbers, record, record_bytes};
use crate::units::{DEGREE, Degrees, Radians, RadiansPerSecond, Seconds};
use crate::words::Rounded;

/// Shortest rest for the comparison.
pub(crate) const REST_SECONDS: Seconds = Seconds(10.0);
/// Greatest change of pitch and roll, and greatest turn since the start and its greatest 1σ, rad: the effect of
/// temperature and tyres on a standing vehicle, 0.05°.
const TILT: f64 = 0.05 * DEGREE;
/// Significance, in σ, at which the rates differ.
const BOUND: f64 = 4.0;
/// Significance, in σ, at which the body counts as turned about the vertical. One that stands is refused once in twenty
/// starts for that; one that was turned by four σ, which is four σ of what is recalled, passes once in forty.
const TURN_BOUND: f64 = 2.0;
/// Greatest 1σ with which the gyros must be able to determine a rotation about the vertical, rad:
/// 0.5°.
const DETERMINED: f64 = 0.5 * DEGREE;
/// Version of the stored layout.
const VERSION: u32 = 1;

/// State that is saved against a loss of supply.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Remembered {
    /// Azimuth of body x.
    pub azimuth: Radians,
    /// Standard deviation of the azimuth, 1σ.
    pub sigma: Radians,
    /// Pitch, nose up positive.
    pub pitch: Radians,
    /// Roll, right side down positive.
    pub roll: Radians,
    /// Mean rates at rest about forward, right, down, including the Earth rate.
    pub rates: [RadiansPerSecond; 3],
    /// Averaging time of these rates.
    pub rest: Seconds,
}

/// Reason for which a saved azimuth is rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RecallRefusal {
    /// The body is not at rest, or not for long enough.
    NotAtRest {
        /// Time at rest.
        seconds: Seconds,
    },
    /// Pitch or roll has changed.
    Tilted {
        /// Greatest change of pitch or roll.
        degrees: Degrees,
    },
    /// The rates at rest have changed.
    Turned {
        /// Greatest change of a rate, in σ.
        sigmas: f64,
    },
    /// The body has turned about the vertical since the start.
    TurnedSince {
        /// Angle by which it has turned.
        degrees: Degrees,
    },
    /// The body may have turned since the start, while nothing was measured.
    TurnUnseen {
        /// Standard deviation of the turn, 1σ.
        sigma: Degrees,
    },
    /// The body set off before it had rested for long enough.
    SetOff,
    /// The gyros cannot determine whether the body was turned.
    TurnUnobservable {
        /// Standard deviation with which they could, 1σ.
        sigma: Degrees,
    },
}

crate::words! { RecallRefusal:
    Self::NotAtRest { seconds } => "the body stood for {} s: too short", Rounded::<1>(seconds.0);
    Self::Tilted { degrees } => "it stands otherwise, by {}°", Rounded::<3>(degrees.0);
    Self::Turned { sigmas } => "the Earth turns it otherwise, by {} σ", Rounded::<1>(sigmas);
    Self::TurnedSince { degrees } => "it has turned by {}° since the start", Rounded::<3>(degrees.0);
    Self::TurnUnseen { sigma } => "it may have turned by {}° (1σ) since the start", Rounded::<3>(sigma.0);
    Self::SetOff => "it set off before that was known";
    Self::TurnUnobservable { sigma } =>
        "a turn about the vertical shows to {}° only: the gyros' biases differ from start to start",
        Rounded::<2>(sigma.0);
}

/// Checks that a body is still in its saved attitude, by its mean rates over the present rest (none
/// where it moves), the length of that rest, and the turn about the vertical since the start with its 1σ. Returns the 1σ of
/// a rotation about the vertical that stays hidden.
pub(super) fn check(
    before: &Remembered,
    now: &Report,
    (rates, rest): (Option<[RadiansPerSecond; 3]>, Seconds),
    [turned, unseen]: [Radians; 2],
    setting: &Setting,
) -> Result<Radians, RecallRefusal> {
    let Some(rates) = rates.filter(|_| now.is_at_rest && rest >= REST_SECONDS) else {
        return Err(RecallRefusal::NotAtRest { seconds: rest });
    };
    let tilt = (now.pitch.0 - before.pitch.0).abs().max((now.roll.0 - before.roll.0).abs());
    if tilt > TILT || tilt.is_nan() {
        return Err(RecallRefusal::Tilted { degrees: Radians(tilt).into() });
    }
    let sigmas: [f64; 3] = core::array::from_fn(|axis| {
        let gyro = &setting.gyros[axis];
        let noise = gyro.noise.white_variance(rest.0) + gyro.noise.white_variance(before.rest.0);
        libm::sqrt(2.0 * gyro.bias_sigma.0 * gyro.bias_sigma.0 + noise)
    });
    let away = (0..3).map(|axis| (rates[axis].0 - before.rates[axis].0).abs() / sigmas[axis]);
    let away = away.fold(0.0, f64::max);
    if away > BOUND || away.is_nan() {
        return Err(RecallRefusal::Turned { sigmas: away });
    }
    let [rotation, sigma] = rotation(before, rates, setting, &sigmas);
    if sigma > DETERMINED || sigma.is_nan() {
        return Err(RecallRefusal::TurnUnobservable { sigma: Radians(sigma).into() });
    }
    if rotation.abs() > TURN_BOUND * sigma {
        return Err(RecallRefusal::Turned { sigmas: rotation.abs() / sigma });
    }
    check_since(turned, unseen)?;
    Ok(Radians(libm::hypot(sigma, unseen.0)))
}

/// Checks the turn about the vertical since the start, and its 1σ.
fn check_since(turned: Radians, unseen: Radians) -> Result<(), RecallRefusal> {
    let turned = turned.0.abs();
    if turned > TILT || turned.is_nan() {
        return Err(RecallRefusal::TurnedSince { degrees: Radians(turned).into() });
    }
    if unseen.0 > TILT || unseen.0.is_nan() {
        return Err(RecallRefusal::TurnUnseen { sigma: unseen.into() });
    }
    Ok(())
}

/// Rotation about the vertical by what it changes of the Earth rate on the gyros, and its 1σ, rad: least squares of the
/// changes of all three, weighted by their σ.
fn rotation(
    before: &Remembered,
    now: [RadiansPerSecond; 3],
    setting: &Setting,
    sigmas: &[f64; 3],
) -> [f64; 2] {
    let [mut moment, mut weight] = [0.0; 2];
    for (axis, moved) in by_azimuth(before, setting).into_iter().enumerate() {
        let part = moved / (sigmas[axis] * sigmas[axis]);
        moment += part * (now[axis].0 - before.rates[axis].0);
        weight += part * moved;
    }
    [moment / weight, 1.0 / libm::sqrt(weight)]
}

/// Derivative by the azimuth A of the Earth rate about forward, right, down, 1/s. On level axes the horizontal rate H is
/// (H cos A, −H sin A, 0).
fn by_azimuth(before: &Remembered, setting: &Setting) -> [f64; 3] {
    let [(sine, cosine), (up, along), (over, upright)] =
        [before.azimuth, before.pitch, before.roll].map(|angle| libm::sincos(angle.0));
    let rate = setting.latitude.horizontal_rate().0;
    let [forward, right] = [-rate * sine, -rate * cosine];
    let [across, down] = [over * up * forward, upright * up * forward];
    [along * forward, across + upright * right, down - over * right]
}

impl Remembered {
    /// Size of the stored form, bytes.
    pub const BYTES: usize = record_bytes(8);

    /// Stored form: version, values in the order of their fields, CRC-32, all little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::BYTES] {
        let Self { azimuth, sigma, pitch, roll, rates: [x, y, z], rest } = *self;
        let values = [azimuth.0, sigma.0, pitch.0, roll.0, x.0, y.0, z.0, rest.0];
        record(VERSION, &values.map(f64::to_bits))
    }

    /// Reads the stored form; `None` where it is damaged, of another version, or not finite.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let values = numbers(VERSION, bytes)?.map(f64::from_bits);
        let [azimuth, sigma, pitch, roll, x, y, z, rest] = values;
        let [azimuth, sigma, pitch, roll] = [azimuth, sigma, pitch, roll].map(Radians);
        let (rates, rest) = ([x, y, z].map(RadiansPerSecond), Seconds(rest));
        let are_finite = values.iter().all(|value| value.is_finite());
        are_finite.then_some(Self { azimuth, sigma, pitch, roll, rates, rest })
    }
}
