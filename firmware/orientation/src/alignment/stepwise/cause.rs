//! Diagnosis of many disturbed dwells whose common cause is not a moving platform.
//!
//! A platform that is pushed or shaken disturbs each dwell differently. If all dwells scatter
//! alike, and white, from block to block and from mean to mean, then the configured noise is wrong
//! or the rates are in another unit. A platform that sways returns to where it was, so the means of
//! its dwells scatter far less than that. A gyro that is stuck is diagnosed as such, and so is a
//! base whose sensors failed before they could observe its sway.

use super::Refusal;
use super::quality::{median_of, statistics};
use super::setting::Setting;
use crate::alignment;
use crate::device::{Device, Trouble};
use crate::math::{Column, Regression};
use crate::signal::blocks::BlockStatistics;
use crate::signal::{Dwell, SampleFault};

/// Factor within which the noise power of a dwell counts as like the median one; chance makes less
/// of a dozen blocks.
const ALIKE: f64 = 3.0;
/// Least part of the dwells that must scatter alike.
const MOST: f64 = 0.75;
/// Least factor of the configured noise power that chance does not explain for so many dwells.
const LEAST: f64 = 2.0;
/// Range of the power between neighbouring blocks over that of white noise. A sway lowers it, or,
/// where its period is two blocks, raises it.
const WHITE: core::ops::Range<f64> = 0.7..1.3;

/// Least power of the dwell means about the Earth rate, as a part of that of white noise.
const LEAST_MEANS: f64 = 0.2;

/// Replaces a refusal for too many disturbed dwells by its common cause, where there is one;
/// returns any other refusal unchanged.
pub(crate) fn of(refusal: Refusal, setting: &Setting, dwells: &[Dwell]) -> alignment::Refusal {
    use Refusal::{Disturbed, NoiseNotAsStated, SwayUnmeasured};
    let cause = match refusal {
        Disturbed { .. } if is_stuck(dwells) => {
            return alignment::Refusal::Device { device: Device::Gyro, trouble: Trouble::Stuck };
        }
        Disturbed { .. } if setting.sway.is_unmeasured() => SwayUnmeasured,
        Disturbed { .. } => {
            noise(setting, dwells).map_or(refusal, |ratio| NoiseNotAsStated { ratio })
        }
        other => other,
    };
    cause.into()
}

/// Whether most dwells showed one constant value.
fn is_stuck(dwells: &[Dwell]) -> bool {
    let stuck = dwells.iter().filter(|dwell| dwell.fault == Some(SampleFault::Stuck));
    2 * stuck.count() > dwells.len()
}

/// Factor of the configured noise power by which the dwells scatter; `None` where they do not
/// scatter alike and white.
fn noise(setting: &Setting, dwells: &[Dwell]) -> Option<f64> {
    let quiet = || statistics(dwells);
    let ratios = || quiet().map(|statistics| power(statistics) / stated(setting, statistics));
    let usual = median_of(ratios());
    let is_alike = |ratio: &f64| (usual / ALIKE..usual * ALIKE).contains(ratio);
    let alike = ratios().filter(is_alike).count() as f64;
    let is_white = WHITE.contains(&median_of(quiet().map(neighbours)));
    let is_found =
        setting.site.noise.is_white_known() && is_white && alike >= MOST * dwells.len() as f64;
    let has_white_means = || means(dwells).is_some_and(|means| means > LEAST_MEANS);
    (is_found && usual > LEAST && has_white_means()).then_some(usual)
}

/// Configured noise power plus the remainder of sway compensation, (rad/s)²·s.
fn stated(setting: &Setting, statistics: &BlockStatistics) -> f64 {
    let (walk, seconds) = (setting.site.noise.model().angle_random_walk, statistics.block_seconds);
    walk.0 * walk.0 + setting.sway.mean_variance(seconds) * seconds
}

/// Noise power of a dwell's block means, (rad/s)²·s.
fn power(statistics: &BlockStatistics) -> f64 {
    statistics.scatter / (statistics.count() - 2.0) * statistics.block_seconds
}

/// Noise power of neighbouring blocks over that of all blocks: one for white noise.
fn neighbours(statistics: &BlockStatistics) -> f64 {
    let of_neighbours = statistics.neighbour_squares / (2.0 * (statistics.count() - 1.0));
    of_neighbours * statistics.block_seconds / power(statistics)
}

/// Noise power of the dwell means about a sinusoid of the stage angle, over the power within the
/// dwells; `None` with too few dwells.
fn means(dwells: &[Dwell]) -> Option<f64> {
    let mut regression = Regression::<3>::default();
    for dwell in dwells {
        let (sine, cosine) = libm::sincos(dwell.stage.rad());
        let deviation = libm::sqrt(power(dwell.statistics.as_ref()?) / dwell.seconds.0);
        let columns = [cosine, sine, 1.0].map(|column| column / deviation);
        regression.push(&columns, dwell.rate.0 / deviation);
    }
    let solution = regression.solve(&[Column::Free; 3])?;
    (solution.degrees > 0).then(|| solution.chi_square / solution.degrees as f64)
}
