//! `meridian run --sway`.

use std::process::{Command, Output};

fn meridian(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meridian"));
    command.arg("run").args(arguments).output().expect("it starts")
}

fn all(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes)).concat()
}

#[test]
fn a_sway_is_subtracted_with_the_base_imu_and_refused_without() {
    let with = meridian(&["--sway", "0.1", "--sway-hertz", "0.7"]);
    assert_eq!(with.status.code(), Some(0), "{}", all(&with));
    assert!(all(&with).contains("base: sways by 0.07"), "{}", all(&with));
    let without = meridian(&["--sway", "0.1", "--no-base-imu"]);
    assert_eq!(without.status.code(), Some(1), "{}", all(&without));
    assert!(all(&without).contains("dwells were disturbed"), "{}", all(&without));
}

#[test]
fn impossible_sways_are_misuse() {
    for arguments in [
        &["--sway", "3"][..],
        &["--sway", "-0.1"],
        &["--sway", "nan"],
        &["--sway", "0.1", "--sway-hertz", "9"],
        &["--no-base-imu"],
        &["--sway", "0.1", "--record", "never.csv"],
    ] {
        assert_eq!(meridian(arguments).status.code(), Some(2), "{arguments:?}");
    }
}
