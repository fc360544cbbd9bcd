//! What subtracting the sway of the base costs.

use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::session::Session;
use orientation::signal::dwell::Dwell;

use crate::output::degrees_per_hour;

/// What the base's coarse IMU, whose rates are subtracted with the sway, brings into a dwell's mean rate.
pub(super) struct SwayNoise {
    /// 1σ in the mean of `seconds`, rad/s.
    pub sigma: f64,
    /// Median length of a dwell, s.
    seconds: f64,
    /// That σ over the one from the gyro's own white noise.
    ratio: f64,
}

impl SwayNoise {
    /// Of the dwells that took part; none where nothing is subtracted.
    pub fn of(session: &Session, conclusion: &Conclusion, kept: &[&Dwell]) -> Option<Self> {
        let mut lengths: Vec<f64> = kept.iter().map(|dwell| dwell.seconds.0).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        let seconds = *lengths.get(lengths.len() / 2)?;
        let sigma = session.setting.sway.mean_variance(seconds).sqrt();
        let own = conclusion.angle_random_walk.0 / seconds.sqrt();
        (sigma > 0.0 && own > 0.0).then_some(Self { sigma, seconds, ratio: sigma / own })
    }

    /// Label and value.
    pub fn in_words(&self) -> [String; 2] {
        let Self { sigma, seconds, ratio } = self;
        let sigma = degrees_per_hour(*sigma);
        let words = format!(
            "subtracted, which leaves the coarse IMU's {sigma:.2} °/h (1σ) in {seconds:.0} s, {ratio:.1} times the gyro's noise"
        );
        ["sway of the base".to_owned(), words]
    }
}
