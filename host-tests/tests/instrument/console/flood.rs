//! Anything over the link, as fast as it takes: bytes, lines and frames that are nearly commands. Without a valid command the
//! azimuth is the same bit for bit.

use std::cell::{Cell, RefCell};

use embassy_time::Instant;
use firmware::health::Health;
use host::instrument::{Carrier, Run, Traffic, Trial};
use simulated::executed;
use simulated::flood::Flood;
use simulated::scenario::Scenario;

use crate::support::link::sentences;

/// Bytes that 115 200 baud bring in a millisecond, times ten.
const TENTHS: u64 = 115;
/// Bytes of a piece.
const PIECE: usize = 64;

/// Bytes without a pause.
struct Flow {
    bytes: RefCell<Flood>,
    sent: Cell<u64>,
}

impl Flow {
    /// Of this seed.
    fn of(seed: u64) -> Self {
        Self { bytes: RefCell::new(Flood::new(seed)), sent: Cell::new(0) }
    }
}

impl Traffic for Flow {
    fn next(&self) -> Option<(Instant, Vec<u8>)> {
        self.sent.set(self.sent.get() + PIECE as u64);
        let at = Instant::from_micros(self.sent.get() * 10_000 / TENTHS);
        Some((at, self.bytes.borrow_mut().by_ref().take(PIECE).collect()))
    }
}

/// What a run reported, all of it and bit for bit, what was lost, and what the link said.
fn shown<C, R, T>(trial: Trial<'_, C>) -> (Vec<String>, Health, String)
where
    C: Carrier<Run = Run<R, T>>,
{
    let run = trial.run().expect("it begins");
    // What is written of a number distinguishes it from each other one.
    let events = run.events.iter().map(|event| format!("{event:?}")).collect();
    (events, run.health, run.lines)
}

/// Runs a scenario with and without bytes that are no command; how many came.
fn flooded<C, R, T>(scenario: &C, seed: u64) -> u64
where
    C: Carrier<Run = Run<R, T>>,
{
    let flow = Flow::of(seed);
    let (quiet, lost, _) = shown(Trial::of(scenario));
    let (loud, lost_loud, said) = shown(Trial::of(scenario).traffic(&flow));
    assert!(quiet.len() > 3, "it reports something: {quiet:?}");
    assert_eq!((quiet, lost), (loud, lost_loud), "seed {seed}");
    let answers = sentences(&said, "PMRDR");
    let sent = flow.sent.get();
    assert!(answers.len() as u64 > sent / 2000, "they are answered: {} of {sent}", answers.len());
    assert!(answers.iter().all(|fields| fields[1] == "refused"), "none was a command");
    sent
}

#[test]
fn ten_million_bytes_without_a_command_leave_the_azimuth_as_it_is_bit_for_bit() {
    let (mut come, mut seed) = (0, 1);
    while come < 10_000_000 {
        let scenario = Scenario { sample_rate_hz: 100.0, ..Scenario::usual(seed) };
        (come, seed) = (come + flooded(&scenario, seed), seed + 1);
    }
}

#[test]
fn bytes_without_a_command_leave_what_every_carrier_finds_as_it_is_bit_for_bit() {
    flooded(&executed::two_frames(1), 1);
    flooded(&executed::turntable(1), 2);
    flooded(&executed::vehicle(1), 3);
    flooded(&executed::spin(1), 4);
}
