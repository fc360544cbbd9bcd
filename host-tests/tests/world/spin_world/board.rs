//! The spinning body behind its five converters: in step, each its own sensor, and means that belong to
//! the middle of a conversion.

use std::cell::RefCell;

use drivers::ads1262::Ads1262;
use drivers::ads1262::configuration::{Configuration, DataRate};
use embassy_time::{Delay, Duration, Instant, Timer};
use hal_mock::chip::{Rig, Select};
use hal_mock::fault::Blackout;
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::spin::plant::{CHIPS, SpinBoard, SpinPlant, SpinPlantConfiguration};
use simulated::line::ObservedLine;

use super::{G, assert_near};

type Converter<'a, 'b> = Ads1262<SpiPort<'a>, ObservedLine<'a, ReadyPin<'a>>, Delay>;

/// 100 turns a second.
const SPIN: f64 = 200.0 * std::f64::consts::PI;

fn board<'a>() -> RefCell<SpinBoard<'a>> {
    RefCell::new(SpinBoard::new(SpinPlant::new(&SpinPlantConfiguration::default(), 1)))
}

fn converter<'a, 'b>(board: &'a RefCell<SpinBoard<'b>>, select: Select) -> Converter<'a, 'b> {
    let configuration = Configuration { rate: DataRate::Sps14400, ..Configuration::default() };
    let bus = SpiPort::new(board, select, 8_000_000);
    let ready = ObservedLine::new(board, select, ReadyPin::new(board, select));
    Ads1262::new(bus, ready, Delay, configuration)
}

fn run<T>(future: impl Future<Output = T>) -> T {
    host::virtual_time::run(future).expect("no task waits without end")
}

/// A code as the input's voltage: 2.5 V full scale.
fn volts(code: i32) -> f64 {
    f64::from(code) / 2_147_483_648.0 * 2.5
}

/// Starts all converters, then their conversions in step by the common line.
async fn start(board: &RefCell<SpinBoard<'_>>) {
    for select in CHIPS {
        converter(board, select).start().await.expect("it is healthy");
    }
    board.borrow_mut().set_start(false, Instant::now());
    Timer::after(Duration::from_millis(5)).await;
    board.borrow_mut().set_start(true, Instant::now());
}

#[test]
fn a_common_start_line_sets_all_five_in_step() {
    let board = board();
    run(async {
        start(&board).await;
        // Table 9-13: 424 µs at 14 400 SPS.
        let due = Some(Instant::now() + Duration::from_micros(424));
        let next = |select| board.borrow_mut().ready_line(select, Instant::now()).next;
        assert!(CHIPS.into_iter().all(|select| next(select) == due));
        Timer::after(Duration::from_secs(2)).await;
        let after = next(CHIPS[0]);
        assert!(after.is_some() && CHIPS.into_iter().all(|select| next(select) == after));
    });
}

#[test]
fn each_converter_shows_its_own_sensor_as_it_was_in_the_middle_of_the_conversion() {
    let board = board();
    run(async {
        start(&board).await;
        let mut chips = CHIPS.map(|select| converter(&board, select));
        let mut after = 0.0;
        for _ in 0..2000 {
            let mut shown = [0.0; 5];
            for (chip, volt) in chips.iter_mut().zip(&mut shown) {
                chip.ready().await.expect("there is a line");
                *volt = volts(chip.read().await.expect("it is healthy").code);
            }
            let ended = board.borrow_mut().ready_line(CHIPS[0], Instant::now()).next;
            after = ended.expect("it converts").as_micros() as f64 * 1e-6 - 1.5 / 14_400.0;
            // Half a period before the end of the latest conversion; both times are whole microseconds.
            let roll = SPIN * after;
            let spin = shown[0] * 350.0;
            let [up, right] = [shown[3], shown[4]].map(|volt| volt / 2e-4);
            assert_near(spin, SPIN, 1e-5, "rate");
            assert_near(up, G * roll.cos() - 0.02 * SPIN * SPIN, 0.01, "force up");
            assert_near(right, -G * roll.sin() - 0.01 * SPIN * SPIN, 0.01, "force to the right");
            assert_near(shown[1].abs() + shown[2].abs(), 0.0, 1e-9, "rates across");
        }
        assert!(after > 0.1);
    });
    for select in CHIPS {
        let count = board.borrow_mut().violations(select).map(|found| found.count);
        assert_eq!(count, Some(0), "{select:?}");
    }
    assert!(board.borrow_mut().violations(Select::Encoder).is_none());
}

#[test]
fn a_supply_that_is_lost_stops_its_converter_and_no_other() {
    let board = board();
    let blackouts = [Blackout { select: Select::ForceUp, at: Instant::from_micros(2_000_000) }];
    board.borrow_mut().blackouts = &blackouts;
    run(async {
        start(&board).await;
        Timer::at(Instant::from_micros(3_000_000)).await;
        let runs = CHIPS
            .map(|select| board.borrow_mut().ready_line(select, Instant::now()).next.is_some());
        assert_eq!(runs, [true, true, true, false, true]);
    });
}
