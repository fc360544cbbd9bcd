//! What so many disturbed dwells have in common, where that is no platform that moves.
//!
//! A platform that is pushed or shaken disturbs dwells unlike each other. Where all scatter alike, and as white noise
//! does, from block to block and from mean to mean, the noise that was stated is wrong, or the rates are in another
//! unit. A platform that sways comes back to where it was, so the means of its dwells scatter by far less than that. And
//! a gyro that is stuck is no platform.

use super::quality::median_of;
use super::regression::{Column, Regression};
use super::setting::Setting;
use crate::device::{Device, Trouble};
use crate::error::Refusal;
use crate::signal::blocks::BlockStatistics;
use crate::signal::dwell::{Dwell, SampleFault};

/// Factor of its noise power within which a dwell scatters like the usual one: chance makes less of a dozen blocks.
const ALIKE: f64 = 3.0;
/// Part of the dwells that must scatter alike.
const MOST: f64 = 0.75;
/// Least factor of the stated noise power that is no chance of so many dwells.
const LEAST: f64 = 2.0;
/// How far neighbouring blocks may differ from what white noise makes of them: a sway makes less of them, or, where its
/// period is two blocks, more.
const WHITE: core::ops::Range<f64> = 0.7..1.3;

/// Least part of white noise that the means of the dwells must show about the Earth rate.
const LEAST_MEANS: f64 = 0.2;

/// The refusal of too many disturbed dwells, or what it is really about; any other refusal as it is.
#[must_use]
pub fn of(refusal: Refusal, setting: &Setting, dwells: &[Dwell]) -> Refusal {
    match refusal {
        Refusal::Disturbed { .. } if is_stuck(dwells) => {
            Refusal::Device { device: Device::Gyro, trouble: Trouble::Stuck }
        }
        Refusal::Disturbed { .. } => {
            noise(setting, dwells).map_or(refusal, |ratio| Refusal::NoiseNotAsStated { ratio })
        }
        other => other,
    }
}

/// Whether most dwells showed one value all the time.
fn is_stuck(dwells: &[Dwell]) -> bool {
    let stuck = dwells.iter().filter(|dwell| dwell.fault == Some(SampleFault::Stuck));
    2 * stuck.count() > dwells.len()
}

/// By what factor of the stated noise power all dwells scatter, where they do so alike and as white noise does.
fn noise(setting: &Setting, dwells: &[Dwell]) -> Option<f64> {
    let quiet = || dwells.iter().filter_map(|dwell| dwell.quietness.as_ref());
    let ratios = || quiet().map(|quietness| power(quietness) / stated(setting, quietness));
    let usual = median_of(ratios());
    let is_alike = |ratio: &f64| (usual / ALIKE..usual * ALIKE).contains(ratio);
    let alike = ratios().filter(is_alike).count() as f64;
    let is_white = WHITE.contains(&median_of(quiet().map(neighbours)));
    let is_found = setting.white_known && is_white && alike >= MOST * dwells.len() as f64;
    let has_white_means = || means(dwells).is_some_and(|means| means > LEAST_MEANS);
    (is_found && usual > LEAST && has_white_means()).then_some(usual)
}

/// Noise power that was stated, with what a subtracted sway leaves, (rad/s)²·s.
fn stated(setting: &Setting, quietness: &BlockStatistics) -> f64 {
    let (walk, seconds) = (setting.noise.angle_random_walk, quietness.block_seconds);
    walk * walk + setting.sway.mean_variance(seconds) * seconds
}

/// Noise power that a dwell's blocks show, (rad/s)²·s.
fn power(quietness: &BlockStatistics) -> f64 {
    quietness.scatter / (quietness.count() - 2.0) * quietness.block_seconds
}

/// Noise power that neighbouring blocks show over that of all: one where it is white.
fn neighbours(quietness: &BlockStatistics) -> f64 {
    let of_neighbours = quietness.neighbour_squares / (2.0 * (quietness.count() - 1.0));
    of_neighbours * quietness.block_seconds / power(quietness)
}

/// Noise power that the means of the dwells show about a cosine of the stage angle, over that inside them; none where
/// there are too few.
fn means(dwells: &[Dwell]) -> Option<f64> {
    let mut regression = Regression::<3>::default();
    for dwell in dwells {
        let (sine, cosine) = libm::sincos(dwell.stage.rad());
        let deviation = libm::sqrt(power(dwell.quietness.as_ref()?) / dwell.seconds);
        let columns = [cosine, sine, 1.0].map(|column| column / deviation);
        regression.push(&columns, dwell.rate / deviation);
    }
    let solution = regression.solve(&[Column::Free; 3])?;
    (solution.degrees > 0).then(|| solution.chi_square / solution.degrees as f64)
}
