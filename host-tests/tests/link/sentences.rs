//! Sentences of NMEA 0183, by the published form of each, by a parser that others wrote, and for any report.

use nmea::ParseResult;
use orientation::alignment::Azimuth;
use orientation::device::Device;
use orientation::roll::Condition;
use orientation::units::{Radians, RadiansPerSecond, Seconds};
use proptest::prelude::*;
use protocol::nmea::{LONGEST, Sentence, WORDS, hdt, phinf, phtro, pmrdl, pmrds, rot, ths, txt};
use protocol::report::{Degradation, Level, Origin, Report, Roll, State};
use protocol::words::Words;

/// All sentences of a report.
const ALL: [fn(&Report) -> Option<Sentence>; 6] = [hdt, ths, rot, phtro, phinf, pmrds];

/// An azimuth and its 1σ, °.
#[expect(clippy::unnecessary_wraps, reason = "as a report has it")]
fn azimuth(angle: f64, sigma: f64) -> Option<Azimuth> {
    Some(Azimuth { angle: Radians::from_degrees(angle), sigma: Radians::from_degrees(sigma) })
}

/// Pitch, roll and their 1σ, °.
#[expect(clippy::unnecessary_wraps, reason = "as a report has it")]
fn level([pitch, roll, sigma]: [f64; 3]) -> Option<Level> {
    let [pitch, roll, sigma] = [pitch, roll, sigma].map(Radians::from_degrees);
    Some(Level { pitch, roll, sigma })
}

/// A report of an instrument that is ready.
fn ready() -> Report {
    Report {
        state: State::Ready,
        azimuth: azimuth(213.7023, 0.0388),
        level: level([1.2, -0.311, 0.0115]),
        rate_of_turn: Some(RadiansPerSecond(-12.34_f64.to_radians() / 60.0)),
        faults: 2,
        since_alignment: Some(Seconds(61.9)),
        ..Report::default()
    }
}

/// A sentence as text, without the end of its line; an empty one where none is sent.
fn text(sentence: Option<Sentence>) -> String {
    let sentence = sentence.map_or(String::new(), |sentence| sentence.to_string());
    sentence.strip_suffix("\r\n").map_or(sentence.clone(), str::to_owned)
}

/// All sentences of a report, as text.
fn texts(report: &Report) -> [String; 6] {
    ALL.map(|sentence| text(sentence(report)))
}

/// Checksums are those of an independent computation: the bytes between `$` and `*`, exclusive or.
#[test]
fn an_instrument_that_is_ready_says_all_that_it_knows() {
    let expected = [
        "$HEHDT,213.702,T*2A",
        "$HETHS,213.702,A*28",
        "$HEROT,-12.3,A*36",
        "$PHTRO,1.20,M,0.31,B*5F",
        "$PHINF,00000000*75",
        "$PMRDS,ready,0.039,0.012,0.012,2,61,,,*0E",
    ];
    assert_eq!(texts(&ready()), expected);
}

#[test]
fn an_instrument_that_knows_nothing_yet_sends_no_number() {
    let expected = [
        "$HEHDT,,T*01",
        "$HETHS,,V*14",
        "$HEROT,,V*12",
        "",
        "$PHINF,00000007*72",
        "$PMRDS,waiting,,,,0,,,,*2F",
    ];
    assert_eq!(texts(&Report::default()), expected);
}

#[test]
fn an_alignment_that_runs_is_told_with_its_progress_and_the_level_that_is_known() {
    let aligning = Report {
        state: State::Aligning,
        azimuth: None,
        since_alignment: None,
        progress: Some([5, 24]),
        ..ready()
    };
    let [heading, moded, _, inclination, status, own] = texts(&aligning);
    assert_eq!((heading.as_str(), moded.as_str()), ("$HEHDT,,T*01", "$HETHS,,V*14"));
    assert_eq!(inclination, "$PHTRO,1.20,M,0.31,B*5F");
    assert_eq!(status, "$PHINF,00000021*76");
    assert!(own.starts_with("$PMRDS,aligning,,0.012,0.012,2,,5,24,*"), "{own}");
}

/// HDT has no sign of its validity, and some receivers take whatever number it has.
#[test]
fn a_heading_without_a_mode_is_sent_only_where_it_may_be_used_without_care() {
    let modes = [
        (State::Waiting, Origin::Gyros, 'V', false),
        (State::Aligning, Origin::Gyros, 'V', false),
        (State::Failed, Origin::Gyros, 'V', false),
        (State::Ready, Origin::Gyros, 'A', true),
        (State::Ready, Origin::Outside, 'M', true),
        (State::Ready, Origin::Simulation, 'S', true),
        (State::Degraded(Degradation::Recalled), Origin::Gyros, 'E', false),
        (State::Degraded(Degradation::Coasting), Origin::Outside, 'E', false),
        (State::Degraded(Degradation::Uncertain), Origin::Simulation, 'S', false),
    ];
    for (state, origin, mode, is_sent) in modes {
        let report = Report { state, origin, ..ready() };
        let [heading, moded, ..] = texts(&report);
        assert_eq!(heading.contains("213.702"), is_sent, "{state}: {heading}");
        assert!(moded.contains(&format!(",{mode}*")), "{state}: {moded}");
        assert_eq!(moded.contains("213.702"), mode != 'V', "{state}: {moded}");
    }
}

/// An azimuth or a σ that is none is never sent, whatever the state says.
#[test]
fn numbers_that_are_none_are_not_sent() {
    for (angle, sigma) in [(f64::NAN, 0.1), (f64::INFINITY, 0.1), (10.0, f64::NAN), (10.0, 0.0)] {
        let report = Report { azimuth: azimuth(angle, sigma), ..ready() };
        let [heading, moded, ..] = texts(&report);
        assert_eq!((heading.as_str(), moded.as_str()), ("$HEHDT,,T*01", "$HETHS,,V*14"));
    }
    let report = Report { rate_of_turn: Some(RadiansPerSecond(f64::NAN)), ..ready() };
    assert_eq!(text(rot(&report)), "$HEROT,,V*12");
}

#[test]
fn what_rounds_to_a_full_turn_is_zero_and_what_rounds_to_zero_has_no_sign() {
    let report = Report {
        azimuth: azimuth(359.9996, 0.1),
        level: level([-0.004, -0.0049, 0.1]),
        rate_of_turn: Some(RadiansPerSecond(-1e-6)),
        ..ready()
    };
    let [heading, _, rate, inclination, ..] = texts(&report);
    assert!(heading.starts_with("$HEHDT,0.000,T"), "{heading}");
    assert!(rate.starts_with("$HEROT,0.0,A"), "{rate}");
    assert!(inclination.starts_with("$PHTRO,0.00,M,0.00,T"), "{inclination}");
}

/// Pitch: M bow up, P bow down; roll: T port up, B port down.
#[test]
fn the_letters_of_pitch_and_roll_are_those_of_fibre_optic_gyrocompasses() {
    let letters =
        |pitch, roll| text(phtro(&Report { level: level([pitch, roll, 0.1]), ..ready() }));
    assert!(letters(1.0, 2.0).starts_with("$PHTRO,1.00,M,2.00,T*"));
    assert!(letters(-1.0, -2.0).starts_with("$PHTRO,1.00,P,2.00,B*"));
}

#[test]
fn devices_that_have_failed_are_bits_of_the_status() {
    let word = |devices: &[Device]| {
        let mut report = ready();
        for device in devices {
            report.failed.insert(*device);
        }
        text(phinf(&report))[7..15].to_owned()
    };
    assert_eq!(word(&[Device::Gyro]), "00000100");
    assert_eq!(word(&[Device::RightGyro, Device::DownGyro]), "00000600");
    assert_eq!(word(&[Device::Accelerometer]), "00001000");
    assert_eq!(word(&[Device::UpAccelerometer, Device::RightAccelerometer]), "00006000");
    assert_eq!(word(&[Device::Encoder]), "00000000");
}

#[test]
fn words_lose_what_a_sentence_may_not_have() {
    let whole = txt(Words(&"last reset: panic"), 0);
    assert_eq!(text(whole), "$HETXT,01,01,00,last reset: panic*65");
    let odd = text(txt(Words(&"a,b*c$d\\e^f!g\r\n° é"), 0));
    assert!(odd.starts_with("$HETXT,01,01,00,a;b c d e f g   deg  *"), "{odd}");
    let long = "x".repeat(3 * WORDS + 1);
    assert_eq!(text(txt(Words(&long), 2)).len(), LONGEST - 2);
    assert!(text(txt(Words(&long), 3)).starts_with("$HETXT,04,04,00,x*"));
    assert_eq!(txt(Words(&long), 4), None);
}

/// Any report that types allow.
fn any_report() -> impl Strategy<Value = Report> {
    let state = prop_oneof![
        Just(State::Waiting),
        Just(State::Aligning),
        Just(State::Ready),
        Just(State::Degraded(Degradation::Coasting)),
        Just(State::Failed),
    ];
    let origin = prop_oneof![Just(Origin::Gyros), Just(Origin::Outside), Just(Origin::Simulation)];
    let number = || prop_oneof![any::<f64>(), -10.0..10.0];
    let azimuth = proptest::option::of((number(), number()));
    let level = proptest::option::of([number(), number(), number()]);
    let rest =
        (any::<u32>(), proptest::option::of(number()), proptest::option::of(any::<[u16; 2]>()));
    (state, origin, azimuth, level, proptest::option::of(number()), rest).prop_map(
        |(state, origin, azimuth, level, rate, (faults, since, progress))| Report {
            state,
            origin,
            azimuth: azimuth
                .map(|(angle, sigma)| Azimuth { angle: Radians(angle), sigma: Radians(sigma) }),
            level: level.map(|[pitch, roll, sigma]| Level {
                pitch: Radians(pitch),
                roll: Radians(roll),
                sigma: Radians(sigma),
            }),
            rate_of_turn: rate.map(RadiansPerSecond),
            faults,
            since_alignment: since.map(Seconds),
            progress,
            ..Report::default()
        },
    )
}

proptest! {
    #[test]
    fn every_sentence_of_any_report_keeps_the_form(report in any_report()) {
        for sentence in ALL {
            let Some(sentence) = sentence(&report) else {
                prop_assert!(report.usable_level().is_none(), "a sentence is too long");
                continue;
            };
            prop_assert!(sentence.len() <= LONGEST && sentence.ends_with("\r\n") && sentence.is_ascii());
            let (content, sum) = sentence[1..].trim_end().split_once('*').expect("it has a checksum");
            let expected = content.bytes().fold(0, |sum, byte| sum ^ byte);
            prop_assert_eq!(sum, format!("{expected:02X}"));
            prop_assert!(content.bytes().all(|byte| byte.is_ascii_alphanumeric() || b",.-".contains(&byte)), "{}", content);
        }
    }

    #[test]
    fn a_heading_reads_back_as_it_was_to_half_a_thousandth_of_a_degree(angle in 0.0..360.0_f64) {
        let sentence = hdt(&Report { azimuth: azimuth(angle, 0.1), ..ready() }).expect("it is sent");
        let parsed = nmea::parse_str(sentence.trim_end()).expect("it is a sentence");
        let ParseResult::HDT(read) = parsed else { panic!("it is {parsed:?}") };
        let off = f64::from(read.heading.expect("it has a heading")) - angle;
        let off = (off + 180.0).rem_euclid(360.0) - 180.0;
        prop_assert!(off.abs() <= 0.0005 + 2e-5, "by {}°", off);
    }
}

#[test]
fn a_heading_that_is_not_valid_reads_back_as_none() {
    let sentence = text(hdt(&Report::default()));
    let ParseResult::HDT(read) = nmea::parse_str(&sentence).expect("it is a sentence") else {
        panic!("it is another sentence")
    };
    assert_eq!(read.heading, None);
}

#[test]
fn words_read_back_as_they_were() {
    let sentence = text(txt(Words(&"last reset: panic"), 0));
    let ParseResult::TXT(read) = nmea::parse_str(&sentence).expect("it is a sentence") else {
        panic!("it is another sentence")
    };
    assert_eq!((read.count, read.seq, read.text.as_str()), (1, 1, "last reset: panic"));
}

#[test]
fn the_roll_of_a_spinning_body_is_told_with_what_it_rests_on() {
    let roll = |angle: Option<[f64; 2]>, condition| {
        let angle = angle.map(|angle| angle.map(Radians::from_degrees));
        pmrdl(&Report { spin: Some(Roll { angle, condition }), ..Report::default() })
    };
    let told = |angle, condition| {
        let sentence = text(roll(angle, condition));
        sentence.rsplit_once('*').expect("it has a checksum").0.to_owned()
    };
    assert_eq!(told(Some([-0.0004, 0.0321]), Condition::Locked), "$PMRDL,0.000,0.033,locked");
    assert_eq!(told(Some([573.2, 0.5]), Condition::Holding), "$PMRDL,213.200,0.500,holding");
    assert_eq!(told(None, Condition::GyroStuck), "$PMRDL,,,gyro stuck");
    assert_eq!(told(Some([f64::NAN, 0.1]), Condition::Locked), "$PMRDL,,,locked");
    assert_eq!(told(Some([1.0, f64::NAN]), Condition::Locked), "$PMRDL,,,locked");
    assert_eq!(pmrdl(&Report::default()), None, "another carrier has none");
}

proptest! {
    #[test]
    fn words_of_any_kind_come_in_parts_of_plain_letters(words in "\\PC{0,400}") {
        const OF: usize = 50;
        let all = Words(&words);
        let parts: Vec<_> =
            (0..all.count(OF)).map(|number| all.part::<OF>(number).to_string()).collect();
        let (_, before) = parts.split_last().expect("there is one at least");
        prop_assert!(before.iter().all(|part| part.len() == OF));
        let parts = parts.concat();
        prop_assert!(parts.bytes().all(|byte| (b' '..=b'~').contains(&byte)));
        let plain: String = words.chars().filter(|letter| (' '..='~').contains(letter)).collect();
        if plain == words {
            prop_assert!(words.starts_with(&parts) && parts.len() == words.len().min(6 * WORDS));
        }
        prop_assert_eq!(all.part::<OF>(all.count(OF)), "");
    }
}

#[test]
fn signs_of_quantities_are_spelt() {
    let words = Words(&"213.702° ± 0.033° (1σ), 5 µg");
    assert_eq!(words.part::<100>(0), "213.702 deg +- 0.033 deg (1sigma), 5 ug");
}
