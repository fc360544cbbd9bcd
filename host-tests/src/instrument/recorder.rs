//! Writes the samples that the session gets as a recording of kind `stage`.
//!
//! Every row is exact: times in whole microseconds, rates in whole nrad/s, so that a replay gets the
//! very same numbers. The accelerometer is read less often than the gyro; its rows repeat the latest
//! reading.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use firmware::ports::Recorder;
use firmware::simulated::scenario::Scenario;
use orientation::align::setting::Setting;
use orientation::signal::Sample;
use orientation::units::{DEGREE_PER_HOUR, SpecificForce, Temperature};

/// A recording in the making.
pub struct CsvRecorder {
    file: BufWriter<File>,
    force: Option<[SpecificForce; 3]>,
    temperature: Option<Temperature>,
    failed: Option<io::Error>,
}

impl CsvRecorder {
    /// Creates the file and writes its header: what the board is told, and the truth for checking.
    ///
    /// # Errors
    /// Those of the file.
    pub fn create(path: &Path, scenario: &Scenario, setting: &Setting) -> io::Result<Self> {
        let mut file = BufWriter::new(File::create(path)?);
        header(&mut file, scenario, setting)?;
        Ok(Self { file, force: None, temperature: None, failed: None })
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// The first that any row met.
    pub fn finish(&mut self) -> io::Result<()> {
        match self.failed.take() {
            Some(error) => Err(error),
            None => self.file.flush(),
        }
    }

    /// One row; none before the first force.
    fn row(&mut self, sample: &Sample) -> io::Result<()> {
        self.force = sample.force.or(self.force);
        self.temperature = sample.temperature.or(self.temperature);
        let (Some([x, y, z]), Some(temperature)) = (self.force, self.temperature) else {
            return Ok(());
        };
        let time = sample.time.0;
        writeln!(
            self.file,
            "{}.{:06},{:.10},{},{},{},{},{}",
            time / 1_000_000,
            time % 1_000_000,
            sample.stage.rad(),
            Scaled(sample.rate.0, 9),
            Scaled(x.0, 6),
            Scaled(y.0, 6),
            Scaled(z.0, 6),
            Scaled(temperature.0, 3)
        )
    }
}

impl Recorder for &mut CsvRecorder {
    async fn record(&mut self, sample: &Sample) {
        if self.failed.is_none() {
            self.failed = self.row(sample).err();
        }
    }
}

fn header(file: &mut impl Write, scenario: &Scenario, setting: &Setting) -> io::Result<()> {
    let [along, across] = setting.g_sensitivity.map(|part| part / DEGREE_PER_HOUR);
    let kappa_sigma = setting.g_sensitivity_sigma / DEGREE_PER_HOUR;
    writeln!(file, "# kind: stage")?;
    writeln!(file, "# latitude_deg: {}", scenario.latitude_deg)?;
    writeln!(file, "# rate_hz: {}", scenario.sample_rate_hz)?;
    writeln!(file, "# gyro_N_deg_sqrt_h: {}", scenario.gyro.n_deg_sqrt_h)?;
    writeln!(file, "# gyro_B_deg_h: {}", scenario.gyro.b_deg_h)?;
    writeln!(file, "# gyro_K_deg_h_sqrt_h: {}", scenario.gyro.k_deg_h_sqrt_h)?;
    writeln!(file, "# gyro_scale_sigma: {}", setting.scale_sigma)?;
    writeln!(file, "# g_sensitivity_deg_h_g: {along:.9},{across:.9}")?;
    writeln!(file, "# g_sensitivity_sigma_deg_h_g: {kappa_sigma:.9}")?;
    writeln!(file, "# accelerometer_bias_m_s2: {:.9}", setting.accelerometer_bias_sigma)?;
    writeln!(file, "# truth_azimuth_deg: {}", scenario.azimuth_deg)?;
    writeln!(file, "t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2,temperature_c")
}

/// An integer of so many decimal places, written out exactly.
struct Scaled(i32, u32);

impl std::fmt::Display for Scaled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self(value, places) = *self;
        let unit = 10_u32.pow(places);
        let (sign, size) = (if value < 0 { "-" } else { "" }, value.unsigned_abs());
        write!(f, "{sign}{}.{:0width$}", size / unit, size % unit, width = places as usize)
    }
}
