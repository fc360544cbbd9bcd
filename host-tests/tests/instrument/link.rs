//! The link of an instrument: what it says in every state, how often, and where nobody takes it.

use std::cell::RefCell;

use conversation::{Conversation, Deaf};
use embassy_futures::select::select;
use embassy_time::{Duration, Instant, Timer};
use embedded_io_async::{ErrorKind, ErrorType, Read, Write};
use firmware::event::Event;
use firmware::ports::Observer;
use firmware::settings::{Format, Item, Output};
use firmware::shared::Shared;
use firmware::status::Status;
use host::virtual_time;
use mavlink::dialects::common::MavMessage;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::{Azimuth, Progress};
use orientation::attitude::{State, Trust};
use orientation::device::{Device, Trouble};
use orientation::navigation::navigator::Attitude;
use orientation::roll::Condition;
use orientation::units::{self, Radians, RadiansPerSecond, Seconds};

use crate::support::link::{messages, sentences, states, words};

/// Keeps what is reported.
#[derive(Default)]
struct Recorded(RefCell<Vec<Event>>);

impl Observer for Recorded {
    fn event(&self, _: Instant, event: &Event) {
        self.0.borrow_mut().push(*event);
    }
}

/// A link that hangs, or refuses.
enum SickLink {
    Hangs,
    Refuses,
}

impl ErrorType for SickLink {
    type Error = ErrorKind;
}

impl Read for SickLink {
    async fn read(&mut self, _: &mut [u8]) -> Result<usize, Self::Error> {
        core::future::pending().await
    }
}

impl Write for SickLink {
    async fn write(&mut self, _: &[u8]) -> Result<usize, ErrorKind> {
        match self {
            Self::Hangs => core::future::pending().await,
            Self::Refuses => Err(ErrorKind::Other),
        }
    }

    async fn flush(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}

/// A link that keeps what it is sent.
#[derive(Default)]
struct Heard(Vec<u8>);

impl ErrorType for Heard {
    type Error = ErrorKind;
}

impl Read for Heard {
    async fn read(&mut self, _: &mut [u8]) -> Result<usize, Self::Error> {
        core::future::pending().await
    }
}

impl Write for Heard {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, ErrorKind> {
        self.0.extend(bytes);
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}

/// What is sent while the navigator looks so often, ten times a second; or while so many tenths of a second pass where
/// nothing is kept. The look after the last ends it.
fn sent(looks: u64, shared: &Shared<'_>) -> Vec<u8> {
    let mut heard = Heard::default();
    let looking = async {
        for _ in 0..looks {
            Timer::after(Duration::from_millis(100)).await;
            if shared.attitude.get().is_some() {
                shared.looked.signal(());
            }
        }
        Timer::after(Duration::from_millis(20)).await;
    };
    let talking = async { Conversation::new(&mut heard, Deaf, shared).without_end().await };
    virtual_time::run(select(talking, looking)).expect("time goes on");
    heard.0
}

/// The sentences of a second.
fn said(shared: &Shared<'_>) -> String {
    String::from_utf8(sent(10, shared)).expect("text")
}

/// An azimuth with its 1σ, °.
fn azimuth(angle: f64, sigma: f64) -> Azimuth {
    let [angle, sigma] = [angle, sigma].map(Radians::from_degrees);
    Azimuth { angle, sigma }
}

/// An attitude with an azimuth of 213.702° ± 0.033°, as gravity corrects it.
fn attitude() -> Attitude {
    let [pitch, roll, level_sigma] = [1.2, -0.31, 0.012].map(Radians::from_degrees);
    Attitude {
        time: units::Instant(61_000_000),
        azimuth: Some(azimuth(213.702, 0.033)),
        is_recalled: false,
        is_from_outside: false,
        since_aligned: Some(Seconds(61.4)),
        resets: 1,
        pitch,
        roll,
        level_sigma,
        rates: Some([0.0, 0.1, 0.2].map(RadiansPerSecond)),
        rate_of_turn: Some(RadiansPerSecond(0.0)),
        state: Some(State { trust: Trust::Level, seconds: Seconds(60.0) }),
    }
}

/// An instrument whose alignment is over, and which keeps this attitude.
fn keeping(attitude: Attitude) -> Shared<'static> {
    let shared = Shared::new(&());
    shared.homed.signal(());
    shared.attitude.set(Some(attitude));
    shared
}

/// The first field of the first sentence of an address, and its second.
fn first<'s>(sent: &'s str, address: &str) -> [&'s str; 2] {
    let found = sentences(sent, address);
    [found[0][0], found[0].get(1).copied().unwrap_or_default()]
}

#[test]
fn an_azimuth_is_valid_only_while_the_level_is_known_within_the_sigma_that_is_required() {
    let trusted = |trust| Some(State { trust, seconds: Seconds(3.0) });
    let ready = attitude();
    let tilted = Attitude { level_sigma: Radians::from_degrees(2.1), ..ready };
    let cases = [
        (ready, 1.0, ["ready", "A"]),
        (Attitude { is_from_outside: true, ..ready }, 1.0, ["ready", "M"]),
        (ready, 0.01, ["degraded", "E"]),
        (Attitude { is_recalled: true, ..ready }, 1.0, ["degraded", "E"]),
        (Attitude { state: trusted(Trust::Coasting), ..ready }, 1.0, ["ready", "A"]),
        (Attitude { state: trusted(Trust::Coasting), ..tilted }, 1.0, ["degraded", "E"]),
        (Attitude { state: trusted(Trust::FreeFall), ..tilted }, 1.0, ["degraded", "E"]),
        (Attitude { state: trusted(Trust::NoForce), ..ready }, 1.0, ["degraded", "E"]),
        (Attitude { state: trusted(Trust::RotationLost), ..ready }, 1.0, ["degraded", "E"]),
        (Attitude { azimuth: None, ..ready }, 1.0, ["aligning", "V"]),
        (Attitude { azimuth: None, state: None, ..ready }, 1.0, ["aligning", "V"]),
    ];
    for (attitude, required, expected) in cases {
        let shared = keeping(attitude);
        shared.required.set(Some(Radians::from_degrees(required)));
        let said = said(&shared);
        let [state, mode] = [states(&said)[0][0], first(&said, "HETHS")[1]];
        assert_eq!([state, mode], expected, "{attitude:?}");
        let heading = if state == "ready" { "213.702" } else { "" };
        assert_eq!(first(&said, "HEHDT"), [heading, "T"], "{attitude:?}");
        let estimate = if attitude.azimuth.is_some() { "213.702" } else { "" };
        assert_eq!(first(&said, "HETHS")[0], estimate, "{attitude:?}");
        let lost = [Trust::Starting, Trust::RotationLost];
        let has_level = attitude.state.is_some_and(|state| !lost.contains(&state.trust));
        assert_eq!(sentences(&said, "PHTRO").len(), usize::from(has_level), "{attitude:?}");
    }
}

#[test]
fn an_attitude_that_is_not_renewed_is_stated_no_more_after_three_tenths_of_a_second() {
    let begun = Instant::now();
    let shared = keeping(Attitude { time: units::Instant(begun.as_micros()), ..attitude() });
    let mut output = Output::default();
    output.rates[Item::Hdt as usize] = 10;
    shared.output.set(output);
    let sent = String::from_utf8(sent(10, &shared)).expect("text");
    let headings = sentences(&sent, "HEHDT");
    let stated: Vec<bool> = headings.iter().map(|heading| !heading[0].is_empty()).collect();
    assert_eq!(stated, [&[true; 3][..], &[false; 7]].concat());
    assert!(sentences(&sent, "PHTRO").is_empty() && first(&sent, "HEROT")[1] == "V", "{sent}");
}

#[test]
fn a_state_without_an_attitude_follows_the_alignment() {
    let found = azimuth(213.702, 0.033);
    let roll = Some([213.702, 0.033].map(Radians::from_degrees));
    let cases = [
        (Status::Waiting, "waiting", "V"),
        (Status::Starting, "aligning", "V"),
        (Status::Measuring([5, 24]), "aligning", "V"),
        // Nothing shows whether the body has turned since.
        (Status::Concluded(found, Instant::now()), "degraded", "E"),
        (Status::Rolling(None, Condition::Searching), "aligning", "V"),
        (Status::Rolling(None, Condition::NotSpinning), "aligning", "V"),
        (Status::Rolling(None, Condition::GyroStuck), "failed", "V"),
        (Status::Rolling(roll, Condition::Locked), "ready", "V"),
        (Status::Rolling(roll, Condition::Holding), "degraded", "V"),
        (Status::Rolling(roll, Condition::ForceLost), "degraded", "V"),
    ];
    for (status, state, mode) in cases {
        let shared = Shared::new(&());
        shared.homed.signal(());
        shared.status.set(status);
        let said = said(&shared);
        assert_eq!((states(&said)[0][0], first(&said, "HETHS")[1]), (state, mode), "{status:?}");
        assert_eq!(first(&said, "HEHDT")[0], "", "{status:?}");
    }
}

#[test]
fn an_azimuth_that_is_not_held_is_told_with_its_age() {
    let shared = Shared::new(&());
    shared.homed.signal(());
    shared.status.set(Status::Concluded(azimuth(213.702, 0.033), Instant::now()));
    let said = String::from_utf8(sent(100, &shared)).expect("text");
    let states = states(&said);
    assert!(states.iter().all(|state| [state[0], state[8]] == ["degraded", "unwatched"]));
    let ages: Vec<u32> = states.iter().map(|state| state[5].parse().expect("seconds")).collect();
    assert_eq!(ages, (ages[0]..ages[0] + 10).collect::<Vec<_>>());
    assert!(ages[0] <= 1, "{ages:?}");
}

#[test]
fn an_alignment_that_was_refused_leaves_the_instrument_failed_with_the_reason() {
    let shared = Shared::new(&());
    shared.homed.signal(());
    shared.progress(Progress::Refused(Refusal::TimeExhausted));
    // The aligner is not there to say that it is over: what it told is said all the same.
    let said = said(&shared);
    let reason = Refusal::TimeExhausted.to_string();
    assert_eq!(words(&said), [format!("no azimuth: {reason}")]);
}

#[test]
fn a_device_that_was_given_up_is_a_bit_of_the_status_until_it_is_started_again() {
    let shared = keeping(attitude());
    shared.report(Event::GivenUp(Device::RightGyro, Trouble::Silent));
    assert_eq!(first(&said(&shared), "PHINF")[0], "00000200");
    shared.report(Event::Started(Device::RightGyro));
    assert_eq!(first(&said(&shared), "PHINF")[0], "00000000");
}

#[test]
fn every_sentence_comes_as_often_as_its_rate_says() {
    for (item, address) in [
        (Item::Hdt, "HEHDT"),
        (Item::Ths, "HETHS"),
        (Item::Rot, "HEROT"),
        (Item::Phtro, "PHTRO"),
        (Item::Phinf, "PHINF"),
        (Item::Pmrds, "PMRDS"),
    ] {
        for rate in [0, 1, 2, 5, 10] {
            let shared = keeping(attitude());
            let mut output = Output::default();
            output.rates[item as usize] = rate;
            shared.output.set(output);
            let said = String::from_utf8(sent(100, &shared)).expect("text");
            assert_eq!(sentences(&said, address).len(), 10 * usize::from(rate), "{address}");
        }
    }
}

#[test]
fn an_autopilot_hears_a_heartbeat_a_second_and_the_azimuth_only_where_it_may_fuse_it() {
    let estimate =
        |message: &MavMessage| matches!(message, MavMessage::VISION_POSITION_ESTIMATE(_));
    let attitudes = |message: &MavMessage| matches!(message, MavMessage::ATTITUDE_QUATERNION(_));
    let heartbeats = |message: &MavMessage| matches!(message, MavMessage::HEARTBEAT(_));
    let recalled = Attitude { is_recalled: true, ..attitude() };
    let unknown = Attitude { azimuth: None, ..attitude() };
    for (attitude, expected) in
        [(attitude(), [100, 100, 10]), (recalled, [0, 0, 10]), (unknown, [0, 0, 10])]
    {
        let shared = keeping(attitude);
        let mut output = Output { format: Format::Mavlink, ..Output::default() };
        output.rates[Item::Vision as usize] = 10;
        shared.output.set(output);
        let messages = messages(&sent(100, &shared));
        let count =
            |is_it: &dyn Fn(&MavMessage) -> bool| messages.iter().filter(|it| is_it(it)).count();
        assert_eq!([count(&estimate), count(&attitudes), count(&heartbeats)], expected);
    }
}

#[test]
fn words_that_are_long_are_told_in_parts() {
    let shared = keeping(attitude());
    shared.output.set(Output { format: Format::Mavlink, ..Output::default() });
    let event = Event::HeadingNotKept(drivers::fault::Fault::Bus);
    shared.report(event);
    let texts: Vec<String> = messages(&sent(10, &shared))
        .into_iter()
        .filter_map(|message| match message {
            MavMessage::STATUSTEXT(text) => Some(text.text.to_str().expect("text").to_owned()),
            _ => None,
        })
        .collect();
    assert!(texts.len() == 2 && texts[0].len() == 50, "{texts:?}");
    assert_eq!(texts.concat(), event.to_string());
}

#[test]
fn what_is_sent_takes_no_more_of_the_link_than_is_stated() {
    for format in [Format::Nmea, Format::Mavlink] {
        let output = Output { format, rates: [10; 10], ..Output::default() };
        // The longest of everything.
        let shared = keeping(Attitude {
            pitch: Radians::from_degrees(-89.999),
            roll: Radians::from_degrees(-179.999),
            rate_of_turn: Some(RadiansPerSecond(-60.0)),
            since_aligned: Some(Seconds(1e9)),
            ..attitude()
        });
        shared.count(|health| health.unsent = u32::MAX);
        shared.output.set(output);
        let bytes = sent(10, &shared).len();
        let stated = output.bytes_per_second() as usize;
        assert!((stated / 2..=stated).contains(&bytes), "{bytes} of {stated}: {format:?}");
    }
}

#[test]
fn a_link_that_cannot_carry_what_is_to_be_sent_is_refused() {
    assert_eq!(Output::default().check(), Ok(()));
    assert_eq!(Output { baud: 4800, ..Output::default() }.check(), Ok(()));
    let all = Output { rates: [10; 10], ..Output::default() };
    assert_eq!(all.check(), Ok(()));
    let words = |output: Output| output.check().expect_err("it is refused").to_string();
    assert!(words(Output { baud: 4800, ..all }).contains("on the link"));
    assert!(words(Output { rates: [3; 10], ..all }).contains("0, 1, 2, 5 or 10 Hz"));
    assert!(words(Output { system: 255, ..all }).contains("system"));
    let mut slow = Output { format: Format::Mavlink, ..Output::default() };
    slow.rates[Item::Vision as usize] = 5;
    assert!(words(slow).contains("vision_rate"), "an autopilot would not begin with it");
}

#[test]
fn a_sick_link_costs_what_it_was_sent_and_is_reported_once() {
    // One that hangs costs a second each time; what is sent once a second are five sentences, each at its own look.
    for (mut sick, most) in [(SickLink::Hangs, 4), (SickLink::Refuses, 18)] {
        let reported = Recorded::default();
        let shared = Shared::new(&reported);
        virtual_time::run(async {
            let passing = Timer::after(Duration::from_millis(3500));
            select(Conversation::new(&mut sick, Deaf, &shared).without_end(), passing).await;
        })
        .expect("time wakes everybody");
        let unsent = shared.health.get().unsent;
        assert!((most - 2..=most).contains(&unsent), "{unsent}");
        assert_eq!(*reported.0.borrow(), [Event::LinkSilent]);
    }
}
