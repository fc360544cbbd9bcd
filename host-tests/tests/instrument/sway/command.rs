//! `meridian run --sway`.

use std::process::Output;

use crate::support::program::meridian;

fn run(arguments: &[&str]) -> Output {
    meridian(&[&["run", "-v"], arguments].concat())
}

fn all(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes)).concat()
}

#[test]
fn a_sway_is_subtracted_with_the_base_imu_and_refused_without() {
    let with = run(&["--sway", "0.1", "--sway-hertz", "0.7"]);
    assert_eq!(with.status.code(), Some(0), "{}", all(&with));
    assert!(all(&with).contains("base: sways by 0.07"), "{}", all(&with));
    let without = run(&["--sway", "0.1", "--no-base-imu"]);
    assert_eq!(without.status.code(), Some(1), "{}", all(&without));
    assert!(all(&without).contains("dwells were disturbed"), "{}", all(&without));
}
