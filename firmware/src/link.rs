//! The status line: one line of text per second over the serial link.
//!
//! ```text
//! measuring 5/24, faults 0
//! azimuth 213.702 sigma 0.033, faults 0
//! azimuth 250.114 sigma 0.041 pitch 1.204 roll -0.310 level, faults 0
//! ```

use core::fmt::Write as _;

use embassy_futures::select::select;
use embassy_time::{Duration, Timer, with_timeout};
use embedded_io_async::Write;
use heapless::String;

use crate::event::Event;
use crate::shared::{Channels, Shared, discard};

/// Time between two lines.
const PERIOD: Duration = Duration::from_secs(1);
/// Time limit for sending a line; the line is discarded beyond it. 160 bytes take 167 ms at 9600
/// baud (10 bits per byte).
const LONGEST: Duration = Duration::from_millis(500);
/// Capacity for the longest line, bytes: an attitude in the state with the longest name, recalled,
/// with all digits of the fault counter.
const LENGTH: usize = 160;

/// Sends a status line every second until nothing more will happen and that has been sent.
pub async fn run<L: Write>(link: &mut L, shared: &Shared<'_>) {
    loop {
        let is_last = shared.is_over();
        send(link, shared).await;
        if is_last {
            return;
        }
        select(Timer::after(PERIOD), shared.concluded.wait()).await;
    }
}

/// Whether the link takes a line in time.
async fn is_taken<L: Write>(link: &mut L, line: &[u8]) -> bool {
    matches!(with_timeout(LONGEST, link.write_all(line)).await, Ok(Ok(())))
}

/// Sends words, one after the other. Those that the link does not take in time are not counted.
pub async fn say<L: Write>(link: &mut L, words: &[&str]) {
    for words in words {
        let _ = is_taken(link, words.as_bytes()).await;
    }
}

/// Says every second why nothing begins, without end.
pub async fn refuse<L: Write>(link: &mut L, reason: &str) -> ! {
    loop {
        say(link, &[reason, "\r\n"]).await;
        Timer::after(PERIOD).await;
    }
}

/// Repeats the conclusion every second without end, and passes by the samples that still come.
pub async fn repeat<L: Write, S>(link: &mut L, channels: &Channels<'_, S>) -> ! {
    loop {
        let sending = async {
            Timer::after(PERIOD).await;
            send(link, &channels.shared).await;
        };
        select(sending, discard(channels)).await;
    }
}

/// Sends one status line. If the link does not take the line in time, the line is discarded and
/// counted; the first loss is also reported as an event.
pub async fn send<L: Write>(link: &mut L, shared: &Shared<'_>) {
    let line = line(shared);
    if !is_taken(link, line.as_bytes()).await {
        if shared.health.get().unsent == 0 {
            shared.report(Event::LinkSilent);
        }
        shared.count(|health| health.unsent = health.unsent.saturating_add(1));
    }
}

/// The present status line.
fn line(shared: &Shared<'_>) -> String<LENGTH> {
    let mut line = String::new();
    let faults = shared.health.get().faults();
    let status = shared.status.get();
    let status = if shared.homed.signaled() { status } else { status.before_homing() };
    // The capacity holds the longest line; a longer one would be cut.
    let _ = write!(line, "{status}, faults {faults}\r\n");
    line
}
