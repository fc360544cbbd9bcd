//! Where a handmade image's memory goes, and figures against their budget.

use host::emulate::budget::{Budget, NAMES};
use host::emulate::checks::{self, Check, Runs};
use host::emulate::collect::{Figures, Task};
use host::emulate::images::root;
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
fn the_budget_of_the_firmware_has_a_limit_for_everything() {
    let budget = Budget::read(&root().join("firmware/budget.toml")).expect("it is well formed");
    assert!(NAMES.iter().all(|name| budget.limit(name) > 0));
    assert_eq!(budget.limit("filter_instructions"), 115);
    assert_eq!(budget.limit("filter_and_dwell_instructions"), 150);
    assert_eq!(budget.limit("match_instructions"), 310_000);
    assert_eq!(budget.limit("flash_bytes"), 484 * 1024);
    assert_eq!(budget.limit("static_ram_bytes"), 32 * 1024);
    assert_eq!(budget.limit("idle_percent"), 90);
    assert_eq!(budget.limit("turning_instructions"), 250);
    assert_eq!(budget.limit("nothing"), 0);
}

#[test]
fn a_budget_that_is_not_well_formed_says_where() {
    let whole = NAMES.map(|name| format!("{name} = 1 # why\n")).concat();
    assert!(Budget::parse(&format!("# remark\n\n{whole}")).is_ok());
    let error = |text: String| Budget::parse(&text).expect_err("not well formed");
    assert_eq!(error(format!("{whole}speed = 1")), "line 25: `speed` is no limit");
    assert_eq!(error(format!("speed\n{whole}")), "line 1: not `name = number`");
    assert_eq!(error(format!("{whole}flash_bytes = 2")), "line 25: flash_bytes stands twice");
    assert_eq!(
        error(whole.replace("stack_bytes = 1", "stack_bytes = -1")),
        "line 24: the limit of stack_bytes is no whole number"
    );
    assert_eq!(error(whole.replace("idle_percent = 1", "")), "idle_percent is missing");
}

fn budget() -> Budget {
    let values = [
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4000, 4000, 4000, 500, 500, 90, 135_668, 3040,
        4096,
    ];
    let lines = NAMES.iter().zip(values).map(|(name, value)| format!("{name} = {value}"));
    Budget::parse(&lines.collect::<Vec<_>>().join("\n")).expect("well formed")
}

fn figures() -> Figures {
    let task = |worst| Task { name: "task".into(), polls: 1, instructions: 1, worst };
    Figures {
        // 4000 instructions a sample, rounded up: with 2000 samples a second a tenth of 80 million.
        instructions: 39_991,
        simulation: 5,
        samples: 10,
        microseconds: 124,
        stack_bytes: 4096,
        tasks: vec![task(400), task(500), task(3)],
    }
}

/// The same in every run.
fn alike(figures: &Figures) -> Runs {
    let [brief, survey, turning, stops] = [(); 4].map(|()| figures.clone());
    Runs { figures: figures.clone(), brief, survey, turning, stops }
}

#[test]
fn figures_at_their_limits_are_within_them() {
    let memory = Memory::of(&image()).expect("an image");
    let checks = checks::all(&alike(&figures()), &memory, &budget());
    let counts: Vec<u64> = checks.iter().map(|check| check.count).collect();
    assert_eq!(counts, [4000, 4000, 4000, 500, 500, 90, 90, 135_668, 3040, 4096, 8192]);
    assert_eq!(checks[10].budget, memory.stack_room_bytes);
    assert!(checks.iter().all(Check::is_kept), "{checks:?}");
}

#[test]
fn a_figure_beyond_its_limit_is_found() {
    let memory = Memory::of(&image()).expect("an image");
    let failing = |figures: &Figures, memory: &Memory| -> Vec<usize> {
        let checks = checks::all(&alike(figures), memory, &budget());
        (0..checks.len()).filter(|&index| !checks[index].is_kept()).collect()
    };
    let worse = |change: fn(&mut Figures)| {
        let mut figures = figures();
        change(&mut figures);
        figures
    };
    assert_eq!(failing(&worse(|f| f.instructions = 40_001), &memory), [0, 1, 2, 5, 6]);
    assert_eq!(failing(&worse(|f| f.tasks[0].worst = 501), &memory), [3, 4]);
    assert_eq!(failing(&worse(|f| f.stack_bytes = 4097), &memory), [9]);
    let smaller = Memory { stack_room_bytes: 8191, ..memory.clone() };
    assert_eq!(failing(&figures(), &smaller), [10]);
    let mut greater = memory;
    greater.sections[3].flash_bytes += 1;
    greater.sections[4].ram_bytes += 1;
    assert_eq!(failing(&figures(), &greater), [7, 8]);
}
