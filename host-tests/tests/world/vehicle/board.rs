//! The vehicle behind its chips: conversions are means, in step where they began together.

use std::cell::RefCell;

use drivers::ads1262::Ads1262;
use drivers::ads1262::configuration::{Configuration, DataRate};
use drivers::adxl355::registers::OutputRate;
use drivers::adxl355::{self, Adxl355};
use embassy_time::{Delay, Duration, Instant, Timer};
use hal_mock::chip::{Rig, Select};
use hal_mock::fault::Blackout;
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::vehicle::plant::{
    CHIPS, GYROS, VehicleBoard, VehiclePlant, VehiclePlantConfiguration,
};
use hal_mock::vehicle::{Leg, Stop, VehicleConfiguration};
use simulated::line::ObservedLine;

use super::{EARTH, assert_near, sway, wave};

type Converter<'a, 'b> = Ads1262<SpiPort<'a>, ObservedLine<'a, ReadyPin<'a>>, Delay>;

/// Swaying fast enough that a conversion at 100 SPS is not what is felt at its end: 0.3° at 3 Hz.
fn legs() -> [Leg; 1] {
    let still = wave([0.0; 3], 0.0, 0.0);
    let sway = sway([wave([0.0, 0.0, 0.3], 3.0, 0.4), still, still]);
    [Leg::Stop(Stop { seconds: 100.0, sway, ..Stop::default() })]
}

fn board(legs: &[Leg]) -> RefCell<VehicleBoard<'_>> {
    let standard = VehiclePlantConfiguration::default();
    let vehicle =
        VehicleConfiguration { latitude_deg: 60.0, legs, rate_hz: 100.0, ..standard.vehicle };
    let plant = VehiclePlant::new(&VehiclePlantConfiguration { vehicle, ..standard }, 1);
    RefCell::new(VehicleBoard::new(plant))
}

fn converter<'a, 'b>(board: &'a RefCell<VehicleBoard<'b>>, select: Select) -> Converter<'a, 'b> {
    let configuration = Configuration { rate: DataRate::Sps100, ..Configuration::default() };
    let bus = SpiPort::new(board, select, 5_000_000);
    let ready = ObservedLine::new(board, select, ReadyPin::new(board, select));
    Ads1262::new(bus, ready, Delay, configuration)
}

fn run<T>(future: impl Future<Output = T>) -> T {
    host::virtual_time::run(future).expect("no task waits without end")
}

/// A code as a rate, rad/s: 2.5 V full scale, 50 mV per °/s.
fn rate(code: i32) -> f64 {
    (f64::from(code) / 2_147_483_648.0 * 2.5 / 0.05).to_radians()
}

/// Roll at a moment, rad.
fn roll(at: Instant) -> f64 {
    let time = at.as_micros() as f64 * 1e-6;
    0.3_f64.to_radians() * (std::f64::consts::TAU * 3.0 * time + 0.4).sin()
}

#[test]
fn the_sum_of_conversions_is_the_angle_that_was_turned() {
    let legs = legs();
    let board = board(&legs);
    run(async {
        let mut gyro = converter(&board, Select::Gyro);
        gyro.start().await.expect("it is healthy");
        gyro.ready().await.expect("there is a line");
        let begun = Instant::now();
        gyro.read().await.expect("it is healthy");
        let mut turned = 0.0;
        for _ in 0..1033 {
            gyro.ready().await.expect("there is a line");
            let before = turned;
            let now = Instant::now();
            turned += rate(gyro.read().await.expect("it is healthy").code) * 0.01;
            // Facing north, a roll is all about forward, and Earth adds its horizontal part.
            let seconds = (now - begun).as_micros() as f64 * 1e-6;
            let expected = roll(now) - roll(begun) + EARTH * 0.5 * seconds;
            assert_near(turned, expected, 1e-8);
            assert!((turned - before).abs() < 1e-3);
        }
    });
    for select in CHIPS {
        let count = board.borrow_mut().violations(select).map(|found| found.count);
        assert_eq!(count, Some(0), "{select:?}");
    }
}

#[test]
fn a_common_start_line_sets_all_converters_in_step() {
    let legs = legs();
    let board = board(&legs);
    run(async {
        for select in GYROS {
            converter(&board, select).start().await.expect("it is healthy");
        }
        let apart = GYROS.map(|select| board.borrow_mut().ready_line(select, Instant::now()).next);
        assert!(apart[0] != apart[1] && apart[1] != apart[2], "{apart:?}");
        board.borrow_mut().set_start(false, Instant::now());
        Timer::after(Duration::from_millis(50)).await;
        assert_eq!(board.borrow_mut().ready_line(Select::GyroDown, Instant::now()).next, None);
        board.borrow_mut().set_start(true, Instant::now());
        // Table 9-13: 10.35 ms at 100 SPS by the filter of one period.
        let due = Instant::now() + Duration::from_micros(10_350);
        for select in GYROS {
            let next = board.borrow_mut().ready_line(select, Instant::now()).next;
            assert_eq!(next, Some(due), "{select:?}");
        }
        Timer::after(Duration::from_secs(20)).await;
        let next = GYROS.map(|select| board.borrow_mut().ready_line(select, Instant::now()).next);
        assert!(next[0] == next[1] && next[1] == next[2]);
    });
}

#[test]
fn three_gyros_are_three_axes() {
    let level = [Leg::Stop(Stop { seconds: 10.0, ..Stop::default() })];
    let board = board(&level);
    run(async {
        let expected = [EARTH * 0.5, 0.0, -EARTH * 0.75_f64.sqrt()];
        for (select, expected) in GYROS.into_iter().zip(expected) {
            let mut gyro = converter(&board, select);
            gyro.start().await.expect("it is healthy");
            gyro.ready().await.expect("there is a line");
            let code = gyro.read().await.expect("it is healthy").code;
            assert_near(rate(code), expected, rate(1));
        }
    });
}

#[test]
fn the_accelerometer_is_fixed_to_the_vehicle() {
    let tilted =
        [Leg::Stop(Stop { seconds: 10.0, pitch_deg: 2.0, roll_deg: 1.0, ..Stop::default() })];
    let board = board(&tilted);
    run(async {
        let bus = SpiPort::new(&board, Select::Accelerometer, adxl355::BUS_HERTZ);
        let mut accelerometer = Adxl355::new(bus, Delay, OutputRate::default());
        accelerometer.start().await.expect("it is healthy");
        Timer::after(Duration::from_millis(100)).await;
        let reading = accelerometer.read().await.expect("it is healthy");
        // 9.8191 m/s² is normal gravity at 60°; one count is 38 µm/s².
        let [pitch, roll] = [2.0_f64, 1.0].map(f64::to_radians);
        let expected = [
            9.819_1 * pitch.sin(),
            -9.819_1 * pitch.cos() * roll.sin(),
            -9.819_1 * pitch.cos() * roll.cos(),
        ];
        for (force, expected) in reading.force.into_iter().zip(expected) {
            assert_near(f64::from(force.0) * 1e-6, expected, 2e-4);
        }
    });
}

#[test]
fn a_supply_that_is_lost_stops_its_converter_and_no_other() {
    let legs = legs();
    let board = board(&legs);
    let blackouts = [Blackout { select: Select::GyroRight, at: Instant::from_micros(2_000_000) }];
    board.borrow_mut().blackouts = &blackouts;
    run(async {
        for select in GYROS {
            converter(&board, select).start().await.expect("it is healthy");
        }
        Timer::at(Instant::from_micros(3_000_000)).await;
        let runs = GYROS
            .map(|select| board.borrow_mut().ready_line(select, Instant::now()).next.is_some());
        assert_eq!(runs, [true, false, true]);
    });
}
