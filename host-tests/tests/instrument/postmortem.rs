//! What is left of a run that ended: records and check-ins in RAM that may hold anything.

use std::fmt::Write;
use std::future::{Future, pending, ready};
use std::pin::pin;
use std::task::{Context, Waker};

use firmware::check_ins::{CheckIns, Checked, Part};
use firmware::postmortem::{CALLERS, End, Outlasting, Record, Registers, Text, WORDS};
use proptest::prelude::*;

/// Words of a panic.
fn text(words: &str) -> Text {
    let mut text = Text::default();
    write!(text, "{words}").expect("it never fails");
    text
}

/// Any record.
fn records() -> impl Strategy<Value = Record> {
    let ends =
        prop_oneof![Just(End::None), Just(End::Panic), Just(End::Fault), Just(End::Unhandled),];
    let numbers = any::<(u32, u32, bool, [u32; 8], [u32; CALLERS])>();
    (ends, numbers, any::<String>()).prop_map(|(end, numbers, words)| {
        let (number, resets, is_crystal_dead, registers, callers) = numbers;
        let [pc, lr, psr, sp, cfsr, hfsr, mmfar, bfar] = registers;
        let registers = Registers { pc, lr, psr, sp, cfsr, hfsr, mmfar, bfar };
        Record { end, number, resets, is_crystal_dead, registers, callers, text: text(&words) }
    })
}

proptest! {
    #[test]
    fn a_record_is_read_as_it_was_written(record in records()) {
        prop_assert_eq!(Record::from_words(&record.to_words()), Some(record));
    }

    #[test]
    fn a_record_with_wrong_bits_is_none(
        record in records(),
        word in 0..WORDS,
        bits in 1..=u32::MAX,
    ) {
        // The CRC-32 finds any error within 32 bits in a row.
        let mut words = record.to_words();
        words[word] ^= bits;
        prop_assert_eq!(Record::from_words(&words), None);
    }

    #[test]
    fn what_ram_holds_after_a_power_on_is_no_record(words in any::<[u32; WORDS]>()) {
        prop_assert_eq!(Record::from_words(&words), None);
    }
}

/// Polls a future once.
fn poll(future: impl Future + Unpin) -> bool {
    let mut future = future;
    let mut context = Context::from_waker(Waker::noop());
    std::pin::Pin::new(&mut future).poll(&mut context).is_ready()
}

/// The lines that a start logs.
fn lines(run: &Outlasting, by_watchdog: bool, by_supply: bool) -> Vec<String> {
    let last = run.begin().expect("a run has begun before");
    let how = last.how(by_watchdog, by_supply);
    how.iter().flat_map(|how| last.lines(*how)).flatten().map(|line| line.to_string()).collect()
}

#[test]
fn the_first_start_finds_nothing_and_each_later_one_counts_a_reset() {
    let run = Outlasting::new();
    assert_eq!(run.begin(), None);
    for resets in 0..3 {
        let last = run.begin().expect("a record");
        assert_eq!((last.record.resets, last.record.end), (resets, End::None));
    }
}

#[test]
fn a_fault_is_told_with_its_registers_and_a_run_that_ended_on_purpose_is_not() {
    let run = Outlasting::new();
    run.begin();
    let registers =
        Registers { pc: 0x0800_1234, cfsr: 0x100, hfsr: 1 << 30, ..Registers::default() };
    let record = run.record().expect("it has begun");
    run.pass_second();
    run.note(&Record { end: End::Fault, registers, callers: [0x0800_0001; CALLERS], ..record });
    let told = lines(&run, false, false);
    assert_eq!(
        told,
        [
            "last reset: fault of the core in no part after 1 s, 0 resets before; running: none; missing: none",
            "PC 0x08001234, LR 0x00000000, PSR 0x00000000, SP 0x00000000",
            "CFSR 0x00000100, HFSR 0x40000000, MMFAR 0x00000000, BFAR 0x00000000",
            "called from 0x08000001 0x08000001 0x08000001 0x08000001 0x08000001 0x08000001",
        ]
    );
    assert_eq!(lines(&run, false, false), [""; 0]);
    assert!(lines(&run, false, true)[0].starts_with("last reset: brown-out"));
}

#[test]
fn a_panic_is_told_with_its_place_and_its_message() {
    let run = Outlasting::new();
    run.begin();
    let mut record = Record { end: End::Panic, ..run.record().expect("it has begun") };
    write!(record.text, "src/run.rs:{}: ", 7).expect("it never fails");
    write!(record.text, "assertion failed\n  left: 1").expect("it never fails");
    run.note(&record);
    let told = lines(&run, false, false);
    assert_eq!(told[1..], ["panicked at src/run.rs:7: assertion failed   left: 1"]);
}

#[test]
fn what_does_not_fit_of_a_panic_is_left_out_with_the_character_that_is_cut() {
    let long = format!("{}°°", "a".repeat(157));
    assert_eq!(text(&long).as_str(), format!("{}°", "a".repeat(157)));
    assert_eq!(text("").as_str(), "");
}

#[test]
fn registers_that_could_not_be_stacked_are_a_stack_overflow() {
    let overflows = |cfsr| Registers { cfsr, ..Registers::default() }.is_stack_overflow();
    assert_eq!([0, 1 << 4, 1 << 12, 0x8200].map(overflows), [false, true, true, false]);
}

#[test]
fn a_part_that_does_not_check_in_is_missing_until_it_ends() {
    let check_ins = CheckIns::new();
    let mut acquisition = Checked::new(Some(&check_ins), Part::Acquisition, pending::<()>());
    let mut link = Checked::new(Some(&check_ins), Part::Link, pending::<()>());
    assert!(check_ins.renew());
    assert!(!poll(&mut acquisition) && !poll(&mut link));
    assert!(check_ins.renew());
    assert_eq!(check_ins.missing().to_string(), "acquisition, link");
    poll(&mut acquisition);
    assert!(!check_ins.renew());
    assert_eq!(check_ins.missing().to_string(), "link");
    drop(link);
    assert!(check_ins.renew());
    drop(acquisition);
    assert!(check_ins.renew() && check_ins.missing().is_empty());
}

#[test]
fn a_part_that_never_returns_is_the_one_that_runs() {
    let run = Outlasting::new();
    run.begin();
    let check_ins = &run.check_ins;
    // What would never return shows instead what a start would find now.
    let stuck = pin!(async {
        assert_eq!(check_ins.running().to_string(), "aligner");
        let above = pin!(async { assert_eq!(check_ins.running().to_string(), "keeper") });
        assert!(poll(Checked::new(Some(check_ins), Part::Keeper, above)));
        lines(&run, true, false)
    });
    let mut context = Context::from_waker(Waker::noop());
    let mut aligner = Checked::new(Some(check_ins), Part::Aligner, stuck);
    let std::task::Poll::Ready(told) = std::pin::Pin::new(&mut aligner).poll(&mut context) else {
        panic!("it waits for nothing");
    };
    assert_eq!(
        told,
        [
            "last reset: stuck task in aligner after 0 s, 0 resets before; running: aligner; missing: aligner"
        ]
    );
}

/// What a start after the watchdog calls the part, where all went on until then, but for so many looks for a part.
fn part_after(vain: u32) -> &'static str {
    let run = Outlasting::new();
    run.begin();
    let mut link = Checked::new(Some(&run.check_ins), Part::Link, pending::<()>());
    assert!(!poll(&mut link) && run.check_ins.renew());
    (0..vain).for_each(|_| assert!(!run.check_ins.renew()));
    let last = run.begin().expect("a run has begun before");
    last.part(last.how(true, false).expect("the watchdog has ended it"))
}

#[test]
fn a_thread_that_is_stuck_outside_of_any_part_is_told_from_a_part_that_waits_for_ever() {
    // Who looks for the parts does so no more, although the link had not checked in.
    assert_eq!([0, 1].map(part_after), ["the thread, outside of any part"; 2]);
    assert_eq!([2, 7].map(part_after), ["link"; 2]);
}

#[test]
fn where_nobody_looks_a_part_is_what_it_is() {
    assert!(poll(Checked::new(None, Part::Link, ready(()))));
}
