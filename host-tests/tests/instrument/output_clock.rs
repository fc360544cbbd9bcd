//! Outputs of a sensor that samples by an oscillator of its own: what shakes adds up to no rotation, and what is
//! missing is counted.

use std::f64::consts::TAU;

use firmware::output_clock::{LEAST_READINGS, Output, OutputClock};
use orientation::units::Instant;
use proptest::prelude::*;

/// Nominal time between two outputs, s: 104 Hz.
const NOMINAL: f64 = 1.0 / 104.0;
/// How long a body stands before it shakes, and how long it shakes, s.
const STANDS: f64 = 5.0;
const SHAKES: f64 = 60.0;

/// A sensor with this time between two outputs, s, of which the first ends after so much of it.
struct Sensor {
    period: f64,
    phase: f64,
}

impl Sensor {
    /// The number of the latest output at a time in s.
    fn output(&self, time: f64) -> i64 {
        (time / self.period - self.phase).floor() as i64
    }

    /// When an output ends, s.
    fn end(&self, output: i64) -> f64 {
        (output as f64 + self.phase) * self.period
    }

    /// The outputs that are new at readings so many seconds apart, each late by up to 0.3 ms, and what the clock states of
    /// them. There is no reading where one of the outputs is the latest that are left out.
    fn taken(&self, apart: f64, is_left_out: impl Fn(i64) -> bool) -> Vec<(i64, Output)> {
        let mut clock = OutputClock::new((1e6 * NOMINAL) as f32);
        let (mut latest, mut taken) = (self.output(0.0), Vec::new());
        let times = (1_u32..)
            .map(|count| f64::from(count) * apart + 3e-4 * f64::from(count * 7 % 11) / 11.0);
        for time in times.take_while(|time| *time < STANDS + SHAKES) {
            let (output, read) = (self.output(time), Instant((1e6 * time) as u64));
            if is_left_out(output) {
                continue;
            }
            if std::mem::replace(&mut latest, output) == output {
                clock.look(read);
            } else {
                taken.push((output, clock.take(read)));
            }
        }
        taken
    }
}

/// Angle of a body that shakes by one radian at a frequency in Hz, rad.
fn angle(hertz: f64, time: f64) -> f64 {
    if time < STANDS { 0.0 } else { 1.0 - (TAU * hertz * (time - STANDS)).cos() }
}

/// Rotation that is not there, rad, of a body that shakes at a frequency in Hz: what the outputs, each a mean over
/// the sensor's period, add up to with the periods that the clock states.
fn drift(sensor: &Sensor, apart: f64, hertz: f64) -> f64 {
    let (mut turned, mut last) = (0.0, 0.0);
    for (output, Output { period, .. }) in sensor.taken(apart, |_| false) {
        let ends = [sensor.end(output - 1), sensor.end(output)].map(|end| angle(hertz, end));
        turned += (ends[1] - ends[0]) / sensor.period * f64::from(period) * 1e-9;
        last = ends[1];
    }
    turned - last
}

proptest! {
    #[test]
    fn what_shakes_at_any_frequency_adds_up_to_no_rotation(
        off in -0.1..0.1,
        phase in 0.0..1.0,
        readings in LEAST_READINGS * 1.1..5.0,
        hertz in 0.3..50.0_f64,
    ) {
        let sensor = Sensor { period: NOMINAL * (1.0 + off), phase };
        let apart = NOMINAL / readings;
        let [outputs, reads] = [1.0 / sensor.period, 1.0 / apart];
        // The beats of outputs and readings are where an error of their times would add up.
        let beats = [1.0, 2.0, 3.0].map(|order| (order * outputs - reads).abs());
        for hertz in beats.into_iter().filter(|beat| (0.3..50.0).contains(beat)).chain([hertz]) {
            let greatest = TAU * hertz;
            prop_assert!(
                drift(&sensor, apart, hertz).abs() < 5e-4 * greatest * SHAKES + 0.01,
                "{hertz} Hz: {} rad in a minute",
                drift(&sensor, apart, hertz)
            );
        }
    }

    #[test]
    fn outputs_that_are_missing_are_counted(
        off in -0.1..0.1,
        phase in 0.0..1.0,
        readings in LEAST_READINGS * 1.1..5.0,
        missing in 1_i64..1000,
    ) {
        let sensor = Sensor { period: NOMINAL * (1.0 + off), phase };
        let begun = sensor.output(STANDS);
        let taken = sensor.taken(NOMINAL / readings, |output| (begun..begun + missing).contains(&output));
        for pair in taken.windows(2) {
            let [(before, _), (output, Output { periods, .. })] = [pair[0], pair[1]];
            let wrong = i64::from(periods) - (output - before);
            // How late the first output after a gap was read is not known.
            prop_assert!(wrong == 0 || periods > 1 && wrong.abs() <= 1, "{periods} at output {output}");
        }
        let period = taken.last().map_or(0.0, |(_, output)| f64::from(output.period) * 1e-9);
        prop_assert!((period / sensor.period - 1.0).abs() < 1e-3, "{period} s");
    }
}
