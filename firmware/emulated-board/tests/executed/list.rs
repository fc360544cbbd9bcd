//! The list of the defects is that of the tests.

use std::collections::BTreeSet;

/// The sources with tests of defects.
const SOURCES: [&str; 14] = [
    include_str!("conclusion.rs"),
    include_str!("cost.rs"),
    include_str!("settings.rs"),
    include_str!("spin.rs"),
    include_str!("stamps.rs"),
    include_str!("start.rs"),
    include_str!("store.rs"),
    include_str!("two_frames.rs"),
    include_str!("../faults/hung.rs"),
    include_str!("../faults/power.rs"),
    include_str!("../faults/saving.rs"),
    include_str!("../faults/stopped.rs"),
    include_str!("../faults/supply.rs"),
    include_str!("../../../../host-tests/tests/instrument/store/sequences.rs"),
];

/// The list.
const LIST: &str = include_str!("../../DEFECTS.md");

/// The test behind an attribute, and what it expects.
fn expected(attribute: &str) -> (&str, &str) {
    let (words, rest) = attribute.split_once('"').expect("what is expected ends");
    let name = rest.split("fn ").nth(1).and_then(|rest| rest.split('(').next());
    (name.expect("a test follows"), words)
}

#[test]
fn the_list_has_every_defect_with_its_figure_and_its_test_and_no_other() {
    let attributes = SOURCES.iter().flat_map(|source| source.split("expected = \"").skip(1));
    let tests: BTreeSet<_> = attributes.map(expected).collect();
    let rows = LIST.lines().filter(|line| line.starts_with("| ") && line.contains('`'));
    let listed: BTreeSet<_> = rows
        .map(|row| {
            let cells: Vec<_> = row.split('|').map(str::trim).collect();
            (cells[2].trim_matches('`'), cells[1])
        })
        .collect();
    assert_eq!(listed, tests);
}
