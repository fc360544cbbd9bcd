//! Anything over the link, as fast as it takes: bytes, lines and frames that are nearly commands. Without a valid command the
//! azimuth is the same bit for bit.

use std::cell::{Cell, RefCell};

use embassy_time::Instant;
use firmware::event::Event;
use host::instrument::{Traffic, Trial};
use orientation::alignment::{Azimuth, Progress};
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

/// The azimuth that a stage finds, what was lost, and what the link said, with this traffic.
fn found(scenario: &Scenario, traffic: Option<&Flow>) -> ([u64; 2], [u32; 3], String) {
    let trial = Trial::of(scenario);
    let trial = match traffic {
        Some(traffic) => trial.traffic(traffic),
        None => trial,
    };
    let run = trial.run().expect("it begins");
    let azimuth = run.events.iter().find_map(|(_, event)| match event {
        Event::Alignment(Progress::Concluded(solution)) => Some(solution.azimuth),
        _ => None,
    });
    let Azimuth { angle, sigma } = azimuth.expect("it concludes");
    let lost = [run.health.faults(), run.health.overflowed, run.health.unsent];
    ([angle.0.to_bits(), sigma.0.to_bits()], lost, run.lines)
}

/// Runs alignments until so many bytes have come.
fn flooded(bytes: u64) {
    let (mut come, mut seed) = (0, 1);
    while come < bytes {
        let scenario = Scenario { sample_rate_hz: 100.0, ..Scenario::usual(seed) };
        let flow = Flow::of(seed);
        let (quiet, lost, _) = found(&scenario, None);
        let (loud, lost_loud, said) = found(&scenario, Some(&flow));
        assert_eq!((quiet, lost), (loud, lost_loud), "seed {seed}");
        let answers = sentences(&said, "PMRDR");
        assert!(answers.len() > 1000, "they are answered: {}", answers.len());
        assert!(answers.iter().all(|fields| fields[1] == "refused"), "none was a command");
        (come, seed) = (come + flow.sent.get(), seed + 1);
    }
}

#[test]
fn ten_million_bytes_without_a_command_leave_the_azimuth_as_it_is_bit_for_bit() {
    flooded(10_000_000);
}
