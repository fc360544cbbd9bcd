//! The driver of a platform that turns on and on: velocities that change on the way.

use core::f64::consts::TAU;

use drivers::fault::Fault;
use drivers::tmc5160::configuration::MICROSTEPS_PER_TURN;
use drivers::tmc5160::units::Velocity;
use embassy_time::{Duration, Ticker, Timer};
use hal_mock::noise::Generator;

use super::driver::{on_a_stage, rest};

/// AMAX of the default ramp, microsteps/s².
const ACCELERATION: f64 = 420_000.0;
/// Turns a second of the platform: the paper's.
const HERTZ: f64 = 0.137;

/// What a velocity that is reported every so many seconds makes of the way: it grows by the ramp, then
/// stays.
fn way(velocities: &[f64], seconds: f64) -> f64 {
    let before = [0.0].iter().chain(velocities);
    let reported = before.zip(velocities);
    reported
        .map(|(before, now)| {
            let ramp = (now - before).abs() / ACCELERATION;
            now * seconds - (now - before) * ramp / 2.0
        })
        .sum()
}

/// Unevenness by a quarter at 0.83 of the turn's frequency, reported 20 times a second: the motor goes
/// exactly the way that its ramps make of it, and never stands.
#[test]
fn a_velocity_that_changes_twenty_times_a_second_is_followed() {
    const SECONDS: f64 = 0.05;
    on_a_stage(async |driver, _, _| {
        let speed = f64::from(MICROSTEPS_PER_TURN) * HERTZ;
        driver.run(Velocity(speed as i32)).await.expect("it runs");
        Timer::after(Duration::from_secs(3)).await;
        let begun = driver.status().await.expect("it is well").position;
        let mut ticker = Ticker::every(Duration::from_millis(50));
        let velocities: Vec<f64> = (0..400)
            .map(|k| speed * (1.0 + 0.25 * (0.83 * HERTZ * TAU * SECONDS * f64::from(k)).sin()))
            .collect();
        for (k, velocity) in velocities.iter().enumerate() {
            driver.run(Velocity(*velocity as i32)).await.expect("it turns on");
            ticker.next().await;
            let status = driver.status().await.expect("it is well");
            assert!(!status.standing && !status.stalled);
            let off = f64::from(status.velocity.0) - velocity;
            assert!(off.abs() < 2.0, "{off} microsteps/s beside the velocity reported in step {k}");
        }
        let status = driver.status().await.expect("it is well");
        // The first step begins at full speed, not at rest.
        let reported = way(&velocities, SECONDS) + speed * speed / ACCELERATION / 2.0;
        let off = f64::from(status.position - begun) - reported;
        // The position is a look later than the last velocity: 0.2 ms; velocities are rounded to 0.7
        // microsteps/s, for 20 s.
        assert!(off.abs() < 800.0, "{off} microsteps beside the way");
    });
}

#[test]
fn a_reversal_on_the_way_takes_the_ramps_time_and_zero_comes_to_rest() {
    on_a_stage(async |driver, rig, _| {
        for velocity in [300_000, -300_000, 300_000] {
            driver.run(Velocity(velocity)).await.expect("it runs");
            Timer::after(Duration::from_millis(1440)).await;
            assert_eq!(driver.status().await.expect("it is well").velocity, Velocity(velocity));
        }
        for velocity in [300_000, -300_000] {
            driver.run(Velocity(velocity)).await.expect("it runs");
            Timer::after(Duration::from_millis(1440)).await;
            driver.run(Velocity(0)).await.expect("it may come to rest");
            let (status, seconds) = rest(driver).await;
            // 300 000 / 420 000 s.
            assert!((seconds - 0.714).abs() < 0.003, "{seconds} s");
            assert!(!status.stalled && status.velocity == Velocity(0));
            Timer::after(Duration::from_secs(1)).await;
            assert_eq!(driver.status().await.expect("it is well").position, status.position);
        }
        assert_eq!(rig.borrow().environment.microsteps_per_s, 0.0);
    });
}

#[test]
fn a_stall_on_the_way_refuses_new_velocities_until_it_is_acknowledged() {
    on_a_stage(async |driver, rig, _| {
        driver.run(Velocity(600_000)).await.expect("it runs");
        Timer::after(Duration::from_secs(2)).await;
        driver.run(Velocity(500_000)).await.expect("it turns on");
        rig.borrow_mut().environment.blocked = true;
        Timer::after(Duration::from_millis(3)).await;
        assert!(driver.status().await.expect("it is well").stalled);
        rig.borrow_mut().environment.blocked = false;
        for velocity in [550_000, 0, -1] {
            let refused = driver.run(Velocity(velocity)).await;
            assert!(matches!(refused, Err(Fault::Alarm { status }) if status & 4 != 0));
        }
        let status = driver.status().await.expect("it is well");
        assert!(status.stalled && status.standing);
        driver.clear_stall().await.expect("it clears");
        driver.run(Velocity(500_000)).await.expect("it turns on");
        Timer::after(Duration::from_secs(2)).await;
        assert_eq!(driver.status().await.expect("it is well").velocity, Velocity(500_000));
    });
}

/// The count wraps around after 466 turns one way (data sheet, 6.3.1): it goes on, as the velocity does.
#[test]
fn a_count_that_wraps_around_does_not_disturb_the_velocity() {
    on_a_stage(async |driver, _, _| {
        driver.set_position(i32::MAX - 100_000).await.expect("it stands");
        driver.run(Velocity(600_000)).await.expect("it runs");
        Timer::after(Duration::from_secs(3)).await;
        let status = driver.status().await.expect("it is well");
        assert_eq!(status.velocity, Velocity(600_000));
        assert!(status.position < 0 && !status.stalled);
    });
}

/// With one wrong bit in each of eight replies, chance leaves a status valid only where every bit falls where
/// any value is possible.
#[test]
fn wrong_bits_in_every_answer_of_a_turning_motor_are_noticed() {
    const LOOKS: usize = 5_000;
    for hertz in [-0.2, -0.01, 0.05, 0.25] {
        on_a_stage(async |driver, _, wire| {
            let speed = f64::from(MICROSTEPS_PER_TURN) * hertz;
            driver.run(Velocity(speed as i32)).await.expect("it runs");
            Timer::after(Duration::from_secs(4)).await;
            wire.noise.replace(Some(Generator::new(hertz.to_bits())));
            let mut passed = 0;
            for _ in 0..LOOKS {
                passed += usize::from(driver.status().await.is_ok());
                Timer::after(Duration::from_millis(20)).await;
            }
            assert!(50 * passed < LOOKS, "{passed} of {LOOKS} passed at {hertz} Hz");
            wire.noise.replace(None);
            assert!(driver.status().await.is_ok());
        });
    }
}
