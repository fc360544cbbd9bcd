//! The recording of a stage or of two frames, kind `stage`. The rate is that which the session was given: on a base with
//! coarse sensors, less the base's sway.

use std::io::{self, Write};
use std::ops::Range;

use embassy_time::Instant;
use firmware::ports::BaseReading;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::setting::Setting;
use orientation::signal::Sample;
use orientation::units::Angle;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;

use super::{Recorded, forces, header, rate, row, seconds};
use crate::instrument::kept::Kept;
use crate::instrument::{FramesRun, Run};
use crate::methods::stepwise::Replay;
use crate::recording::inputs::{Carrier, Given};
use crate::recording::{self, Kind, Truth};

/// The columns of every stage, then that of a mount, then those of a base with coarse sensors.
const COLUMNS: [&str; 3] = [
    "t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2,temperature_c,force_is_new",
    "elevation_rad",
    "bgx_rad_s,bgy_rad_s,bgz_rad_s,bax_m_s2,bay_m_s2,baz_m_s2",
];

impl Recorded for Scenario {
    fn write(&self, to: &mut impl Write, run: &Run, of: &[Sample]) -> io::Result<()> {
        write(to, self, (self.setting(), self.procedure()), run, of)
    }

    fn given(&self) -> Option<Given> {
        let carrier = Carrier::Stage(Box::new((self.setting()?, self.procedure())));
        Some(Given { carrier, attitude: self.keeper()?, policy: self.policy() })
    }

    fn end_of<'r>(&self, run: &'r Run) -> (&'r Kept, Truth) {
        run.end(self.azimuth_deg)
    }
}

impl Recorded for FramesScenario {
    fn write(&self, to: &mut impl Write, run: &FramesRun, of: &[Sample]) -> io::Result<()> {
        write(to, &self.base, (self.setting(), self.procedure()), run, of)
    }

    fn given(&self) -> Option<Given> {
        let carrier = Carrier::TwoFrame(Box::new((self.setting()?, self.procedure())));
        Some(Given { carrier, attitude: self.base.keeper()?, policy: self.base.policy() })
    }

    fn end_of<'r>(&self, run: &'r FramesRun) -> (&'r Kept, Truth) {
        run.end(self.base.azimuth_deg)
    }
}

/// Writes what a board was given at the beginning, for a survey changes it, and what it measured.
fn write(
    to: &mut impl Write,
    scenario: &Scenario,
    (setting, procedure): (Option<Setting>, Procedure),
    run: &Run<Replay, impl Sized>,
    of: &[Sample],
) -> io::Result<()> {
    let setting = setting.ok_or(io::ErrorKind::InvalidInput)?;
    let setting = Setting { sway: run.replay.session.setting.sway, ..setting };
    let ended = run.conclusion().and_then(|conclusion| conclusion.verdict.err());
    let mut head = Vec::new();
    header(&mut head, Kind::Stage, scenario, &setting.site)?;
    recording::Given::new(setting, procedure, ended).write(to, &head)?;
    let is_mounted = of.iter().any(|sample| sample.elevation.is_some());
    let (groups, fields) = match (run.base.is_empty(), is_mounted) {
        (true, false) => (1, 8),
        (true, true) => (2, 9),
        (false, _) => (3, 15),
    };
    writeln!(to, "# truth_azimuth_deg: {}", scenario.azimuth_deg)?;
    writeln!(to, "{}", COLUMNS[..groups].join(","))?;
    let mut force = [0.0; 3];
    of.iter().enumerate().try_for_each(|(index, sample)| {
        force = sample.force.map_or(force, forces);
        let until = of.get(index + 1).map_or(u64::MAX, |next| next.time.0);
        let measured = [seconds(sample.time), sample.stage.rad(), rate(sample.rate)];
        let temperature = sample.temperature.map_or(f64::NAN, |shown| f64::from(shown.0) / 1e3);
        let elevation = sample.elevation.map_or(f64::NAN, Angle::rad);
        let beside = [temperature, f64::from(sample.force.is_some()), elevation];
        let base = shown(&run.base, sample.time.0..until);
        row(to, &[&measured[..], &force, &beside, &base].concat()[..fields])
    })
}

/// The latest reading of the base's sensors in a span of time, µs; no numbers without one.
fn shown(base: &[(Instant, BaseReading)], span: Range<u64>) -> [f64; 6] {
    let before = base.partition_point(|(at, _)| at.as_micros() < span.end);
    match base[..before].last() {
        Some((at, reading)) if at.as_micros() >= span.start => {
            let ([x, y, z], [ahead, right, down]) = (reading.rate.map(rate), forces(reading.force));
            [x, y, z, ahead, right, down]
        }
        _ => [f64::NAN; 6],
    }
}
