//! What is said unasked: of the report what is due, and words for people.

use core::fmt::{self, Display};

use firmware::event::Event;
use firmware::settings::{FASTEST, Format, ITEMS, Item, Output};
use firmware::shared::Shared;
use firmware::status::Step;
use protocol::mavlink::{self, MavSeverity};
use protocol::nmea;
use protocol::report::Report;
use protocol::words::Words;

use super::outbox::Outbox;
use super::situation::report;

/// What is due to be said.
#[derive(Default)]
pub(super) struct Reporter {
    /// Whether a heartbeat is due.
    is_heartbeat_due: bool,
    /// Which items of the report are due.
    due: [bool; ITEMS],
    /// The step of the alignment that was told last.
    told: Option<Step>,
    /// Words that are being told, and how many parts of them have been.
    words: Option<(News, u8)>,
    /// Identity of the latest text that takes more than one message.
    text: u8,
}

/// What words are told of.
#[derive(Clone, Copy)]
enum News {
    /// A step of the alignment.
    Step(Step),
    /// An event.
    Event(Event),
}

impl Display for News {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(step) => step.fmt(formatter),
            Self::Event(event) => event.fmt(formatter),
        }
    }
}

impl News {
    /// How severe it is.
    const fn severity(&self) -> MavSeverity {
        match self {
            Self::Step(_) => MavSeverity::MAV_SEVERITY_INFO,
            Self::Event(_) => MavSeverity::MAV_SEVERITY_NOTICE,
        }
    }
}

impl Reporter {
    /// Notes what is due between two looks of these numbers. Returns by which settings.
    pub fn look(&mut self, looks: [u32; 2], shared: &Shared<'_>) -> Output {
        let output = shared.output.get();
        self.is_heartbeat_due |= output.format == Format::Mavlink && is_due(1, looks);
        for (item, due) in Item::ALL.iter().zip(&mut self.due) {
            // Each has its own look, so that no look has all of them: nothing that computes is held up for long.
            let own = looks.map(|look| look.wrapping_add(*item as u32));
            *due |= is_due(output.rate(*item), own);
        }
        output
    }

    /// Puts what is to be said as far as there is room: words first.
    pub fn put(&mut self, outbox: &mut Outbox, shared: &Shared<'_>) {
        let format = shared.output.get().format;
        while has_room(format, outbox) && self.put_words(format, outbox, shared) {}
        if !self.is_heartbeat_due && !self.due.contains(&true) {
            return;
        }
        let report = report(shared);
        if self.is_heartbeat_due && outbox.has_room() {
            self.is_heartbeat_due = false;
            outbox.put_message(&mavlink::heartbeat(&report));
        }
        for (item, due) in Item::ALL.into_iter().zip(&mut self.due) {
            if *due && has_room(item.format(), outbox) {
                *due = false;
                put_item(item, &report, outbox);
            }
        }
    }

    /// Puts the next part of words; whether there was one.
    fn put_words(&mut self, format: Format, outbox: &mut Outbox, shared: &Shared<'_>) -> bool {
        let Some((news, number)) = self.words.take().or_else(|| Some((self.news(shared)?, 0)))
        else {
            return false;
        };
        let words = Words(&news);
        let many = match format {
            Format::Nmea => {
                outbox.put(nmea::txt(words, number).as_ref());
                words.count(nmea::WORDS)
            }
            Format::Mavlink => {
                let many = words.count(mavlink::WORDS);
                let is_first_of_many = number == 0 && many > 1;
                self.text = if is_first_of_many { (self.text % u8::MAX) + 1 } else { self.text };
                let identity = if many > 1 { self.text } else { 0 };
                let place = [identity, number];
                outbox.put_message(&mavlink::statustext(news.severity(), place, words));
                many
            }
        };
        self.words = Some((news, number + 1)).filter(|_| number + 1 < many);
        true
    }

    /// A step of the alignment that is new, or the next event.
    fn news(&mut self, shared: &Shared<'_>) -> Option<News> {
        let step = shared.shown_status().step();
        if core::mem::replace(&mut self.told, step) != step
            && let Some(step) = step
        {
            return Some(News::Step(step));
        }
        shared.notices.try_receive().ok().map(News::Event)
    }
}

/// Whether there is room for what is said in this format.
fn has_room(format: Format, outbox: &Outbox) -> bool {
    match format {
        Format::Nmea => outbox.has_room_for_sentence(),
        Format::Mavlink => outbox.has_room(),
    }
}

/// Puts an item of the report, where there is something to say of it; whether there was.
fn put_item(item: Item, report: &Report, outbox: &mut Outbox) -> bool {
    let sentence = match item {
        Item::Hdt => nmea::hdt(report),
        Item::Ths => nmea::ths(report),
        Item::Rot => nmea::rot(report),
        Item::Phtro => nmea::phtro(report),
        Item::Phinf => nmea::phinf(report),
        Item::Pmrds => nmea::pmrds(report),
        Item::Pmrdl => nmea::pmrdl(report),
        Item::Attitude => {
            return mavlink::attitude_quaternion(report)
                .map(|message| outbox.put_message(&message))
                .is_some();
        }
        Item::Vision => {
            return mavlink::vision_position_estimate(report)
                .map(|message| outbox.put_message(&message))
                .is_some();
        }
        Item::SysStatus => {
            outbox.put_message(&mavlink::sys_status(report));
            return true;
        }
    };
    outbox.put(sentence.as_ref());
    sentence.is_some()
}

/// Puts an item now, where there is something to say of it; whether there was.
pub(crate) fn put_now(item: Item, outbox: &mut Outbox, shared: &Shared<'_>) -> bool {
    put_item(item, &report(shared), outbox)
}

/// Whether something of a rate, Hz, is due between two looks of these numbers.
fn is_due(rate: u8, [before, now]: [u32; 2]) -> bool {
    let period = u32::from(FASTEST).checked_div(rate.into());
    period.is_some_and(|period| before / period != now / period)
}
