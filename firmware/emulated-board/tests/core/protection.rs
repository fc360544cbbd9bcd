//! The memory protection unit against the manual's rules (ARMv7-M Architecture Reference Manual, B3.5).

use emulated_board::controller::protection::{Access, Level, Protection};

const THREAD: Level = Level { is_unprivileged: true, is_above_faults: false };
const HANDLER: Level = Level { is_unprivileged: false, is_above_faults: false };
const HARD: Level = Level { is_unprivileged: false, is_above_faults: true };

/// A unit with this control and one region: base, attributes.
fn unit(control: u32, base: u32, attributes: u32) -> Protection {
    let mut unit = Protection::default();
    for (offset, value) in [(0xC, base | 0x10), (0x10, attributes), (0x4, control)] {
        assert!(unit.write(offset, value), "no register at {offset:#x}");
    }
    unit
}

#[test]
fn each_access_permission_allows_what_its_table_says() {
    // Table B3-15: privileged, then unprivileged: read, write.
    let table =
        [(0, "----"), (1, "rw--"), (2, "rwr-"), (3, "rwrw"), (5, "r---"), (6, "r-r-"), (7, "r-r-")];
    for (permission, expected) in table {
        let unit = unit(0b101, 0x2000_0000, permission << 24 | 9 << 1 | 1);
        let allows = |access, level, letter| {
            if unit.allows(0x2000_0010, 4, access, level) { letter } else { '-' }
        };
        let told: String = [HANDLER, THREAD]
            .iter()
            .flat_map(|level| {
                [allows(Access::Read, *level, 'r'), allows(Access::Write, *level, 'w')]
            })
            .collect();
        assert_eq!(told, expected, "AP {permission:03b}");
    }
}

#[test]
fn hard_faults_are_protected_only_where_the_unit_says_so() {
    for (control, expected) in [(0b101, true), (0b111, false)] {
        let unit = unit(control, 0x2000_0000, 9 << 1 | 1);
        assert_eq!(
            unit.allows(0x2000_0000, 4, Access::Read, HARD),
            expected,
            "control {control:03b}"
        );
        assert!(!unit.allows(0x2000_0000, 4, Access::Read, HANDLER), "control {control:03b}");
    }
}

#[test]
fn without_a_region_only_privilege_and_the_default_map_allow() {
    let [with_map, without] = [0b101, 0b001].map(|control| unit(control, 0x2000_0000, 9 << 1 | 1));
    let elsewhere = |unit: &Protection, level| unit.allows(0x4000_0000, 4, Access::Read, level);
    assert!(
        elsewhere(&with_map, HANDLER)
            && !elsewhere(&with_map, THREAD)
            && !elsewhere(&without, HANDLER)
    );
    // Registers of the core are accessible in any case (B3.5.1).
    assert!(without.allows(0xE000_ED94, 4, Access::Write, HANDLER));
    assert!(!unit(0, 0, 0).is_on() && unit(0, 0, 0).allows(0, 4, Access::Write, THREAD));
}

#[test]
fn a_region_of_all_addresses_and_one_of_32_bytes_cover_what_they_say() {
    let all = unit(0b101, 0, 31 << 1 | 1);
    assert!(
        !all.allows(0xDFFF_FFFC, 4, Access::Read, HANDLER)
            && !all.allows(0, 1, Access::Read, HANDLER)
    );
    let small = unit(0b101, 0x2000_0020, 4 << 1 | 1);
    let allowed = [0x1C, 0x20, 0x3C, 0x40]
        .map(|offset| small.allows(0x2000_0000 + offset, 4, Access::Read, HANDLER));
    assert_eq!(allowed, [true, false, false, true]);
    // Eighths that are left out are of regions from 256 bytes on.
    let eighths = unit(0b101, 0x2000_0000, 0xFF00 | 6 << 1 | 1);
    assert!(!eighths.allows(0x2000_0000, 4, Access::Read, HANDLER));
    let eighths = unit(0b101, 0x2000_0000, 0x0100 | 7 << 1 | 1);
    assert!(eighths.allows(0x2000_001C, 4, Access::Read, HANDLER));
    assert!(!eighths.allows(0x2000_0020, 4, Access::Read, HANDLER));
}

#[test]
fn accesses_are_watched_where_one_may_be_refused() {
    let region = 4 << 1 | 1;
    assert_eq!(unit(0, 0x2000_0020, region).watched(true), None);
    assert_eq!(unit(0b101, 0x2000_0020, region).watched(false), Some((0x2000_0020, 0x2000_003F)));
    assert_eq!(unit(0b101, 0x2000_0020, 0).watched(false), None);
    assert_eq!(unit(0b101, 0x8000_0000, 31 << 1 | 1).watched(false), Some((0, u32::MAX)));
    // Without the default map, or without privilege, what no region covers is refused too.
    assert_eq!(unit(0b001, 0x2000_0020, region).watched(false), Some((0, u32::MAX)));
    assert_eq!(unit(0b101, 0x2000_0020, region).watched(true), Some((0, u32::MAX)));
}
