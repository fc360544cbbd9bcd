//! The attitude that is shown to users ten times a second, sample by sample.

use orientation::alignment::Azimuth;
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::{EARTH_RATE, Latitude};
use orientation::navigation::navigator::Attitude;
use orientation::navigation::{Input, Motion, Navigator, Output};
use orientation::units::{AngleIncrement, DEGREE, Instant, Radians, RadiansPerSecond, Seconds};

use super::handing::{TURN, keeper, moved, policy, sample};

/// What is shown of these inputs.
fn shown(keeper: &mut Keeper, inputs: impl IntoIterator<Item = Input>) -> Vec<Attitude> {
    let mut shown = Vec::new();
    let mut navigator = Navigator::new(keeper, &policy());
    for input in inputs {
        navigator.take(&input, &mut |output| {
            if let Output::Attitude(attitude) = output {
                shown.push(attitude);
            }
        });
    }
    shown
}

/// An azimuth with its 1σ, °.
fn azimuth(angle: f64, sigma: f64) -> Azimuth {
    let [angle, sigma] = [angle, sigma].map(Radians::from_degrees);
    Azimuth { angle, sigma }
}

#[test]
fn a_body_that_turns_is_shown_ten_times_a_second_with_its_rates() {
    let shown = shown(&mut keeper(), (1..=1000).map(|index| moved(index, TURN)));
    assert_eq!(shown.len(), 99, "ten seconds but for the first look");
    let times: Vec<u64> = shown.iter().map(|attitude| attitude.time.0).collect();
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] == 100_000), "{times:?}");
    let latest = shown.last().expect("there is one");
    let [forward, right, down] = latest.rates.expect("nothing is saturated").map(|rate| rate.0);
    assert!(forward.abs() < 1e-6 && right.abs() < 1e-6, "{forward} {right}");
    assert!((down - 10.0 * DEGREE).abs() < 1e-5, "{down}");
    // The Earth turns below, the other way round as seen from above.
    let turn = latest.rate_of_turn.expect("the biases are known").0 - 10.0 * DEGREE;
    let expected = EARTH_RATE * 0.5_f64.sqrt();
    assert!((turn - expected).abs() < 0.05 * expected, "{turn}, not {expected}");
}

#[test]
fn rates_are_unknown_while_a_gyro_is_at_the_limit_of_its_range() {
    let inputs = (1..=500).map(|index| {
        let mut sample = sample(index, 0.0);
        if index == 255 {
            sample.turned[1] = AngleIncrement(i32::MAX);
        }
        Input::Motion(Motion::Moved(sample))
    });
    let shown = shown(&mut keeper(), inputs);
    let known = |attitude: &Attitude| attitude.rates.is_some();
    let lost: Vec<u64> =
        shown.iter().filter(|it| !known(it)).map(|attitude| attitude.time.0).collect();
    assert_eq!(lost, [2_610_000]);
    assert!(shown.iter().all(|it| known(it) || it.rate_of_turn.is_none()));
}

/// A coarse gyro's bias is that of 2 °/s, which would be a rate of turn of 120 °/min.
#[test]
fn a_rate_of_turn_is_not_stated_before_a_rest_has_shown_the_biases() {
    let coarse = Gyro { bias_sigma: RadiansPerSecond(3.0 * DEGREE), ..Gyro::coarse() };
    let latitude = Latitude::from_degrees(45.0).expect("a latitude");
    let setting = Setting { gyros: [coarse; 3], ..Setting::coarse(latitude, Seconds(0.01)) };
    let inputs = (1..=6000).map(|index| moved(index, 0.02 * DEGREE));
    let shown = shown(&mut Keeper::new(&setting), inputs);
    let first = shown.iter().position(|attitude| attitude.rate_of_turn.is_some());
    let first = first.expect("a minute at rest shows the bias");
    assert!(first > 5, "it is known after {first} looks");
    for attitude in &shown[first..] {
        let turn = attitude.rate_of_turn.map_or(0.0, |turn| turn.0 / DEGREE * 60.0);
        assert!(turn.abs() < 2.0, "{turn} °/min");
    }
}

#[test]
fn an_azimuth_is_set_anew_where_it_is_taken_and_not_where_it_is_confirmed() {
    let found = |second: u64, azimuth| Input::Found(Instant(second * 1_000_000), azimuth);
    let events = [
        (100, found(1, azimuth(100.0, 0.1))),
        // Confirmed by another alignment, and from outside.
        (200, found(2, azimuth(100.05, 0.1))),
        (300, Input::Aided(None, Some(azimuth(100.1, 0.2)))),
        // Contradicted, so that none is left; then taken anew, from outside.
        (400, Input::Aided(None, Some(azimuth(130.0, 0.1)))),
        (500, Input::Aided(None, Some(azimuth(130.0, 0.1)))),
        // Confirmed by an alignment, whose it is then.
        (600, found(6, azimuth(130.05, 0.1))),
    ];
    let inputs = (1..=700).flat_map(|index| {
        let event = events.iter().find(|(at, _)| *at == index).map(|(_, event)| *event);
        event.into_iter().chain([moved(index, 0.0), Input::Settled])
    });
    let shown = shown(&mut keeper(), inputs);
    let at = |second: f64| {
        let attitude = &shown[(10.0 * second) as usize - 2];
        (attitude.azimuth.is_some(), attitude.resets, attitude.is_from_outside)
    };
    assert_eq!(at(0.8), (false, 0, false));
    assert_eq!([1.8, 2.8, 3.8].map(at), [(true, 1, false); 3]);
    assert_eq!(at(4.8), (false, 1, false));
    assert_eq!(at(5.8), (true, 2, true));
    assert_eq!(at(6.8), (true, 2, false));
    let since = shown.last().and_then(|attitude| attitude.since_aligned);
    assert!(since.is_some_and(|since| (0.9..1.1).contains(&since.0)), "{since:?}");
}
