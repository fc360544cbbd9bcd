//! Rows of a spinning body's recording as the samples that the core takes.

use orientation::signal::SpinSample;
use orientation::units::{AngleIncrement, Instant, SpinForce};

use crate::methods::limits;
use crate::recording::{GREATEST_SPIN_RATE, SpinRow};

/// Makes samples of what the sensors of a spinning body show at moments; what rounding leaves over of a
/// rotation goes to the next sample.
#[derive(Clone, Copy, Debug)]
pub struct Converter {
    period_s: f64,
    carried: [f64; 3],
    /// Rates of the sample before, rad/s.
    before: Option<[f64; 3]>,
}

impl Converter {
    /// A converter of samples with this period, s.
    #[must_use]
    pub fn new(period_s: f64) -> Self {
        Self { period_s, carried: [0.0; 3], before: None }
    }

    /// The sample of a time, s: rates about body x, y and z, rad/s, forces along y and z, m/s². Between two
    /// moments a rate is taken to change evenly; before the first one nothing has turned, and of a gap only
    /// its last period is reported, as on a board. What is not a number goes out as a sensor at its limit, a force
    /// as none.
    #[must_use]
    pub fn sample(&mut self, time_s: f64, rates: [f64; 3], force: [f64; 2]) -> SpinSample {
        let earlier = self.before.replace(rates);
        let mut turned = [AngleIncrement::default(); 3];
        for (axis, turned) in turned.iter_mut().enumerate() {
            let mean = |earlier: [f64; 3]| 0.5 * (rates[axis] + earlier[axis]);
            let angle = earlier.map_or(0.0, mean) * self.period_s;
            *turned = AngleIncrement::from_rad(angle, &mut self.carried[axis]);
        }
        let is_known = force.iter().all(|force| force.is_finite());
        let force = is_known.then(|| force.map(SpinForce::from_m_per_s2));
        SpinSample { time: Instant::from_seconds(time_s), turned, force }
    }
}

/// The samples of rows; their time counts from the first one. Times may be rounded, so it is whole periods,
/// s, that pass between them. The rates across are not recorded: they are taken as zero.
pub fn samples(rows: &[SpinRow], period_s: f64) -> impl Iterator<Item = SpinSample> + '_ {
    let begin = rows.first().map_or(0.0, |row| row.time_s);
    let limits = limits::of_channels(rows, channels);
    let mut converter = Converter::new(period_s);
    rows.iter().map(move |row| {
        let time_s = ((row.time_s - begin) / period_s).round() * period_s;
        let mut cut =
            channels(row).into_iter().zip(limits).map(|(value, limit)| value.abs() >= limit);
        let spin = if cut.next() == Some(true) { f64::NAN } else { row.rate_rad_s };
        let force = if cut.any(|is_cut| is_cut) { [f64::NAN; 2] } else { row.force_m_s2 };
        converter.sample(time_s, [spin, 0.0, 0.0], force)
    })
}

/// The samples of a run, as its board had them: a rate is what turned in the period, s, that ended with its row.
pub fn given(rows: &[SpinRow], period_s: f64) -> impl Iterator<Item = SpinSample> + '_ {
    let turned = move |rate: f64| {
        let is_cut = rate.abs() >= GREATEST_SPIN_RATE;
        AngleIncrement::from_rad(if is_cut { f64::NAN } else { rate * period_s }, &mut 0.0)
    };
    rows.iter().map(move |row| {
        let [y, z] = row.across_rad_s.unwrap_or_default();
        let force = row.force_m_s2.map(SpinForce::from_m_per_s2);
        SpinSample {
            time: Instant::from_seconds(row.time_s),
            turned: [row.rate_rad_s, y, z].map(turned),
            force: (!force.iter().any(|force| force.is_saturated())).then_some(force),
        }
    })
}

/// The rate, then both forces.
fn channels(row: &SpinRow) -> [f64; 3] {
    let [y, z] = row.force_m_s2;
    [row.rate_rad_s, y, z]
}
