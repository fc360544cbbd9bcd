//! The recording of a vehicle, kind `imu`. Rates are what turned in a sample, over its nominal period.

use std::io::{self, Write};

use orientation::signal::InertialSample;
use simulated::vehicle::VehicleScenario;

use super::{Recorded, forces, header, mean_rate, row, seconds};
use crate::instrument::VehicleRun;
use crate::instrument::kept::Kept;
use crate::output::degrees;
use crate::recording::inputs::{Carrier, Given};
use crate::recording::{self, GREATEST_BODY_RATE, Kind, Truth};

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
        writeln!(to, "# truth_start_azimuth_deg: {}", self.base.azimuth_deg)?;
        writeln!(to, "{COLUMNS}")?;
        let mut force = [0.0; 3];
        of.iter().try_for_each(|sample| {
            force = sample.force.map_or(force, forces);
            let ([x, y, z], [ahead, right, down]) = (
                sample.turned.map(|turned| mean_rate(turned, period_s.0, GREATEST_BODY_RATE)),
                force,
            );
            let is_new = f64::from(sample.force.is_some());
            row(to, &[seconds(sample.time), x, y, z, ahead, right, down, is_new])
        })
    }

    fn given(&self) -> Option<Given> {
        let carrier = Carrier::Vehicle(Box::new((self.setting()?, self.procedure())));
        Some(Given { carrier, attitude: self.keeper()?, policy: self.policy() })
    }

    fn end_of<'r>(&self, run: &'r VehicleRun) -> (&'r Kept, Truth) {
        let truth = Truth {
            azimuth_deg: Some(degrees(run.azimuth_rad()).rem_euclid(360.0)),
            start_azimuth_deg: Some(self.base.azimuth_deg),
            ..Truth::default()
        };
        (&run.kept, truth)
    }
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
