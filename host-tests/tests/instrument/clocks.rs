//! Clocks that are off: angles and times are true all the same, and a lost conversion costs none of them.
//!
//! Sensors turn at rates that are known in closed form. Their converters go by a clock of their own, and the virtual
//! time, which is what the controller's clock shows, runs slower than the true time or faster.

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_time::{Instant, Timer};
use firmware::acquire::{Source, TriadAcquisition, acquire, on_mount, on_stage};
use firmware::calibration::Harmonics;
use firmware::configuration::{Configuration, FramesConfiguration, VehicleConfiguration};
use firmware::ports::{
    Accelerometer, BaseReading, BaseSensors, Encoder, ForceReading, Frames, Gyro, InStep, NoBase,
    RateReading, Sensors, Startable, VehicleSensors,
};
use firmware::shared::Channels;
use firmware::sway::SwayCompensation;
use host::virtual_time;
use orientation::alignment::Azimuth;
use orientation::alignment::stepwise::mount::TwoFrame;
use orientation::attitude::{self, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::navigation::Motion;
use orientation::navigation::progress::VerticalGyro;
use orientation::noise::model::GyroNoise;
use orientation::signal::InertialSample;
use orientation::signal::sway::CoarseSensors;
use orientation::timebase::{Clock, Timebase};
use orientation::units::{
    self, Angle, AngleIncrement, AngularRate, DEGREE, MetresPerSecondSquared, Radians,
    RadiansPerSecond, Seconds, SpecificForce, TURN, Temperature,
};

/// The MSI at 4 MHz, locked to the crystal: its frequency and the one by which its time counts.
const LOCKED: [u64; 2] = [122 * 32_768, 4_000_000];
/// An oscillator without a crystal that is a per cent slow.
const FREE: [u64; 2] = [99, 100];
/// Nominal sample rate, Hz.
const HERTZ: f64 = 400.0;
/// Nominal sample period, ns.
const PERIOD: u64 = 2_500_000;

/// Rate of an axis in a conversion by its number, rad/s.
type Rate = fn(u64) -> f64;

/// A sensor of the tests: a gyro behind its converter, or whatever reads at the present time.
#[derive(Clone, Copy)]
struct Sensor {
    /// True period of the conversions, ns.
    period: u64,
    /// Frequency of the controller's clock, and the one by which its time counts.
    controller: [u64; 2],
    /// The rates about the axes, of which a gyro has the first.
    rates: [Rate; 3],
    /// One in so many readings is lost.
    loses: u64,
    /// Number of readings until now.
    count: u64,
}

impl Sensor {
    /// A sensor that loses nothing, and converts as is stated.
    fn new(controller: [u64; 2], rate: Rate) -> Self {
        Self { period: PERIOD, controller, rates: [rate; 3], loses: u64::MAX, count: 0 }
    }

    /// Whether the latest reading is one of those that are lost.
    fn is_lost(&self) -> bool {
        self.count % self.loses == self.loses - 1
    }

    /// The rates of the latest reading, whose last bits differ from reading to reading, as noise would have them.
    fn shown(&self) -> [AngularRate; 3] {
        let noise = (self.count % 7) as i32 - 3;
        self.rates.map(|rate| AngularRate(AngularRate::from_rad_per_s(rate(self.count)).0 + noise))
    }
}

impl Startable for Sensor {
    async fn start(&mut self) -> Result<(), Fault> {
        Ok(())
    }
}

impl Gyro for Sensor {
    async fn ready(&mut self) -> Result<Edge, Fault> {
        let [actual, nominal] = self.controller.map(u128::from);
        let true_time = u128::from((self.count + 1) * self.period);
        let at = (true_time * actual / nominal / 1000) as u64;
        Timer::at(Instant::from_micros(at)).await;
        self.count += 1;
        Ok(Edge { at: units::Instant(at), count: self.count as u32 })
    }

    async fn read(&mut self) -> Result<RateReading, Fault> {
        let [rate, ..] = self.shown();
        Ok(RateReading { rate, is_new: !self.is_lost() })
    }
}

impl InStep for Sensor {
    async fn arm(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    async fn begin(&mut self) -> Result<(), Fault> {
        Ok(())
    }
}

impl Encoder for Sensor {
    async fn read(&mut self) -> Result<Angle, Fault> {
        let [rate, ..] = self.rates;
        Ok(Angle::from_rad(rate(0) * true_seconds(self.controller)))
    }
}

/// The force on a level body at rest.
fn level(count: u64) -> [SpecificForce; 3] {
    let SpecificForce(down) = SpecificForce::from_m_per_s2(-place().gravity().0);
    [0, 0, down].map(|force| SpecificForce(force + (count % 7) as i32 - 3))
}

impl Accelerometer for Sensor {
    async fn read(&mut self) -> Result<ForceReading, Fault> {
        self.count += 1;
        Ok(ForceReading {
            force: level(self.count),
            temperature: Temperature(20_000),
            is_new: true,
            is_clipped: false,
        })
    }
}

impl BaseSensors for Sensor {
    async fn read(&mut self) -> Result<Option<BaseReading>, Fault> {
        self.count += 1;
        let (rate, force) = (self.shown(), level(self.count));
        let reading = BaseReading { rate, force, is_clipped: false };
        if self.is_lost() { Err(Fault::Checksum) } else { Ok(Some(reading)) }
    }

    fn sensors(&self) -> CoarseSensors {
        CoarseSensors::of_densities(4.0, 90.0)
    }

    fn divider(&self) -> u32 {
        2
    }

    fn output_period(&self) -> core::time::Duration {
        core::time::Duration::from_secs(2).div_f64(HERTZ)
    }
}

fn place() -> Latitude {
    Latitude::from_degrees(47.58).expect("a latitude")
}

/// Channels whose motions a keeper takes, of a board with these clocks.
fn channels<S>(clocks: Timebase) -> Channels<'static, S> {
    let mut channels = Channels::new(&());
    channels.shared.clocks = clocks;
    channels.shared.is_kept.set(true);
    channels
}

/// The true time, s, by a controller's clock.
fn true_seconds([actual, nominal]: [u64; 2]) -> f64 {
    Instant::now().as_micros() as f64 * 1e-6 * nominal as f64 / actual as f64
}

/// Gives the motions that a source makes to a test, until it wants no more.
fn follow<'a, S: Source<'a>>(
    mut source: S,
    channels: &'a Channels<'a, S::Sample>,
    mut take: impl FnMut(Motion) -> bool,
) {
    let taking = async {
        loop {
            channels.samples.receive().await;
            while let Ok(motion) = channels.shared.motions.try_receive() {
                if !take(motion) {
                    return;
                }
            }
        }
    };
    virtual_time::run_beside(acquire(&mut source), taking).expect("conversions come");
}

/// Gives the motions of a vehicle whose gyros are these to a test.
fn drive(gyros: [Sensor; 3], sample_rate: f64, clocks: Timebase, take: impl FnMut(Motion) -> bool) {
    let channels = channels(clocks);
    let accelerometer = Sensor::new(LOCKED, |_| 0.0);
    let mut sensors = VehicleSensors { gyros, accelerometer };
    let configuration = VehicleConfiguration::at(sample_rate);
    follow(TriadAcquisition::new(&mut sensors, &configuration, &channels), &channels, take);
}

/// The sensors of an instrument that turns a gyro on a base.
fn sensors<E>(
    gyro: Sensor,
    encoder: E,
    base: &mut Sensor,
) -> Sensors<Sensor, Sensor, E, SwayCompensation<'_, Sensor>> {
    let accelerometer = Sensor::new(LOCKED, |_| 0.0);
    Sensors { gyro, accelerometer, encoder, base: SwayCompensation::for_keeping(base) }
}

#[test]
fn an_hour_of_turning_by_a_clock_that_is_off_comes_to_its_angle_within_a_step() {
    const SAMPLES: u64 = 3600 * 400;
    const RATES: [Rate; 3] = [|_| 10.0 * DEGREE, |_| -3.0 * DEGREE, |_| 15.0 * DEGREE / 3600.0];
    let crystals = Timebase::new(Clock::Crystal, Clock::Crystal, LOCKED);
    let dead = Timebase::nominal(Clock::Crystal, Clock::Controller);
    for (clocks, controller) in [(crystals, LOCKED), (dead, FREE)] {
        let (mut steps, mut count, mut times) = ([0_i128; 3], 0, [None, None]);
        drive(RATES.map(|rate| Sensor::new(controller, rate)), HERTZ, clocks, |motion| {
            let Motion::Moved(InertialSample { time, turned, .. }) = motion else { return true };
            steps.iter_mut().zip(turned).for_each(|(sum, step)| *sum += i128::from(step.0));
            times = [times[0].or(Some(time.0)), Some(time.0)];
            count += 1;
            count < SAMPLES
        });
        for (steps, rate) in steps.into_iter().zip(RATES) {
            let mut shown = Sensor::new(controller, rate);
            let exact: i128 = (1..=SAMPLES)
                .map(|count| {
                    shown.count = count;
                    let [rate, ..] = shown.shown();
                    i128::from(rate.0) * i128::from(PERIOD)
                })
                .sum();
            // A step is 4 nrad, a product of whole numbers 10⁻¹⁸ rad.
            assert!((steps * 4_000_000_000 - exact).abs() < 4_000_000_000, "{steps} steps");
        }
        let [Some(first), Some(last)] = times else { panic!("no sample came") };
        let true_time = (SAMPLES - 1) * PERIOD / 1000;
        let off = (last - first) as f64 / true_time as f64 - 1.0;
        // Without a crystal nothing tells how wrong the clock is.
        let allowed = if clocks == dead { 0.0101 } else { 1e-9 };
        assert!(off.abs() <= allowed, "the samples' times are {off} off");
    }
}

/// Course of a body after a time, s, rad: from north it turns by a degree a second, quicker and slower by turns, since what
/// turns evenly may be at rest.
fn course(seconds: f64) -> f64 {
    DEGREE * (seconds - 0.5 * (0.3 * seconds).sin() / 0.3)
}

/// Rates of a level body in a conversion that ends after a time, s, and lasted so long, s, rad/s.
fn turning(seconds: f64, lasted: f64) -> [f64; 3] {
    let (sine, cosine) = course(seconds - 0.5 * lasted).sin_cos();
    let [level, down] = [place().horizontal_rate().0, place().vertical_rate().0];
    let about_down = (course(seconds) - course(seconds - lasted)) / lasted;
    [level * cosine, -level * sine, about_down - down]
}

/// A keeper that is given the azimuth of its first sample.
struct Held {
    keeper: Keeper,
    has_begun: bool,
}

impl Held {
    fn new(period: f64) -> Self {
        let gyro = attitude::Gyro {
            noise: GyroNoise::from_field_units(0.001, 0.007, 0.0, 0.0),
            bias_sigma: RadiansPerSecond::from_degrees_per_hour(0.5),
            scale_sigma: 5e-4,
        };
        let setting = Setting::precise(place(), Seconds(period), gyro);
        Self { keeper: Keeper::new(&setting), has_begun: false }
    }

    /// Takes a sample that ends so long after the begin of the first conversion, s.
    fn take(&mut self, sample: &InertialSample, seconds: f64) {
        self.keeper.push(sample);
        if !std::mem::replace(&mut self.has_begun, true) {
            let angle = Radians(course(seconds).rem_euclid(TURN));
            self.keeper.hand_over(Azimuth { angle, sigma: Radians(1e-5) });
        }
    }

    /// Error of the azimuth at the latest sample, which has ended so long after that, s, in °.
    fn error(&self, seconds: f64) -> f64 {
        let azimuth = self.keeper.report().azimuth.expect("it is held");
        let off = azimuth.angle.0 - course(seconds);
        (off - TURN * (off / TURN).round()) / DEGREE
    }
}

/// Error of the azimuth after an hour of turning in a vehicle, where one in so many conversions is lost, °.
fn drifted(loses: u64) -> f64 {
    const SAMPLES: u64 = 3600 * 100;
    const RATES: [Rate; 3] = [
        |count| turning(count as f64 * 0.01, 0.01)[0],
        |count| turning(count as f64 * 0.01, 0.01)[1],
        |count| turning(count as f64 * 0.01, 0.01)[2],
    ];
    let clocks = Timebase::new(Clock::Crystal, Clock::Crystal, LOCKED);
    let mut gyros = RATES.map(|rate| Sensor { period: 4 * PERIOD, ..Sensor::new(LOCKED, rate) });
    gyros[1].loses = loses;
    let (mut held, mut seconds) = (Held::new(0.01), 0.0);
    drive(gyros, 100.0, clocks, |motion| {
        let Motion::Moved(sample) = motion else { return true };
        seconds = true_seconds(LOCKED);
        held.take(&sample, seconds);
        seconds < SAMPLES as f64 * 0.01
    });
    held.error(seconds)
}

#[test]
fn a_lost_conversion_and_a_slow_clock_cost_a_vehicle_no_heading() {
    for loses in [u64::MAX, 97] {
        let error = drifted(loses);
        assert!(error.abs() < 2e-3, "{error}° off in an hour, one in {loses} lost");
    }
}

/// Error of the azimuth after ten minutes of turning with a platform's base, °, where one in so many of its readings is
/// lost.
fn carried(loses: u64) -> f64 {
    // It is read with every second conversion, from the first one on.
    const RATES: [Rate; 3] = [
        |count| turning((count as f64 - 0.5) * 0.005, 0.005)[0],
        |count| turning((count as f64 - 0.5) * 0.005, 0.005)[1],
        |count| turning((count as f64 - 0.5) * 0.005, 0.005)[2],
    ];
    let clocks = Timebase::new(Clock::Converter, Clock::Crystal, LOCKED);
    let channels = channels(clocks);
    let gyro = Sensor::new(LOCKED, |_| 0.0);
    let mut base = Sensor { loses, rates: RATES, ..Sensor::new(LOCKED, |_| 0.0) };
    let mut sensors = sensors(gyro, gyro, &mut base);
    let (mut held, mut seconds) = (Held::new(0.005), 0.0);
    let configuration = Configuration::at(HERTZ);
    follow(on_stage(&mut sensors, &configuration, &channels), &channels, |motion| {
        let Motion::Moved(sample) = motion else { return true };
        seconds = true_seconds(LOCKED);
        held.take(&sample, seconds);
        seconds < 600.0
    });
    held.error(seconds)
}

#[test]
fn a_reading_of_the_base_that_is_lost_is_bridged_once() {
    for loses in [u64::MAX, 50, 3] {
        let error = carried(loses);
        assert!(error.abs() < 5e-3, "{error}° of 600° off, one in {loses} lost");
    }
}

#[test]
fn the_vertical_gyro_turns_by_the_better_clock_whatever_is_lost() {
    const RATE: Rate = |_| 2.0 * DEGREE;
    let crystal = Timebase::new(Clock::Converter, Clock::Crystal, LOCKED);
    let dead = Timebase::nominal(Clock::Converter, Clock::Controller);
    // The converter is off by one and a half per cent, or by nothing where its clock is the better one.
    let slow = PERIOD * 203 / 200;
    for (clocks, controller, period) in [(crystal, LOCKED, slow), (dead, FREE, PERIOD)] {
        let frames = FramesConfiguration::new(
            TwoFrame::default(),
            Frames { outer: Harmonics::default(), inner: Harmonics::default() },
            MetresPerSecondSquared(1e-3),
        );
        let (frames, channels) = (frames.expect("a geometry"), channels(clocks));
        let gyro = Sensor { period, loses: 11, ..Sensor::new(controller, RATE) };
        let mut base = Sensor::new(controller, RATE);
        let still = Sensor::new(controller, |_| 0.0);
        let mut sensors = sensors(gyro, Frames { outer: still, inner: still }, &mut base);
        let (mut turned, mut first, mut last) = (0.0, None, 0.0);
        let configuration = Configuration::at(HERTZ);
        let source = on_mount(&mut sensors, &configuration, &frames, &channels);
        let mut is_precise = false;
        follow(source, &channels, |motion| {
            match motion {
                Motion::Exchanged(down) => is_precise = down == VerticalGyro::Precise,
                Motion::Moved(sample) if is_precise => {
                    let [.., down] = sample.turned;
                    if first.is_some() {
                        assert!(!down.is_saturated(), "rotation is lost");
                        turned += AngleIncrement::rad(down);
                    }
                    last = true_seconds(controller);
                    first = first.or(Some(last));
                }
                _ => {}
            }
            last < 600.0
        });
        let first = first.expect("the axis is vertical");
        let off = turned / (RATE(0) * (last - first)) - 1.0;
        // A conversion at either end may stand for three periods.
        assert!(off.abs() < 4.0 * 2.5e-3 / 600.0, "the angle is {off} off");
    }
}

#[test]
fn an_angle_of_a_platform_belongs_to_the_sample_that_has_it_first_whatever_is_lost() {
    const RATE: Rate = |_| 50.0 * DEGREE;
    let channels = channels(Timebase::nominal(Clock::Converter, Clock::Crystal));
    let exact = Sensor::new([1, 1], RATE);
    let mut sensors = Sensors {
        gyro: Sensor { loses: 7, ..exact },
        accelerometer: exact,
        encoder: exact,
        base: NoBase,
    };
    let configuration = Configuration::at(HERTZ);
    let mut source = on_stage(&mut sensors, &configuration, &channels);
    let taking = async {
        let (mut before, mut new) = (Angle(0), 0);
        while new < 1000 {
            let sample = channels.samples.receive().await;
            if core::mem::replace(&mut before, sample.stage) == sample.stage {
                continue;
            }
            new += 1;
            let off =
                (sample.stage - Angle::from_rad(RATE(0) * sample.time.seconds())).signed_rad();
            assert!(off.abs() < 1e-8, "{} s: an angle is {off} rad off", sample.time.seconds());
        }
    };
    virtual_time::run_beside(acquire(&mut source), taking).expect("conversions come");
}
