//! What a recording says to no purpose is reported, and changes nothing.

use std::fs;

use crate::support::files::{Scratch, recordings};
use crate::support::program::{code, meridian, object, text};

use super::recorded;

/// The warnings of a recording, as they stand on standard error and in the object.
fn warnings(scratch: &Scratch, recording: &str) -> Vec<String> {
    let path = scratch.with("warned.csv", recording);
    let output = meridian(&["replay", &path, "--json"]);
    let reported = text(&output.stderr);
    let lines: Vec<String> = reported
        .lines()
        .filter_map(|line| line.strip_prefix("warning: ").map(str::to_owned))
        .collect();
    let object = object(&output);
    let listed = object["warnings"].as_array().cloned().unwrap_or_default();
    let listed: Vec<&str> = listed.iter().filter_map(serde_json::Value::as_str).collect();
    assert_eq!(listed, lines);
    lines
}

#[test]
fn an_unknown_key_that_resembles_a_known_one_is_reported_with_its_line() {
    let scratch = Scratch::new("keys");
    let sound = recorded();
    for (line, key, known) in [
        (2, "latitude", "latitude_deg"),
        (2, "Latitude_deg", "latitude_deg"),
        (2, "latitude_rad", "latitude_deg"),
        (2, "lattitude_deg", "latitude_deg"),
        (2, "lat_deg", "latitude_deg"),
        (3, "rate", "rate_hz"),
        (3, "sample_rate_hz", "rate_hz"),
        (4, "gyro_N_deg_per_sqrt_h", "gyro_N_deg_sqrt_h"),
        (4, "gyro_noise_deg_sqrt_h", "gyro_N_deg_sqrt_h"),
        (4, "arw_deg_sqrt_h", "gyro_N_deg_sqrt_h"),
        (4, "gyro_N", "gyro_N_deg_sqrt_h"),
        (4, "Gyro_n_deg_sqrt_h", "gyro_N_deg_sqrt_h"),
        (4, "gyro_N_deg_sqr_h", "gyro_N_deg_sqrt_h"),
        (3, "fs_hz", "rate_hz"),
        (3, "dt_s", "rate_hz"),
        (8, "g_sensitivity_deg_h", "g_sensitivity_deg_h_g"),
        (10, "accelerometer_bias_mg", "accelerometer_bias_m_s2"),
        (10, "accel_bias_m_s2", "accelerometer_bias_m_s2"),
        (11, "truth_azimuth", "truth_azimuth_deg"),
    ] {
        let changed = sound.replace(&format!("# {known}:"), &format!("# {key}:"));
        assert_ne!(changed, sound);
        let reported = warnings(&scratch, &changed);
        let words =
            format!("line {line}, key {key}: is not known and passed over; if {known} is meant");
        assert!(reported.iter().any(|line| line.contains(&words)), "{words}: {reported:?}");
    }
}

#[test]
fn a_key_of_the_drift_that_is_called_otherwise_is_reported() {
    let scratch = Scratch::new("drift-keys");
    for (key, known) in [
        ("gyro_bias_instability_deg_h", "gyro_B_deg_h"),
        ("rrw", "gyro_K_deg_h_sqrt_h"),
        ("rate_random_walk_deg_h_sqrt_h", "gyro_K_deg_h_sqrt_h"),
        ("rate_ramp_deg_h2", "gyro_R_deg_h2"),
    ] {
        let reported = warnings(&scratch, &format!("# {key}: 0.01\n{}", recorded()));
        let words = format!("key {key}: is not known and passed over; if {known} is meant");
        assert!(reported.iter().any(|line| line.contains(&words)), "{words}: {reported:?}");
    }
}

#[test]
fn a_remark_is_no_slip_of_a_key() {
    let scratch = Scratch::new("remarks");
    let remarks = "# gyro: KVH DSP-1760\n# site: Lindau, 47.54 N\n# operator: rh\n# date: 2026-11-22 10:15\n\
                   # mind: the gap\n# note: latitude by map\n# seed: 4\n";
    assert_eq!(warnings(&scratch, &(remarks.to_owned() + recorded())), [""; 0]);
}

#[test]
fn no_stored_recording_is_warned_of() {
    for file in fs::read_dir(recordings()).expect("it is there") {
        let path = file.expect("it is there").path();
        if path.extension().is_some_and(|extension| extension == "gz") {
            let recording = host::recording::read(&path).expect("it reads");
            assert_eq!(recording.warnings, [], "{}", path.display());
        }
    }
}

#[test]
fn a_kind_that_is_written_otherwise_is_found_in_its_line() {
    let scratch = Scratch::new("kind");
    let path = scratch.with("kind.csv", recorded().replace("# kind:", "# Kind:"));
    let output = meridian(&["replay", &path]);
    assert_eq!(code(&output), 1);
    let reported = text(&output.stderr);
    assert!(reported.contains("line 1, key Kind: the header does not name the kind"), "{reported}");
}

#[test]
fn a_column_of_truth_that_is_malformed_is_reported() {
    let scratch = Scratch::new("truth");
    let sound = recorded();
    let with = |name: &str, value: &str| {
        let mut rows = 0;
        let line = |line: &str| match line {
            line if line.starts_with('#') => format!("{line}\n"),
            line if line.starts_with("t_s") => format!("{line},{name}\n"),
            line => {
                rows += 1;
                let field = if rows == 3 { value } else { "0.5" };
                format!("{line},{field}\n")
            }
        };
        sound.lines().map(line).collect::<String>()
    };
    let reported = warnings(&scratch, &with("truth_heading_deg", "north"));
    assert_eq!(reported.len(), 1, "{reported:?}");
    assert!(reported[0].contains("line 15, column truth_heading_deg: \"north\" is not a number"));
    assert_eq!(warnings(&scratch, &with("truth_heading_deg", "nan")), [""; 0]);
    let reported =
        warnings(&scratch, &with("Temperature_C", "20").replace(",temperature_c,", ",warmth,"));
    assert!(
        reported[0].contains("column Temperature_C: is not known and passed over"),
        "{reported:?}"
    );
}

#[test]
fn a_true_attitude_in_parts_or_of_no_length_is_reported() {
    let header = "# kind: imu\n# latitude_deg: 50\n# rate_hz: 10\n";
    let columns = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2";
    let recording = |names: &str, values: &str| {
        let row =
            |i: u32| format!("{},0.001,0.00{},0,0,0,-9.8{values}\n", f64::from(i) * 0.1, i % 7);
        format!("{header}{columns}{names}\n{}", (0..50).map(row).collect::<String>())
    };
    let scratch = Scratch::new("attitude");
    let reported = warnings(&scratch, &recording(",truth_qw,truth_qx,truth_qz", ",1,0,0"));
    assert!(
        reported[0].contains("truth_qy is missing, so the others are passed over"),
        "{reported:?}"
    );
    let all = ",truth_qw,truth_qx,truth_qy,truth_qz";
    let reported = warnings(&scratch, &recording(all, ",0,0,0,0"));
    assert!(reported[0].contains("no row holds a quaternion of length one"), "{reported:?}");
    assert_eq!(warnings(&scratch, &recording(all, ",1,0,0,0")), [""; 0]);
}

#[test]
fn what_takes_from_a_result_stands_in_text_and_object_alike() {
    for run in ["run --rate 50 --fault gyro-reset --hold 0", "run --rate 50 --sway 0.02 --hold 0"] {
        let arguments: Vec<&str> = run.split(' ').collect();
        let object = object(&meridian(&[&arguments[..], &["--json"]].concat()));
        let noted = object["noted"].as_array().expect("something takes from it");
        let told = text(&meridian(&[&arguments[..], &["-v"]].concat()).stdout);
        let unfolded = told.split_whitespace().collect::<Vec<_>>().join(" ");
        for words in noted {
            let words = words.as_str().expect("it is words");
            assert!(unfolded.contains(&format!("noted {words}")), "{run}: {words} in {told}");
        }
        assert_eq!(told.matches("\n  noted ").count(), noted.len(), "{run}");
    }
    let sound = object(&meridian(&["run", "--hold", "0", "--json"]));
    assert!(sound.get("noted").is_none(), "{sound}");
}
