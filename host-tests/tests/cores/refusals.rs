//! Refusals as text: in a recording's header, and as sentences with their remedies.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::{rotating, stepwise};
use orientation::device::{Device, Trouble};
use orientation::units::Degrees;

#[test]
fn what_the_samples_do_not_show_stands_in_text_under_its_name() {
    for (refusal, text) in [
        (Refusal::TimeExhausted, r#""TimeExhausted""#),
        (Refusal::MovedDuringAlignment, r#""MovedDuringAlignment""#),
        (Refusal::MisalignmentUnknown, r#""MisalignmentUnknown""#),
        (
            Refusal::LatitudeTooHigh { latitude: Degrees(86.125) },
            r#"{"LatitudeTooHigh":{"latitude":86.125}}"#,
        ),
        (
            Refusal::Device { device: Device::Gyro, trouble: Trouble::Stuck },
            r#"{"Device":{"device":"Gyro","trouble":"Stuck"}}"#,
        ),
    ] {
        assert_eq!(serde_json::to_string(&refusal).expect("it is text"), text);
        assert_eq!(serde_json::from_str::<Refusal>(text).expect("it reads"), refusal);
    }
}

#[test]
fn a_sentence_ends_with_its_remedy() {
    let disturbed = stepwise::Refusal::Disturbed { disturbed: 9, positions: 24 };
    for (refusal, remedy) in [
        (Refusal::TiltTooGreat { tilt: Degrees(7.25), allowed: Degrees(5.0) }, ": level it"),
        (disturbed.into(), ": keep the platform still"),
        (stepwise::Refusal::AzimuthUnobservable.into(), ": turn the stage over a longer arc"),
        (stepwise::Refusal::TrendNotSeparable.into(), ": turn a full circle"),
        (
            rotating::Refusal::TurnsDisturbed { disturbed: 9, turns: 24 }.into(),
            ": keep the base still, let the sensor settle",
        ),
        (Refusal::TimeExhausted, ""),
    ] {
        assert_eq!(refusal.remedy(), remedy);
        assert!(refusal.to_string().ends_with(remedy), "{refusal}");
    }
}
