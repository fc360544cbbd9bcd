//! Turns that are joined keep their means, their number and their order.

use orientation::alignment::rotating::turn::{Sense, Stretch, TURNS, Turn};

fn turn(number: u32) -> Turn {
    let x = f64::from(number);
    let part = |k: f64| (1e-5 * (0.7 * k * x).sin()) as f32;
    Turn {
        rate: [part(1.0), part(2.0)],
        turning: [part(3.0), part(4.0)],
        leak: [part(5.0), part(6.0)],
        force: [part(7.0), part(8.0)],
        across: [0.0; 2],
        mean_force: part(9.0),
        offset: part(10.0),
        middle: 8.0 * number as f32 + 4.0,
        seconds: 8.0,
        speed: -0.8,
    }
}

fn stretch(count: u32) -> Stretch {
    let mut stretch = Stretch::new(Sense::CounterClockwise, 17);
    (0..count).for_each(|number| stretch.push(turn(number)));
    stretch
}

#[track_caller]
fn assert_mean(stretch: &Stretch, of: impl Fn(&Turn) -> f32) {
    let exact: f64 = (0..stretch.count()).map(|number| f64::from(of(&turn(number)))).sum();
    let found: f64 = stretch.turns.iter().map(|turn| f64::from(of(turn))).sum();
    let (exact, found) = (exact / f64::from(stretch.count()), found / stretch.turns.len() as f64);
    assert!((found - exact).abs() <= 3e-7 * exact.abs() + 3e-12, "{found} is not {exact}");
}

#[test]
fn joined_turns_keep_means_number_and_order() {
    for count in [1, 2, 31, 32, 33, 34, 63, 64, 65, 100, 129, 1000, 4097] {
        let stretch = stretch(count);
        let length = stretch.turns.len() as u32;
        assert!(length as usize <= TURNS && stretch.count() <= count);
        // What waits is less than one joined turn.
        let joined = stretch.count() / length;
        assert!(count - stretch.count() < joined, "{count}: {}", stretch.count());
        assert!(joined.is_power_of_two() && (count <= 32 || length > 15));
        assert_mean(&stretch, |turn| turn.rate[0]);
        assert_mean(&stretch, |turn| turn.rate[1]);
        assert_mean(&stretch, |turn| turn.turning[1]);
        assert_mean(&stretch, |turn| turn.leak[0]);
        assert_mean(&stretch, |turn| turn.force[1]);
        assert_mean(&stretch, |turn| turn.mean_force);
        assert_mean(&stretch, |turn| turn.offset);
        assert!((stretch.speed() - 0.8).abs() < 1e-7 && stretch.since == 17);
        assert!(
            (stretch.turns.iter().map(|turn| f64::from(turn.seconds)).sum::<f64>()
                - 8.0 * f64::from(stretch.count()))
            .abs()
                < 1e-3
        );
        for (number, turn) in stretch.turns.iter().enumerate() {
            let middle = 8.0 * f64::from(joined) * (number as f64 + 0.5);
            assert!((f64::from(turn.middle) - middle).abs() < 1e-6 * middle, "{count} {number}");
        }
    }
}

#[test]
fn turns_of_different_lengths_are_weighted_by_them() {
    let mut stretch = Stretch::new(Sense::Clockwise, 0);
    for number in 0..64 {
        let seconds = if number % 2 == 0 { 6.0 } else { 2.0 };
        let offset = if number % 2 == 0 { 1.0 } else { 5.0 };
        stretch.push(Turn { seconds, offset, ..turn(number) });
    }
    assert_eq!((stretch.turns.len(), stretch.count()), (32, 64));
    for turn in stretch.turns {
        assert_eq!((turn.seconds, turn.offset), (8.0, 2.0));
    }
}
