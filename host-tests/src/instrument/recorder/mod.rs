//! Recordings of simulated runs, to the last digit: what an instrument's session was given, in CSV, or all that came to
//! both halves of the instrument, as JSON lines.
//!
//! [`Samples`] keeps what the session gets while it runs; [`write()`] makes a recording of it afterwards, when it is
//! known how the run ended. Integers of the board are written out whole, so that a replay gets the very same ones. Such a
//! recording holds one alignment, and not what is kept after it; the [inputs](crate::recording::inputs) hold both, and are
//! written while the instrument runs.

mod spin;
mod stage;
mod turntable;
mod vehicle;

use std::io::{self, Write};
use std::path::Path;

use firmware::ports::Recorder;
use orientation::alignment::site::Site;
use orientation::units::{AngleIncrement, AngularRate, DEGREE_PER_HOUR, Instant, SpecificForce};
use simulated::scenario::Scenario;

pub use turntable::{given_by, turning_rows};
pub use vehicle::driven_rows;

use super::Carrier;
use super::kept::Kept;
use crate::packed::Packed;
use crate::recording::inputs::Given;
use crate::recording::{Kind, Truth};

/// The samples that a session was given, in order: the recorder of every carrier.
#[derive(Clone, Debug, Default)]
pub struct Samples<S> {
    /// The samples so far.
    pub taken: Vec<S>,
    /// Whether none is kept: a long run has a hundred million.
    pub is_idle: bool,
}

impl<S: Copy> Recorder<S> for &mut Samples<S> {
    async fn record(&mut self, sample: &S) {
        if !self.is_idle {
            self.taken.push(*sample);
        }
    }
}

/// A carrier whose runs can be recorded.
pub trait Recorded: Carrier {
    /// Writes header, column names and rows.
    ///
    /// # Errors
    /// The file cannot be written.
    fn write(&self, to: &mut impl Write, run: &Self::Run, of: &[Self::Sample]) -> io::Result<()>;

    /// What both halves are given, by whose inputs a whole run replays; none where the latitude is none, or of a body in
    /// fast rotation, which is followed by one part.
    fn given(&self) -> Option<Given> {
        None
    }

    /// What was kept in a run, and what was true of its alignment or at its samples.
    fn end_of<'r>(&self, run: &'r Self::Run) -> (&'r Kept, Truth);
}

/// Writes the recording of a finished run and its session's samples to a file; compressed where its name ends in `gz`.
///
/// # Errors
/// The file cannot be made or written, or there is no sample.
pub fn write<C: Recorded>(
    path: &Path,
    carrier: &C,
    run: &C::Run,
    samples: &[C::Sample],
) -> io::Result<()> {
    if samples.is_empty() {
        return Err(io::Error::other("the run ended before its session got a sample"));
    }
    let mut to = Packed::create(path)?;
    carrier.write(&mut to, run, samples)?;
    to.finish()
}

/// Writes what a board was given of place and instrument, as far as keys of their own say it.
fn header(to: &mut impl Write, kind: Kind, base: &Scenario, site: &Site) -> io::Result<()> {
    let [along, across] = site.g_sensitivity.map(|part| part.0 / DEGREE_PER_HOUR);
    let kappa_sigma = site.g_sensitivity_sigma.0 / DEGREE_PER_HOUR;
    writeln!(to, "# kind: {kind}")?;
    writeln!(to, "# latitude_deg: {}", base.latitude_deg)?;
    writeln!(to, "# rate_hz: {}", base.sample_rate_hz)?;
    writeln!(to, "# gyro_N_deg_sqrt_h: {}", base.gyro.n_deg_sqrt_h)?;
    writeln!(to, "# gyro_B_deg_h: {}", base.gyro.b_deg_h)?;
    writeln!(to, "# gyro_K_deg_h_sqrt_h: {}", base.gyro.k_deg_h_sqrt_h)?;
    writeln!(to, "# gyro_scale_sigma: {}", site.scale_sigma)?;
    writeln!(to, "# g_sensitivity_deg_h_g: {along:.9},{across:.9}")?;
    writeln!(to, "# g_sensitivity_sigma_deg_h_g: {kappa_sigma:.9}")?;
    writeln!(to, "# accelerometer_bias_m_s2: {:.9}", site.accelerometer_bias_sigma.0)
}

/// Writes a row, with all digits of its numbers; what is not a number leaves its field empty.
fn row(to: &mut impl Write, fields: &[f64]) -> io::Result<()> {
    let text = |field: &f64| if field.is_nan() { String::new() } else { field.to_string() };
    writeln!(to, "{}", fields.iter().map(text).collect::<Vec<_>>().join(","))
}

// A division gives the number that is nearest to the decimal fraction, and so is written as that.

/// A time, s.
fn seconds(time: Instant) -> f64 {
    time.0 as f64 / 1e6
}

/// A rate, rad/s; at its lower limit the least that a recording can hold.
fn rate(rate: AngularRate) -> f64 {
    f64::from(rate.0.max(-i32::MAX)) / 1e9
}

/// What turned in a period, s, as a rate, rad/s; at a limit of the gyro's range this greatest one.
fn mean_rate(turned: AngleIncrement, period_s: f64, greatest: f64) -> f64 {
    if turned.is_saturated() { greatest } else { turned.rad() / period_s }
}

/// Forces, m/s².
fn forces(forces: [SpecificForce; 3]) -> [f64; 3] {
    forces.map(|force| f64::from(force.0) / 1e6)
}
