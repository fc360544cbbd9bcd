//! x
#![allow(missing_docs)]
use hal_mock::gyro::*;
use hal_mock::instruments::*;
use hal_mock::turntable::*;
#[test]
fn speed() {
    let gyro = GyroConfiguration { n_deg_sqrt_h: 0.02, ..Default::default() };
    let segments = [Segment::steady(0.86, 200.0)];
    for un in [0.0, 0.002] {
        let mut c = TurntableConfiguration {
            instruments: InstrumentsConfiguration { gyro, rate_hz: 50000.0, ..Default::default() },
            segments: &segments,
            ..Default::default()
        };
        c.unevenness.first.relative = un;
        c.instruments.accelerometer.noise_m_s2_sqrt_hz = 2e-4;
        let t = std::time::Instant::now();
        let s: f64 =
            Turntable::new(&c, 1).map(|s| s.rate_rad_s + s.stage_rad + s.force_m_s2[0]).sum();
        let e = t.elapsed().as_secs_f64();
        println!("{un} {} M/s {s}", 10.0 / e);
    }
}
