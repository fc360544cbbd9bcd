//! The recording of a platform that turns all the time, kind `rotating`, and its rows for figures.

use std::io::{self, Write};

use firmware::ports::Store;
use firmware::shared::Channels;
use firmware::storage::load_calibration;
use orientation::signal::Sample;
use orientation::units::Angle;
use simulated::turntable::TurntableScenario;

use super::{Recorded, forces, header, rate, row, seconds};
use crate::instrument::TurntableRun;
use crate::instrument::kept::Kept;
use crate::recording::inputs::{Carrier, Given};
use crate::recording::{self, Kind, RotatingRow, Truth};
use crate::virtual_time;

const COLUMNS: &str = "t_s,stage_rad,stage_rate_rad_s,g_rad_s,a_m_s2,a_across_m_s2,force_is_new";

impl Recorded for TurntableScenario {
    fn write(&self, to: &mut impl Write, run: &TurntableRun, of: &[Sample]) -> io::Result<()> {
        let session = &run.replay;
        let (setting, procedure) = (session.setting, session.procedure.clone());
        let ended = session.conclusion().and_then(|conclusion| conclusion.verdict.err());
        let mut head = Vec::new();
        header(&mut head, Kind::Rotating, &self.base, &setting.site)?;
        let sensor = if self.molecular.is_some() { "met" } else { "gyro" };
        writeln!(head, "# sensor: {sensor}")?;
        let zero_sigma = setting.encoder_zero_sigma.degrees();
        writeln!(head, "# encoder_zero_sigma_deg: {zero_sigma:.9}")?;
        recording::Given::new(setting, procedure, ended).write(to, &head)?;
        writeln!(to, "# truth_azimuth_deg: {}\n{COLUMNS}", self.base.azimuth_deg)?;
        turning_rows(of).iter().try_for_each(|it| {
            let (angle, is_new) = (it.stage_rad, f64::from(it.force_is_new));
            let [along, across] = [it.force_m_s2, it.across_m_s2.unwrap_or_default()];
            let turning = it.stage_rate_rad_s;
            row(to, &[it.time_s, angle, turning, it.rate_rad_s, along, across, is_new])
        })
    }

    fn given(&self) -> Option<Given> {
        let carrier = Carrier::Turntable(Box::new((self.setting()?, self.procedure())));
        Some(Given { carrier, attitude: self.base.keeper()?, policy: self.base.policy() })
    }

    fn end_of<'r>(&self, run: &'r TurntableRun) -> (&'r Kept, Truth) {
        run.end(self.base.azimuth_deg)
    }
}

/// What a board is given that takes the axis misalignments of its store on a day; without a day as ever.
pub fn given_by<T: Store>(scenario: &TurntableScenario, store: &mut T) -> Option<Given> {
    let mut given = scenario.given()?;
    if let (Carrier::Turntable(of), Some(today)) = (&mut given.carrier, scenario.today) {
        let (setting, procedure) = &mut **of;
        let channels: Channels<'_> = Channels::new(&());
        let load = load_calibration(store, today, (setting, procedure), &channels.shared);
        virtual_time::run(load).ok()?;
    }
    Some(given)
}

/// The rows of a recording of these samples, their angles from that of the first one on with whole turns counted, the
/// platform's rate from reading to reading of its encoder, the force the latest.
#[must_use]
pub fn turning_rows(samples: &[Sample]) -> Vec<RotatingRow> {
    let (mut steps, mut force) = (0, [0.0; 3]);
    let start = samples.first().map_or(0.0, |first| first.stage.rad());
    let before = samples.first().into_iter().chain(samples);
    let row = |((line, sample), (before, turning)): ((u64, &Sample), (&Sample, f64))| {
        steps += turned(before, sample);
        force = sample.force.map_or(force, forces);
        RotatingRow {
            line,
            time_s: seconds(sample.time),
            stage_rad: start + steps as f64 * Angle::STEP,
            stage_rate_rad_s: turning,
            rate_rad_s: rate(sample.rate),
            force_m_s2: force[0],
            across_m_s2: Some(force[1]),
            force_is_new: sample.force.is_some(),
        }
    };
    (1..).zip(samples).zip(before.zip(stage_rates(samples))).map(row).collect()
}

/// Steps of the angle from one sample to another.
fn turned(from: &Sample, to: &Sample) -> i64 {
    i64::from((to.stage - from.stage).0.cast_signed())
}

/// The platform's rate at each sample, rad/s: an encoder that is read more seldom than the gyro stands between its
/// readings, so that all samples up to a new reading have the rate since the one before.
fn stage_rates(samples: &[Sample]) -> Vec<f64> {
    let mut rates = Vec::with_capacity(samples.len());
    let mut read = samples.first();
    for (index, sample) in samples.iter().enumerate() {
        if let Some(before) = read.filter(|before| before.stage != sample.stage) {
            let lasted_s = (sample.time.0 - before.time.0).max(1) as f64 * 1e-6;
            rates.resize(index + 1, turned(before, sample) as f64 * Angle::STEP / lasted_s);
            read = Some(sample);
        }
    }
    rates.resize(samples.len(), 0.0);
    rates
}
