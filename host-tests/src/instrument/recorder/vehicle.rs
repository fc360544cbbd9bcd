//! The recording of a vehicle, kind `imu`.
//!
//! Rates are what turned in a sample, over its nominal period.

use std::io::{self, Write};

use firmware::event::Event;
use firmware::simulated::vehicle::VehicleScenario;
use orientation::signal::InertialSample;
use orientation::units::AngleIncrement;

use super::text::{forces, seconds};
use super::{Carrier, Ending, header};
use crate::instrument::VehicleRun;
use crate::recording::{GREATEST_BODY_RATE, Given, Kind};

const COLUMNS: &str = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2,force_is_new";

impl Carrier for VehicleScenario {
    type Run = VehicleRun;
    type Sample = InertialSample;

    fn write(
        &self,
        to: &mut impl Write,
        run: &VehicleRun,
        of: &[InertialSample],
    ) -> io::Result<()> {
        let session = &run.run.replay;
        let ending = Ending::of(&run.run.events);
        let (setting, procedure) = (*session.setting(), session.procedure().clone());
        let period_s = procedure.sample_seconds;
        header(to, Kind::Imu, &self.base, &setting.common)?;
        writeln!(to, "# gyro_bias_deg_h: {}", self.base.gyro.bias_sigma_deg_h)?;
        stops(to, run, &ending)?;
        if self.base.hold.seconds == 0.0 {
            let azimuth_deg = run.truth.attitude.azimuth_rad.to_degrees();
            writeln!(to, "# truth_azimuth_deg: {}", azimuth_deg.rem_euclid(360.0))?;
        }
        writeln!(to, "{}", Given { setting, procedure, ended: ending.reason })?;
        writeln!(to, "{COLUMNS}")?;
        let mut force = Default::default();
        for sample in of.iter().take_while(|sample| sample.time <= ending.at) {
            force = sample.force.unwrap_or(force);
            let [x, y, z] = sample.turned.map(|turned| mean_rate(turned, period_s));
            let [ahead, right, down] = forces(force);
            let (time, is_new) = (seconds(sample.time), u8::from(sample.force.is_some()));
            writeln!(to, "{time},{x},{y},{z},{ahead},{right},{down},{is_new}")?;
        }
        Ok(())
    }
}

/// What turned in a period, s, as a rate, rad/s; at a limit of the gyro's range the greatest that there is.
fn mean_rate(turned: AngleIncrement, period_s: f64) -> f64 {
    if turned.is_saturated() { GREATEST_BODY_RATE } else { turned.rad() / period_s }
}

/// Where the vehicle stood until the alignment ended, and what the board was told of its displacements.
fn stops(to: &mut impl Write, run: &VehicleRun, ending: &Ending) -> io::Result<()> {
    let mut places = vec![[0.0; 2]];
    for (at, event) in &run.run.events {
        if let Event::Displaced(stop, place) = *event
            && (at.as_micros(), stop) <= (ending.at.0, places.len() + 1)
        {
            places.push(place);
        }
    }
    let stood = run.run.replay.stops().iter().filter(|stop| stop.to <= ending.at.seconds());
    let stops: Vec<String> = stood.map(|stop| format!("{}-{}", stop.from, stop.to)).collect();
    if !stops.is_empty() && (places.len() == 1 || places.len() == stops.len()) {
        writeln!(to, "# stops_s: {}", stops.join(";"))?;
    }
    if places.len() == 1 {
        return Ok(());
    }
    let places = places.iter().map(|[north, east]| format!("{north},{east}"));
    writeln!(to, "# displacements_north_east_m: {}", places.collect::<Vec<_>>().join(";"))
}
