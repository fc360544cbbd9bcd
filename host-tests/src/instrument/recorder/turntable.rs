//! The recording of a platform that turns all the time, kind `rotating`, and its rows for figures.

use std::io::{self, Write};

use firmware::simulated::turntable::TurntableScenario;
use orientation::signal::Sample;
use orientation::units::{Angle, SpecificForce};

use super::text::{forces, rate, seconds};
use super::{Carrier, Ending, header};
use crate::instrument::TurntableRun;
use crate::recording::{Given, Kind, RotatingRow, Sensor};

const COLUMNS: &str = "t_s,stage_rad,stage_rate_rad_s,g_rad_s,a_m_s2,a_across_m_s2,force_is_new";

impl Carrier for TurntableScenario {
    type Run = TurntableRun;
    type Sample = Sample;

    fn write(&self, to: &mut impl Write, run: &TurntableRun, of: &[Sample]) -> io::Result<()> {
        let session = &run.run.replay;
        let ending = Ending::of(&run.run.events);
        let (setting, procedure) = (*session.setting(), session.procedure().clone());
        header(to, Kind::Rotating, &self.base, &setting.common)?;
        let sensor = if self.molecular.is_some() { Sensor::Met } else { Sensor::Gyro };
        writeln!(to, "# sensor: {}", sensor.name())?;
        let zero_sigma = setting.encoder_zero_sigma.to_degrees();
        writeln!(to, "# encoder_zero_sigma_deg: {zero_sigma:.9}")?;
        writeln!(to, "# truth_azimuth_deg: {}", self.base.azimuth_deg)?;
        writeln!(to, "{}", Given { setting, procedure, ended: ending.reason })?;
        writeln!(to, "{COLUMNS}")?;
        for (sample, turning) in of.iter().zip(Turning::of(of)) {
            let (time, gyro) = (seconds(sample.time), rate(sample.rate));
            let [along, across, _] = forces(turning.force);
            let is_new = u8::from(sample.force.is_some());
            let Turning { angle, rate, .. } = turning;
            writeln!(to, "{time},{angle:.10},{rate},{gyro},{along},{across},{is_new}")?;
        }
        Ok(())
    }
}

/// What a sample shows by those before it.
struct Turning {
    /// Angle of the platform with whole turns counted, and its rate, rad and rad/s.
    angle: f64,
    rate: f64,
    /// The latest force.
    force: [SpecificForce; 3],
}

impl Turning {
    /// What each of some samples shows.
    fn of(samples: &[Sample]) -> impl Iterator<Item = Self> + '_ {
        let mut steps = samples.first().map_or(0, |first| i64::from(first.stage.0.cast_signed()));
        let mut force = [SpecificForce::default(); 3];
        let before = samples.first().into_iter().chain(samples);
        samples.iter().zip(before).map(move |(sample, before)| {
            let turned = (sample.stage - before.stage).0.cast_signed();
            let seconds = (sample.time.0 - before.time.0).max(1) as f64 * 1e-6;
            steps += i64::from(turned);
            force = sample.force.unwrap_or(force);
            let rate = f64::from(turned) * Angle::STEP / seconds;
            Self { angle: steps as f64 * Angle::STEP, rate, force }
        })
    }
}

/// The rows of a recording of these samples, for figures.
#[must_use]
pub fn turning_rows(samples: &[Sample]) -> Vec<RotatingRow> {
    let row = |((line, sample), turning): ((u64, &Sample), Turning)| RotatingRow {
        line,
        time_s: sample.time.0 as f64 * 1e-6,
        stage_rad: turning.angle,
        stage_rate_rad_s: turning.rate,
        rate_rad_s: sample.rate.rad_per_s(),
        force_m_s2: turning.force[0].m_per_s2(),
        across_m_s2: None,
        force_is_new: sample.force.is_some(),
    };
    (1..).zip(samples).zip(Turning::of(samples)).map(row).collect()
}
