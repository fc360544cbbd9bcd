//! Keeps the samples of a board on a turning platform as rows of a recording, for figures.

use firmware::ports::Recorder;
use orientation::signal::Sample;
use orientation::units::Angle;

use crate::recording::RotatingRow;

/// The rows so far.
#[derive(Clone, Debug, Default)]
pub struct RowRecorder {
    rows: Vec<RotatingRow>,
    last: Option<Sample>,
    force_m_s2: f64,
}

impl RowRecorder {
    /// The rows: whole turns counted, the platform's rate from sample to sample, the force the latest.
    #[must_use]
    pub fn rows(&self) -> &[RotatingRow] {
        &self.rows
    }

    fn push(&mut self, sample: &Sample) {
        if let Some([along, _, _]) = sample.force {
            self.force_m_s2 = along.m_per_s2();
        }
        let (last, before) = (self.last.replace(*sample), self.rows.last());
        let [turned, seconds] = last.map_or([0.0, 1.0], |last| {
            let steps = (sample.stage - last.stage).0.cast_signed();
            [f64::from(steps) * Angle::STEP, (sample.time.0 - last.time.0) as f64 * 1e-6]
        });
        self.rows.push(RotatingRow {
            line: self.rows.len() as u64 + 1,
            time_s: sample.time.0 as f64 * 1e-6,
            stage_rad: before.map_or(0.0, |row| row.stage_rad) + turned,
            stage_rate_rad_s: turned / seconds,
            rate_rad_s: sample.rate.rad_per_s(),
            force_m_s2: self.force_m_s2,
            across_m_s2: None,
        });
    }
}

impl Recorder for &mut RowRecorder {
    async fn record(&mut self, sample: &Sample) {
        self.push(sample);
    }
}
