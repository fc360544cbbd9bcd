//! Settings by their names: what was stated is shown again to its last decimal place, in the unit that was stated, and
//! whatever is not possible changes nothing.

use std::collections::BTreeSet;

use firmware::settings::{
    CALIBRATIONS, EditError, Editable, LONGEST, Output, PlatformCalibration, Serial, Settings,
    SpinCalibration, SpinSchedule, StageSchedule, Stated, TurntableCalibration, TurntableSchedule,
    TwoFrameSchedule, VehicleSchedule,
};
use hal_mock::noise::Generator;
use orientation::alignment::setup::SetupError;

use super::{SERIAL, read, settings, spin, stage, turntable, two_frame, vehicle};

/// Random values of each setting that are stated and shown.
const VALUES: u64 = 300;
/// Most digits of a number that is stated.
const DIGITS: u32 = 15;

/// A number among settings: its name, decimal places, and least and greatest value in its user's unit.
type Number = (&'static str, u32, f64, f64);

/// What the link sends, and when an alignment begins. The rates are among few numbers.
const OUTPUT: &[Number] = &[("baud", 0, 4800.0, 921_600.0), ("mav_system", 0, 1.0, 254.0)];
const RATES: [&str; 10] = [
    "hdt_rate",
    "ths_rate",
    "rot_rate",
    "phtro_rate",
    "phinf_rate",
    "pmrds_rate",
    "pmrdl_rate",
    "attitude_rate",
    "vision_rate",
    "sysstatus_rate",
];

/// What all have that find an azimuth. Where no other limit is known, it is that of the digits.
const AZIMUTH: &[Number] = &[
    ("latitude", 7, -85.0, 85.0),
    ("accuracy", 4, 0.0006, 180.0),
    ("gyro_scale", 10, 1e-10, 99_999.0),
    ("gyro_scale_sigma", 7, 0.0, 1.0),
    ("gyro_limit", 4, 0.0042, 123.04),
    ("gyro_q", 5, 0.0, 9_999_999_999.0),
    ("gyro_n", 7, 0.0, 99_999_999.0),
    ("gyro_b", 6, 0.0, 999_999_999.0),
    ("gyro_k", 6, 0.0, 999_999_999.0),
    ("gyro_r", 6, 0.0, 999_999_999.0),
    ("gyro_bias_sigma", 5, 0.0, 442_900.0),
];

/// What gravity does to the sensors.
const FELT: &[Number] = &[
    ("g_along", 5, -1000.0, 1000.0),
    ("g_across", 5, -1000.0, 1000.0),
    ("g_sigma", 5, 0.0, 1000.0),
    ("force_sigma", 4, 0.0, 1000.0),
];

const ENCODER: &[Number] = &[
    ("encoder_sin_1", 5, -10.0, 10.0),
    ("encoder_cos_1", 5, -10.0, 10.0),
    ("encoder_sin_2", 5, -10.0, 10.0),
    ("encoder_cos_2", 5, -10.0, 10.0),
    ("encoder_sigma", 5, 0.0, 10.0),
];

const STAGE: &[Number] = &[
    ("positions", 0, 2.0, 64.0),
    ("dwell", 3, 0.5, 600.0),
    ("survey", 3, 60.0, 36_000.0),
    ("allowed", 3, 60.0, 36_000.0),
];

const TWO_FRAME: &[Number] = &[("passes", 0, 1.0, 16.0), ("dwell", 3, 0.5, 600.0)];

const FRAMES: &[Number] = &[
    ("encoder_in_sin_1", 5, -10.0, 10.0),
    ("encoder_in_cos_1", 5, -10.0, 10.0),
    ("encoder_in_sin_2", 5, -10.0, 10.0),
    ("encoder_in_cos_2", 5, -10.0, 10.0),
    ("frame_azimuth", 5, -10.0, 10.0),
    ("frame_pitch", 5, -10.0, 10.0),
    ("frame_square", 5, -10.0, 10.0),
    ("frame_gyro", 5, -10.0, 10.0),
    ("frame_outer_zero", 5, -10.0, 10.0),
    ("frame_inner_zero", 5, -10.0, 10.0),
    ("frame_sigma", 5, 0.0, 10.0),
];

const TURNTABLE: &[Number] = &[
    ("speed_1", 6, 0.02, 0.5),
    ("speed_2", 6, 0.02, 0.5),
    ("turns", 0, 2.0, 1000.0),
    ("modulated_turns", 0, 4.0, 1000.0),
];

const INDEX: &[Number] = &[
    ("encoder_0_sigma", 5, 0.0, 180.0),
    ("index_cw", 4, 0.0, 360.0),
    ("index_ccw", 4, 0.0, 360.0),
];

const VEHICLE: &[Number] = &[("stops", 0, 2.0, 8.0), ("stop", 3, 10.0, 3600.0)];

const SPIN: &[Number] = &[
    ("course", 4, -360.0, 360.0),
    ("pitch", 4, -90.0, 90.0),
    ("spin_x_scale", 12, 2e-8, 17.4),
    ("spin_x_limit", 2, 0.58, 57_295_779.0),
    ("spin_y_scale", 12, 2e-8, 17.4),
    ("spin_y_limit", 2, 0.58, 57_295_779.0),
    ("spin_z_scale", 12, 2e-8, 17.4),
    ("spin_z_limit", 2, 0.58, 57_295_779.0),
    ("spin_fy_scale", 9, 1e-6, 1000.0),
    ("spin_fy_limit", 2, 0.01, 1_000_000.0),
    ("spin_fz_scale", 9, 1e-6, 1000.0),
    ("spin_fz_limit", 2, 0.01, 1_000_000.0),
    ("spin_n", 5, 0.0, 1000.0),
    ("spin_scale_sigma", 7, 0.0, 1.0),
    ("spin_bias_sigma", 3, 0.0, 10_000_000.0),
];

/// Choices and their words.
type Choice = (&'static str, &'static [&'static str]);
const FLAG: &[&str] = &["no", "yes"];
const HALF: Choice = ("half", &["none", "east", "west"]);
/// Choices of every carrier, and of all that find an azimuth.
const COMMON: [Choice; 2] = [("output", &["nmea", "mavlink"]), ("autostart", FLAG)];
const HOLD: Choice = ("hold", FLAG);

/// A carrier: its settings, the numbers among them, and the choices.
struct Carrier {
    settings: Box<dyn Editable>,
    numbers: Vec<Number>,
    choices: Vec<Choice>,
}

/// Every carrier, with a link that is as usual.
fn carriers() -> Vec<Carrier> {
    fn of<E: Editable + 'static>(
        settings: E,
        numbers: &[&[Number]],
        choices: &[Choice],
    ) -> Carrier {
        let numbers = [OUTPUT].iter().chain(numbers).flat_map(|part| part.iter().copied());
        let choices = COMMON.iter().chain(choices).copied().collect();
        Carrier { settings: Box::new(settings), numbers: numbers.collect(), choices }
    }
    let output = Output::default();
    let driving = [HOLD, ("realigns", FLAG), ("align_known", FLAG)];
    let turning = [HOLD, ("sensor", &["gyro", "molecular"][..])];
    vec![
        of(
            Settings { output, ..settings(stage()) },
            &[AZIMUTH, STAGE, FELT, ENCODER],
            &[HOLD, HALF],
        ),
        of(
            Settings { output, ..settings(two_frame()) },
            &[AZIMUTH, TWO_FRAME, FELT, ENCODER, FRAMES],
            &[HOLD, HALF],
        ),
        of(
            Settings { output, ..settings(turntable()) },
            &[AZIMUTH, TURNTABLE, FELT, ENCODER, INDEX],
            &turning,
        ),
        of(Settings { output, ..settings(vehicle()) }, &[AZIMUTH, VEHICLE, FELT], &driving),
        of(Settings { output, ..settings(spin()) }, &[SPIN], &[]),
    ]
}

/// All settings in their order.
fn all(settings: &mut dyn Editable) -> Vec<Stated> {
    let all: Vec<Stated> = settings.all().collect();
    assert_eq!(all.len(), settings.count());
    assert_eq!(settings.nth(all.len()), None);
    all
}

/// States a setting by a text, as a terminal does.
fn state(settings: &mut dyn Editable, name: &str, text: &str) -> Result<(), EditError> {
    let value = settings.parse(name, text)?;
    settings.set(name, value)
}

/// What is shown for a setting.
fn shown(settings: &mut dyn Editable, name: &str) -> String {
    settings.get(name).expect("there is such a setting").to_string()
}

/// The decimal number of so many units of its last place.
fn decimal(count: i64, places: u32) -> String {
    let digits = format!("{:0width$}", count.unsigned_abs(), width = places as usize + 1);
    let (whole, part) = digits.split_at(digits.len() - places as usize);
    let part = part.trim_end_matches('0');
    let sign = if count < 0 { "-" } else { "" };
    if part.is_empty() { format!("{sign}{whole}") } else { format!("{sign}{whole}.{part}") }
}

#[test]
fn every_name_is_short_plain_and_one_of_a_kind() {
    for Carrier { mut settings, numbers, choices } in carriers() {
        let all = all(&mut *settings);
        for Stated { name, .. } in &all {
            let is_plain = |letter: u8| matches!(letter, b'a'..=b'z' | b'0'..=b'9' | b'_');
            assert!(name.bytes().all(is_plain) && name.len() <= LONGEST, "{name}");
        }
        let names: BTreeSet<_> = all.iter().map(|stated| stated.name).collect();
        assert_eq!(names.len(), all.len(), "{all:?}");
        let known = numbers.iter().map(|number| number.0).chain(choices.iter().map(|it| it.0));
        assert_eq!(names, known.chain(RATES).collect());
    }
    assert_eq!(LONGEST, 16, "as a parameter of MAVLink");
}

/// The beginning of a name tells them apart.
#[test]
fn calibrations_alone_begin_as_calibrations_do() {
    let gyro = &AZIMUTH[2..];
    let spinning = &SPIN[2..];
    let measured = [gyro, FELT, ENCODER, FRAMES, INDEX, spinning].concat();
    let measured: BTreeSet<_> = measured.iter().map(|number| number.0).collect();
    for Carrier { mut settings, .. } in carriers() {
        for Stated { name, .. } in all(&mut *settings) {
            let begins = CALIBRATIONS.iter().any(|beginning| name.starts_with(beginning));
            assert_eq!(begins, measured.contains(name), "{name}");
        }
    }
}

#[test]
fn every_number_within_its_range_is_shown_as_it_was_stated_to_its_last_place() {
    let mut noise = Generator::new(1);
    for Carrier { mut settings, numbers, .. } in carriers() {
        for (name, places, least, greatest) in numbers {
            assert_eq!(settings.get(name).map(|stated| stated.places.into()), Some(places));
            let unit = 10_f64.powi(places.cast_signed());
            let ends = [(least * unit).round(), (greatest * unit).round()].map(|end| end as i64);
            let [first, last] =
                ends.map(|end| end.clamp(1 - 10_i64.pow(DIGITS), 10_i64.pow(DIGITS) - 1));
            let span = last.abs_diff(first) + 1;
            let chosen = (0..VALUES).map(|_| first + (noise.next_u64() % span).cast_signed());
            // Numbers of every size, beside those that are as great as can be.
            let chosen: Vec<i64> = chosen.collect();
            let small =
                (0..VALUES).map(|_| (noise.next_u64() >> (noise.next_u64() % 64)).cast_signed());
            let small = small.filter(|count| (first..=last).contains(count)).collect::<Vec<_>>();
            for count in [first, last].into_iter().chain(chosen).chain(small) {
                let text = decimal(count, places);
                assert_eq!(state(&mut *settings, name, &text), Ok(()), "{name} {text}");
                assert_eq!(shown(&mut *settings, name), text, "{name}");
            }
        }
    }
}

#[test]
fn every_word_of_a_choice_is_shown_as_it_was_stated() {
    for Carrier { mut settings, choices, .. } in carriers() {
        for (name, words) in choices {
            assert_eq!(settings.get(name).map(|stated| stated.words), Some(words));
            for (index, word) in words.iter().enumerate() {
                assert_eq!(state(&mut *settings, name, word), Ok(()), "{name} {word}");
                assert_eq!(shown(&mut *settings, name), *word, "{name}");
                assert_eq!(settings.get(name).map(|stated| stated.value), Some(index as f64));
            }
            for wrong in ["", "1", "Yes", "gyros"] {
                let refused = state(&mut *settings, name, wrong);
                assert_eq!(refused, Err(EditError::NoSuchWord(words)), "{name} {wrong}");
                let reason = format!("not one of {}", words.join(" "));
                assert_eq!(refused.expect_err("it is").to_string(), reason);
            }
        }
        for rate in RATES {
            for hertz in ["0", "1", "2", "5", "10"] {
                let is_possible = rate != "vision_rate" || ["0", "10"].contains(&hertz);
                assert_eq!(state(&mut *settings, rate, hertz).is_ok(), is_possible);
                assert_eq!(shown(&mut *settings, rate) == hertz, is_possible, "{rate}");
            }
            assert_eq!(state(&mut *settings, rate, "0"), Ok(()));
        }
    }
}

#[test]
fn latitude_survey_time_allowed_half_and_second_speed_may_be_absent_and_nothing_else() {
    const ABSENT: [&str; 5] = ["latitude", "survey", "allowed", "half", "speed_2"];
    for Carrier { mut settings, .. } in carriers() {
        for Stated { name, .. } in all(&mut *settings) {
            let done = state(&mut *settings, name, "none");
            assert_eq!(done.is_ok(), ABSENT.contains(&name), "{name}: {done:?}");
            if done.is_ok() {
                assert_eq!(shown(&mut *settings, name), "none");
            }
        }
    }
}

/// A platform that turns at no speed at all is none.
#[test]
fn a_second_speed_is_added_and_taken_away_and_the_first_one_stays() {
    let mut settings = settings(turntable());
    let editable: &mut dyn Editable = &mut settings;
    assert_eq!(state(editable, "speed_2", "none"), Ok(()));
    assert_eq!(state(editable, "speed_1", "0.137"), Ok(()));
    assert_eq!(shown(editable, "speed_2"), "none");
    assert!(matches!(state(editable, "speed_1", "none"), Err(EditError::OutOfRange(_))));
    assert_eq!(shown(editable, "speed_1"), "0.137");
    assert_eq!(state(editable, "speed_2", "0.25"), Ok(()));
    assert_eq!([shown(editable, "speed_1"), shown(editable, "speed_2")], ["0.137", "0.25"]);
}

/// The carrier by its index in [`carriers`], a setting, and what it cannot be.
const BEYOND: [(usize, &str, &str); 23] = [
    (0, "vision_rate", "5"),
    (0, "baud", "4799"),
    (0, "mav_system", "0"),
    (0, "hdt_rate", "3"),
    (0, "latitude", "85.0000001"),
    (0, "latitude", "-90"),
    (0, "accuracy", "-0.0001"),
    (0, "gyro_scale", "0"),
    (0, "gyro_limit", "123.05"),
    (0, "gyro_n", "-0.0000001"),
    (0, "positions", "65"),
    (0, "dwell", "0.499"),
    (0, "survey", "59.999"),
    (1, "encoder_in_cos_2", "10.00001"),
    (1, "frame_inner_zero", "-10.00001"),
    (1, "g_across", "1000.00001"),
    (2, "speed_1", "0.500001"),
    (2, "modulated_turns", "3"),
    (2, "index_ccw", "360.0001"),
    (3, "force_sigma", "1000.0001"),
    (3, "stops", "9"),
    (4, "pitch", "90.0001"),
    (4, "spin_fz_scale", "0"),
];

#[test]
fn what_is_not_possible_is_refused_with_the_quantity_and_changes_nothing() {
    for (index, name, text) in BEYOND {
        let Carrier { mut settings, numbers, .. } = carriers().swap_remove(index);
        let (before, record) = (all(&mut *settings), settings.to_record(&SERIAL));
        let refused = state(&mut *settings, name, text).expect_err("it is not possible");
        let range = numbers.iter().find(|(other, ..)| *other == name);
        let range = range.map(|(.., least, greatest)| [*least, *greatest]);
        match refused {
            EditError::Beyond([least, greatest]) => {
                let [from, to] = range.expect("it is a number");
                let slack = 1e-6 * to.abs();
                assert!(least <= from + slack && to - slack <= greatest, "{name}: {refused}");
                let wrong = settings.parse(name, text).expect("a number");
                assert!(!(least + slack..=greatest - slack).contains(&wrong), "{name}: {refused}");
            }
            EditError::NotAmong(choices) => assert!(choices.ends_with(" Hz"), "{choices}"),
            _ => panic!("{name} {text} is not refused for that: {refused:?}"),
        }
        assert_eq!(all(&mut *settings).len(), before.len());
        assert_eq!(settings.to_record(&SERIAL), record, "{name} {text}");
    }
}

#[test]
fn a_range_is_told_in_the_users_unit() {
    let reasons = [
        (0, "latitude", "86", "not from -85 to 85"),
        (0, "dwell", "0.1", "not from 0.5 to 600"),
        (2, "speed_1", "0.6", "not from 0.02 to 0.5"),
        (4, "pitch", "91", "not from -90 to 90"),
    ];
    for (index, name, text, reason) in reasons {
        let Carrier { mut settings, .. } = carriers().swap_remove(index);
        let refused = state(&mut *settings, name, text).expect_err("it is not possible");
        assert_eq!(refused.to_string(), reason, "{name}");
    }
}

#[test]
fn two_positions_are_taken_once_the_half_of_the_circle_is_stated() {
    let mut settings = settings(stage());
    let editable: &mut dyn Editable = &mut settings;
    assert_eq!(state(editable, "half", "none"), Ok(()));
    // A survey plans others.
    assert_eq!(state(editable, "survey", "none"), Ok(()));
    let refused = state(editable, "positions", "2");
    assert_eq!(refused, Err(EditError::OutOfRange(SetupError::TwoPositions)));
    assert_eq!(state(editable, "half", "west"), Ok(()));
    assert_eq!(state(editable, "positions", "2"), Ok(()));
    let refused = state(editable, "half", "none");
    assert_eq!(refused, Err(EditError::OutOfRange(SetupError::TwoPositions)));
}

/// So a program may set what it has read, whatever its own number was rounded to.
#[test]
fn a_setting_that_is_given_what_it_shows_stays_as_it_is() {
    for Carrier { mut settings, .. } in carriers() {
        let record = settings.to_record(&SERIAL);
        for stated in all(&mut *settings) {
            assert_eq!(state(&mut *settings, stated.name, &stated.to_string()), Ok(()));
            assert_eq!(settings.to_record(&SERIAL), record, "{}", stated.name);
        }
    }
}

/// A rate that the link cannot carry is refused, though it is one of the rates.
#[test]
fn what_is_possible_alone_is_refused_where_it_is_not_beside_the_others() {
    let mut settings = Settings { output: Output::default(), ..settings(stage()) };
    let editable: &mut dyn Editable = &mut settings;
    assert_eq!(state(editable, "baud", "4800"), Ok(()));
    let refused = state(editable, "pmrds_rate", "10").expect_err("the link is slow");
    assert!(refused.to_string().starts_with("bytes a second on the link is"), "{refused}");
    assert_eq!(shown(editable, "pmrds_rate"), "1");
    assert_eq!(state(editable, "baud", "38400"), Ok(()));
    assert_eq!(state(editable, "pmrds_rate", "10"), Ok(()));
}

#[test]
fn what_is_no_value_of_a_setting_is_refused_by_a_reason() {
    let mut settings = settings(stage());
    let editable: &mut dyn Editable = &mut settings;
    let not_held = [("positions", 2.5), ("positions", 256.0), ("positions", -1.0), ("hold", 2.0)];
    for (name, value) in not_held {
        assert_eq!(editable.set(name, value), Err(EditError::NotHeld), "{name} {value}");
    }
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(editable.set("dwell", value), Err(EditError::NotHeld));
        assert_eq!(editable.set("hold", value), Err(EditError::NotHeld));
        assert_eq!(editable.set("baud", value), Err(EditError::NotHeld));
    }
    assert_eq!(editable.set("latitude", 91.0), Err(EditError::NotHeld));
    // Whatever it is now: it is not rounded.
    for held in [23.0, 24.0] {
        assert_eq!(editable.set("positions", held), Ok(()));
        assert_eq!(editable.set("positions", 24.4), Err(EditError::NotHeld), "beside {held}");
        assert_eq!(editable.set("positions", 23.6), Err(EditError::NotHeld), "beside {held}");
    }
    assert_eq!(editable.set("latitude", f64::INFINITY), Err(EditError::NotHeld));
    assert_eq!(editable.set("speed_1", 0.1), Err(EditError::Unknown), "a stage has none");
    assert_eq!(state(editable, "Latitude", "45"), Err(EditError::Unknown));
    for text in ["", "1e3", "4 5", "+1", "nan", "inf", "0x10", "1,5", "1234567890.1234567"] {
        assert_eq!(state(editable, "dwell", text), Err(EditError::NotANumber), "{text}");
    }
    let words = [EditError::Unknown, EditError::NotANumber, EditError::NotHeld]
        .map(|error| error.to_string());
    assert_eq!(words, ["no such setting", "not a number", "not a value of this setting"]);
}

/// Whether a number is that of SI units to twelve digits.
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found}, not {expected}");
}

/// Each in the user's unit, against SI units that were computed by hand.
#[test]
fn the_units_of_the_common_settings_are_those_of_their_users() {
    let mut settings = settings(stage());
    let editable: &mut dyn Editable = &mut settings;
    for (name, text) in [
        ("latitude", "-47.58"),
        ("accuracy", "0.05"),
        ("gyro_scale", "-0.05"),
        ("gyro_limit", "38.8"),
        ("gyro_q", "0.2"),
        ("gyro_n", "0.001"),
        ("gyro_b", "0.007"),
        ("gyro_k", "0.06"),
        ("gyro_r", "3.6"),
        ("gyro_bias_sigma", "0.5"),
        ("gyro_scale_sigma", "0.0005"),
        ("survey", "600"),
    ] {
        assert_eq!(state(editable, name, text), Ok(()), "{name}");
    }
    let degree = core::f64::consts::PI / 180.0;
    let noise = settings.gyro.errors.noise;
    near(settings.latitude.expect("it was stated").rad(), -0.830_427_658_098_9);
    near(settings.required_sigma.0, 8.726_646_259_971_648e-4);
    near(settings.gyro.volts_per_rad_per_s, -2.864_788_975_654_116);
    near(settings.gyro.limit.0, 0.677_187_749_773_799_8);
    near(noise.quantisation.0, 0.2 * degree / 3600.0);
    near(noise.angle_random_walk.0, 2.908_882_086_657_216e-7);
    near(noise.bias_instability.0, 0.007 * degree / 3600.0);
    near(noise.rate_random_walk.0, 0.001 * degree / 3600.0);
    near(noise.rate_ramp.0, 0.001 * degree / 3600.0);
    near(settings.gyro.errors.bias_sigma.0, 2.424_068_405_547_680_4e-6);
    near(settings.gyro.errors.scale_sigma, 5e-4);
    near(settings.schedule.survey.expect("it was stated").0, 600.0);
}

#[test]
fn the_units_of_calibrations_are_those_of_their_users() {
    let degree = core::f64::consts::PI / 180.0;
    let mut turntable = settings(turntable());
    let editable: &mut dyn Editable = &mut turntable;
    for (name, text) in [
        ("speed_1", "0.1"),
        ("g_across", "-0.03"),
        ("force_sigma", "8.3"),
        ("encoder_cos_2", "0.02"),
        ("index_cw", "30"),
    ] {
        assert_eq!(state(editable, name, text), Ok(()), "{name}");
    }
    let TurntableCalibration { platform, index, .. } = turntable.calibration;
    near(turntable.schedule.speeds[0].0, 0.628_318_530_717_958_6);
    near(platform.felt.g_sensitivity[1].0, -0.03 * degree / 3600.0);
    near(platform.felt.force_bias_sigma.0, 0.081_395_195);
    near(platform.encoder.second[1].into(), f64::from((0.02 * degree) as f32));
    near(index[0].0, 0.523_598_775_598_298_8);
    let mut spin = settings(spin());
    let editable: &mut dyn Editable = &mut spin;
    for (name, text) in [("spin_x_scale", "0.00005"), ("spin_x_limit", "36000"), ("spin_n", "0.5")]
    {
        assert_eq!(state(editable, name, text), Ok(()), "{name}");
    }
    near(spin.calibration.gyros[0].scale, 2.864_788_975_654_116e-3);
    near(spin.calibration.gyros[0].limit, 628.318_530_717_958_6);
    near(spin.calibration.angle_random_walk.0, 1.454_441_043_328_608e-4);
}

/// As test sheets and data sheets have them.
#[test]
fn the_calibrations_of_an_instrument_that_was_not_calibrated_are_shown_in_round_numbers() {
    let calibration = PlatformCalibration::default();
    let mut stage = Settings { calibration, ..settings(stage()) };
    let editable: &mut dyn Editable = &mut stage;
    let names = ["g_along", "g_sigma", "force_sigma", "encoder_sin_1", "encoder_sigma"];
    assert_eq!(names.map(|name| shown(editable, name)), ["0", "0.1", "8.3", "0", "0.05"]);
    let calibration = TurntableCalibration::default();
    let mut turntable = Settings { calibration, ..settings(turntable()) };
    let editable: &mut dyn Editable = &mut turntable;
    let names = ["encoder_0_sigma", "index_cw", "index_ccw", "sensor"];
    assert_eq!(names.map(|name| shown(editable, name)), ["0.15", "30", "40", "gyro"]);
    let mut spin = Settings { calibration: SpinCalibration::default(), ..settings(spin()) };
    let editable: &mut dyn Editable = &mut spin;
    let names = ["spin_x_scale", "spin_x_limit", "spin_fy_scale", "spin_n", "spin_bias_sigma"];
    // 2 V for 700 rad/s.
    let expected = ["0.00004986655", "38961.13", "0.0002", "0.5", "200"];
    assert_eq!(names.map(|name| shown(editable, name)), expected);
}

/// What a file has of the settings of one board is that of another, when it is stated there.
#[test]
fn what_is_shown_of_all_settings_makes_the_same_settings_where_it_is_stated() {
    fn copied<C: super::Calibrated>(from: Settings<C>, to: &mut Settings<C>) {
        let mut from = from;
        for stated in all(&mut from) {
            assert_eq!(state(to, stated.name, &stated.to_string()), Ok(()), "{}", stated.name);
        }
        assert_eq!(all(&mut from).len(), all(to).len());
        for (theirs, ours) in all(&mut from).into_iter().zip(all(to)) {
            assert_eq!(theirs.to_string(), ours.to_string(), "{}", theirs.name);
        }
        let serial = Serial([7; 12]);
        let record = to.to_record(&serial).expect("they are in range");
        assert_eq!(Settings::from_record(&record, &serial).as_ref(), Ok(&*to));
        assert!(read::<C>(&record).is_err(), "it is of another board");
    }
    let output = Output { rates: [0; 10], ..Output::default() };
    let mut other = Settings { output, latitude: None, ..settings(stage()) };
    other.calibration = PlatformCalibration::default();
    copied(settings(stage()), &mut other);
    let mut other = settings(StageSchedule { survey: None, half: None, ..stage() });
    copied(settings(stage()), &mut other);
    let speeds = turntable().speeds.into_iter().take(1).collect();
    copied(settings(turntable()), &mut settings(TurntableSchedule { speeds, ..turntable() }));
    copied(
        settings(TurntableSchedule { modulated_turns: 0, ..turntable() }),
        &mut settings(turntable()),
    );
    copied(settings(two_frame()), &mut settings(TwoFrameSchedule { passes: 1, ..two_frame() }));
    copied(settings(vehicle()), &mut settings(VehicleSchedule { realigns: false, ..vehicle() }));
    copied(settings(spin()), &mut settings(SpinSchedule { ..spin() }));
}
