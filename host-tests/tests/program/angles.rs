//! Angles as people write them: every way of writing gives the angle, and what is none is refused in a sentence.

use host::angle::{AngleError, Quantity, degrees};
use proptest::prelude::*;

use crate::support::program::{assert_misuse, code, meridian, object, reason};

/// Ways of writing degrees, minutes and seconds.
const WAYS: [[&str; 3]; 8] = [
    ["°", "′", "″"],
    ["°", "'", "\""],
    ["° ", "′ ", "″"],
    ["°", "’", "”"],
    ["°", "'", "''"],
    ["d", "m", "s"],
    [":", ":", ""],
    ["°", "′", ""],
];

/// An angle of so many arc seconds in one of the ways.
fn written(seconds: u32, [degree, minute, second]: [&str; 3]) -> String {
    let [whole, minutes, seconds] = [seconds / 3600, seconds / 60 % 60, seconds % 60];
    format!("{whole}{degree}{minutes}{minute}{seconds}{second}")
}

proptest! {
    #[test]
    fn every_way_of_writing_gives_the_angle(seconds in 0_u32..360 * 3600) {
        let expected = f64::from(seconds) / 3600.0;
        for way in WAYS {
            let text = written(seconds, way);
            for (text, sign) in [(text.clone(), 1.0), (format!("-{text}"), -1.0), (format!("−{text}"), -1.0), (format!("+{text}"), 1.0)] {
                let found = degrees(&text, Quantity::Other).expect("it is an angle");
                prop_assert!((found - sign * expected).abs() < 1e-12, "{text}: {found}");
            }
            for (letter, of, sign) in [('N', Quantity::Latitude, 1.0), ('S', Quantity::Latitude, -1.0), ('E', Quantity::Azimuth, 1.0), ('W', Quantity::Azimuth, -1.0)] {
                for text in [format!("{text}{letter}"), format!("{text} {letter}")] {
                    let found = degrees(&text, of).expect("it is an angle");
                    prop_assert!((found - sign * expected).abs() < 1e-12, "{text}: {found}");
                }
                prop_assert_eq!(degrees(&format!("-{text}{letter}"), of), Err(AngleError::SignAndLetter));
                prop_assert_eq!(degrees(&format!("{text}{letter}"), Quantity::Other), Err(AngleError::Letter(Quantity::Other)));
            }
        }
    }

    #[test]
    fn a_number_of_degrees_is_what_it_was(value in -360.0_f64..360.0) {
        prop_assert_eq!(degrees(&value.to_string(), Quantity::Latitude), Ok(value));
        prop_assert_eq!(degrees(&format!("{value}°"), Quantity::Azimuth), Ok(value));
    }

    #[test]
    fn the_last_part_alone_may_have_decimal_places(whole in 0_u32..90, tenths in 1_u32..600) {
        let minutes = f64::from(tenths) / 10.0;
        let found = degrees(&format!("{whole}°{minutes}′"), Quantity::Latitude);
        prop_assert!(found.is_ok_and(|found| (found - f64::from(whole) - minutes / 60.0).abs() < 1e-12));
        prop_assert_eq!(degrees(&format!("{whole}.5°{minutes}′"), Quantity::Latitude), Err(AngleError::Unknown));
    }

    #[test]
    fn sixty_minutes_or_seconds_are_none(whole in 0_u32..90, over in 60_u32..1000) {
        for text in [format!("{whole}°{over}′"), format!("{whole}:0:{over}"), format!("{whole}d{over}m0s")] {
            prop_assert_eq!(degrees(&text, Quantity::Latitude), Err(AngleError::Sixty));
        }
    }

    #[test]
    fn whatever_the_text_it_is_an_angle_or_an_error(text in "[-+−0-9.:°′″\'\"dmsNSEW e]{0,12}") {
        for of in [Quantity::Latitude, Quantity::Azimuth, Quantity::Other] {
            if let Ok(found) = degrees(&text, of) {
                prop_assert!(text.contains(|c: char| c.is_ascii_digit()) && !found.is_nan());
            }
        }
    }
}

#[test]
fn what_is_no_angle_is_refused_in_a_sentence_that_shows_one() {
    for text in [
        "",
        "north",
        "47,58",
        "47°35°",
        "35′47°",
        "1:2:3:4",
        ":",
        "°",
        "--5",
        "+-5",
        "4 7",
        "47.5.1",
    ] {
        assert_eq!(degrees(text, Quantity::Latitude), Err(AngleError::Unknown), "{text}");
    }
    for option in ["--latitude", "--azimuth", "--pitch", "--roll"] {
        assert_misuse(&["run", option, "much"], "not a number of degrees, as 47.58 or 47°35′20″");
        assert_misuse(&["run", option, "1°60′"], "minutes and seconds of an angle are below 60");
    }
    assert_misuse(&["run", "--latitude", "47E"], "a latitude has N or S behind it");
    assert_misuse(&["run", "--azimuth", "47N"], "an azimuth has E or W behind it");
    assert_misuse(&["run", "--pitch", "1W"], "neither N, S, E nor W has a meaning here");
    assert_misuse(&["run", "--latitude", "90°0′1″"], "outside ±90°");
}

#[test]
fn every_option_with_an_angle_takes_minutes() {
    let short = ["run", "--json", "--rate", "50", "--dwell", "2", "--positions", "6"];
    let place =
        ["--latitude", "33°54′S", "--azimuth", "12:30", "--pitch", "-1°30'", "--roll", "2d"];
    let output = meridian(&[&short[..], &place].concat());
    assert_eq!(code(&output), 0, "{}", reason(&output));
    let object = object(&output);
    let number = |key: &str| object[key].as_f64().expect("a number");
    assert!((number("azimuth_deg") - 12.5).abs() < 5.0 * number("sigma_deg"));
    assert!((number("pitch_deg") + 1.5).abs() < 0.05 && (number("roll_deg") - 2.0).abs() < 0.05);
    let plan = ["plan", "--arw", "0.001", "--latitude", "47°35′", "--sigma", "0°3′"];
    assert_eq!(code(&meridian(&plan)), 0);
}
