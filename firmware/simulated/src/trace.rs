//! The results of a run as bit patterns, by which runs on different machines are compared.

use orientation::alignment::rotating::turn::Turn;
use orientation::alignment::stops::stop::Stop;
use orientation::alignment::{rotating, stepwise, stops};
use orientation::attitude::Report;
use orientation::roll::Flight;
use orientation::signal::dwell::Dwell;

/// The bit pattern of an absent value: a NaN that no computation yields.
pub const ABSENT: u64 = u64::MAX;

/// A dwell at a position.
pub const DWELL: &str =
    "dwell stage middle seconds samples rate taper force_x force_y force_z temperature";
/// A turn of a rotating platform.
pub const TURN: &str = "turn rate_cos rate_sin turning_cos turning_sin leak_cos leak_sin force_cos \
    force_sin mean_force offset middle seconds speed";
/// A stop of a vehicle.
pub const STOP: &str = "stop from to turned_x turned_y turned_z force_x force_y force_z";
/// What the navigator reports in a second.
pub const KEPT: &str = "kept time azimuth sigma pitch roll w x y z";
/// The end of the tracking of a roll.
pub const FLIGHT: &str = "flight roll sigma course pitch scale scale_sigma lift";
/// The verdict of an alignment.
pub const AZIMUTH: &str = "azimuth angle sigma";

/// Receiver of rows: the kind of a row with the names of its numbers, and the numbers as the bits of
/// 64-bit floats or integers.
pub type Rows<'a> = &'a mut dyn FnMut(&'static str, &[u64]);

/// What a run found, as rows of bit patterns in the order of cause and effect.
pub trait Trace {
    /// Passes each row on.
    fn trace(&self, rows: Rows);
}

/// The bits of a number that may be absent.
fn or_absent(value: Option<f64>) -> u64 {
    value.map_or(ABSENT, f64::to_bits)
}

impl Trace for stepwise::Session {
    fn trace(&self, rows: Rows) {
        self.dwells().iter().for_each(|dwell| dwell.trace(rows));
    }
}

impl Trace for rotating::Session {
    fn trace(&self, rows: Rows) {
        let stretches = self.turn_accumulator.stretches.iter();
        stretches.flat_map(|stretch| &stretch.turns).for_each(|turn| turn.trace(rows));
    }
}

impl Trace for stops::Session {
    fn trace(&self, rows: Rows) {
        self.stops().iter().for_each(|stop| stop.trace(rows));
    }
}

impl Trace for Flight {
    fn trace(&self, rows: Rows) {
        let [scale, scale_sigma] = self.spin.scale().unwrap_or([f64::NAN; 2]);
        let [course, pitch] = [self.attitude.course.0, self.attitude.pitch.0];
        let roll = self.spin.roll().rad();
        let sigma = or_absent(self.spin.sigma().map(|sigma| sigma.0));
        let lift = or_absent(self.spin.lift().map(|lift| lift.0));
        let [roll, course, pitch] = [roll, course, pitch].map(f64::to_bits);
        let [scale, scale_sigma] = [scale, scale_sigma].map(f64::to_bits);
        rows(FLIGHT, &[roll, sigma, course, pitch, scale, scale_sigma, lift]);
    }
}

impl Trace for Dwell {
    fn trace(&self, rows: Rows) {
        let [x, y, z] = self.force.map_or([ABSENT; 3], |force| force.map(|part| part.0.to_bits()));
        let [middle, seconds] = [self.middle.0, self.seconds.0].map(f64::to_bits);
        let [rate, taper] = [self.rate.0, self.taper].map(f64::to_bits);
        let [stage, samples] = [self.stage.0, self.samples].map(u64::from);
        let temperature = or_absent(self.temperature.get());
        let numbers = [stage, middle, seconds, samples, rate, taper, x, y, z, temperature];
        rows(DWELL, &numbers);
    }
}

impl Trace for Turn {
    fn trace(&self, rows: Rows) {
        let [[a, b], [c, d], [e, f], [g, h]] = [self.rate, self.turning, self.leak, self.force];
        let rest = [self.mean_force, self.offset, self.middle, self.seconds, self.speed];
        let [i, j, k, l, m] = rest;
        let numbers = [a, b, c, d, e, f, g, h, i, j, k, l, m];
        rows(TURN, &numbers.map(|value| f64::from(value).to_bits()));
    }
}

impl Trace for Stop {
    fn trace(&self, rows: Rows) {
        let ([a, b, c], [d, e, f]) = (self.turned.mean(), self.force.mean());
        rows(STOP, &[self.from.0, self.to.0, a, b, c, d, e, f].map(f64::to_bits));
    }
}

impl Trace for Report {
    fn trace(&self, rows: Rows) {
        let azimuth = or_absent(self.azimuth.map(|azimuth| azimuth.angle.0));
        let sigma = or_absent(self.azimuth.map(|azimuth| azimuth.sigma.0));
        let [w, x, y, z] = self.attitude.map(f64::to_bits);
        let [pitch, roll] = [self.pitch.0, self.roll.0].map(f64::to_bits);
        rows(KEPT, &[self.time.0, azimuth, sigma, pitch, roll, w, x, y, z]);
    }
}
