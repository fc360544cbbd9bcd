//! What is wrong with a file, its header or its column names is said in these words.

use host::recording::{Kind, Place, Problem, read_from};

use super::{DWELLS, STAGE, changed, message, read};

/// The message when a stage recording's first line has these lines after it.
fn with_key(lines: &str) -> String {
    message(changed(STAGE, "# kind: stage", &format!("# kind: stage\n{lines}")))
}

#[test]
fn an_empty_file_is_refused() {
    let text = "walk.csv: the file is empty; record again or name another file";
    for empty in ["", "\n\r\n  \n", "\u{feff}"] {
        assert_eq!(message(empty), text);
    }
}

#[test]
fn a_missing_kind_is_refused() {
    assert_eq!(
        message(changed(STAGE, "# kind: stage\n", "")),
        "walk.csv: the header does not name the kind; add a line `# kind: …` with stage, rotating, \
         imu, spin, static or dwells"
    );
}

#[test]
fn an_unknown_kind_is_refused() {
    assert_eq!(
        message(changed(STAGE, "kind: stage", "kind: table")),
        "walk.csv: line 1, key kind: \"table\" is not a kind; use stage, rotating, imu, spin, \
         static or dwells"
    );
}

#[test]
fn every_kind_is_read_and_its_missing_columns_are_named_before_its_rows() {
    for kind in Kind::ALL {
        let text = message(format!("# kind: {kind}\nq\nabc\n"));
        assert!(text.starts_with("walk.csv: line 2, column "), "{text}");
        assert!(text.contains(": is missing; the kind needs "), "{text}");
    }
}

#[test]
fn columns_that_are_not_separated_by_commas_are_told_so() {
    for kind in Kind::ALL {
        for separator in [';', '\t'] {
            let names = ["t_s", "g_rad_s", "stage_rad"].join(&separator.to_string());
            let expected = format!(
                "walk.csv: line 2: columns are separated by {separator:?}; commas must separate \
                 them, and points stand in numbers"
            );
            assert_eq!(message(format!("# kind: {kind}\n{names}\n")), expected);
        }
    }
}

#[test]
fn the_message_for_an_unknown_kind_names_every_kind() {
    let text = message("# kind: x\n");
    assert!(Kind::ALL.iter().all(|kind| text.contains(kind.name())), "{text}");
}

#[test]
fn an_error_can_be_matched_as_well_as_printed() {
    let error = read_from("a", "# kind: spin\n".as_bytes()).expect_err("has no columns");
    assert_eq!(error.place, Place::Line(1));
    assert_eq!(error.problem, Problem::NoColumnNames);
}

#[test]
fn a_header_without_column_names_is_refused() {
    assert_eq!(
        message("# kind: stage\n# rate_hz: 50\n"),
        "walk.csv: line 2: the file ends without a line of column names"
    );
}

#[test]
fn a_missing_column_is_named_with_the_line_of_the_names() {
    assert_eq!(
        message(changed(STAGE, "fz_m_s2", "fzz")),
        "walk.csv: line 4, column fz_m_s2: is missing; the kind needs \
         t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2"
    );
}

#[test]
fn forces_of_dwells_come_together() {
    assert_eq!(
        message(changed(DWELLS, ",fy_m_s2", ",fy")),
        "walk.csv: line 2, column fy_m_s2: is missing; the kind needs \
         stage_rad,rate_rad_s,sigma_rad_s,seconds,fx_m_s2,fy_m_s2,fz_m_s2"
    );
}

#[test]
fn a_column_named_twice_is_refused() {
    assert_eq!(
        message(changed(STAGE, "fx_m_s2", "g_rad_s")),
        "walk.csv: line 4, column g_rad_s: is named twice; rename or remove one of them"
    );
    assert_eq!(
        message(changed(STAGE, "fz_m_s2", "fz_m_s2,note,note")),
        "walk.csv: line 4, column note: is named twice; rename or remove one of them"
    );
}

#[test]
fn a_column_without_a_name_is_refused() {
    assert_eq!(
        message(changed(STAGE, "fz_m_s2", "fz_m_s2,")),
        "walk.csv: line 4: column 7 has no name; name it or remove the comma"
    );
}

#[test]
fn a_key_with_two_values_is_refused() {
    assert_eq!(
        with_key("# latitude_deg: 50"),
        "walk.csv: line 3, key latitude_deg: \"52.0\" contradicts \"50\" of line 2; keep one of them"
    );
    assert_eq!(
        with_key("# truth_x: 1\n# truth_x: 2"),
        "walk.csv: line 3, key truth_x: \"2\" contradicts \"1\" of line 2; keep one of them"
    );
}

#[test]
fn a_key_that_matters_below_the_column_names_is_refused() {
    assert_eq!(
        message(format!("{STAGE}# gyro_N_deg_sqrt_h: 1\n")),
        "walk.csv: line 9, key gyro_N_deg_sqrt_h: stands below the column names; move it above them"
    );
}

#[test]
fn a_latitude_beyond_the_poles_is_refused() {
    for text in ["90.1", "-91", "1e9", "90°1′", "91S"] {
        assert_eq!(
            message(changed(STAGE, "52.0", text)),
            format!(
                "walk.csv: line 2, key latitude_deg: {text:?} is outside the range of ±90°; check \
                 the unit"
            )
        );
    }
}

#[test]
fn a_latitude_that_is_no_angle_is_refused() {
    let place = "walk.csv: line 2, key latitude_deg: ";
    for (text, problem) in [
        ("NaN", "\"NaN\" is allowed only in truth_ columns"),
        ("inf", "\"inf\" is not a finite number"),
        ("1e999", "\"1e999\" is not a finite number"),
        ("52N3", "\"52N3\": not a number of degrees, as 47.58 or 47°35′20″, 47d35m20s, 47:35:20"),
        ("52°60′", "\"52°60′\": minutes and seconds of an angle are below 60"),
        ("52E", "\"52E\": a latitude has N or S behind it, no other letter here"),
        ("-52S", "\"-52S\": a sign before it and a letter behind it say the same; leave one out"),
        ("", "the field is empty"),
    ] {
        assert_eq!(message(changed(STAGE, "52.0", text)), format!("{place}{problem}"));
    }
}

#[test]
fn a_rate_that_no_recorder_has_is_refused() {
    for text in ["0", "-50", "1000001"] {
        assert_eq!(
            message(changed(STAGE, "hz: 50", &format!("hz: {text}"))),
            format!(
                "walk.csv: line 3, key rate_hz: {text:?} is outside the range of above 0 to \
                 1000000 Hz; check the unit"
            )
        );
    }
}

#[test]
fn a_noise_that_is_negative_or_no_number_is_refused() {
    for (key, unit) in [
        ("gyro_N_deg_sqrt_h", "°/√h"),
        ("gyro_B_deg_h", "°/h"),
        ("gyro_K_deg_h_sqrt_h", "°/h/√h"),
        ("gyro_R_deg_h2", "°/h²"),
        ("gyro_bias_deg_h", "°/h"),
        ("g_sensitivity_sigma_deg_h_g", "°/h/g"),
    ] {
        let place = format!("walk.csv: line 2, key {key}: ");
        let range = format!("is outside the range of 0 to 1000000 {unit}; check the unit");
        assert_eq!(with_key(&format!("# {key}: -1")), format!("{place}\"-1\" {range}"));
        assert_eq!(with_key(&format!("# {key}: low")), format!("{place}\"low\" is not a number"));
    }
}

#[test]
fn a_scale_or_accelerometer_uncertainty_out_of_range_is_refused() {
    assert_eq!(
        with_key("# gyro_scale_sigma: 3"),
        "walk.csv: line 2, key gyro_scale_sigma: \"3\" is outside the range of 0 to 1; check the unit"
    );
    assert_eq!(
        with_key("# accelerometer_bias_m_s2: -0.1"),
        "walk.csv: line 2, key accelerometer_bias_m_s2: \"-0.1\" is outside the range of 0 to \
         2147 m/s²; check the unit"
    );
}

#[test]
fn a_g_sensitivity_that_is_no_pair_of_numbers_is_refused() {
    let place = "walk.csv: line 2, key g_sensitivity_deg_h_g: ";
    for (text, problem) in [
        ("9", "\"9\" is not two numbers with a comma between"),
        ("9,x", "\"x\" is not a number"),
        ("1,2,3", "\"2,3\" is not a number"),
        ("9,", "the field is empty"),
        ("2e6,0", "\"2e6\" is outside the range of ±1000000 °/h/g; check the unit"),
    ] {
        let line = format!("# g_sensitivity_deg_h_g: {text}");
        assert_eq!(with_key(&line), format!("{place}{problem}"));
    }
}

#[test]
fn an_unknown_sensor_is_refused() {
    assert_eq!(
        with_key("# sensor: laser"),
        "walk.csv: line 2, key sensor: \"laser\" is not a sensor; use gyro or met"
    );
}

#[test]
fn a_true_azimuth_that_is_no_angle_is_refused() {
    assert_eq!(
        with_key("# truth_azimuth_deg: west"),
        "walk.csv: line 2, key truth_azimuth_deg: \"west\": not a number of degrees, as 47.58 or 47°35′20″, \
         47d35m20s, 47:35:20"
    );
}

#[test]
fn a_message_quotes_no_more_than_it_must_and_stays_one_line() {
    let text = format!("# kind: {}\n", "\u{7}ab\u{2028}".repeat(30));
    let quoted = r"\u{7}ab\u{2028}".repeat(10);
    assert!(
        message(text).starts_with(&format!("walk.csv: line 1, key kind: \"{quoted}\"… is not"))
    );
    let error = read_from("a\nb.csv", "".as_bytes()).expect_err("is empty").to_string();
    assert!(error.starts_with("a\\nb.csv: the file is empty"), "{error}");
}

#[test]
fn unknown_keys_and_columns_are_no_errors() {
    let text = changed(STAGE, "# kind: stage", "# kind: stage\n# stops_s: 0-60;x\n# colour: red");
    assert_eq!(read(text).header, read(STAGE).header);
}
