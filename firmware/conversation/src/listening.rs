//! What takes the bytes that a link brings: a console, or nothing.

use embassy_time::{Instant, Timer};
use firmware::settings::{BoardSettings, SharedSettings};
use firmware::shared::Shared;
use protocol::receiver::Receiver;

use super::console::Console;
use super::outbox::Outbox;

/// What takes the bytes that a link brings, and answers them.
pub trait Listen {
    /// Whether nothing is listened to: an image without a console has no code for one.
    const IS_DEAF: bool;

    /// Takes some of these bytes, at least one once [`Self::answer`] has found nothing; how many.
    fn take(&mut self, bytes: &[u8]) -> usize;

    /// Notes that no byte has come for some time.
    fn pause(&mut self);

    /// Notes that bytes were lost.
    fn lose(&mut self);

    /// Answers the next line or frame among the bytes that were taken; whether there was one. The outbox has room for an
    /// answer.
    async fn answer(&mut self, outbox: &mut Outbox, shared: &Shared<'_>) -> bool;

    /// Goes on with a long answer, for which there is room of so many bytes, whatever the length of its last part; whether
    /// there was one. The outbox has room for a part.
    async fn go_on(&mut self, outbox: &mut Outbox, room: &mut usize, shared: &Shared<'_>) -> bool;

    /// Does what comes after the answers were sent.
    fn finish(&mut self);
}

/// Nothing is listened to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deaf;

impl Listen for Deaf {
    const IS_DEAF: bool = true;

    fn take(&mut self, bytes: &[u8]) -> usize {
        bytes.len()
    }

    fn pause(&mut self) {}

    fn lose(&mut self) {}

    async fn answer(&mut self, _: &mut Outbox, _: &Shared<'_>) -> bool {
        false
    }

    async fn go_on(&mut self, _: &mut Outbox, _: &mut usize, _: &Shared<'_>) -> bool {
        false
    }

    fn finish(&mut self) {}
}

/// So many times as long as a command has taken, the next one waits: what has a lesser priority than the link computes
/// meanwhile. On a spinning body it has a tenth of the core to spare.
const REST: u32 = 10;

/// A console behind the search for lines and frames.
pub struct Listening<'c> {
    receiver: Receiver,
    settings: &'c SharedSettings,
    console: Console,
    /// When the next command is taken, at the earliest.
    rested: Instant,
}

impl<'c> Listening<'c> {
    /// Listens to commands about the settings of a board; `reboot` starts it anew.
    #[must_use]
    pub fn new(BoardSettings { settings, serial }: BoardSettings<'c>, reboot: fn()) -> Self {
        let (receiver, console) = (Receiver::default(), Console::new(serial, reboot));
        Self { receiver, settings, console, rested: Instant::MIN }
    }
}

impl Listen for Listening<'_> {
    const IS_DEAF: bool = false;

    fn take(&mut self, bytes: &[u8]) -> usize {
        self.receiver.take(bytes)
    }

    fn pause(&mut self) {
        self.receiver.pause();
    }

    fn lose(&mut self) {
        self.receiver.lose();
    }

    async fn answer(&mut self, outbox: &mut Outbox, shared: &Shared<'_>) -> bool {
        let Some(received) = self.receiver.next() else { return false };
        Timer::at(self.rested).await;
        // The store has them while it makes a record of them, which does not take long.
        let settings = &mut *self.settings.lock().await;
        let begun = Instant::now();
        self.console.take(&received, settings, outbox, shared);
        let ended = Instant::now();
        self.rested = ended + (ended - begun) * REST;
        true
    }

    async fn go_on(&mut self, outbox: &mut Outbox, room: &mut usize, shared: &Shared<'_>) -> bool {
        let settings = &mut *self.settings.lock().await;
        let before = outbox.len();
        let goes_on = *room > 0 && self.console.go_on(settings, outbox, shared);
        *room = room.saturating_sub(outbox.len() - before);
        goes_on
    }

    fn finish(&mut self) {
        self.console.finish();
    }
}

/// What may listen, as a host chooses it.
impl<L: Listen> Listen for Option<L> {
    const IS_DEAF: bool = false;

    fn take(&mut self, bytes: &[u8]) -> usize {
        self.as_mut().map_or(bytes.len(), |listener| listener.take(bytes))
    }

    fn pause(&mut self) {
        self.iter_mut().for_each(Listen::pause);
    }

    fn lose(&mut self) {
        self.iter_mut().for_each(Listen::lose);
    }

    async fn answer(&mut self, outbox: &mut Outbox, shared: &Shared<'_>) -> bool {
        match self {
            Some(listener) => listener.answer(outbox, shared).await,
            None => false,
        }
    }

    async fn go_on(&mut self, outbox: &mut Outbox, room: &mut usize, shared: &Shared<'_>) -> bool {
        match self {
            Some(listener) => listener.go_on(outbox, room, shared).await,
            None => false,
        }
    }

    fn finish(&mut self) {
        if let Some(listener) = self {
            listener.finish();
        }
    }
}
