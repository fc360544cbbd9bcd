//! Where a handmade image's memory goes, and figures against their budget.

use firmware::budget;
use host::emulate::Run;
use host::emulate::checks;
use host::emulate::collect::{Figures, Task};
use host::emulate::jobs::{BRIEF_STAGE, JOBS, Job, SPIN, SURVEY, TURNTABLE, TWO_FRAME, VEHICLE};
use host::emulate::sections::{Memory, Section};

use super::handmade::{self, ABSOLUTE, ALLOC, EXECUTE, NOBITS, PROGBITS, WRITE};

fn image() -> Vec<u8> {
    let new = handmade::Section::new;
    let sections = [
        new(".vector_table", PROGBITS, ALLOC, 0x0800_0000, 1024),
        new(".text", PROGBITS, ALLOC | EXECUTE, 0x0800_0400, 5000),
        new(".etalon", PROGBITS, ALLOC, 0x0800_2000, 129_604),
        new(".data", PROGBITS, ALLOC | WRITE, 0x2000_0000, 40),
        new(".gnu.sgstubs", PROGBITS, ALLOC, 0x0810_0000, 0),
        new(".bss", NOBITS, ALLOC | WRITE, 0x2000_0028, 3000),
        new(".debug_info", PROGBITS, 0, 0, 70_000),
    ];
    let symbols = [("_stack_start", 0x2001_8000, ABSOLUTE), ("_stack_end", 0x2000_0C00, ABSOLUTE)];
    handmade::elf(&sections, &symbols)
}

#[test]
fn every_section_is_counted_where_it_takes_memory() {
    let memory = Memory::of(&image()).expect("an image");
    let section = |name: &str, flash_bytes, ram_bytes| Section {
        name: name.to_owned(),
        flash_bytes,
        ram_bytes,
    };
    let expected = [
        section(".vector_table", 1024, 0),
        section(".text", 5000, 0),
        section(".etalon", 129_604, 0),
        section(".data", 40, 40),
        section(".bss", 0, 3000),
    ];
    assert_eq!(memory.sections, expected);
    assert_eq!((memory.flash_bytes(), memory.ram_bytes()), (135_668, 3040));
    assert_eq!(memory.stack_room_bytes, 0x2001_8000 - 0x2000_0C00);
}

#[test]
fn an_image_without_stack_symbols_is_refused() {
    let error = Memory::of(&handmade::elf(&[], &[])).expect_err("no symbols");
    assert_eq!(error, "no symbol _stack_start");
}

#[test]
fn the_budget_of_the_firmware_is_that_of_its_file() {
    assert_eq!((budget::FILTER_INSTRUCTIONS, budget::IDLE_PERCENT), (115, 88));
    assert_eq!(
        (budget::BOARD_FLASH_BYTES, budget::BOARD_STATIC_RAM_BYTES),
        (448 * 1024, 36 * 1024)
    );
    // As the file says, less than 12 % of the board's 64 million at 2 000 samples a second.
    assert_eq!(budget::SAMPLE_INSTRUCTIONS * 2000 * 100 / 64_000_000, 11);
}

/// A run of ten samples of so many instructions, whose longest poll takes so many.
fn figures(sample: u64, worst: u64) -> Figures {
    let task = |worst| Task { name: "task".into(), polls: 1, instructions: 1, worst };
    Figures {
        // Rounded up.
        instructions: 10 * sample - 9,
        stand_ins: 2,
        simulation: 5,
        samples: 10,
        microseconds: 124,
        stack_bytes: budget::STACK_BYTES,
        tasks: vec![task(400), task(worst), task(3)],
    }
}

/// All runs at their limits.
fn runs() -> Vec<Run> {
    let run = |job: &'static Job| {
        let poll = if job.word == SURVEY.word {
            budget::SURVEY_POLL_INSTRUCTIONS
        } else {
            budget::POLL_INSTRUCTIONS
        };
        Run { job, figures: figures(job.sample_budget.unwrap_or(1), poll) }
    };
    JOBS.map(run).into()
}

/// The run of a job.
fn run_of<'r>(runs: &'r mut [Run], job: &Job) -> &'r mut Figures {
    let run = runs.iter_mut().find(|run| run.job.word == job.word);
    &mut run.expect("all jobs are run").figures
}

/// The memory of an image at its limits.
fn memory() -> Memory {
    let [flash_bytes, ram_bytes] = [budget::FLASH_BYTES, budget::STATIC_RAM_BYTES];
    let section = Section { name: ".text".into(), flash_bytes, ram_bytes };
    Memory { sections: vec![section], stack_room_bytes: 2 * budget::STACK_BYTES }
}

#[test]
fn figures_at_their_limits_are_within_them() {
    let checks = checks::all(&runs(), &memory());
    assert_eq!(checks.len(), 12);
    assert!(
        checks.iter().all(|check| check.is_kept() && check.count == check.budget),
        "{checks:?}"
    );
}

/// What makes a figure worse.
type Worse = fn(&mut [Run], &mut Memory);

#[test]
fn a_figure_beyond_its_limit_is_found() {
    let sample = "instructions a sample, ";
    let idle = "percent idle at 2000 Hz, at least, ";
    // A hundredth of 64 MHz at 2 kHz is 320 instructions a sample: 400 more than the limit take the next one.
    let changes: [(Worse, &[&str]); 8] = [
        (|runs, _| run_of(runs, &BRIEF_STAGE).instructions += 4010, &[sample, idle]),
        (|runs, _| run_of(runs, &TURNTABLE).instructions += 4010, &[sample, idle]),
        (|runs, _| run_of(runs, &VEHICLE).instructions += 10, &[sample]),
        (|runs, _| run_of(runs, &SPIN).instructions += 10, &[sample]),
        (|runs, _| run_of(runs, &VEHICLE).tasks[1].worst += 1, &["instructions of the longest"]),
        (|runs, _| run_of(runs, &SURVEY).tasks[1].worst += 1, &["the same where the noise"]),
        (|_, memory| memory.sections[0].flash_bytes += 1, &["bytes of flash"]),
        (|_, memory| memory.sections[0].ram_bytes += 1, &["bytes of static RAM"]),
    ];
    for (change, expected) in changes {
        let (mut runs, mut memory) = (runs(), memory());
        change(&mut runs, &mut memory);
        let checks = checks::all(&runs, &memory);
        let failing: Vec<_> = checks.iter().filter(|check| !check.is_kept()).collect();
        assert_eq!(failing.len(), expected.len(), "{failing:?}");
        for (check, begin) in failing.iter().zip(expected) {
            assert!(check.what.starts_with(begin), "{check:?}");
        }
    }
}

#[test]
fn the_deepest_stack_of_any_run_is_held_to_its_limit() {
    let (mut runs, memory) = (runs(), memory());
    run_of(&mut runs, &TWO_FRAME).stack_bytes += 1;
    let checks = checks::all(&runs, &memory);
    let failing = checks.iter().filter(|check| !check.is_kept()).map(|check| check.what.as_str());
    assert_eq!(failing.collect::<Vec<_>>(), ["bytes of stack at its deepest"]);
}
