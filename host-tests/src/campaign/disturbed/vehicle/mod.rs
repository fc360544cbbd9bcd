//! Three gyros and three accelerometers in a vehicle that stops and drives, or only stands: drawn units, and
//! what is wrong with what is said of them.

mod classes;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Leg, Vehicle};
use orientation::alignment::Method;

use super::Platform;
use super::axes::{Axes, UPRIGHT, shown};
use super::class::{Aligned, Subject};
use crate::campaign::chance::Chance;
use crate::campaign::szymanowski::parked::standing;
use crate::methods::asked::Asked;
use crate::methods::stops::{Replay, SIAP, STATIC, replay};
use crate::recording::{Body, Header, ImuRow, ImuSample};

/// A vehicle: one that stops and drives where the seed is even, one that only stands where it is odd.
pub(super) const PLATFORM: Platform = Platform::of::<Unit>("vehicle", classes::classes);

/// The random stream of a unit: none of those that a world draws from.
const DRAWN: u64 = 2_011;
/// Seeds of one series, beyond which those of another begin.
const RESERVED: u64 = 1 << 20;
/// m/s² of a thousandth of gravity.
const MILLI_G: f64 = 9.806_65e-3;
/// How well a stop's place is stated, 1σ, m.
const FIX_M: f64 = 5.0;

/// A drawn unit in its vehicle, and what is wrong with it.
#[derive(Clone, Debug)]
struct Unit {
    seed: u64,
    method: &'static str,
    day: Scenario,
    header: Header,
    /// Whether the header states where the vehicle stood, and how far the stops lie apart.
    states_stops: bool,
    states_places: bool,
    /// What the columns show of the accelerometers' axes.
    accelerometer_axes: Axes,
    /// What the recorder's clock makes of a second.
    clock: f64,
}

impl Unit {
    /// A healthy unit that stops and drives; what is stated about it is true.
    fn siap(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let stops = chance.one_of(&[2, 2, 3]);
        let (stop_s, drive_s) = (chance.between(60.0, 120.0), chance.scaled(180.0, 600.0));
        let day = Scenario::stops(seed, stops, stop_s, drive_s);
        let (states_stops, states_places) = (chance.happens(0.7), chance.happens(0.5));
        Self { states_stops, states_places, ..Self::of(seed, SIAP, day, &mut chance) }
    }

    /// A healthy unit that only stands, quietly or swaying.
    fn standing(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let (seconds, has_doors) = (chance.scaled(60.0, 660.0), chance.happens(0.3));
        let day = standing(seed, seconds, has_doors, chance.happens(0.5));
        Self::of(seed, STATIC, day, &mut chance)
    }

    /// One that moves: what is built in wrongly shows in sway and drives, not in a level vehicle that is quiet.
    fn moving(seed: u64) -> Self {
        let sways = |leg: &Leg| matches!(leg, Leg::Stop(stop) if stop.sway.is_active());
        let moves = |unit: &Self| unit.method == SIAP || unit.day.legs.iter().any(sways);
        let later = |index: u64| Self::drawn(seed.wrapping_add(2 * RESERVED * index));
        (0..RESERVED).map(later).find(moves).unwrap_or_else(|| Self::siap(seed))
    }

    /// A unit of drawn quality for a day.
    fn of(seed: u64, method: &'static str, mut day: Scenario, chance: &mut Chance) -> Self {
        let n = chance.scaled(1e-3, 5e-2);
        // A vehicle that only stands cannot distinguish a bias from the Earth: σ would be degrees.
        let bias = n * chance.scaled(3.0, if method == SIAP { 20.0 } else { 8.0 });
        let scale = chance.scaled(1e-5, 3e-4);
        let force_bias = chance.scaled(0.05, 1.0) * MILLI_G;
        let vehicle = &mut day.vehicle;
        vehicle.latitude_deg = chance.between(-65.0, 65.0);
        vehicle.rate_hz = chance.one_of(&[10.0, 20.0, 25.0, 50.0, 100.0]);
        vehicle.gyros = [GyroConfiguration {
            n_deg_sqrt_h: n,
            bias_sigma_deg_h: bias,
            scale_sigma: scale,
            ..GyroConfiguration::default()
        }; 3];
        vehicle.accelerometer = AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: chance.scaled(3e-4, 3e-3),
            bias_sigma_m_s2: force_bias,
            ..AccelerometerConfiguration::default()
        };
        let header = Header {
            latitude_deg: Some(vehicle.latitude_deg),
            rate_hz: Some(vehicle.rate_hz),
            gyro_n_deg_sqrt_h: chance.happens(0.7).then_some(n),
            gyro_b_deg_h: Some(0.0),
            gyro_k_deg_h_sqrt_h: Some(0.0),
            gyro_r_deg_h2: Some(0.0),
            gyro_bias_deg_h: Some(bias),
            gyro_scale_sigma: Some(scale),
            accelerometer_bias_m_s2: Some(force_bias),
            g_sensitivity_deg_h_g: Some([0.0; 2]),
            g_sensitivity_sigma_deg_h_g: Some(0.0),
            ..Header::default()
        };
        Self {
            seed,
            method,
            day,
            header,
            states_stops: false,
            states_places: false,
            accelerometer_axes: UPRIGHT,
            clock: 1.0,
        }
    }

    /// The gyros, all alike.
    fn gyro(&self) -> GyroConfiguration {
        self.day.vehicle.gyros[0]
    }

    /// The recording: its rows, the header, and the true azimuth at its end, °.
    fn recorded(&self) -> (Body, Header, f64) {
        let configuration = self.day.configuration();
        let mut vehicle = Vehicle::new(&configuration, self.seed);
        let stops: Vec<[f64; 2]> = configuration.stops().collect();
        let mut fixes = Chance::new(self.seed, Self::FAULT + 1);
        let mut middles = stops.iter().map(|[from, to]| 0.5 * (from + to)).peekable();
        let (mut rows, mut places) = (Vec::new(), Vec::new());
        while let Some(sample) = vehicle.next() {
            let rates = sample.turned_rad.map(|angle| angle * configuration.rate_hz);
            rows.push(ImuRow {
                line: rows.len() as u64 + 1,
                time_s: sample.time_s * self.clock,
                sample: ImuSample {
                    rates_rad_s: rates,
                    force_m_s2: shown(&self.accelerometer_axes, sample.force_m_s2),
                },
                force_is_new: true,
            });
            if middles.next_if(|middle| *middle <= sample.time_s).is_some() {
                let sigma = if places.is_empty() { 0.0 } else { FIX_M };
                places.push(vehicle.truth().displacement_m.map(|m| m + sigma * fixes.normal()));
            }
        }
        let stops = stops.iter().map(|stop| stop.map(|time| time * self.clock)).collect();
        let header = Header {
            stops_s: self.states_stops.then_some(stops),
            displacements_m: self.states_places.then_some(places),
            ..self.header.clone()
        };
        (Body::Imu(rows), header, vehicle.truth().attitude.azimuth_rad.to_degrees())
    }
}

impl Subject for Unit {
    const NAME: &'static str = "vehicle-";
    const FAULT: u64 = 2_012;

    /// One or the other.
    fn drawn(seed: u64) -> Self {
        if seed.is_multiple_of(2) { Self::siap(seed) } else { Self::standing(seed) }
    }

    fn seed(&self) -> u64 {
        self.seed
    }

    fn align(&self) -> Aligned {
        let (body, header, truth_deg) = self.recorded();
        let options = Asked { method: Some(self.method), ..Asked::default() };
        replay(&header, &body, &options)
            .map_or_else(Aligned::refused, |replay| aligned(&replay, truth_deg))
    }
}

/// What a replay found, and what it found believed or not.
fn aligned(replay: &Replay, truth_deg: f64) -> Aligned {
    let found = replay.session.conclusion().and_then(|conclusion| conclusion.found.as_ref());
    Aligned::of(
        replay.session.verdict(),
        found.map(|found| found.unchecked.degrees()),
        &[],
        truth_deg,
    )
}
