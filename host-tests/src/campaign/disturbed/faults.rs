//! What goes wrong with a rig, whatever turns it; and what is drawn or left unsaid for it beforehand.

use std::f64::consts::TAU;

use hal_mock::gyro::DEGREE_PER_HOUR;
use hal_mock::stage::Harmonic;
use hal_mock::temperature::TemperatureConfiguration;

use super::axes::TURNED;
use super::chance::Chance;
use super::gyro::Drift;
use super::unit::Rig;

/// m/s² of a thousandth of gravity.
const MILLI_G: f64 = 9.81e-3;

/// The base tilts slowly, °/h.
pub(super) fn base_tilts<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
    let rates = [0.0, cosine, sine];
    rig.unit_mut().base.rates_rad_s = rates.map(|part| part * size * DEGREE_PER_HOUR);
}

/// The base turns slowly about the vertical, °/min.
pub(super) fn base_yaws<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    rig.unit_mut().base.rates_rad_s[0] = chance.sign() * size.to_radians() / 60.0;
}

/// The base is turned about the vertical, °.
pub(super) fn base_turns<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let at = rig.some_time(chance);
    rig.unit_mut().base.turns.push((at, chance.sign() * size.to_radians()));
}

/// The encoder slips, °.
pub(super) fn encoder_slips<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let at = rig.some_time(chance);
    rig.unit_mut().slips.push((at, chance.sign() * size.to_radians()));
}

/// The encoder errs twice a turn, °.
pub(super) fn encoder_errs_twice<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    rig.unit_mut().instruments.encoder.second =
        Harmonic { amplitude_rad: size.to_radians(), phase_rad: chance.between(0.0, TAU) };
}

/// The encoder counts the other way, under so many degrees of tilt.
pub(super) fn encoder_reversed<R: Rig>(mut rig: R, size: f64) -> super::Pair {
    tilt(&mut rig, size);
    rig.with(|rig, _, _| rig.unit_mut().is_reversed = true, size)
}

/// The gyro's bias steps, twice, σ of a mean.
pub(super) fn bias_steps<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    for _ in 0..2 {
        let at_s = rig.some_time(chance);
        let rate = chance.sign() * size * rig.mean_sigma();
        rig.unit_mut().drift.push(Drift::Step { at_s, rate });
    }
}

/// The gyro's bias walks, σ of a mean over the recording.
pub(super) fn bias_walks<R: Rig>(rig: &mut R, _: &mut Chance, size: f64) {
    let density = size * rig.mean_sigma() / rig.seconds().sqrt();
    rig.unit_mut().drift.push(Drift::Walk { density });
}

/// The gyro warms up, σ of a mean.
pub(super) fn gyro_warms_up<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let rate = chance.sign() * size * rig.mean_sigma();
    let seconds = chance.scaled(0.1, 3.0) * rig.seconds();
    rig.unit_mut().drift.push(Drift::WarmUp { rate, seconds });
}

/// A temperature that rises or falls, with a noise in °C.
pub(super) fn warm<R: Rig>(rig: &mut R, noise_c: f64) {
    let mut chance = Chance::new(rig.unit().seed, R::FAULT + 2);
    rig.unit_mut().instruments.temperature = TemperatureConfiguration {
        rise_c: chance.sign() * chance.scaled(1.0, 20.0),
        time_constant_s: chance.scaled(0.1, 3.0) * rig.seconds(),
        noise_c,
        ..TemperatureConfiguration::default()
    };
}

/// The bias follows the temperature, σ of a mean over the recording.
pub(super) fn bias_follows_temperature<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let temperature = &rig.unit().instruments.temperature;
    let rise = temperature.at(rig.seconds()) - temperature.at(0.0);
    let rate = chance.sign() * size * rig.mean_sigma();
    rig.unit_mut().instruments.gyro.temperature_deg_h_c = rate / rise / DEGREE_PER_HOUR;
}

/// The gyro lags, s.
pub(super) fn gyro_lags<R: Rig>(rig: &mut R, _: &mut Chance, size: f64) {
    rig.unit_mut().gyro.lag_s = size;
}

/// The gyro's column is late, s.
pub(super) fn gyro_is_late<R: Rig>(rig: &mut R, _: &mut Chance, size: f64) {
    rig.unit_mut().gyro.late_s = size;
}

/// The gyro's column has coarse steps, σ of a sample.
pub(super) fn gyro_is_coarse<R: Rig>(rig: &mut R, _: &mut Chance, size: f64) {
    rig.unit_mut().gyro.step = size * rig.sample_sigma();
}

/// The gyro's column is clipped, by parts of the horizontal Earth rate below the greatest of these rates, rad/s.
pub(super) fn gyro_clips<R: Rig>(rig: &mut R, size: f64, rates: impl Iterator<Item = f64>) {
    let latitude = rig.unit().instruments.latitude_deg.to_radians();
    let earth = latitude.cos() * 15.041 * DEGREE_PER_HOUR;
    rig.unit_mut().gyro.limit = Some(rates.fold(f64::MIN, f64::max) - size * earth);
}

/// A tilt by so many degrees, any way.
pub(super) fn tilt<R: Rig>(rig: &mut R, size: f64) {
    let uphill = 360.0 * Chance::new(rig.unit().seed, R::FAULT).between(0.0, 1.0);
    let instruments = &mut rig.unit_mut().instruments;
    *instruments = instruments.leaning(size, uphill);
}

/// Two of the accelerometer's axes are flipped together or turned by 90°, under so many degrees of tilt. As far as
/// the Earth-rate ratio tells: what the wrong axes add lies along the Earth rate.
pub(super) fn accelerometer_axes<R: Rig>(mut rig: R, size: f64) -> super::Pair {
    let mut chance = Chance::new(rig.unit().seed, R::FAULT);
    let [flipped, right, left] = TURNED;
    let (axes, turn) = chance.one_of(&[(flipped, 0.0), (right, -45.0), (left, 45.0)]);
    let aside = chance.sign() * chance.between(25.0, 40.0);
    let unit = rig.unit_mut();
    let along = -unit.instruments.azimuth_deg + turn + aside;
    unit.instruments = unit.instruments.leaning(size, along);
    let scale_sigma = chance.scaled(1e-5, 1e-4);
    unit.instruments.gyro.scale_sigma = scale_sigma;
    unit.header.gyro_scale_sigma = Some(scale_sigma);
    rig.with(|rig, _, _| rig.unit_mut().axes = axes, size)
}

/// The header's rate is not that of the times, by a part of it.
pub(super) fn period_is_wrong<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let wrong = if chance.happens(0.5) { 1.0 + size } else { 1.0 / (1.0 + size) };
    rig.unit_mut().header.rate_hz = Some(R::RATE_HZ * wrong);
}

/// Says nothing of the g-sensitivity.
pub(super) fn leave_g_sensitivity_unsaid<R: Rig>(rig: &mut R) {
    let header = &mut rig.unit_mut().header;
    header.g_sensitivity_deg_h_g = None;
    header.g_sensitivity_sigma_deg_h_g = None;
}

/// A g-sensitivity, times 50 000 °/h/g for each (°/√h)² of N.
pub(super) fn g_sensitivity<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
    let gyro = &mut rig.unit_mut().instruments.gyro;
    let size = (size * 50_000.0 * gyro.n_deg_sqrt_h * gyro.n_deg_sqrt_h).min(212.0);
    gyro.g_sensitivity_deg_h_g = [size * cosine, size * sine];
}

/// Says nothing of the gyro's scale, which is exact.
pub(super) fn leave_scale_unsaid<R: Rig>(rig: &mut R) {
    rig.unit_mut().header.gyro_scale_sigma = None;
    rig.unit_mut().instruments.gyro.scale_sigma = 0.0;
}

/// A scale error.
pub(super) fn scale<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    rig.unit_mut().instruments.gyro.scale_error = chance.sign() * size;
}

/// Says nothing of the accelerometer's biases, which are none.
pub(super) fn leave_accelerometer_bias_unsaid<R: Rig>(rig: &mut R) {
    rig.unit_mut().header.accelerometer_bias_m_s2 = None;
    rig.unit_mut().instruments.accelerometer.bias_sigma_m_s2 = 0.0;
}

/// Biases of the accelerometer, mg.
pub(super) fn accelerometer_bias<R: Rig>(rig: &mut R, chance: &mut Chance, size: f64) {
    rig.unit_mut().instruments.accelerometer.bias_m_s2 =
        [0, 1, 2].map(|_| chance.sign() * size * MILLI_G);
}
