//! The conversation over the serial link: what the instrument says of itself while it works, and what it hears.
//!
//! ```text
//! $HEHDT,213.702,T*2A
//! $HEROT,-12.3,A*36
//! $HETXT,01,01,00,stop 1 done; may drive*5E
//! ```
//!
//! Sentences or messages are made of a [report](protocol::report) at the navigator's pace, ten times a second, of which each
//! takes its share; words for people are sent as they come, and so are answers to [commands](console). Nothing waits for the
//! link: what it does not take in time is dropped and counted.
//!
//! | file | what it is |
//! |---|---|
//! | `lib.rs` | its turns: what is due at a look is sent, what comes between two of them is heard |
//! | `reporter.rs` | what is due, and words |
//! | `situation.rs` | the report |
//! | `outbox.rs` | what is sent together |
//! | `listening.rs` | what takes the bytes that the link brings: a console, or nothing |
//! | `console/` | commands and settings |
#![no_std]
#![forbid(unsafe_code)]
#![expect(
    async_fn_in_trait,
    reason = "a future stays in the executor that polls it first: none needs to be Send"
)]

pub mod console;
mod listening;
mod outbox;
mod reporter;
mod situation;

pub use listening::{Deaf, Listen, Listening};
pub use outbox::{Outbox, PIECE};

use core::fmt::Display;
use core::future::pending;

use embassy_futures::select::{Either, select};
use embassy_time::{Duration, Instant, Timer, with_timeout};
use embedded_io_async::{Read, Write};
use firmware::event::Event;
use firmware::settings::FASTEST;
use firmware::shared::Shared;
use protocol::mavlink::Sender;
use protocol::nmea;
use protocol::words::Words;

use reporter::Reporter;

/// Time between two looks at what is to be sent.
const LOOK: Duration = Duration::from_millis(1000 / FASTEST as u64);
/// Time after which an attitude that does not come is not waited for.
const OVERDUE: Duration = Duration::from_millis(150);
/// Time limit for what is sent at once; it is dropped beyond it.
const LONGEST: Duration = Duration::from_secs(1);

/// Bytes that are taken at once of those that were received.
const TAKEN: usize = 64;

/// The conversation over a link: what is sent, and what takes the bytes that come.
pub struct Conversation<'c, 'a, L, H> {
    link: L,
    outbox: Outbox,
    reporter: Reporter,
    pace: Pace,
    listener: H,
    /// Bytes of long answers that may be sent until the next look.
    room: usize,
    /// Whether bytes have come since the latest look.
    has_heard: bool,
    shared: &'c Shared<'a>,
}

impl<'c, 'a, L: Read + Write, H: Listen> Conversation<'c, 'a, L, H> {
    /// Has said and heard nothing yet.
    pub fn new(link: L, listener: H, shared: &'c Shared<'a>) -> Self {
        let outbox = Outbox::of(Sender::of_system(shared.output.get().system));
        let (reporter, pace) = (Reporter::default(), Pace::new());
        Self { link, outbox, reporter, pace, listener, room: 0, has_heard: false, shared }
    }

    /// Converses until nothing more will happen, and that has been said, with everything that is sent at any time.
    pub async fn until_over(&mut self) {
        while !self.shared.is_over() {
            self.turn().await;
        }
        self.reporter.look([0, u32::from(FASTEST)], self.shared);
        self.say(&[]).await;
    }

    /// Converses without end, also after everything is over.
    pub async fn without_end(&mut self) -> ! {
        loop {
            self.turn().await;
        }
    }

    /// Sends what is due at the next look, or takes what comes before it, and answers it.
    async fn turn(&mut self) {
        let mut taken = [0; TAKEN];
        let heard =
            async { if H::IS_DEAF { pending().await } else { self.link.read(&mut taken).await } };
        // A look goes first, so that no flood of commands keeps it waiting.
        let count = match select(self.pace.wait(self.shared), heard).await {
            Either::First(()) => {
                let output = self.reporter.look(self.pace.looks, self.shared);
                self.outbox.sender.system = output.system;
                self.room = output.room_at_a_look();
                if !core::mem::take(&mut self.has_heard) {
                    self.listener.pause();
                }
                0
            }
            Either::Second(Ok(count)) => {
                self.has_heard = true;
                count
            }
            Either::Second(Err(_)) => {
                self.listener.lose();
                0
            }
        };
        self.say(&taken[..count]).await;
        self.listener.finish();
    }

    /// Sends what is due, and the answers to what was received.
    async fn say(&mut self, mut received: &[u8]) {
        loop {
            let is_all = self.put(&mut received).await;
            if !self.outbox.is_empty() {
                send(&mut self.link, self.outbox.bytes(), self.shared).await;
                self.outbox.clear();
            }
            if is_all {
                break;
            }
        }
    }

    /// Puts together as much as is sent at once, of answers one; whether that is all. What computes goes on while it is sent.
    async fn put(&mut self, received: &mut &[u8]) -> bool {
        let Self { outbox, reporter, listener, room, shared, .. } = self;
        reporter.put(outbox, shared);
        while outbox.has_room() {
            *received = &received[listener.take(received)..];
            if listener.answer(outbox, shared).await {
                return false;
            }
            if received.is_empty() && !listener.go_on(outbox, room, shared).await {
                return true;
            }
        }
        false
    }
}

/// Sends words for people before anything else is sent, as sentences.
pub async fn announce<L: Write>(link: &mut L, words: &dyn Display) {
    let words = Words(words);
    for number in 0..words.count(nmea::WORDS) {
        if let Some(sentence) = nmea::txt(words, number) {
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
