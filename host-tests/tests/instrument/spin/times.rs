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
use orientation::units;
use simulated::spin::SpinScenario;

/// When the first conversion begins, µs.
const START: f64 = 1000.0;

/// A converter that was begun so long after the first one, with the length of its conversions, both µs.
struct Converter {
    after: f64,
    length: f64,
    count: u32,
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
        Ok(RateReading { rate: Code(1000 + self.count.cast_signed() % 7), is_new: true })
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

/// How late the times of samples are for the middles of the accelerometers' conversions, µs, at a sample rate, Hz, where
/// converters were begun so long after the first one, µs.
fn late(begun: [f64; CHANNELS], sample_rate: f64) -> Vec<f64> {
    let length = 1e6 / sample_rate;
    let converters = begun.map(|after| Converter { after, length, count: 0 });
    let mut sensors = SpinSensors { converters, reader: OneByOne::default() };
    let configuration = SpinScenario::default().configuration().expect("scales are numbers");
    let configuration = SpinConfiguration { sample_rate, ..configuration };
    let channels = Channels::new(&());
    let mut source = SpinAcquisition::new(&mut sensors, &configuration, &channels);
    let mut late = Vec::new();
    let taking = async {
        let first = START + 0.5 * (begun[3] + begun[4]);
        for count in 0..900 {
            let time = channels.samples.receive().await.time.0 as f64;
            late.push(time - first - (f64::from(count) + 0.5) * length);
        }
    };
    virtual_time::run_beside(acquire(&mut source), taking).expect("conversions come");
    late
}

#[test]
fn a_sample_has_the_time_of_its_forces_however_far_apart_converters_were_begun() {
    let spacings = [
        [0.0; CHANNELS],
        [0.0, 1.0, 2.0, 3.0, 4.0],
        [0.0, 8.0, 16.0, 24.0, 32.0],
        [0.0, 3.0, 5.0, 20.0, 41.0],
        [9.0, 7.0, 6.0, 0.0, 2.0],
    ];
    for (begun, sample_rate) in
        spacings.into_iter().flat_map(|begun| [10_000.0, 14_400.0].map(|rate| (begun, rate)))
    {
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
