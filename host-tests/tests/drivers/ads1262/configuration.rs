//! Rates, latencies and register images, against the data sheet's tables.

use std::time::Duration;

use drivers::ads1262::configuration::{Configuration, DataRate, Filter, Gain, Sign};
use drivers::ads1262::{BYTES_PER_SAMPLE, GREATEST_BUS_HERTZ, bus_time};

const RATES: [DataRate; 16] = [
    DataRate::Sps2p5,
    DataRate::Sps5,
    DataRate::Sps10,
    DataRate::Sps16p6,
    DataRate::Sps20,
    DataRate::Sps50,
    DataRate::Sps60,
    DataRate::Sps100,
    DataRate::Sps400,
    DataRate::Sps1200,
    DataRate::Sps2400,
    DataRate::Sps4800,
    DataRate::Sps7200,
    DataRate::Sps14400,
    DataRate::Sps19200,
    DataRate::Sps38400,
];

#[test]
fn rates_are_those_of_the_table() {
    let nominal = [
        2.5,
        5.0,
        10.0,
        50.0 / 3.0,
        20.0,
        50.0,
        60.0,
        100.0,
        400.0,
        1200.0,
        2400.0,
        4800.0,
        7200.0,
        14_400.0,
        19_200.0,
        38_400.0,
    ];
    for (code, (rate, hertz)) in RATES.into_iter().zip(nominal).enumerate() {
        assert!((rate.hertz() / hertz - 1.0).abs() < 1e-15, "{rate:?}");
        assert_eq!(rate as usize, code, "bits DR of MODE2");
    }
}

/// Table 9-13, ms; the number of printed digits sets the tolerance.
#[test]
fn latencies_are_those_of_the_table() {
    let table = [
        (Filter::Sinc1, DataRate::Sps2p5, 400.4, 0.05),
        (Filter::Sinc1, DataRate::Sps16p6, 60.35, 0.01),
        (Filter::Sinc1, DataRate::Sps60, 17.02, 0.005),
        (Filter::Sinc1, DataRate::Sps100, 10.35, 0.005),
        (Filter::Sinc1, DataRate::Sps400, 2.855, 0.001),
        (Filter::Sinc1, DataRate::Sps1200, 1.188, 0.001),
        (Filter::Sinc1, DataRate::Sps2400, 0.771, 0.001),
        (Filter::Sinc1, DataRate::Sps7200, 0.494, 0.001),
        (Filter::Sinc1, DataRate::Sps14400, 0.424, 0.001),
        (Filter::Sinc1, DataRate::Sps19200, 0.337, 0.001),
        (Filter::Sinc1, DataRate::Sps38400, 0.207, 0.001),
        (Filter::Sinc2, DataRate::Sps400, 5.424, 0.001),
        (Filter::Sinc2, DataRate::Sps7200, 0.702, 0.001),
        (Filter::Sinc3, DataRate::Sps1200, 2.924, 0.001),
        (Filter::Sinc3, DataRate::Sps60, 50.42, 0.005),
        (Filter::Sinc4, DataRate::Sps4800, 1.258, 0.001),
        (Filter::Sinc4, DataRate::Sps20, 200.4, 0.05),
        (Filter::Sinc4, DataRate::Sps38400, 0.207, 0.001),
    ];
    for (filter, rate, milliseconds, tolerance) in table {
        let latency = Configuration { rate, filter, gain: Gain::X1 }.latency();
        let error = latency.as_secs_f64() * 1e3 - milliseconds;
        assert!(error.abs() <= tolerance + 0.001, "{filter:?} {rate:?}: {latency:?}");
    }
}

/// White noise at the modulator through five means of the first stage's length and one of the
/// second's: the correlation of neighbours that the documentation of `Filter` states.
#[test]
fn neighbouring_conversions_are_as_correlated_as_stated() {
    for (first, second, stated) in [
        (64, 36, 0.009),
        (64, 12, 0.029),
        (64, 6, 0.061),
        (64, 2, 0.24),
        (64, 1, 0.56),
        (24, 1, 0.56),
    ] {
        let mut stage = vec![1.0_f64];
        for _ in 0..5 {
            stage = (0..stage.len() + first - 1)
                .map(|at| {
                    stage[at.saturating_sub(first - 1).min(stage.len())..stage.len().min(at + 1)]
                        .iter()
                        .sum()
                })
                .collect();
        }
        let mut response = vec![0.0; stage.len() + first * (second - 1)];
        for begin in (0..second).map(|output| output * first) {
            stage.iter().zip(&mut response[begin..]).for_each(|(from, to)| *to += from);
        }
        let product = |lag: usize| -> f64 {
            response.iter().zip(&response[lag..]).map(|(one, other)| one * other).sum()
        };
        let correlation = product(first * second) / product(0);
        assert!((correlation - stated).abs() < 0.005, "{first} {second}: {correlation}");
    }
}

/// Field by field from the tables of section 9.6.
#[test]
fn register_images_are_those_that_the_data_sheet_asks_for() {
    let configuration =
        Configuration { rate: DataRate::Sps1200, filter: Filter::Sinc3, gain: Gain::X8 };
    assert_eq!(
        *configuration.image().bytes(),
        [0x01, 0x05, 0x00, 0x40, 0x39, 0x01, 0, 0, 0, 0, 0, 0x40, 0xBB, 0, 0, 0, 0]
    );
    for (sign, positive, negative) in [(Sign::Plus, 0x04, 0x14), (Sign::Minus, 0x14, 0x04)] {
        assert_eq!(
            *configuration.test_image(sign).bytes(),
            [0x01, 0x05, 0, 0x40, 0x39, 0xEE, 0, 0, 0, 0, 0, 0x40, 0xBB, 0, 0, positive, negative]
        );
    }
    assert_eq!(Configuration::default().rate.hertz(), 400.0);
    assert_eq!(Configuration::default().filter, Filter::Sinc1);
}

#[test]
fn the_bus_budget_is_as_stated() {
    assert_eq!(BYTES_PER_SAMPLE, 7);
    assert_eq!(bus_time(GREATEST_BUS_HERTZ), Duration::from_micros(7));
    assert_eq!(bus_time(5_000_000), Duration::from_nanos(11_200));
    let share = bus_time(5_000_000).as_secs_f64() * Configuration::default().rate.hertz();
    assert!((share - 0.0045).abs() < 0.0005, "{share}");
    assert_eq!(Configuration::default().latency(), Duration::from_micros(2855));
}
