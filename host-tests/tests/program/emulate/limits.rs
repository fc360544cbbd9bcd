//! Where a handmade image's memory goes, and figures against their budget.

use firmware::budget;
use host::emulate::checks::{self, Runs};
use host::emulate::collect::{Figures, Task};
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
    assert_eq!((budget::FILTER_INSTRUCTIONS, budget::IDLE_PERCENT), (115, 90));
    assert_eq!((budget::FLASH_BYTES, budget::STATIC_RAM_BYTES), (484 * 1024, 32 * 1024));
    // The README's 4 000 instructions are a tenth of the board's 80 million at 2 000 samples a second.
    assert_eq!(budget::SAMPLE_INSTRUCTIONS * 2000 * 10, 80_000_000);
}

/// A run of ten samples of so many instructions, whose longest poll takes so many.
fn figures(sample: u64, worst: u64) -> Figures {
    let task = |worst| Task { name: "task".into(), polls: 1, instructions: 1, worst };
    Figures {
        // Rounded up.
        instructions: 10 * sample - 9,
        simulation: 5,
        samples: 10,
        microseconds: 124,
        stack_bytes: budget::STACK_BYTES,
        tasks: vec![task(400), task(worst), task(3)],
    }
}

/// Runs at their limits.
fn runs() -> Runs {
    Runs {
        figures: figures(1, budget::POLL_INSTRUCTIONS),
        brief: figures(budget::SAMPLE_INSTRUCTIONS, 0),
        survey: figures(1, budget::SURVEY_POLL_INSTRUCTIONS),
        turning: figures(budget::TURNING_SAMPLE_INSTRUCTIONS, budget::POLL_INSTRUCTIONS),
        stops: figures(budget::STOPS_SAMPLE_INSTRUCTIONS, budget::POLL_INSTRUCTIONS),
    }
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
    assert_eq!(checks.len(), 11);
    assert!(
        checks.iter().all(|check| check.is_kept() && check.count == check.budget),
        "{checks:?}"
    );
}

#[test]
fn a_figure_beyond_its_limit_is_found() {
    let failing = |change: fn(&mut Runs, &mut Memory)| -> Vec<usize> {
        let (mut runs, mut memory) = (runs(), memory());
        change(&mut runs, &mut memory);
        let checks = checks::all(&runs, &memory);
        (0..checks.len()).filter(|&index| !checks[index].is_kept()).collect()
    };
    assert_eq!(failing(|runs, _| runs.brief.instructions += 10), [0, 5]);
    assert_eq!(failing(|runs, _| runs.turning.instructions += 10), [1, 6]);
    assert_eq!(failing(|runs, _| runs.stops.instructions += 10), [2]);
    assert_eq!(failing(|runs, _| runs.stops.tasks[0].worst = budget::POLL_INSTRUCTIONS + 1), [3]);
    assert_eq!(failing(|runs, _| runs.survey.tasks[1].worst += 1), [4]);
    assert_eq!(failing(|_, memory| memory.sections[0].flash_bytes += 1), [7]);
    assert_eq!(failing(|_, memory| memory.sections[0].ram_bytes += 1), [8]);
    assert_eq!(failing(|runs, _| runs.turning.stack_bytes += 1), [9, 10]);
    assert_eq!(failing(|_, memory| memory.stack_room_bytes -= 1), [10]);
}
