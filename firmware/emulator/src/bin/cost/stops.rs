//! Cost of the azimuth from stops: the strapdown per sample, U(azp) per candidate, the search for
//! its minimum, and the conclusion (Szymanowski 2003).

use core::hint::black_box;

use orientation::alignment::site::Site;
use orientation::alignment::stops::Setting;
use orientation::alignment::stops::conclusion::Conclusion;
use orientation::alignment::stops::inclination::Inclination;
use orientation::alignment::stops::stop_detector::{Rests, StopDetector};
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::signal::InertialSample;
use orientation::units::{DEGREE, DEGREE_PER_HOUR, ForceNoise, RadiansPerSecond, Seconds};

use crate::report::{Report, figure, mean_and_greatest};
use crate::samples::inertial;
use firmware::budget::{INCLINATION_INSTRUCTIONS, STOPS_INSTRUCTIONS, STRAPDOWN_INSTRUCTIONS};
use measure::counter::Counter;
use measure::stack;

/// Sample rate of the strapdown, Hz.
const RATE_HZ: u64 = 2000;
/// Number of strapdown samples: five seconds.
const SAMPLES: u64 = 10_000;
/// Sample rate of the drive, Hz; the cost of its conclusion does not depend on it.
const DRIVE_HZ: u64 = 25;
/// Ends of the first stop, of the drive and of the second stop, s.
const DRIVE: [f64; 3] = [60.0, 960.0, 1020.0];
/// Latitude, °.
const LATITUDE: f64 = 52.0;
/// Azimuth at the start, rad.
const AZIMUTH: f64 = 72.0 * DEGREE;
/// Rate of rotation during the drive, rad/s: 140° in all.
const TURNING: f64 = 140.0 * DEGREE / 900.0;

/// Type of [`StopDetector::push`].
type Push = fn(&mut StopDetector, &InertialSample) -> bool;
/// Type of [`Inclination::angle`].
type Form = fn(&Inclination, f64) -> f64;

/// Measures all cases.
pub fn report(counter: &Counter, report: &mut Report) {
    sample(counter, report);
    let mut stop_detector = drive();
    let (cost, conclusion) = counter.measure(|| conclude(&mut stop_detector));
    let found = conclusion.found.filter(|_| conclusion.verdict.is_ok());
    let is_right = found.is_some_and(|found| (found.start.angle.0 - AZIMUTH).abs() < 0.01 * DEGREE);
    report.require("the azimuth at the start is found from two stops", is_right);
    report.budget("conclusion of two stops and a drive", cost.instructions(), STOPS_INSTRUCTIONS);
    if let Some(found) = found {
        inclination(counter, report, &found.plain.inclination);
    }
}

/// Measures the mean sample, and the most expensive one, which ends a second.
fn sample(counter: &Counter, report: &mut Report) {
    let mut stop_detector = stop_detector(RATE_HZ);
    // Through a pointer that is opaque to the optimiser the function is called, not inlined.
    let push = black_box(StopDetector::push as Push);
    let mut carried = [0.0; 3];
    let [mean, worst] = mean_and_greatest(SAMPLES, |index| {
        let rates = [0.02, -0.03, 0.4].map(|rate| rate * libm::sin(index as f64 / 700.0));
        let sample = inertial(index, RATE_HZ, rates, gravity(), &mut carried);
        counter.measure(|| push(&mut stop_detector, &sample)).0
    });
    report.budget("strapdown of three gyros, a sample at 2 kHz", mean, STRAPDOWN_INSTRUCTIONS);
    figure("the same, a sample that ends a second", worst);
}

/// Measures the greatest cost of U over the circle, and that of the search.
fn inclination(counter: &Counter, report: &mut Report, inclination: &Inclination) {
    for (name, form) in [
        ("U(azp), the angle, greatest", Inclination::angle as Form),
        ("U(azp), the paper's form, greatest", Inclination::euler as Form),
    ] {
        let form = black_box(form);
        let [_, worst] = mean_and_greatest(360, |step| {
            let azimuth = step as f64 * DEGREE;
            counter.measure(|| form(inclination, azimuth)).0
        });
        if name.contains("angle") {
            report.budget(name, worst, INCLINATION_INSTRUCTIONS);
        } else {
            figure(name, worst);
        }
    }
    let (cost, minimum) = counter.measure(|| inclination.minimised(Inclination::angle));
    let off = minimum.at - inclination.closed_form();
    report.require("the search finds the closed form", off.abs() < 1e-6 * DEGREE);
    figure("search for the least U by Brent's method", cost.instructions());
}

/// Conclusion that is measured, not inlined.
#[inline(never)]
fn conclude(stop_detector: &mut StopDetector) -> Conclusion {
    Conclusion::of(&setting(), stop_detector)
}

/// Stack of a conclusion, bytes.
pub fn stack() -> usize {
    let mut stop_detector = drive();
    stack::stack_of(|| black_box(conclude(&mut stop_detector)).verdict.is_ok()).0
}

/// Configuration of the alignment.
fn setting() -> Setting {
    let latitude = Latitude::from_degrees(LATITUDE).unwrap_or(Latitude::EQUATOR);
    let noise = GyroNoise::from_field_units(0.05, 0.0, 0.0, 0.0);
    let site = Site { noise: StatedNoise::Whole(noise), ..Site::at(latitude) };
    let bias_sigma = Some(RadiansPerSecond(DEGREE_PER_HOUR));
    Setting { bias_sigma, force_noise: ForceNoise(1e-3), ..Setting::new(site) }
}

/// Stop detector at this sample rate, Hz.
fn stop_detector(rate: u64) -> StopDetector {
    let setting = setting();
    let gravity = setting.site.latitude.gravity();
    StopDetector::new(Rests::Found, &setting.sensors(), gravity, Seconds(1.0 / rate as f64))
}

/// Recording of a level vehicle that stands for a minute, turns for a quarter of an hour and stands
/// again, without noise.
fn drive() -> StopDetector {
    let mut stop_detector = stop_detector(DRIVE_HZ);
    let earth = setting().site.latitude;
    let (mut azimuth, mut carried) = (AZIMUTH, [0.0; 3]);
    for index in 0..(DRIVE[2] as u64) * DRIVE_HZ {
        let time = index as f64 / DRIVE_HZ as f64;
        let is_driving = (DRIVE[0]..DRIVE[1]).contains(&time);
        let turning = if is_driving { TURNING } else { 0.0 };
        let step = turning / DRIVE_HZ as f64;
        let (sine, cosine) = libm::sincos(azimuth + 0.5 * step);
        azimuth += step;
        let north = earth.horizontal_rate();
        let rates = [north.0 * cosine, -north.0 * sine, turning - earth.vertical_rate().0];
        stop_detector.push(&inertial(index, DRIVE_HZ, rates, gravity(), &mut carried));
    }
    stop_detector
}

/// The only force of a level vehicle, m/s².
fn gravity() -> [f64; 3] {
    [0.0, 0.0, -setting().site.latitude.gravity().0]
}
