//! What the simulated driver moves in these tests, and the bare bus to it.

use embassy_time::{Duration, Instant};
use hal_mock::chip::{Rig, Select, Single, SpiChip, Transaction};
use hal_mock::environment::Mechanics;
use hal_mock::tmc5160::{Oscillator, Tmc5160};
use hal_mock::violation::Misuse;

/// A motor that notes where it was driven.
#[derive(Clone, Debug, Default)]
pub struct Motor {
    pub microsteps: f64,
    pub microsteps_per_s: f64,
    pub fastest: f64,
    pub highest: f64,
    pub lowest: f64,
    pub calls: usize,
    pub blocked: bool,
    /// The left switch is touched at and below this position.
    pub left_at: Option<f64>,
    pub right: bool,
}

impl Mechanics for Motor {
    fn drive(&mut self, _: Instant, microsteps: f64, microsteps_per_s: f64) {
        self.microsteps = microsteps;
        self.microsteps_per_s = microsteps_per_s;
        self.fastest = self.fastest.max(microsteps_per_s.abs());
        self.highest = self.highest.max(microsteps);
        self.lowest = self.lowest.min(microsteps);
        self.calls += 1;
    }

    fn is_blocked(&self) -> bool {
        self.blocked
    }

    fn reference_switches(&self) -> [bool; 2] {
        [self.left_at.is_some_and(|edge| self.microsteps <= edge), self.right]
    }
}

/// The internal oscillator as the data sheet has it.
pub const NOMINAL: Oscillator = Oscillator::Internal { hertz: 12_000_000 };

/// A chip on a bare bus.
pub struct Bus {
    pub single: Single<Tmc5160, Motor>,
    pub now: Instant,
}

impl Bus {
    /// After the reset delay.
    pub fn new() -> Self {
        let chip = Tmc5160::new(NOMINAL, Instant::from_micros(0));
        let single = Single { chip, environment: Motor::default() };
        Self { single, now: Instant::from_micros(100) }
    }

    /// Sends bytes, all at once.
    pub fn send(&mut self, hertz: u32, sent: &[u8]) -> Vec<u8> {
        let mut reply = vec![0; sent.len()];
        let transaction = Transaction { now: self.now, hertz, sent };
        self.single.transact(Select::Actuator, &transaction, &mut reply);
        self.now += Duration::from_micros(20);
        reply
    }

    /// A datagram of forty bits; status and data.
    pub fn datagram(&mut self, bits: u64) -> (u8, u32) {
        let reply = self.send(2_000_000, &bits.to_be_bytes()[3..]);
        (reply[0], u32::from_be_bytes([reply[1], reply[2], reply[3], reply[4]]))
    }

    pub fn write(&mut self, address: u8, data: u32) {
        self.datagram(u64::from(address | 0x80) << 32 | u64::from(data));
    }

    pub fn read(&mut self, address: u8) -> u32 {
        self.datagram(u64::from(address) << 32);
        self.datagram(u64::from(address) << 32).1
    }

    pub fn pass(&mut self, time: Duration) {
        self.now += time;
    }

    /// Lets the motor come to rest; the time it took from `since`, s.
    pub fn come_to_rest(&mut self, since: Instant) -> f64 {
        let Single { chip, environment } = &mut self.single;
        while let Some(at) = SpiChip::<Motor>::next_event(chip) {
            chip.event(environment);
            self.now = self.now.max(at);
            assert!(at < since + Duration::from_secs(4000), "it never rests");
        }
        (self.now - since).as_micros() as f64 * 1e-6
    }

    pub fn misuses(&self) -> Vec<Misuse> {
        let violations = SpiChip::<Motor>::violations(&self.single.chip);
        violations.first.iter().map(|violation| violation.misuse).collect()
    }
}
