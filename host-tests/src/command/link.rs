//! What the commands share that talk to an instrument: where it is, and how it is listened to.

use std::time::Duration;

use clap::Args;
use host::link::address::Address;
use host::link::conversation::Conversation;
use host::link::port::Port;
use host::link::words::{NoWords, Words, commands};

use super::Failure;
use super::mistyped::nearest;

/// Heading of the options of a link.
const LINK: &str = "Link";
/// Longest silence that can be asked for, s: an hour, which no command takes.
const LONGEST: f64 = 3600.0;

/// How the instrument is listened to.
#[derive(Args)]
pub struct LinkOptions {
    /// Baud rate of a serial port, bits/s.
    #[arg(long, global = true, help_heading = LINK, default_value_t = 115_200, value_parser = baud)]
    baud: u32,
    /// How long the instrument may be silent before it is taken not to answer, s.
    #[arg(
        long,
        global = true,
        help_heading = LINK,
        value_name = "SECONDS",
        default_value_t = 5.0,
        value_parser = wait
    )]
    wait: f64,
}

impl LinkOptions {
    /// A conversation with the instrument at an address.
    ///
    /// # Errors
    /// Why the port cannot be opened, and what mends that.
    pub fn open(&self, address: &Address) -> Result<Conversation, String> {
        let port = Port::open(address, self.baud)?;
        Ok(Conversation::over(port, Duration::from_secs_f64(self.wait)))
    }
}

/// A baud rate.
fn baud(text: &str) -> Result<u32, String> {
    super::whole::<50, 4_000_000>(text).map(|baud| baud as u32)
}

/// A silence in seconds.
fn wait(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.01..=LONGEST).contains(seconds));
    seconds.ok_or_else(|| format!("not a number of seconds from 0.01 to {LONGEST}"))
}

/// The command of words on the command line.
///
/// # Errors
/// What is wrong with them, and what may have been meant.
pub fn worded<'w>(words: impl IntoIterator<Item = &'w str>) -> Result<Words, Failure> {
    Words::of(words).map_err(|wrong| {
        let meant = match &wrong {
            NoWords::Unknown(name) => {
                let all = || format!("; there are {}", commands().join(", "));
                Some(nearest(name, commands().iter()))
                    .filter(|it| !it.is_empty())
                    .unwrap_or_else(all)
            }
            NoWords::Wrong(_) => String::new(),
        };
        Failure::misuse(format!("COMMAND: {wrong}{meant}"))
    })
}
