//! What is sent at each look: of the report what is due, and the words that wait.

use embedded_io_async::Write;
use heapless::Vec;
use protocol::mavlink::{self, MavSeverity, Sender};
use protocol::nmea;
use protocol::report::Report;
use protocol::words::Words;

use super::send;
use super::situation::report;
use crate::event::Event;
use crate::kept_lines::Weight;
use crate::settings::{FASTEST, Format, Item};
use crate::shared::Shared;
use crate::status::Step;

/// Most bytes that are handed to the link at once: all sentences of a look. They take 600 ms at 4800 baud, the slowest link.
pub(super) const TOGETHER: usize = 288;

/// Speaks over the link.
pub(super) struct Talker<'t, 'a> {
    shared: &'t Shared<'a>,
    /// Who sends messages.
    sender: Sender,
    /// The step of the alignment that was told last.
    told: Option<Step>,
    /// Identity of the latest text that takes more than one message.
    text: u8,
    /// What is to be sent together.
    together: Vec<u8, TOGETHER>,
}

impl<'t, 'a> Talker<'t, 'a> {
    /// Has told nothing yet.
    pub fn new(shared: &'t Shared<'a>) -> Self {
        let sender = Sender::of_system(shared.output.get().system);
        Self { shared, sender, told: None, text: 0, together: Vec::new() }
    }

    /// Sends the words that wait, and what is due between two looks of these numbers.
    pub async fn speak<L: Write>(&mut self, link: &mut L, looks: [u32; 2]) {
        self.tell(link).await;
        let output = self.shared.output.get();
        self.sender.system = output.system;
        let has_heartbeat = output.format == Format::Mavlink && is_due(1, looks);
        // Each has its own look, so that no look has all of them: nothing that computes is held up for long.
        let is_due = |item: &Item| {
            is_due(output.rate(*item), looks.map(|look| look.wrapping_add(*item as u32)))
        };
        if has_heartbeat || Item::ALL.iter().any(is_due) {
            let report = report(self.shared);
            if has_heartbeat {
                let frame = self.sender.frame(&mavlink::heartbeat(&report));
                self.put(link, frame.raw_bytes()).await;
            }
            for item in Item::ALL.into_iter().filter(is_due) {
                self.state(link, item, &report).await;
            }
        }
        self.flush(link).await;
    }

    /// Sends the words that wait, and everything once more, now that all is over.
    pub async fn end<L: Write>(&mut self, link: &mut L) {
        self.speak(link, [0, u32::from(FASTEST)]).await;
    }

    /// Puts an item of the report to what is sent, where there is something to say of it.
    async fn state<L: Write>(&mut self, link: &mut L, item: Item, report: &Report) {
        let sentence = match item {
            Item::Hdt => nmea::hdt(report),
            Item::Ths => nmea::ths(report),
            Item::Rot => nmea::rot(report),
            Item::Phtro => nmea::phtro(report),
            Item::Phinf => nmea::phinf(report),
            Item::Pmrds => nmea::pmrds(report),
            Item::Pmrdl => nmea::pmrdl(report),
            Item::Attitude | Item::Vision | Item::SysStatus => None,
        };
        if let Some(sentence) = sentence {
            self.put(link, sentence.as_bytes()).await;
        }
        let sender = &mut self.sender;
        let frame = match item {
            Item::Attitude => mavlink::attitude_quaternion(report).map(|it| sender.frame(&it)),
            Item::Vision => mavlink::vision_position_estimate(report).map(|it| sender.frame(&it)),
            Item::SysStatus => Some(sender.frame(&mavlink::sys_status(report))),
            _ => None,
        };
        if let Some(frame) = frame {
            self.put(link, frame.raw_bytes()).await;
        }
    }

    /// Sends a step of the alignment that is new, and the events that wait.
    async fn tell<L: Write>(&mut self, link: &mut L) {
        let step = self.shared.shown_status().step();
        if let Some(step) = step.filter(|step| self.told != Some(*step)) {
            self.say(link, &Words::new(step), MavSeverity::MAV_SEVERITY_INFO).await;
        }
        self.told = step;
        while let Ok(event) = self.shared.notices.try_receive() {
            self.say(link, &Words::new(event), MavSeverity::MAV_SEVERITY_NOTICE).await;
        }
    }

    /// Puts words to what is sent, in as many sentences or messages as they take.
    async fn say<L: Write>(&mut self, link: &mut L, words: &Words, severity: MavSeverity) {
        let is_mavlink = self.shared.output.get().format == Format::Mavlink;
        let longest = if is_mavlink { mavlink::WORDS } else { nmea::WORDS };
        let many = words.count(longest);
        self.text = if many > 1 { (self.text % u8::MAX) + 1 } else { self.text };
        let identity = if many > 1 { self.text } else { 0 };
        for number in 0..many {
            let part = words.part(longest, number);
            if is_mavlink {
                let text = mavlink::statustext(severity, [identity, number], part);
                let frame = self.sender.frame(&text);
                self.put(link, frame.raw_bytes()).await;
            } else if let Some(sentence) = nmea::txt([many, number + 1], part) {
                self.put(link, sentence.as_bytes()).await;
            }
        }
    }

    /// Puts a sentence or a message to what is sent together; what there was goes first where both are too long.
    async fn put<L: Write>(&mut self, link: &mut L, bytes: &[u8]) {
        if self.together.len() + bytes.len() > TOGETHER {
            self.flush(link).await;
        }
        // There is room for the longest message in what is empty.
        let _ = self.together.extend_from_slice(bytes);
    }

    /// Sends what was put together.
    async fn flush<L: Write>(&mut self, link: &mut L) {
        if !self.together.is_empty() {
            send(link, &self.together, self.shared).await;
            self.together.clear();
        }
    }
}

/// Whether something of a rate, Hz, is due between two looks of these numbers.
fn is_due(rate: u8, [before, now]: [u32; 2]) -> bool {
    let period = u32::from(FASTEST).checked_div(rate.into());
    period.is_some_and(|period| before / period != now / period)
}

/// Whether an event is told over the link: what came of an alignment or of the azimuth that is kept, and what was given up.
pub(crate) fn is_told(event: &Event) -> bool {
    event.weight() == Some(Weight::Outcome)
}
