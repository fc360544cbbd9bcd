//! The recording of a stage or of two frames, kind `stage`.
//!
//! The rate is that which the session was given: on a base with coarse sensors, less the base's sway.

use std::io::{self, Write};

use embassy_time::Instant;
use firmware::ports::BaseReading;
use firmware::simulated::mount::FramesScenario;
use firmware::simulated::scenario::Scenario;
use orientation::align::setting::Setting;
use orientation::session::procedure::Procedure;
use orientation::signal::Sample;

use super::text::{Maybe, Scaled, angle, forces, rate, seconds};
use super::{Carrier, Ending, header};
use crate::instrument::{FramesRun, Run};
use crate::recording::{Given, Kind};

const COLUMNS: &str = "t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2,temperature_c,force_is_new";
const ELEVATION: &str = ",elevation_rad";
const BASE: &str = ",bgx_rad_s,bgy_rad_s,bgz_rad_s,bax_m_s2,bay_m_s2,baz_m_s2";

impl Carrier for Scenario {
    type Run = Run;
    type Sample = Sample;

    fn write(&self, to: &mut impl Write, run: &Run, of: &[Sample]) -> io::Result<()> {
        write(to, self, (self.setting(), self.procedure()), run, of)
    }
}

impl Carrier for FramesScenario {
    type Run = FramesRun;
    type Sample = Sample;

    fn write(&self, to: &mut impl Write, run: &FramesRun, of: &[Sample]) -> io::Result<()> {
        write(to, &self.base, (self.setting(), self.procedure()), &run.run, of)
    }
}

/// Writes what a board was told at the begin, for a survey changes it, and what it measured.
fn write(
    to: &mut impl Write,
    base: &Scenario,
    (setting, procedure): (Option<Setting>, Procedure),
    run: &Run,
    of: &[Sample],
) -> io::Result<()> {
    let ending = Ending::of(&run.events);
    let setting = setting.ok_or(io::ErrorKind::InvalidInput)?;
    let setting = Setting { sway: run.replay.setting.sway, ..setting };
    let of = &of[..of.partition_point(|sample| sample.time <= ending.at)];
    let is_mounted = of.iter().any(|sample| sample.elevation.is_some());
    header(to, Kind::Stage, base, &setting)?;
    writeln!(to, "# truth_azimuth_deg: {}", base.azimuth_deg)?;
    writeln!(to, "{}", Given { setting, procedure, ended: ending.reason })?;
    let elevation = if is_mounted { ELEVATION } else { "" };
    writeln!(to, "{COLUMNS}{elevation}{}", if run.base.is_empty() { "" } else { BASE })?;
    let mut force = Default::default();
    for (index, sample) in of.iter().enumerate() {
        force = sample.force.unwrap_or(force);
        let [x, y, z] = forces(force);
        let (time, stage, gyro) = (seconds(sample.time), angle(sample.stage), rate(sample.rate));
        let temperature = Maybe(sample.temperature.map(|shown| Scaled::new(shown.0, 3)));
        let is_new = u8::from(sample.force.is_some());
        write!(to, "{time},{stage},{gyro},{x},{y},{z},{temperature},{is_new}")?;
        if is_mounted {
            write!(to, ",{}", Maybe(sample.elevation.map(angle)))?;
        }
        if !run.base.is_empty() {
            write_base(to, latest(&run.base, sample, of.get(index + 1)))?;
        }
        writeln!(to)?;
    }
    Ok(())
}

/// The latest reading of the base's sensors from a sample to before the next; none without a new one.
fn latest<'a>(
    base: &'a [(Instant, BaseReading)],
    sample: &Sample,
    next: Option<&Sample>,
) -> Option<&'a BaseReading> {
    let end = next.map_or(u64::MAX, |next| next.time.0);
    let before = base.partition_point(|(at, _)| at.as_micros() < end);
    let (at, reading) = base.get(before.checked_sub(1)?)?;
    (at.as_micros() >= sample.time.0).then_some(reading)
}

/// Writes the fields of a reading of the base's sensors, empty without one.
fn write_base(to: &mut impl Write, reading: Option<&BaseReading>) -> io::Result<()> {
    let Some(BaseReading { rate: turning, force, .. }) = reading else {
        return write!(to, ",,,,,,");
    };
    let ([x, y, z], [ahead, right, down]) = (turning.map(rate), forces(*force));
    write!(to, ",{x},{y},{z},{ahead},{right},{down}")
}
