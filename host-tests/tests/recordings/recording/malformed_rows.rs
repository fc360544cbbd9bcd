//! What is wrong with a row, a value or the times is said in these words.

use super::{DWELLS, STAGE, changed, message};

/// The message when one thing of the stage recording is changed.
fn stage(from: &str, to: &str) -> String {
    message(changed(STAGE, from, to))
}

/// The message when one thing of the dwells recording is changed.
fn dwells(from: &str, to: &str) -> String {
    message(changed(DWELLS, from, to))
}

#[test]
fn a_recording_without_rows_is_refused() {
    let head = &STAGE[..STAGE.find("0.00").unwrap_or(0)];
    assert_eq!(message(head), "walk.csv: line 4: no rows follow the column names");
}

#[test]
fn a_row_with_too_few_or_too_many_fields_is_refused() {
    assert_eq!(stage(",-9.82", ""), "walk.csv: line 6: 5 fields, but 6 columns are named");
    assert_eq!(stage("-9.82", "-9.82,"), "walk.csv: line 6: 7 fields, but 6 columns are named");
    assert_eq!(stage("-9.82", "-9,82"), "walk.csv: line 6: 7 fields, but 6 columns are named");
}

#[test]
fn a_last_line_cut_short_is_distinguished_from_one_that_has_few_fields() {
    assert_eq!(
        stage(",-0.28,-9.84\n", ""),
        "walk.csv: line 8: truncated: 4 of 6 fields and no line end; remove the line"
    );
    assert_eq!(stage(",-0.28,-9.84", ""), "walk.csv: line 8: 4 fields, but 6 columns are named");
}

#[test]
fn a_field_that_is_empty_is_refused() {
    assert_eq!(stage("2.5e-5", " "), "walk.csv: line 6, column g_rad_s: the field is empty");
}

#[test]
fn a_field_that_is_no_number_is_refused() {
    assert_eq!(stage("2.5e-5", "abc"), "walk.csv: line 6, column g_rad_s: \"abc\" is not a number");
    assert_eq!(stage("0.126", "1 2"), "walk.csv: line 6, column fx_m_s2: \"1 2\" is not a number");
}

#[test]
fn nan_and_infinity_are_refused_outside_truth() {
    assert_eq!(
        stage("2.5e-5", "nan"),
        "walk.csv: line 6, column g_rad_s: \"nan\" is allowed only in truth_ columns"
    );
    assert_eq!(
        stage("0.02", "-inf"),
        "walk.csv: line 6, column t_s: \"-inf\" is not a finite number"
    );
}

#[test]
fn a_rate_or_force_beyond_the_units_is_refused() {
    assert_eq!(
        stage("2.5e-5", "2.147483648"),
        "walk.csv: line 6, column g_rad_s: \"2.147483648\" is outside the range of ±2.147483647 \
         rad/s; check the unit"
    );
    assert_eq!(
        stage("-9.82", "-9820"),
        "walk.csv: line 6, column fz_m_s2: \"-9820\" is outside the range of ±2147.483647 m/s²; \
         check the unit"
    );
}

#[test]
fn a_time_or_stage_angle_beyond_what_keeps_its_digits_is_refused() {
    assert_eq!(
        stage("0.02", "1e11"),
        "walk.csv: line 6, column t_s: \"1e11\" is outside the range of ±10000000000 s; check the unit"
    );
    assert_eq!(
        stage("0.02,0.0", "0.02,1e7"),
        "walk.csv: line 6, column stage_rad: \"1e7\" is outside the range of ±6283185 rad; check \
         the unit"
    );
}

#[test]
fn a_temperature_is_checked_like_any_number() {
    let text = STAGE.replace("fz_m_s2\n", "fz_m_s2,temperature_c\n").replace("81\n", "81,hot\n");
    assert_eq!(message(text), "walk.csv: line 5, column temperature_c: \"hot\" is not a number");
}

#[test]
fn time_that_runs_back_or_stands_still_is_refused() {
    for time in ["0.01", "0.02"] {
        assert_eq!(
            stage("0.04", time),
            format!("walk.csv: line 7, column t_s: {time} s does not come after 0.02 s of line 6")
        );
    }
}

#[test]
fn a_gap_is_refused_with_its_length() {
    let gap = "is a gap longer than three sample periods of 0.02 s; split the recording here";
    let text = STAGE.replace("0.04", "0.10").replace("0.06", "0.12");
    let expected = format!("walk.csv: line 7, column t_s: 0.08 s after line 6 {gap}");
    assert_eq!(message(&text), expected);
    let without_rate = message(text.replace("# rate_hz: 50\n", ""));
    assert_eq!(without_rate, format!("walk.csv: line 6, column t_s: 0.08 s after line 5 {gap}"));
}

#[test]
fn a_rate_that_contradicts_the_times_is_refused() {
    for rate in ["100", "44", "56", "49.4", "50.6"] {
        assert_eq!(
            stage("hz: 50", &format!("hz: {rate}")),
            format!(
                "walk.csv: line 3, key rate_hz: {rate} Hz contradicts the times, which have 50 Hz; \
                 correct it"
            )
        );
    }
}

#[test]
fn times_in_milliseconds_are_told_from_a_wrong_rate() {
    for rate in [1.0, 50.0, 400.0] {
        let row = |i: u32| format!("{},0,{i}e-6,0,0,-9.8", f64::from(i) * 1e3 / rate);
        let rows = (0..20).map(row).collect::<Vec<_>>().join("\n");
        let names = "t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2";
        let text = message(format!("# kind: stage\n# rate_hz: {rate}\n{names}\n{rows}\n"));
        let told = "contradicts the times";
        let hint = "the times are in ms, as it seems, and must be in s";
        assert!(text.contains(told) && text.ends_with(hint), "{rate} Hz: {text}");
    }
}

#[test]
fn a_dwell_without_length_or_uncertainty_is_refused() {
    assert_eq!(
        dwells("2e-8", "0"),
        "walk.csv: line 4, column sigma_rad_s: \"0\" is outside the range of above 0 to 2.147483647 \
         rad/s; check the unit"
    );
    assert_eq!(
        dwells(",50,", ",-50,"),
        "walk.csv: line 4, column seconds: \"-50\" is outside the range of above 0 to 10000000000 \
         s; check the unit"
    );
}

#[test]
fn a_dwell_that_does_not_come_after_the_one_before_is_refused() {
    assert_eq!(
        dwells(",100,", ",30,"),
        "walk.csv: line 4, column mid_s: 30 s does not come after 30 s of line 3"
    );
}
