//! When a sample was taken: as its forces were, however far apart the converters were begun, and whatever part of a
//! microsecond a conversion lasts.

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_time::{Instant, Timer};
use firmware::acquire::{OneByOne, SpinAcquisition, acquire};
use firmware::ports::{Code, Gyro, InStep, RateReading, SpinSensors, Startable};
use firmware::shared::Channels;
use firmware::spin::configuration::{CHANNELS, SpinConfiguration};
use host::instrument::Trial;
use host::methods::spin::errors::wrapped;
use host::virtual_time;
use orientation::signal::SpinSample;
use orientation::units;
use simulated::spin::SpinScenario;

/// When the first conversion begins, µs.
const START: f64 = 1000.0;

/// Code of a body that spins, when it begins to stop, and until when it does, µs.
const SPINNING: f64 = 1e9;
const STOPS: [f64; 2] = [21_234.5, 41_234.5];

/// A converter that was begun so long after the first one, with the length of its conversions, both µs.
struct Converter {
    after: f64,
    length: f64,
    count: u32,
}

/// Integral of the code of a body that stops up to a time, µs.
fn spun(time: f64) -> f64 {
    let [from, to] = STOPS;
    let into = time.clamp(from, to) - from;
    SPINNING * (time.min(from) + into - 0.5 * into * into / (to - from))
}

impl Startable for Converter {
    async fn start(&mut self) -> Result<(), Fault> {
        Ok(())
    }
}

impl Gyro<Code> for Converter {
    async fn ready(&mut self) -> Result<Edge, Fault> {
        self.count += 1;
        let at = (START + self.after + f64::from(self.count) * self.length).round() as u64;
        Timer::at(Instant::from_micros(at)).await;
        Ok(Edge { at: units::Instant(at), count: self.count })
    }

    async fn read(&mut self) -> Result<RateReading<Code>, Fault> {
        let end = START + self.after + f64::from(self.count) * self.length;
        let mean = (spun(end) - spun(end - self.length)) / self.length;
        // The last bits differ from reading to reading, as noise would have them.
        let rate = Code(mean.round() as i32 + 1000 + self.count.cast_signed() % 7);
        Ok(RateReading { rate, is_new: true })
    }
}

impl InStep<Code> for Converter {
    async fn arm(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    async fn begin(&mut self) -> Result<(), Fault> {
        Ok(())
    }
}

/// Samples at a rate, Hz, where converters were begun so long after the first one, µs.
fn samples(begun: [f64; CHANNELS], sample_rate: f64) -> Vec<SpinSample> {
    let length = 1e6 / sample_rate;
    let converters = begun.map(|after| Converter { after, length, count: 0 });
    let mut sensors = SpinSensors { converters, reader: OneByOne::default() };
    let configuration = SpinScenario::default().configuration().expect("scales are numbers");
    let configuration = SpinConfiguration { sample_rate, ..configuration };
    let channels = Channels::new(&());
    let mut source = SpinAcquisition::new(&mut sensors, &configuration, &channels);
    let mut taken = Vec::new();
    let taking = async {
        for _ in 0..900 {
            taken.push(channels.samples.receive().await);
        }
    };
    virtual_time::run_beside(acquire(&mut source), taking).expect("conversions come");
    taken
}

/// How far apart converters are begun, µs, at a sample rate, Hz.
fn spacings() -> impl Iterator<Item = ([f64; CHANNELS], f64)> {
    let spacings = [
        [0.0; CHANNELS],
        [0.0, 1.0, 2.0, 3.0, 4.0],
        [0.0, 8.0, 16.0, 24.0, 32.0],
        [0.0, 3.0, 5.0, 20.0, 41.0],
        [9.0, 7.0, 6.0, 0.0, 2.0],
    ];
    spacings.into_iter().flat_map(|begun| [10_000.0, 14_400.0].map(|rate| (begun, rate)))
}

/// How late the times of samples are for the middles of the accelerometers' conversions, µs.
fn late(begun: [f64; CHANNELS], sample_rate: f64) -> Vec<f64> {
    let first = START + 0.5 * (begun[3] + begun[4]);
    let middle = |count: u32| first + (f64::from(count) + 0.5) * 1e6 / sample_rate;
    let times = samples(begun, sample_rate).into_iter().map(|sample| sample.time.0 as f64);
    (0..).zip(times).map(|(count, time)| time - middle(count)).collect()
}

#[test]
fn a_spin_that_stops_has_turned_as_far_as_it_had_at_the_times_of_the_forces() {
    for (begun, sample_rate) in spacings() {
        let length = 1e6 / sample_rate;
        let middle =
            |count: u32| START + 0.5 * (begun[3] + begun[4]) + (f64::from(count) + 0.5) * length;
        let taken = samples(begun, sample_rate);
        let gyros = SpinScenario::default().configuration().expect("scales are numbers").gyros;
        for (axis, gyro) in gyros.iter().enumerate() {
            let turned: f64 =
                taken[1..].iter().map(|sample| f64::from(sample.turned[axis].0)).sum();
            let of_code = f64::from(gyro.steps(Code(SPINNING as i32))) / SPINNING;
            let codes = (spun(middle(899)) - spun(middle(0))) / length + 1003.0 * 899.0;
            // A stamp is good to a microsecond, and so is what the stop begins and ends with.
            let error = turned / of_code - codes;
            let most = 1.5 * SPINNING / length;
            assert!(error.abs() < most, "{begun:?} at {sample_rate} Hz: {error} of {SPINNING}");
        }
    }
}

#[test]
fn a_sample_has_the_time_of_its_forces_however_far_apart_converters_were_begun() {
    for (begun, sample_rate) in spacings() {
        let late = late(begun, sample_rate);
        // Stamps are rounded, and so is the time.
        let most = late.iter().fold(0.0, |most, late| f64::max(most, late.abs()));
        assert!(most <= 1.0, "{begun:?} at {sample_rate} Hz: {most} µs");
        // Sums of two stamps are whole, so that the time alone may be off on average.
        let mean = late.iter().sum::<f64>() / late.len() as f64;
        assert!(mean.abs() <= 0.5, "{begun:?} at {sample_rate} Hz: {mean} µs on average");
    }
}

#[test]
fn the_error_of_the_roll_is_that_of_its_sigma_and_none_on_average() {
    const SEEDS: u32 = 25;
    let errors: Vec<f64> = (1..=SEEDS)
        .map(|seed| {
            // Flights end in every part of a microsecond.
            let seconds = 2.0 + f64::from(seed) / 14_400.0;
            let scenario = SpinScenario { seed: seed.into(), seconds, ..SpinScenario::default() };
            let run = Trial::of(&scenario).run().unwrap_or_else(|error| panic!("{error}"));
            let sigma = run.replay.spin.sigma().expect("it is locked");
            wrapped(run.replay.spin.roll().rad() - run.truth.end.roll_rad) / sigma.0
        })
        .collect();
    let mean_of =
        |of: fn(f64) -> f64| errors.iter().map(|error| of(*error)).sum::<f64>() / f64::from(SEEDS);
    let (mean, square) = (mean_of(|error| error), mean_of(|error| error * error));
    assert!(mean.abs() < 3.0 / f64::from(SEEDS).sqrt(), "{mean} σ on average");
    // The variance of 25 errors is good to 0.3 (1σ).
    assert!((0.4..1.8).contains(&square), "{square} σ² on average");
}
