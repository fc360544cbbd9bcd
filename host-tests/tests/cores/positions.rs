//! Autocompensated positions: two, three, four and many, in passes, under drift.

use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::stage::Stop;
use hal_mock::world::{World, WorldConfiguration};
use host::campaign::statistics::rms;
use host::methods::asked::Asked;
use host::methods::stepwise::positions::autocompensation;
use host::methods::stepwise::{drive, replay};
use host::output::azimuth_error;
use host::simulate::stage_path;
use orientation::alignment::Input;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise;
use orientation::alignment::stepwise::session::Session;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::schedule::{Position, Schedule};
use orientation::alignment::stepwise::setting::{Half, Setting};
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::units::{Radians, Seconds};

use crate::support::files::recording;

const LATITUDE_DEG: f64 = 52.0;
const RATE_HZ: f64 = 25.0;

/// A gyro: N °/√h, B °/h, K °/h/√h, R °/h².
type Gyro = [f64; 4];

/// An alignment at these stage angles, °, of so many seconds each and two for a rotation.
struct Trial<'a> {
    gyro: Gyro,
    angles_deg: &'a [f64],
    seconds: f64,
    half: Option<Half>,
}

impl Trial<'_> {
    fn stops(&self) -> Vec<Stop> {
        let stop = |angle: &f64| Stop::new(angle.to_radians(), self.seconds).after(2.0);
        self.angles_deg.iter().map(stop).collect()
    }

    fn session(&self, azimuth_deg: f64, seed: u64) -> Session {
        let [n, b, k, r] = self.gyro;
        let site = Site {
            noise: StatedNoise::Whole(GyroNoise::from_field_units(n, b, k, r)),
            required_sigma: Radians::from_degrees(20.0),
            ..Site::at(Latitude::from_degrees(LATITUDE_DEG).expect("it is one"))
        };
        let setting = Setting { half: self.half, ..Setting::new(site) };
        let position = |angle: &f64| Position {
            angle: Radians::from_degrees(*angle),
            seconds: Seconds(self.seconds),
        };
        let positions: Vec<Position> = self.angles_deg.iter().map(position).collect();
        let schedule = Schedule::listed(&positions).expect("they fit");
        let procedure =
            Procedure { retries: 0, ..Procedure::new(schedule, Seconds(1.0 / RATE_HZ)) };
        let mut session = Session::new(setting, procedure).expect("it begins");
        let gyro = GyroConfiguration {
            n_deg_sqrt_h: n,
            b_deg_h: b,
            k_deg_h_sqrt_h: k,
            r_deg_h2: r,
            bias_sigma_deg_h: 2.0,
            ..GyroConfiguration::default()
        };
        let instruments = InstrumentsConfiguration {
            latitude_deg: LATITUDE_DEG,
            azimuth_deg,
            rate_hz: RATE_HZ,
            gyro,
            ..InstrumentsConfiguration::default()
        };
        let stops = self.stops();
        let world =
            World::new(WorldConfiguration { instruments, stops: &stops, disturbances: &[] }, seed);
        drive(&mut session, world.map(|reading| stage_path(&reading)), Input::End, |_| {});
        session
    }

    fn verdict(&self, azimuth_deg: f64, seed: u64) -> Result<(f64, f64), Refusal> {
        let session = self.session(azimuth_deg, seed);
        let azimuth = session.conclusion().expect("done").verdict?;
        let error = azimuth_error(azimuth.angle.degrees(), azimuth_deg);
        Ok((error, azimuth.sigma.degrees()))
    }

    /// RMS of error over σ and RMS error, °, over seeds and azimuths.
    fn errors(&self, runs: u64) -> (f64, f64) {
        let all: Vec<(f64, f64)> = (1..=runs)
            .map(|seed| self.verdict((seed * 47 % 360) as f64 + 0.3, seed).expect("it is north"))
            .collect();
        let ratios: Vec<f64> = all.iter().map(|(error, sigma)| error / sigma).collect();
        (rms(&ratios), rms(all.iter().map(|(error, _)| error)))
    }
}

#[test]
fn the_recordings_give_north_by_positions_within_three_and_a_half_sigma() {
    for name in ["positions-four-fog", "stepwise-tilted-drift"] {
        let (header, body, truth) = recording(name).into_parts();
        let options = Asked { method: Some("positions"), ..Asked::default() };
        let replay = replay(&header, &body, &options, |_| {}).expect("it replays");
        let conclusion = replay.session.conclusion().expect("done");
        let azimuth = conclusion.verdict.expect("north");
        let truth = truth.azimuth_deg.expect("it carries a truth");
        let error = azimuth_error(azimuth.angle.degrees(), truth);
        assert!(error.abs() <= 3.5 * azimuth.sigma.degrees(), "{name}: {error}°");
        // Both orders go up a circle, in passes or not: plain least squares is not far off.
        let plain = autocompensation(&replay.session, conclusion);
        assert!(plain.plain_off_sigmas.expect("it is determined").abs() < 1.0, "{plain:?}");
        assert_eq!(plain.visits.iter().sum::<usize>(), replay.session.dwells().len());
    }
}

#[test]
fn two_opposite_positions_are_refused_without_the_half_and_right_with_it() {
    let angles_deg = [0.0, 180.0, 180.0, 0.0, 0.0, 180.0];
    let gyro = [0.002, 0.0, 0.0, 0.0];
    let trial = |half| Trial { gyro, angles_deg: &angles_deg, seconds: 30.0, half };
    assert_eq!(
        trial(None).verdict(70.0, 1),
        Err(Refusal::Stepwise(stepwise::Refusal::SignUnknown))
    );
    let (mut ratios, mut widened) = (Vec::new(), 0);
    for seed in 1..=60 {
        let azimuth = 40.0 + (seed * 17 % 100) as f64;
        for (half, truth) in [(Half::East, azimuth), (Half::West, 360.0 - azimuth)] {
            let (error, sigma) = trial(Some(half)).verdict(truth, seed).expect("it is north");
            // √2 N over the cosine's slope: half of the standstill on either side.
            let rate = 15.041_067 * LATITUDE_DEG.to_radians().cos();
            let least = (0.002 / (rate * (180.0_f64 / 3600.0).sqrt())).to_degrees();
            let expected = least / truth.to_radians().sin().abs();
            // Dwells that scatter by chance as one series in twenty does widen σ.
            let wider = sigma / expected;
            assert!(wider > 0.95, "{sigma} against {expected}");
            widened += usize::from(wider > 1.05);
            ratios.push(error / sigma);
        }
    }
    assert!(widened <= 12, "{widened} of 120");
    assert!((0.85..1.15).contains(&rms(&ratios)), "{}", rms(&ratios));
}

#[test]
fn two_positions_say_nothing_along_their_own_axis() {
    let trial = Trial {
        gyro: [0.002, 0.0, 0.0, 0.0],
        angles_deg: &[0.0, 180.0, 180.0, 0.0],
        seconds: 30.0,
        half: Some(Half::East),
    };
    for azimuth in [0.5, 1.5, 178.5] {
        let verdict = trial.verdict(azimuth, 3);
        assert!(verdict.is_err(), "{azimuth}: {verdict:?}");
    }
}

#[test]
fn three_and_four_positions_and_passes_reach_their_sigma_under_every_drift() {
    let passes = [0.0, 180.0, 90.0, 270.0].repeat(4);
    let thirds = [0.0, 120.0, 240.0].repeat(4);
    for gyro in [[0.002, 0.0, 0.0, 0.0], [0.001, 0.007, 0.0, 0.127], [0.06, 1.0, 0.5, 2.0]] {
        for (angles_deg, seconds) in [(&passes, 15.0), (&thirds, 20.0)] {
            let trial = Trial { gyro, angles_deg, seconds, half: None };
            let (ratio, _) = trial.errors(150);
            assert!((0.88..1.12).contains(&ratio), "{gyro:?}, {angles_deg:?}: {ratio}");
        }
    }
}

#[test]
fn passes_cancel_the_drift_that_a_single_pass_and_a_circle_keep() {
    let gyro = [0.06, 1.0, 0.5, 2.0];
    let circle: Vec<f64> = (0..12).map(|index| 30.0 * f64::from(index)).collect();
    let passes = [0.0, 180.0, 90.0, 270.0].repeat(7);
    let error = |angles_deg: &[f64]| {
        let seconds = (300.0 - 2.0 * (angles_deg.len() - 1) as f64) / angles_deg.len() as f64;
        Trial { gyro, angles_deg, seconds, half: None }.errors(200).1
    };
    let [passes, one, circle] = [error(&passes), error(&[0.0, 180.0, 90.0, 270.0]), error(&circle)];
    assert!(one > 1.3 * passes && circle > 1.4 * passes, "{passes}, {one}, {circle}");
}
