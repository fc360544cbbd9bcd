//! What a rate-modulated turn tells of the misalignment, against the simulation's truth; and how it is stored.

use hal_mock::molecular::MolecularConfiguration;
use hal_mock::turntable::{Segment, Turntable};
use orientation::alignment::rotating::misalignment::{AxisMisalignment, BYTES, nearest};
use orientation::alignment::rotating::turn_accumulator::{Mode, TurnAccumulator};
use orientation::units::{RadiansPerSecond, Seconds};
use proptest::prelude::*;

use super::outcome::{SPEED, healthy, turns_s};
use super::rig::{Case, modulated, over, rms, sample};

const LAG_S: f64 = 0.05;

/// What a rate-modulated turn of a sensor with this lag tells.
fn found(seed: u64, lag_s: f64, segment: Segment) -> (Case, Option<AxisMisalignment>) {
    let mut case = healthy(seed, 0.02);
    case.instruments.gyro.molecular = (lag_s > 0.0)
        .then_some(MolecularConfiguration { lag_s, ..MolecularConfiguration::default() });
    case.segments = vec![segment];
    let mut turn_accumulator = TurnAccumulator::new(1, Mode::Modulated);
    for turning in Turntable::new(&case.configuration(), seed) {
        let turning_rate = (seed.is_multiple_of(2)).then_some(turning.stage_rate_rad_s as f32);
        turn_accumulator.push(&sample(&turning), turning_rate);
    }
    let misalignment = turn_accumulator.modulated[0].misalignment(case.setting.site.noise.model());
    (case, misalignment)
}

/// s/(1 + jwτ): in phase with the rate, and over w for its derivative.
fn pole(sine: f64, lag: f64, frequency: f64) -> (f64, f64) {
    let size = 1.0 + (frequency * lag).powi(2);
    (sine / size, -sine * frequency * lag / size)
}

#[test]
fn sine_and_lag_are_the_simulations_and_their_sigma_is_honest() {
    for lag_s in [0.0, LAG_S] {
        let ratios = over(0..150, |seed| {
            let (case, misalignment) = found(seed, lag_s, modulated(SPEED, 10.0));
            let misalignment = misalignment.expect("it was modulated");
            let sine = -case.instruments.gyro.axis_elevation_rad.sin();
            let (in_phase, quadrature) = pole(sine, lag_s, 0.83 * SPEED);
            assert!((misalignment.frequency.0 / SPEED / 0.83 - 1.0).abs() < 0.03);
            assert!(
                (misalignment.angle().0 - case.instruments.gyro.axis_elevation_rad).abs() < 1e-4
            );
            let quadrature = quadrature / (0.83 * SPEED);
            [
                (misalignment.sine - in_phase) / misalignment.sine_sigma,
                (misalignment.quadrature.0 - quadrature) / misalignment.quadrature_sigma.0,
            ]
        });
        for part in [0, 1] {
            let ratio = rms(&ratios.iter().map(|both| both[part]).collect::<Vec<_>>());
            // 150 draws tell it to 6 %.
            assert!((0.8..1.2).contains(&ratio), "{ratio} of σ, part {part}, lag {lag_s}");
        }
    }
}

#[test]
fn the_response_at_the_turn_is_that_of_one_pole() {
    for (sine, lag) in [(0.02, 0.05), (-0.01, 0.3), (0.03, 0.0)] {
        let learnt = 0.7;
        let (in_phase, lagging) = pole(sine, lag, learnt);
        let misalignment = stored(in_phase, lagging / learnt, learnt);
        assert!((misalignment.lag().0 - lag).abs() < 1e-6);
        for frequency in [0.1, -0.8, 0.8, 2.0] {
            let (re, im) = pole(sine, lag, frequency);
            let response = misalignment.response(frequency);
            assert!((response.re - re).abs() < 1e-7 && (response.im - im).abs() < 1e-7);
        }
    }
}

fn stored(sine: f64, quadrature: f64, frequency: f64) -> AxisMisalignment {
    let (sine_sigma, quadrature_sigma, date) = (1e-9, 1e-9, 1_700_000_000);
    AxisMisalignment {
        sine,
        quadrature: Seconds(quadrature),
        sine_sigma,
        quadrature_sigma: Seconds(quadrature_sigma),
        frequency: RadiansPerSecond(frequency),
        date,
        temperature: 21.5,
    }
}

#[test]
fn an_even_or_short_turn_tells_nothing() {
    for segment in [Segment::steady(SPEED, turns_s(10.0)), modulated(SPEED, 2.5)] {
        for seed in 0..6 {
            assert_eq!(found(seed, 0.0, segment).1, None);
        }
    }
}

#[test]
fn the_nearest_speed_counts_in_either_sense() {
    let both = [stored(0.01, 0.0, 0.4), stored(0.02, 0.0, 1.0)];
    for (speed, sine) in [(0.1, 0.01), (-0.65, 0.01), (0.75, 0.02), (-3.0, 0.02)] {
        assert_eq!(nearest(&both, speed).map(|misalignment| misalignment.sine), Some(sine));
    }
    assert_eq!(nearest(&[], 1.0), None);
}

proptest! {
    #[test]
    fn a_misalignment_comes_back_from_its_bytes(
        sine in -1.0..1.0_f64,
        quadrature in -10.0..10.0_f64,
        sigmas in (0.0..1.0_f64, 0.0..1.0_f64),
        frequency in 1e-6..10.0_f64,
        date in any::<u64>(),
        temperature in -100.0..100.0_f32,
    ) {
        let misalignment = AxisMisalignment {
            sine,
            quadrature: Seconds(quadrature),
            sine_sigma: sigmas.0,
            quadrature_sigma: Seconds(sigmas.1),
            frequency: RadiansPerSecond(frequency),
            date,
            temperature,
        };
        prop_assert_eq!(AxisMisalignment::from_bytes(&misalignment.to_bytes()), Some(misalignment));
    }

    #[test]
    fn any_bytes_are_a_sound_misalignment_or_none(bytes in proptest::array::uniform32(any::<u8>())) {
        let mut all = [0; BYTES];
        all[..32].copy_from_slice(&bytes);
        all[32..].copy_from_slice(&bytes);
        prop_assert_eq!(AxisMisalignment::from_bytes(&all), None);
    }
}

#[test]
fn any_flipped_bit_is_refused() {
    let bytes = stored(0.01, -1e-4, 0.7).to_bytes();
    assert!(AxisMisalignment::from_bytes(&bytes).is_some());
    for bit in 0..8 * BYTES {
        let mut damaged = bytes;
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(AxisMisalignment::from_bytes(&damaged), None, "bit {bit}");
    }
}

/// CRC-32 of IEEE 802.3, bit by bit; of "123456789" it is 0xCBF43926.
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0xEDB8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

#[test]
fn another_version_a_cut_and_impossible_numbers_are_refused_though_the_checksum_is_right() {
    assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    let sound = stored(0.01, -1e-4, 0.7).to_bytes();
    let with = |edit: &dyn Fn(&mut [u8; BYTES])| {
        let mut bytes = sound;
        edit(&mut bytes);
        let checksum = crc32(&bytes[..BYTES - 4]);
        bytes[BYTES - 4..].copy_from_slice(&checksum.to_le_bytes());
        AxisMisalignment::from_bytes(&bytes)
    };
    assert!(with(&|_| {}).is_some());
    for version in [0, 2, 255] {
        assert_eq!(with(&|bytes| bytes[0] = version), None);
    }
    assert_eq!(with(&|bytes| bytes[30..].fill(0)), None);
    for number in [f64::NAN, f64::INFINITY, 1.5] {
        assert_eq!(with(&|bytes| bytes[4..12].copy_from_slice(&number.to_le_bytes())), None);
    }
    for frequency in [0.0_f64, -1.0, f64::NAN] {
        assert_eq!(with(&|bytes| bytes[36..44].copy_from_slice(&frequency.to_le_bytes())), None);
    }
}
