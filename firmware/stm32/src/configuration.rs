//! Configuration of what is soldered: carrier, chips and clocks. The carrier is chosen by a feature.

use drivers::ads1262::configuration::{Configuration as Converter, DataRate, Filter, Gain};
use drivers::lsm6dsl::registers::OutputRate as BaseRate;
use firmware::calibration::Harmonics;
use firmware::configuration::{Configuration, VehicleConfiguration};
use firmware::platform::Platform;
use orientation::signal::sway::CoarseSensors;
use orientation::timebase::{Clock as Source, Timebase};
use orientation::units::Seconds;

use crate::wiring::Clock;

/// Platform of this instrument, by the feature that is chosen of this crate. Code for the others is not
/// in the image.
pub const PLATFORM: Platform = match [
    cfg!(feature = "stage"),
    cfg!(feature = "two-frame"),
    cfg!(feature = "turntable"),
    cfg!(feature = "vehicle"),
    cfg!(feature = "spin"),
] {
    [true, false, false, false, false] => Platform::Stage,
    [false, true, false, false, false] => Platform::TwoFrame,
    [false, false, true, false, false] => Platform::Turntable,
    [false, false, false, true, false] => Platform::Vehicle,
    [false, false, false, false, true] => Platform::Spin,
    [false, false, false, false, false] => {
        panic!("choose a carrier, as in `cargo board --features stage`")
    }
    _ => panic!("more than one carrier is chosen"),
};

/// Sample rate of the precise gyros: by the feature `sps2400` the next one that the converter has beyond 2 kHz.
const RATE: DataRate = if cfg!(feature = "sps2400") { DataRate::Sps2400 } else { DataRate::Sps400 };
/// Configuration of the converter: sample rate, filter and gain.
pub const CONVERTER: Converter = Converter { rate: RATE, filter: Filter::Sinc1, gain: Gain::X1 };

/// Frequency of the controller's oscillator MSI as the crystal locks it, and the nominal one by which
/// its time counts, Hz: 122 times 32 768 Hz for 4 MHz (RM0351, section 6.2.3).
const MSI_HERTZ: [u64; 2] = [122 * 32_768, 4_000_000];

/// Clocks of the instrument: an oscillator feeds the converters in a vehicle and on a spinning body, and
/// the controller has its crystal unless that is dead.
#[must_use]
pub fn timebase(Clock { has_crystal }: Clock) -> Timebase {
    let converter = match PLATFORM {
        Platform::Vehicle | Platform::Spin => Source::Crystal,
        Platform::Stage | Platform::TwoFrame | Platform::Turntable => Source::Converter,
    };
    if has_crystal {
        Timebase::new(converter, Source::Crystal, MSI_HERTZ)
    } else {
        Timebase::nominal(converter, Source::Controller)
    }
}

/// Sample period of the converter that takes the precise gyros.
pub fn period() -> Seconds {
    Seconds(1.0 / CONVERTER.rate.hertz())
}

/// Decimation of the LSM6DSL of the board itself: read once in this many samples of the gyro, 200 times a
/// second, which finds every output of [`BASE_OUTPUT`]. By it the result is held on a stage, two frames or a
/// turntable, and the sway of the base is compensated: the board is fixed to the base, the chip's x axis forward,
/// y to the right, z down.
pub const BASE_DIVIDER: u32 = if cfg!(feature = "sps2400") { 12 } else { 2 };
/// Output rate of the LSM6DSL.
pub const BASE_OUTPUT: BaseRate = BaseRate::Hz104;
/// Noise densities of the LSM6DSL, m°/s/√Hz and µg/√Hz: those of its data sheet, raised by a twentieth
/// for its oscillator and for errors that successive dwells share.
pub const BASE_NOISE: [f64; 2] = [1.05 * 4.0, 1.05 * 90.0];
/// 1σ of the LSM6DSL's rates at rest, °/s, of its scale, relative, and of its accelerometers' biases,
/// m/s²: half of the zero-g level of ±40 mg (data sheet, `LA_TyOff`), since nothing calibrates them
/// before they are compared with the ADXL355.
pub const BASE_SIGMAS: (f64, f64, f64) = (3.0, 0.005, 20e-3 * 9.80665);
/// Distance of the board from the point about which the base sways, m.
const BASE_LEVER: f64 = 0.4;

/// Time between two outputs of the LSM6DSL, s.
#[must_use]
pub fn base_period() -> f64 {
    1.0 / f64::from(BASE_OUTPUT.hertz())
}

/// Properties of the LSM6DSL, for the compensation of sway.
#[must_use]
pub fn base_sensors() -> CoarseSensors {
    let [rate, force] = BASE_NOISE;
    let sample = 1.0 / CONVERTER.rate.hertz();
    let read = f64::from(BASE_DIVIDER) * sample;
    CoarseSensors {
        mismatch: BASE_SIGMAS.1 as f32,
        lever: BASE_LEVER as f32,
        ..CoarseSensors::of_densities(rate, force).read_in_periods(base_period(), read, sample)
    }
}

/// Configuration of the devices of a stage, a turntable or two frames, whose one or outer encoder has such errors.
#[must_use]
pub fn instrument(encoder: Harmonics) -> Configuration {
    let rate = CONVERTER.rate.hertz();
    Configuration { encoder, ..Configuration::at(rate) }
}

/// Configuration of the vehicle's devices.
#[must_use]
pub fn vehicle() -> VehicleConfiguration {
    VehicleConfiguration::at(CONVERTER.rate.hertz())
}

/// Configuration of the converters of a spinning body: the next rate above the 10 kHz of Nekrasova
/// 2017.
pub const SPIN_CONVERTER: Converter =
    Converter { rate: DataRate::Sps14400, filter: Filter::Sinc1, gain: Gain::X1 };
