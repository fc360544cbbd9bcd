//! The recording of a spinning body, kind `spin`. Rates are what turned in a sample, over its period.

use std::io::{self, Write};

use orientation::signal::SpinSample;
use orientation::units::SpinForce;
use simulated::spin::{SAMPLE_RATE, SpinScenario};

use super::{Recorded, mean_rate, row, seconds};
use crate::instrument::SpinRun;
use crate::instrument::kept::Kept;
use crate::recording::{GREATEST_SPIN_RATE, Given, Kind, Truth};

const COLUMNS: &str = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ay_m_s2,az_m_s2,truth_roll_rad";

impl Recorded for SpinScenario {
    fn write(&self, to: &mut impl Write, run: &SpinRun, of: &[SpinSample]) -> io::Result<()> {
        let mut head = Vec::new();
        writeln!(head, "# kind: {}\n# rate_hz: {SAMPLE_RATE}", Kind::Spin)?;
        writeln!(head, "# gyro_N_deg_sqrt_h: {}", self.gyro_n_deg_sqrt_h)?;
        writeln!(head, "# gyro_scale_sigma: {}", self.scale_sigma)?;
        Given::new(self.setting(), (), run.ended()).write(to, &head)?;
        writeln!(to, "{COLUMNS}")?;
        of.iter().zip(&run.truth.rolls_rad).try_for_each(|(sample, roll)| {
            let [x, y, z] = sample
                .turned
                .map(|turned| mean_rate(turned, 1.0 / SAMPLE_RATE, GREATEST_SPIN_RATE));
            let force = sample.force.unwrap_or([SpinForce(i32::MAX); 2]);
            let [up, right] = force.map(|force| f64::from(force.0) / 1e5);
            row(to, &[seconds(sample.time), x, y, z, up, right, *roll])
        })
    }

    fn end_of<'r>(&self, run: &'r SpinRun) -> (&'r Kept, Truth) {
        (&run.kept, Truth { roll_rad: run.truth.rolls_rad.clone(), ..Truth::default() })
    }
}
