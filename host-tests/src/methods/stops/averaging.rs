//! The plain averaging alignment: the azimuth from the mean rate and the mean specific force, as a vehicle
//! at rest has always done it. Nothing else depends on it; campaigns and reports show it beside the others.

use std::ops::AddAssign;

/// Sums of rates and forces at rest.
#[derive(Clone, Copy, Debug, Default)]
pub struct Averages {
    turned_rad: [f64; 3],
    force_m_s2: [f64; 3],
}

impl Averages {
    /// Adds a sample: what it turned, rad, and its mean force, m/s². Neither needs a scale: directions count.
    pub fn push(&mut self, turned_rad: [f64; 3], force_m_s2: [f64; 3]) {
        add(&mut self.turned_rad, turned_rad);
        add(&mut self.force_m_s2, force_m_s2);
    }

    /// Azimuth of body x, rad, (−π, π]: north is where the mean rate points, less its part along the
    /// mean force.
    #[must_use]
    pub fn azimuth(&self) -> f64 {
        let [x, y, z] = self.force_m_s2.map(|force| -force);
        // Roll and pitch from the force, atan2(f_y, f_z) and atan2(−f_x, √(f_y² + f_z²)), then the rate on level axes that point where the body does.
        let (roll, pitch) = (y.atan2(z), (-x).atan2(y.hypot(z)));
        let [forward, right, down] = self.turned_rad;
        let across = right * roll.cos() - down * roll.sin();
        let below = right * roll.sin() + down * roll.cos();
        let along = forward * pitch.cos() + below * pitch.sin();
        (-across).atan2(along)
    }
}

fn add(sums: &mut [f64; 3], parts: [f64; 3]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        sum.add_assign(part);
    }
}
