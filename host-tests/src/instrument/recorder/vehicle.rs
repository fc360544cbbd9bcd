//! The recording of a vehicle, kind `imu`. Rates are what turned in a sample, over its nominal period.

use std::io::{self, Write};

use orientation::signal::InertialSample;
use simulated::vehicle::VehicleScenario;

use super::{Recorded, forces, header, mean_rate, row, seconds};
use crate::instrument::VehicleRun;
use crate::instrument::kept::Kept;
use crate::output::degrees;
use crate::recording::inputs::{Carrier, Given};
use crate::recording::{self, GREATEST_BODY_RATE, ImuRow, ImuSample, Kind, Truth};

const COLUMNS: &str = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2,force_is_new";

impl Recorded for VehicleScenario {
    fn write(
        &self,
        to: &mut impl Write,
        run: &VehicleRun,
        of: &[InertialSample],
    ) -> io::Result<()> {
        let session = &run.replay;
        let (setting, procedure) = (session.setting, session.procedure.clone());
        let period_s = procedure.sample_seconds;
        let ended = session.conclusion().and_then(|conclusion| conclusion.verdict.err());
        let mut head = Vec::new();
        header(&mut head, Kind::Imu, &self.base, &setting.site)?;
        writeln!(head, "# gyro_bias_deg_h: {}", self.base.gyro.bias_sigma_deg_h)?;
        stops(&mut head, run)?;
        recording::Given::new(setting, procedure, ended).write(to, &head)?;
        let azimuth = degrees(run.azimuth_rad()).rem_euclid(360.0);
        writeln!(to, "# truth_azimuth_deg: {azimuth}")?;
        if let Some(start) = start_deg(self, run) {
            writeln!(to, "# truth_start_azimuth_deg: {start}")?;
        }
        writeln!(to, "{COLUMNS}")?;
        driven_rows(of, period_s.0).iter().try_for_each(|it| {
            let ([x, y, z], [ahead, right, down]) = (it.sample.rates_rad_s, it.sample.force_m_s2);
            row(to, &[it.time_s, x, y, z, ahead, right, down, f64::from(it.force_is_new)])
        })
    }

    fn given(&self) -> Option<Given> {
        let carrier = Carrier::Vehicle(Box::new((self.setting()?, self.procedure())));
        Some(Given { carrier, attitude: self.keeper()?, policy: self.policy() })
    }

    fn end_of<'r>(&self, run: &'r VehicleRun) -> (&'r Kept, Truth) {
        let truth = Truth {
            azimuth_deg: Some(degrees(run.azimuth_rad()).rem_euclid(360.0)),
            start_azimuth_deg: start_deg(self, run),
            ..Truth::default()
        };
        (&run.kept, truth)
    }
}

/// The rows of a recording of these samples, a period apart: mean rates, and the latest force.
#[must_use]
pub fn driven_rows(samples: &[InertialSample], period_s: f64) -> Vec<ImuRow> {
    let mut force_m_s2 = [0.0; 3];
    let row = |(line, sample): (u64, &InertialSample)| {
        let rate = |turned| mean_rate(turned, period_s, GREATEST_BODY_RATE);
        force_m_s2 = sample.force.map_or(force_m_s2, forces);
        let body = ImuSample { rates_rad_s: sample.turned.map(rate), force_m_s2 };
        let (time_s, force_is_new) = (seconds(sample.time), sample.force.is_some());
        ImuRow { line, time_s, sample: body, force_is_new }
    };
    (1..).zip(samples).map(row).collect()
}

/// The true azimuth where the alignment began, °: the scenario's of the first one, not known of one that was begun anew.
fn start_deg(scenario: &VehicleScenario, run: &VehicleRun) -> Option<f64> {
    (!run.is_realigned()).then_some(scenario.base.azimuth_deg)
}

/// Writes where the vehicle stood, and what the board was given of how far from the first stop that was.
fn stops(to: &mut impl Write, run: &VehicleRun) -> io::Result<()> {
    let stops = run.replay.stops();
    if stops.is_empty() {
        return Ok(());
    }
    let stood: Vec<_> = stops.iter().map(|stop| format!("{}-{}", stop.from.0, stop.to.0)).collect();
    writeln!(to, "# stops_s: {}", stood.join(";"))?;
    let places = stops.iter().map(|stop| stop.displacement);
    let places = places.map(|place| place.map(|[north, east]| format!("{},{}", north.0, east.0)));
    let Some(places) = places.collect::<Option<Vec<_>>>() else { return Ok(()) };
    writeln!(to, "# displacements_north_east_m: {}", places.join(";"))
}
