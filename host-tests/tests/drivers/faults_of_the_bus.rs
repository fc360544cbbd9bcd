//! Each fault of the bus does exactly what it says, in its time, and nothing before.
//!
//! The chip of these tests counts what it hears: it answers with the number of the transaction, then
//! with the complement of each byte that was sent, one place later. Its data-ready line falls every
//! millisecond.

use std::cell::RefCell;
use std::convert::Infallible;

use embassy_time::{Duration, Instant, Timer, with_timeout};
use embedded_hal::digital::ErrorType as PinErrorType;
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::{Error, ErrorKind, ErrorType, Operation, SpiDevice};
use hal_mock::chip::{Exchange, ReadyLine, Select, Single, SpiChip};
use hal_mock::fault::{BusFault, FaultPlan, FaultyReady, FaultySpi, When};
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::violation::Violations;
use host::virtual_time::{Deadlock, run};

/// Bus clock, Hz: 1 µs a byte.
const HERTZ: u32 = 8_000_000;

/// Period of the data-ready line, µs.
const PERIOD: u64 = 1000;

#[derive(Debug, Default)]
struct Counter {
    heard: Vec<Vec<u8>>,
    edges: u64,
    violations: Violations,
}

impl SpiChip<()> for Counter {
    fn next_event(&self) -> Option<Instant> {
        Some(Instant::from_micros((self.edges + 1) * PERIOD))
    }

    fn event(&mut self, (): &mut ()) {
        self.edges += 1;
    }

    fn select(&mut self, (): &mut (), _: Instant) {
        self.heard.push(Vec::new());
    }

    fn exchange(&mut self, (): &mut (), exchange: &Exchange) -> u8 {
        let count = self.heard.len() as u8;
        let heard = self.heard.last_mut().expect("it is selected");
        let answer = heard.last().map_or(count, |byte| !byte);
        heard.push(exchange.sent);
        answer
    }

    fn deselect(&mut self, (): &mut (), _: Instant, _: bool) {}

    fn ready_line(&self) -> ReadyLine {
        ReadyLine { active: true, next: self.next_event(), ..ReadyLine::default() }
    }

    fn power_cycle(&mut self, _: Instant) {}

    fn violations(&self) -> &Violations {
        &self.violations
    }
}

type Rig = RefCell<Single<Counter, ()>>;

fn rig() -> Rig {
    RefCell::new(Single { chip: Counter::default(), environment: () })
}

fn device(rig: &Rig, fault: BusFault, when: When) -> FaultySpi<SpiPort<'_>> {
    let port = SpiPort::new(rig, Select::Gyro, HERTZ);
    FaultySpi::new(port, Some(FaultPlan { fault, when }))
}

fn heard(rig: &Rig) -> usize {
    rig.borrow().chip.heard.len()
}

fn micros(micros: u64) -> Instant {
    Instant::from_micros(micros)
}

/// What the chip answers as its `count`-th transaction.
fn answer(count: usize, sent: &[u8]) -> Vec<u8> {
    let mut answer = vec![count as u8];
    answer.extend(sent.iter().map(|byte| !byte));
    answer.truncate(sent.len());
    answer
}

/// A transfer of these bytes, with the result and the reply.
async fn ask(
    device: &mut impl SpiDevice<Error = ErrorKind>,
    sent: &[u8],
) -> (Result<(), ErrorKind>, Vec<u8>) {
    let mut reply = vec![0xaa; sent.len()];
    let result = device.transfer(&mut reply, sent).await;
    (result, reply)
}

/// As the healthy chip answers its `count`-th transaction.
async fn is_healthy(
    device: &mut impl SpiDevice<Error = ErrorKind>,
    count: usize,
    sent: &[u8],
) -> bool {
    ask(device, sent).await == (Ok(()), answer(count, sent))
}

const SENT: [u8; 3] = [5, 6, 7];

const ALL: [BusFault; 5] = [
    BusFault::Error,
    BusFault::FlippedBit { seed: 3 },
    BusFault::Stuck,
    BusFault::Missing { level: 0xff },
    BusFault::Hang,
];

/// All that happens to one transaction of every kind of operation.
async fn mixed(
    device: &mut impl SpiDevice<Error = ErrorKind>,
) -> (Result<(), ErrorKind>, Vec<u8>, Instant) {
    let (mut read, mut longer, mut in_place) = ([0xaa; 2], [0xaa; 4], [9, 8]);
    let mut operations = [
        Operation::Write(&SENT),
        Operation::Read(&mut read),
        Operation::DelayNs(3000),
        Operation::Transfer(&mut longer, &[1, 2]),
        Operation::TransferInPlace(&mut in_place),
    ];
    let result = device.transaction(&mut operations).await;
    (result, [&read[..], &longer, &in_place].concat(), Instant::now())
}

#[test]
fn without_a_plan_everything_passes_unchanged() {
    let bare = run(async {
        let rig = rig();
        mixed(&mut SpiPort::new(&rig, Select::Gyro, HERTZ)).await
    });
    let wrapped = run(async {
        let rig = rig();
        mixed(&mut FaultySpi::new(SpiPort::new(&rig, Select::Gyro, HERTZ), None)).await
    });
    assert_eq!(bare, wrapped);
    // 11 bytes and a pause of 3 µs.
    assert_eq!(bare.expect("it ends").2, micros(14));
}

#[test]
fn no_fault_shows_before_its_time_or_after_it() {
    for fault in ALL {
        run(async {
            let rig = rig();
            let duration = Duration::from_micros(500);
            let mut device = device(&rig, fault, When::during(micros(1000), duration));
            for count in 1..=333 {
                assert!(is_healthy(&mut device, count, &SENT).await, "{fault:?} {count}");
            }
            assert_eq!(Instant::now(), micros(999));
            Timer::at(micros(1500)).await;
            assert!(is_healthy(&mut device, 334, &SENT).await, "{fault:?}");
            assert_eq!(Instant::now(), micros(1503));
        })
        .expect("it ends");
    }
}

#[test]
fn a_bus_error_loses_the_reply_of_what_the_chip_has_heard() {
    run(async {
        let rig = rig();
        let mut device = device(&rig, BusFault::Error, When::once(micros(3)));
        assert!(is_healthy(&mut device, 1, &SENT).await);
        assert_eq!(ask(&mut device, &SENT).await, (Err(ErrorKind::Overrun), vec![0; 3]));
        assert_eq!(heard(&rig), 2);
        assert_eq!(Instant::now(), micros(6));
        assert!(is_healthy(&mut device, 3, &SENT).await);
    })
    .expect("it ends");
}

#[test]
fn a_lasting_bus_error_lasts() {
    run(async {
        let rig = rig();
        let mut device = device(&rig, BusFault::Error, When::always(micros(0)));
        for _ in 0..100 {
            assert_eq!(device.write(&SENT).await, Err(ErrorKind::Overrun));
        }
    })
    .expect("it ends");
}

/// Bits in which two replies differ, counted from the first byte's lowest.
fn flipped(reply: &[u8], healthy: &[u8]) -> Vec<usize> {
    let bits = 0..8 * reply.len();
    bits.filter(|bit| (reply[bit / 8] ^ healthy[bit / 8]) >> (bit % 8) & 1 == 1).collect()
}

/// Bits flipped in so many transfers of three bytes.
fn flips(seed: u64, when: When, transfers: usize) -> Vec<Vec<usize>> {
    run(async {
        let rig = rig();
        let mut device = device(&rig, BusFault::FlippedBit { seed }, when);
        let mut found = Vec::new();
        for count in 1..=transfers {
            let (result, reply) = ask(&mut device, &SENT).await;
            assert_eq!(result, Ok(()));
            found.push(flipped(&reply, &answer(count, &SENT)));
        }
        found
    })
    .expect("it ends")
}

#[test]
fn one_bit_of_one_reply_is_flipped() {
    let found = flips(11, When::once(micros(6)), 20);
    let counts: Vec<usize> = found.iter().map(Vec::len).collect();
    assert_eq!(counts[..4], [0, 0, 1, 0]);
    assert_eq!(counts.iter().sum::<usize>(), 1);
}

#[test]
fn one_bit_of_every_reply_is_flipped_any_of_them_as_the_seed_says() {
    let always = When::always(micros(0));
    let found = flips(11, always, 400);
    assert!(found.iter().all(|bits| bits.len() == 1));
    for bit in 0..24 {
        // 400/24 = 17 of each are expected.
        let count = found.iter().filter(|bits| bits[0] == bit).count();
        assert!((4..=34).contains(&count), "bit {bit} {count} times");
    }
    assert_eq!(flips(11, always, 400), found);
    assert_ne!(flips(12, always, 400), found);
}

#[test]
fn a_bit_is_flipped_where_there_is_a_reply_and_what_is_written_stays_whole() {
    run(async {
        let rig = rig();
        let mut device = device(&rig, BusFault::FlippedBit { seed: 5 }, When::once(micros(0)));
        assert_eq!(device.write(&SENT).await, Ok(()));
        let mut reply = [0; 2];
        let mut operations = [Operation::Write(&SENT), Operation::Read(&mut reply)];
        assert_eq!(device.transaction(&mut operations).await, Ok(()));
        assert_eq!(flipped(&reply, &[!SENT[2], !0]).len(), 1);
        assert_eq!(rig.borrow().chip.heard, [SENT.to_vec(), vec![5, 6, 7, 0, 0]]);
        assert!(is_healthy(&mut device, 3, &SENT).await);
    })
    .expect("it ends");
}

#[test]
fn stuck_data_repeats_the_last_healthy_reply_of_the_same_first_byte_and_length() {
    run(async {
        let rig = rig();
        let mut device = device(&rig, BusFault::Stuck, When::always(micros(100)));
        assert!(is_healthy(&mut device, 1, &[5, 0, 0]).await);
        assert!(is_healthy(&mut device, 2, &[5, 1, 1]).await);
        assert!(is_healthy(&mut device, 3, &[5, 0]).await);
        assert!(is_healthy(&mut device, 4, &[6, 0, 0]).await);
        Timer::at(micros(100)).await;
        for _ in 0..3 {
            assert_eq!(ask(&mut device, &[5, 9, 9]).await, (Ok(()), answer(2, &[5, 1, 1])));
        }
        assert_eq!(ask(&mut device, &[5, 9]).await, (Ok(()), answer(3, &[5, 0])));
        assert_eq!(ask(&mut device, &[6, 9, 9]).await, (Ok(()), answer(4, &[6, 0, 0])));
        // The chip goes on, and what it never answered before it answers now.
        assert_eq!(heard(&rig), 9);
        assert!(is_healthy(&mut device, 10, &[8, 0, 0]).await);
        assert!(is_healthy(&mut device, 11, &[8, 0, 0]).await);
    })
    .expect("it ends");
}

#[test]
fn stuck_data_repeats_through_every_kind_of_operation_and_recalls_the_latest_kinds() {
    run(async {
        let rig = rig();
        let mut device =
            device(&rig, BusFault::Stuck, When::during(micros(100), Duration::from_micros(100)));
        for first in 0..20 {
            assert!(is_healthy(&mut device, usize::from(first) + 1, &[first, 0]).await);
        }
        Timer::at(micros(100)).await;
        for first in 16..20 {
            let old = answer(usize::from(first) + 1, &[first, 0]);
            let mut bytes = [first, 7];
            assert_eq!(device.transfer_in_place(&mut bytes).await, Ok(()));
            assert_eq!(bytes, old[..]);
            let mut operations = [Operation::Write(&[first]), Operation::Read(&mut bytes[1..])];
            assert_eq!(device.transaction(&mut operations).await, Ok(()));
            // The read byte of this shape is the first remembered one.
            assert_eq!(bytes[1], old[0]);
        }
        assert!(is_healthy(&mut device, 29, &[1, 0]).await);
        Timer::at(micros(200)).await;
        assert!(is_healthy(&mut device, 30, &[19, 0]).await);
    })
    .expect("it ends");
}

#[test]
fn a_missing_device_hears_nothing_and_its_line_never_changes() {
    for level in [0x00, 0xff] {
        run(async {
            let rig = rig();
            let mut device = device(&rig, BusFault::Missing { level }, When::always(micros(0)));
            assert_eq!(ask(&mut device, &SENT).await, (Ok(()), vec![level; 3]));
            let (result, replies, _) = mixed(&mut device).await;
            assert_eq!((result, replies), (Ok(()), vec![level; 8]));
            assert_eq!(heard(&rig), 0);
            // 3 and 11 bytes at 1 MHz: the clock goes on.
            assert_eq!(Instant::now(), micros(14 * 8));
        })
        .expect("it ends");
    }
}

#[test]
fn a_transfer_that_hangs_once_is_given_up_and_has_sent_nothing() {
    run(async {
        let rig = rig();
        let mut device = device(&rig, BusFault::Hang, When::once(micros(0)));
        assert_eq!(ask(&mut device, &SENT).await.0, Err(ErrorKind::Other));
        assert_eq!((heard(&rig), Instant::now()), (0, micros(1000)));
        assert!(is_healthy(&mut device, 1, &SENT).await);
        assert_eq!(Instant::now(), micros(1003));
    })
    .expect("it ends");
}

/// A device with an error of its own.
struct Broken;

#[derive(Debug)]
struct OwnError;

impl Error for OwnError {
    fn kind(&self) -> ErrorKind {
        ErrorKind::ModeFault
    }
}

impl ErrorType for Broken {
    type Error = OwnError;
}

impl SpiDevice for Broken {
    async fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), OwnError> {
        Err(OwnError)
    }
}

#[test]
fn the_errors_of_a_device_keep_their_kind() {
    let result = run(async { FaultySpi::new(Broken, None).write(&SENT).await });
    assert_eq!(result, Ok(Err(ErrorKind::ModeFault)));
}

// Data-ready -------------------------------------------------------------------------------------

fn line(rig: &Rig, when: Option<When>) -> FaultyReady<ReadyPin<'_>> {
    FaultyReady::new(ReadyPin::new(rig, Select::Gyro), when, None)
}

/// Moments of the next falling edges, µs.
async fn edges(line: &mut impl Wait, count: usize) -> Vec<u64> {
    let mut seen = Vec::new();
    for _ in 0..count {
        line.wait_for_falling_edge().await.expect("a pin does not fail");
        seen.push(Instant::now().as_micros());
    }
    seen
}

#[test]
fn a_healthy_line_passes_every_edge() {
    let seen = run(async { edges(&mut line(&rig(), None), 3).await });
    assert_eq!(seen, Ok(vec![1000, 2000, 3000]));
}

#[test]
fn an_edge_is_lost_once() {
    let when = When::once(micros(1500));
    let seen = run(async { edges(&mut line(&rig(), Some(when)), 4).await });
    assert_eq!(seen, Ok(vec![1000, 3000, 4000, 5000]));
}

#[test]
fn edges_are_lost_for_a_while() {
    let when = When::during(micros(2000), Duration::from_micros(3000));
    let seen = run(async { edges(&mut line(&rig(), Some(when)), 4).await });
    assert_eq!(seen, Ok(vec![1000, 5000, 6000, 7000]));
}

#[test]
fn edges_are_lost_for_ever_and_a_patient_reader_sees_the_time_pass() {
    let result = run(async {
        let rig = rig();
        let mut line = line(&rig, Some(When::always(micros(1500))));
        assert_eq!(edges(&mut line, 1).await, [1000]);
        for _ in 0..3 {
            let waiting = line.wait_for_falling_edge();
            assert!(with_timeout(Duration::from_millis(20), waiting).await.is_err());
        }
        Instant::now()
    });
    assert_eq!(result, Ok(micros(61_000)));
}

#[test]
fn the_level_that_a_lost_edge_brought_is_not_seen_until_the_next() {
    let result = run(async {
        let rig = rig();
        let mut line = line(&rig, Some(When::once(micros(500))));
        line.wait_for_low().await.expect("a pin does not fail");
        assert_eq!(Instant::now(), micros(0));
        Timer::at(micros(1200)).await;
        line.wait_for_low().await.expect("a pin does not fail");
        assert_eq!(Instant::now(), micros(2000));
        line.wait_for_low().await.expect("a pin does not fail");
        Instant::now()
    });
    assert_eq!(result, Ok(micros(2000)));
}

#[test]
fn giving_up_on_a_line_costs_no_edge_but_the_lost_one() {
    let result = run(async {
        let rig = rig();
        let mut line = line(&rig, Some(When::once(micros(500))));
        let waiting = line.wait_for_falling_edge();
        assert!(with_timeout(Duration::from_micros(1500), waiting).await.is_err());
        edges(&mut line, 2).await
    });
    assert_eq!(result, Ok(vec![2000, 3000]));
}

/// A line whose every event happens at once.
struct Busy {
    asked: Vec<&'static str>,
}

impl PinErrorType for Busy {
    type Error = Infallible;
}

impl Wait for Busy {
    async fn wait_for_high(&mut self) -> Result<(), Infallible> {
        self.asked.push("high");
        Ok(())
    }

    async fn wait_for_low(&mut self) -> Result<(), Infallible> {
        self.asked.push("low");
        Ok(())
    }

    async fn wait_for_rising_edge(&mut self) -> Result<(), Infallible> {
        self.asked.push("rising");
        Ok(())
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), Infallible> {
        self.asked.push("falling");
        Ok(())
    }

    async fn wait_for_any_edge(&mut self) -> Result<(), Infallible> {
        self.asked.push("any");
        Ok(())
    }
}

#[test]
fn every_wait_asks_the_line_for_what_was_asked() {
    let result = run(async {
        let mut busy = Busy { asked: Vec::new() };
        let mut line = FaultyReady::new(&mut busy, None, None);
        let _ = line.wait_for_high().await;
        let _ = line.wait_for_low().await;
        let _ = line.wait_for_rising_edge().await;
        let _ = line.wait_for_falling_edge().await;
        let _ = line.wait_for_any_edge().await;
        let mut line = FaultyReady::new(&mut busy, Some(When::once(micros(0))), None);
        let _ = line.wait_for_high().await;
        busy.asked
    });
    let expected = ["high", "low", "rising", "falling", "any", "high", "rising"];
    assert_eq!(result, Ok::<_, Deadlock>(expected.to_vec()));
}
