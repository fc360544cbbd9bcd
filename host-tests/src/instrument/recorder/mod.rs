//! Recordings of simulated runs: what an instrument's session was given, to the last digit.
//!
//! [`Samples`] keeps what the session gets while it runs; [`write`] makes a recording of it afterwards, when it is
//! known how the run ended. Integers of the board are written out whole, so that a replay gets the very same ones.
//! Of a run that aligns more than once, the recording holds the first alignment.

mod spin;
mod stage;
mod text;
mod turntable;
mod vehicle;

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::Recorder;
use firmware::simulated::scenario::Scenario;
use orientation::align::setting::Setting;
use orientation::error::Refusal;
use orientation::units::{self, DEGREE_PER_HOUR};

pub use turntable::turning_rows;

use crate::recording::Kind;

/// The samples that a session was given, in order: the recorder of every carrier.
#[derive(Clone, Debug, Default)]
pub struct Samples<S>(pub Vec<S>);

impl<S: Copy> Recorder<S> for &mut Samples<S> {
    async fn record(&mut self, sample: &S) {
        self.0.push(*sample);
    }
}

/// A carrier whose runs can be recorded.
pub trait Carrier {
    /// A finished run.
    type Run;
    /// What its session takes.
    type Sample;

    /// Writes header, column names and rows.
    ///
    /// # Errors
    /// Those of the file.
    fn write(&self, to: &mut impl Write, run: &Self::Run, of: &[Self::Sample]) -> io::Result<()>;
}

/// Writes the recording of a finished run and its session's samples to a file.
///
/// # Errors
/// Those of the file.
pub fn write<C: Carrier>(
    path: &Path,
    carrier: &C,
    run: &C::Run,
    samples: &[C::Sample],
) -> io::Result<()> {
    let mut to = BufWriter::new(File::create(path)?);
    carrier.write(&mut to, run, samples)?;
    to.flush()
}

/// How the first alignment of a run ended: when, and why without a result.
#[derive(Clone, Copy, Debug)]
struct Ending {
    at: units::Instant,
    reason: Option<Refusal>,
}

impl Ending {
    /// The ending that a board told.
    fn of(events: &[(Instant, Event)]) -> Self {
        let ending = |(at, event): &(Instant, Event)| {
            let reason = match *event {
                Event::Concluded(..) | Event::Flown { .. } => None,
                Event::Refused(reason) | Event::RollEnded(reason) => Some(reason),
                _ => return None,
            };
            Some(Self { at: units::Instant(at.as_micros()), reason })
        };
        let never = Self { at: units::Instant(u64::MAX), reason: None };
        events.iter().find_map(ending).unwrap_or(never)
    }
}

/// Writes what the keys of a header say of place and instrument, for those who read nothing else.
fn header(to: &mut impl Write, kind: Kind, base: &Scenario, setting: &Setting) -> io::Result<()> {
    let [along, across] = setting.g_sensitivity.map(|part| part / DEGREE_PER_HOUR);
    let kappa_sigma = setting.g_sensitivity_sigma / DEGREE_PER_HOUR;
    writeln!(to, "# kind: {kind}")?;
    writeln!(to, "# latitude_deg: {}", base.latitude_deg)?;
    writeln!(to, "# rate_hz: {}", base.sample_rate_hz)?;
    writeln!(to, "# gyro_N_deg_sqrt_h: {}", base.gyro.n_deg_sqrt_h)?;
    writeln!(to, "# gyro_B_deg_h: {}", base.gyro.b_deg_h)?;
    writeln!(to, "# gyro_K_deg_h_sqrt_h: {}", base.gyro.k_deg_h_sqrt_h)?;
    writeln!(to, "# gyro_scale_sigma: {}", setting.scale_sigma)?;
    writeln!(to, "# g_sensitivity_deg_h_g: {along:.9},{across:.9}")?;
    writeln!(to, "# g_sensitivity_sigma_deg_h_g: {kappa_sigma:.9}")?;
    writeln!(to, "# accelerometer_bias_m_s2: {:.9}", setting.accelerometer_bias_sigma)
}
