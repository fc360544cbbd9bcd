//! The serial link: what the instrument sends of itself while it works.
//!
//! ```text
//! $HEHDT,213.702,T*2A
//! $HEROT,-12.3,A*36
//! $HETXT,01,01,00,stop 1 done; may drive*5E
//! ```
//!
//! Sentences or messages are made of a [report](protocol::report) at the navigator's pace, ten times a second, of which each
//! takes its share; words for people are sent as they come. Nothing waits for the link: what it does not take in time is
//! dropped and counted.

mod situation;
mod talker;

use core::fmt::Display;

use embassy_futures::select::select;
use embassy_time::{Duration, Instant, Timer, with_timeout};
use embedded_io_async::Write;
use protocol::nmea;
use protocol::words::Words;

pub(crate) use self::talker::is_told;

use self::talker::Talker;
use crate::event::Event;
use crate::shared::Shared;

/// Time between two looks at what is to be sent.
const LOOK: Duration = Duration::from_millis(1000 / crate::settings::FASTEST as u64);
/// Time after which an attitude that does not come is not waited for.
const OVERDUE: Duration = Duration::from_millis(150);
/// Time limit for what is sent at once; it is dropped beyond it. [`TOGETHER`](talker::TOGETHER) says how long that takes.
const LONGEST: Duration = Duration::from_secs(1);

/// Sends until nothing more will happen, and that has been said.
pub async fn run<L: Write>(link: &mut L, shared: &Shared<'_>) {
    let mut talker = Talker::new(shared);
    let mut pace = Pace::new();
    while !shared.is_over() {
        pace.wait(shared).await;
        talker.speak(link, pace.looks).await;
    }
    talker.end(link).await;
}

/// Sends without end, also after everything is over.
pub async fn serve<L: Write>(link: &mut L, shared: &Shared<'_>) -> ! {
    let mut talker = Talker::new(shared);
    let mut pace = Pace::new();
    loop {
        pace.wait(shared).await;
        talker.speak(link, pace.looks).await;
    }
}

/// Sends words for people before anything else is sent, as sentences.
pub async fn announce<L: Write>(link: &mut L, words: &dyn Display) {
    let words = Words::new(words);
    let many = words.count(nmea::WORDS);
    for number in 0..many {
        if let Some(sentence) = nmea::txt([many, number + 1], words.part(nmea::WORDS, number)) {
            let _ = is_taken(link, sentence.as_bytes()).await;
        }
    }
}

/// The pace of the navigator's attitudes, or of the clock where none come.
struct Pace {
    /// Time of the latest look.
    latest: Instant,
    /// Numbers of the looks that were last, and that is now.
    looks: [u32; 2],
}

impl Pace {
    /// The pace from now on.
    fn new() -> Self {
        Self { latest: Instant::now(), looks: [0; 2] }
    }

    /// Waits for the next look. Those that were missed meanwhile are counted.
    async fn wait(&mut self, shared: &Shared<'_>) {
        let longest = if shared.attitude.get().is_some() { OVERDUE } else { LOOK };
        let news = select(shared.looked.wait(), shared.concluded.wait());
        let is_new = select(news, Timer::at(self.latest + longest)).await.is_first();
        let now = Instant::now();
        // One that has come early or late is a look; where none has come, the clock goes on by whole ones.
        let since = now - self.latest;
        let passed = if is_new { since + LOOK / 2 } else { since }.as_ticks() / LOOK.as_ticks();
        self.latest = if is_new { now } else { self.latest + LOOK * passed as u32 };
        let [_, before] = self.looks;
        self.looks = [before, before.wrapping_add(passed as u32)];
    }
}

/// Whether the link takes bytes in time.
async fn is_taken<L: Write>(link: &mut L, bytes: &[u8]) -> bool {
    matches!(with_timeout(LONGEST, link.write_all(bytes)).await, Ok(Ok(())))
}

/// Sends bytes. Where the link does not take them in time they are dropped and counted; the first loss is also reported
/// as an event.
async fn send<L: Write>(link: &mut L, bytes: &[u8], shared: &Shared<'_>) {
    if is_taken(link, bytes).await {
        return;
    }
    if shared.health.get().unsent == 0 {
        shared.report(Event::LinkSilent);
    }
    shared.count(|health| health.unsent = health.unsent.saturating_add(1));
}
