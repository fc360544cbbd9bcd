//! The driver on the simulated chip, in health.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

use drivers::ads1262::configuration::{Configuration, DataRate, Filter, Gain};
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use embassy_time::Instant;

use super::rig::{Input, device, rig, run, until, violations};

/// Time now, µs.
fn now() -> u64 {
    Instant::now().as_micros()
}

#[test]
fn a_chip_starts_and_measures_what_is_there() {
    let rig = rig(Input::steady(0.5));
    run(async {
        let mut device = device(&rig, Configuration::default());
        device.start().await.expect("it is healthy");
        assert_eq!(rig.borrow().environment.asked, 0, "nothing is asked of the gyro before");
        device.ready().await.expect("there is a line");
        let conversion = device.read().await.expect("it is healthy");
        assert_eq!(conversion.code, 429_496_730, "0.5 V of 2.5 V");
        assert!(conversion.is_new && !conversion.is_clipped);
        let scale = Scale::new(2.0, INTERNAL_REFERENCE_VOLTS, Gain::X1).expect("it is one");
        assert_eq!(scale.rate(conversion.code).0, 250_000_000, "2 V per rad/s");
    });
    assert_eq!(violations(&rig), 0);
}

/// The self-test's time is two conversions: all else is 60 ms and less than 1 ms of bus.
#[test]
fn every_rate_filter_and_gain_starts_within_its_time() {
    for rate in [DataRate::Sps2p5, DataRate::Sps60, DataRate::Sps7200, DataRate::Sps38400] {
        for filter in [Filter::Sinc1, Filter::Sinc2, Filter::Sinc3, Filter::Sinc4] {
            for gain in [Gain::X1, Gain::X2, Gain::X4, Gain::X8, Gain::X16, Gain::X32] {
                let configuration = Configuration { rate, filter, gain };
                let rig = rig(Input::steady(0.01));
                run(async {
                    let mut device = device(&rig, configuration);
                    device.start().await.expect("it is healthy");
                    let bound = 61_000 + 2 * configuration.latency().as_micros() as u64 * 21 / 20;
                    assert!(now() <= bound, "{configuration:?}: {}", now());
                    device.ready().await.expect("there is a line");
                    let code = f64::from(device.read().await.expect("it is healthy").code);
                    let volts = code / 2_147_483_648.0 * 2.5 / gain.factor();
                    assert!((volts - 0.01).abs() < 1e-9, "{configuration:?}: {volts}");
                });
                assert_eq!(violations(&rig), 0, "{configuration:?}");
            }
        }
    }
}

/// 2000 conversions at 1200 SPS: the k-th is that of its own time, none is lost or read twice.
#[test]
fn every_conversion_is_read_once_and_in_time() {
    let rig = rig(Input { volts: -1.0, volts_per_s: 1.0, asked: 0 });
    run(async {
        let rate = DataRate::Sps1200;
        let mut device = device(&rig, Configuration { rate, ..Configuration::default() });
        device.start().await.expect("it is healthy");
        device.ready().await.expect("there is a line");
        let begin = now();
        device.read().await.expect("it is healthy");
        for count in 1..2000_u64 {
            device.ready().await.expect("there is a line");
            let expected = begin as f64 + count as f64 * 1e6 / 1200.0;
            assert!((now() as f64 - expected).abs() <= 0.5, "{count}");
            let at = now() as f64 * 1e-6;
            let conversion = device.read().await.expect("it is healthy");
            assert!(conversion.is_new);
            let volts = f64::from(conversion.code) / 2_147_483_648.0 * 2.5;
            assert!((volts - (at - 1.0)).abs() < 2e-9, "{count}: {volts}");
        }
    });
    assert_eq!(rig.borrow().chip.overwritten, 0);
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_late_reader_gets_the_newest_and_then_waits_for_the_next() {
    let rig = rig(Input { volts: 0.0, volts_per_s: 1.0, asked: 0 });
    run(async {
        let mut device = device(&rig, Configuration::default());
        device.start().await.expect("it is healthy");
        device.ready().await.expect("there is a line");
        let first = now();
        until(first + 26_000).await;
        device.ready().await.expect("it is already low");
        assert_eq!(now(), first + 26_000);
        let newest = device.read().await.expect("it is healthy");
        assert!(newest.is_new);
        let volts = f64::from(newest.code) / 2_147_483_648.0 * 2.5;
        assert!((volts - (first + 25_000) as f64 * 1e-6).abs() < 1e-9);
        assert!(!device.read().await.expect("it is healthy").is_new);
        device.ready().await.expect("there is a line");
        assert_eq!(now(), first + 27_500);
    });
    assert_eq!(rig.borrow().chip.overwritten, 10);
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_dropped_wait_loses_nothing() {
    let rig = rig(Input::default());
    run(async {
        let mut device = device(&rig, Configuration::default());
        device.start().await.expect("it is healthy");
        for _ in 0..3 {
            let mut context = Context::from_waker(Waker::noop());
            assert_eq!(pin!(device.ready()).poll(&mut context), Poll::Pending);
        }
        device.ready().await.expect("there is a line");
        assert!(device.read().await.expect("it is healthy").is_new);
    });
    assert_eq!(rig.borrow().chip.overwritten, 0);
}

#[test]
fn starting_again_brings_back_a_chip_in_any_state() {
    let rig = rig(Input::steady(-0.5));
    run(async {
        let mut device = device(&rig, Configuration::default());
        for state in 0_u8..50 {
            device.start().await.expect("it is healthy");
            device.ready().await.expect("there is a line");
            assert_eq!(device.read().await.expect("it is healthy").code, -429_496_730);
            // Other modes, inputs and calibrations, running.
            let sent = [0x43, 9, 0x40, 0x20, state % 16, state, 9, 9, 9, 9, 9, 0x39];
            super::rig::exchange(&rig, &sent).await;
            super::rig::exchange(&rig, &[0x08]).await;
        }
    });
    assert_eq!(violations(&rig), 0);
}
