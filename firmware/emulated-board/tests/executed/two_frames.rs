//! Two frames, whose base stands although its forces change.
//!
//! Until the base counts as still, the keeper has the forces of the LSM6DSL; from there on those of the ADXL355 on the
//! base. The offset of the first is 20 mg (1σ) by the data sheet, so that gravity seems to change its direction by a
//! degree. The keeper is told of the change, and does not take it for an acceleration, after 5 s of which the body would
//! count as having set off.

use firmware::platform::Platform;

use super::support::executed::executed;
use super::support::figure::within;
use super::support::worlds::calibrated_two_frames;

#[test]
fn two_frames_on_a_base_at_rest_are_aligned() {
    let shown = executed(Platform::TwoFrame, 1);
    let azimuth = shown.report.azimuth_deg;
    let [azimuth, sigma, _] = azimuth.unwrap_or_else(|| panic!("{}", shown.text()));
    let error = (azimuth - shown.report.truth_deg).abs();
    within(error / sigma, 0.0..=3.0, "σ the azimuth of two frames on a base at rest is wrong");
}

#[test]
fn two_frames_are_aligned_on_a_base_whose_coarse_accelerometers_are_calibrated() {
    let report = &calibrated_two_frames().report;
    let [azimuth, sigma, _] = report.azimuth_deg.unwrap_or_else(|| panic!("{}", report.outcome));
    let error = (azimuth - report.truth_deg).abs();
    assert!(error <= 3.0 * sigma, "{error}° at a σ of {sigma}°");
}
