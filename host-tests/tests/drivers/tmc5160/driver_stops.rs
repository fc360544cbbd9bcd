//! The driver where something stops the motor: stalls, switches, homing.

use drivers::fault::Fault;
use drivers::tmc5160::units::Velocity;
use embassy_time::{Duration, Instant, Timer};
use firmware::configuration::StageConfiguration;
use firmware::mechanism::Mechanism as _;
use firmware::ports::Actuator;
use firmware::shared::Shared;
use firmware::stage::Stage;
use hal_mock::tmc5160::ChipFault;

use super::driver::{on_a_stage, rest};

#[test]
fn a_blocked_motor_stops_at_once_until_the_stall_is_acknowledged() {
    on_a_stage(async |driver, rig, _| {
        driver.go_to(500_000).await.expect("it goes");
        Timer::after(Duration::from_millis(900)).await;
        rig.borrow_mut().environment.blocked = true;
        Timer::after(Duration::from_millis(3)).await;
        let status = driver.status().await.expect("it is well");
        assert!(status.stalled && status.standing && !status.reached);
        rig.borrow_mut().environment.blocked = false;
        assert!(
            matches!(driver.go_to(500_000).await, Err(Fault::Alarm { status }) if status & 4 != 0)
        );
        assert!(driver.run(Velocity(1000)).await.is_err());
        driver.stop().await.expect("it may always stop");
        assert!(driver.status().await.expect("it is well").stalled);

        driver.clear_stall().await.expect("it clears");
        Timer::after(Duration::from_millis(200)).await;
        let after = driver.status().await.expect("it is well");
        assert!(!after.stalled && after.standing && after.position == status.position);
        driver.go_to(500_000).await.expect("it goes");
        assert_eq!(rest(driver).await.0.position, 500_000);
    });
}

/// Data sheet, 13.5 and 6.2 (TCOOLTHRS): below its threshold a stall cannot be reported.
#[test]
fn a_slow_motor_does_not_notice_that_it_is_blocked() {
    on_a_stage(async |driver, rig, _| {
        rig.borrow_mut().environment.blocked = true;
        driver.run(Velocity(50_000)).await.expect("it runs");
        Timer::after(Duration::from_secs(1)).await;
        let status = driver.status().await.expect("it is well");
        assert!(!status.stalled && !status.standing);
        driver.stop().await.expect("it stops");
        rest(driver).await;
        driver.go_to(500_000).await.expect("it goes");
        assert!(rest(driver).await.0.stalled, "but a fast one does");
        let fastest = rig.borrow().environment.fastest;
        assert!(fastest > 51_200.0 && fastest < 56_000.0, "{fastest}");
    });
}

#[test]
fn homing_finds_the_edge_of_the_left_switch_and_returns_to_it() {
    on_a_stage(async |driver, rig, _| {
        rig.borrow_mut().environment.left_at = Some(-30_000.0);
        driver.run(Velocity(-40_000)).await.expect("it runs");
        assert_eq!(driver.left_edge().await, Ok(None));
        let (status, _) = rest(driver).await;
        assert!(status.left_switch && !status.right_switch && !status.stalled);
        let edge = driver.left_edge().await.expect("it is well").expect("it was met");
        assert!((-30_045..=-30_000).contains(&edge), "to a millisecond's way: {edge}");
        assert!(status.position < edge - 1000, "it stopped softly");
        driver.set_position(status.position - edge).await.expect("it stands");
        driver.go_to(0).await.expect("it goes");
        let (status, _) = rest(driver).await;
        assert!(status.reached && status.position == 0);
        assert_eq!(rig.borrow().environment.microsteps, f64::from(edge));
    });
}

#[test]
fn a_switch_stops_a_fast_motion_at_once_and_lets_it_go_back() {
    on_a_stage(async |driver, rig, _| {
        rig.borrow_mut().environment.left_at = Some(-100_000.0);
        driver.go_to(-300_000).await.expect("it goes");
        let (status, _) = rest(driver).await;
        assert!(status.left_switch && !status.reached);
        assert!((-100_300..=-100_000).contains(&status.position), "{}", status.position);
        driver.go_to(-400_000).await.expect("it is stated");
        Timer::after(Duration::from_millis(100)).await;
        assert_eq!(driver.status().await.expect("it is well").position, status.position);
        driver.go_to(0).await.expect("it goes");
        assert!(rest(driver).await.0.reached);
    });
}

#[test]
fn a_position_is_counted_on_where_the_chips_register_overflows() {
    for way in [1, -1] {
        on_a_stage(async |driver, _, _| {
            let begin = way * (i32::MAX - 1000);
            driver.set_position(begin).await.expect("it stands");
            let before = driver.status().await.expect("it is well").position;
            assert_eq!(driver.counted(before), i64::from(begin));
            driver.run(Velocity(way * 40_000)).await.expect("it runs");
            Timer::after(Duration::from_secs(1)).await;
            let after = driver.status().await.expect("it is well").position;
            assert!(after.signum() == -way, "it has overflowed: {after}");
            let moved = (driver.counted(after) - i64::from(begin)) * i64::from(way);
            assert!((36_000..40_500).contains(&moved), "{moved}");
            driver.stop().await.expect("it stops");
            rest(driver).await;
            driver.set_position(7).await.expect("it stands");
            assert_eq!(driver.counted(7), 7, "a position that was set is what it says");
        });
    }
}

#[test]
fn a_moving_motor_keeps_its_position() {
    on_a_stage(async |driver, _, _| {
        driver.run(Velocity(1000)).await.expect("it runs");
        Timer::after(Duration::from_millis(50)).await;
        assert_eq!(driver.set_position(0).await, Err(Fault::NotReady));
        let status = driver.status().await.expect("it is well");
        assert_eq!(status.velocity, Velocity(1000));
        driver.stop().await.expect("it stops");
        let (status, _) = rest(driver).await;
        driver.set_position(-7).await.expect("it stands");
        assert!(status.position > 0);
        let status = driver.status().await.expect("it is well");
        assert!(status.position == -7 && status.reached && status.standing);
    });
}

#[test]
fn a_stop_takes_the_ramps_time() {
    on_a_stage(async |driver, _, _| {
        driver.run(Velocity(-210_000)).await.expect("it runs");
        Timer::after(Duration::from_secs(1)).await;
        assert_eq!(driver.status().await.expect("it is well").velocity, Velocity(-210_000));
        driver.stop().await.expect("it stops");
        // 210 000 / 420 000 s.
        let (_, seconds) = rest(driver).await;
        assert!((seconds - 0.5).abs() < 0.003, "{seconds}");
    });
}

/// Halts the axis, as once it is given up; returns how long that took, s, and whether its current is to be taken away.
async fn halted(driver: &mut impl Actuator) -> (f64, bool) {
    let shared = Shared::new(&());
    let begun = Instant::now();
    Stage::new(driver, &StageConfiguration::default(), &shared).halt().await;
    (begun.elapsed().as_micros() as f64 * 1e-6, shared.current.signaled())
}

#[test]
fn an_axis_that_is_halted_at_a_switch_stays_there_when_the_switch_opens() {
    on_a_stage(async |driver, rig, _| {
        rig.borrow_mut().environment.left_at = Some(-30_000.0);
        driver.run(Velocity(-40_000)).await.expect("it runs");
        rest(driver).await;
        assert!(!halted(driver).await.1);
        let before = driver.status().await.expect("it is well").position;
        rig.borrow_mut().environment.left_at = None;
        Timer::after(Duration::from_secs(5)).await;
        assert_eq!(driver.status().await.expect("it is well").position, before);
    });
}

#[test]
fn an_axis_whose_bridges_were_hot_for_a_moment_is_halted_by_its_ramp() {
    on_a_stage(async |driver, rig, _| {
        driver.run(Velocity(210_000)).await.expect("it runs");
        Timer::after(Duration::from_secs(1)).await;
        rig.borrow_mut().chip.inject(ChipFault::Overheated);
        Timer::after(Duration::from_millis(20)).await;
        let _ = driver.status().await;
        rig.borrow_mut().chip.inject(ChipFault::None);
        let (seconds, is_current_off) = halted(driver).await;
        assert!(seconds < 1.0 && !is_current_off, "{seconds} s");
        assert!(driver.status().await.expect("it is well").standing);
    });
}
