//! A refusal names what it is likely to come from: a unit, a noise, a sensor that is stuck, another command.

use std::fmt::Write;

use crate::support::files::{Scratch, stored, unpacked};
use crate::support::program::{code, meridian, object, page, reason, text, words};

use super::{mapped, recorded, refused, scaled};

const FORCES: [&str; 3] = ["fx_m_s2", "fy_m_s2", "fz_m_s2"];
const DEGREES: f64 = 57.295_779_513_082_32;

#[test]
fn a_column_in_another_unit_is_named_with_the_factor_that_mends_it() {
    let scratch = Scratch::new("units");
    let sound = recorded();
    let cases: [(&[&str], f64, &str); 5] = [
        (&["stage_rad"], DEGREES, "column stage_rad: in degrees, as it seems, not rad"),
        (&["g_rad_s"], DEGREES, "column g_rad_s: in °/s, as it seems, not rad/s"),
        (&FORCES, 1.0 / 9.806_65, "columns fx_m_s2 to fz_m_s2: in g, as it seems, not m/s²"),
        (&FORCES, 1e3 / 9.806_65, "columns fx_m_s2 to fz_m_s2: in mg, as it seems, not m/s²"),
        (&["g_rad_s"], DEGREES * 3600.0, "check the unit: °/s or °/h?"),
    ];
    for (columns, factor, words) in cases {
        let why = refused(&scratch, &scaled(sound, columns, factor));
        assert!(why.contains(words), "{why}");
    }
    let both = scaled(&scaled(sound, &["stage_rad", "g_rad_s"], DEGREES), &FORCES, 1e3 / 9.806_65);
    let why = refused(&scratch, &both);
    for words in ["stage_rad: in degrees", "g_rad_s: in °/s", "fz_m_s2: in mg"] {
        assert!(why.contains(words), "{why}");
    }
}

#[test]
fn the_text_for_people_names_the_likely_cause_too() {
    let scratch = Scratch::new("text");
    let path = scratch.with("x.csv", scaled(recorded(), &["stage_rad"], DEGREES));
    let output = meridian(&["replay", &path]);
    let reported = text(&output.stdout);
    assert!(reported.contains("column stage_rad: in degrees"), "{reported}");
}

#[test]
fn what_the_columns_show_stands_before_the_refusal_that_came_of_it() {
    let scratch = Scratch::new("leading");
    let path = scratch.with("x.csv", scaled(recorded(), &["stage_rad"], DEGREES));
    let output = meridian(&["replay", &path]);
    let why = reason(&output);
    assert!(why.contains("x.csv: column stage_rad: in degrees"), "{why}");
    assert!(why.contains("; as it stands: "), "{why}");
}

#[test]
fn scatter_that_is_no_noise_has_a_row_of_its_own_in_the_budget() {
    let scratch = Scratch::new("scatter");
    let rows = [
        "0,-2.7900e-05",
        "45,-4.3220e-05",
        "90,-3.1672e-05",
        "135,-5.5589e-07",
        "180,3.2230e-05",
        "225,4.6949e-05",
        "270,3.5562e-05",
        "315,4.6146e-06",
    ];
    let rows = rows.map(|row| format!("{row},3.9e-07,60\n")).concat();
    let header = "# kind: dwells\n# latitude_deg: 52\nstage_rad,rate_rad_s,sigma_rad_s,seconds\n";
    let path = scratch.with("degrees.csv", format!("{header}{rows}"));
    let told = text(&meridian(&["replay", &path]).stdout);
    assert!(
        told.contains("(1σ of the azimuth): scatter beyond noise and drift dominates"),
        "{told}"
    );
    assert!(told.contains("scatter beyond noise and drift  13.29"), "{told}");
    assert!(!told.contains("gyro noise           12"), "{told}");
}

#[test]
fn dwells_that_scatter_alike_tell_of_n_and_not_of_the_platform() {
    let scratch = Scratch::new("noise");
    let sound = recorded();
    let with =
        |n: &str| sound.replace("gyro_N_deg_sqrt_h: 0.001", &format!("gyro_N_deg_sqrt_h: {n}"));
    for n in ["0.00001", "0.0001", "0.0003"] {
        let why = refused(&scratch, &with(n));
        assert!(why.contains("all dwells scatter alike, with "), "{why}");
        assert!(why.contains("check N, and the unit of the rates"), "{why}");
        let reported = format!("key gyro_N_deg_sqrt_h says {n} °/√h, but the dwells show ");
        assert!(why.contains(&reported), "{why}");
    }
    let why = refused(&scratch, &with("30"));
    assert!(why.contains("says 30 °/√h, but the dwells show "), "{why}");
}

#[test]
fn a_stuck_gyro_and_a_stuck_encoder_of_a_stage_are_named() {
    let scratch = Scratch::new("stuck");
    let sound = recorded();
    let why = refused(&scratch, &mapped(sound, &["g_rad_s"], |_| "1e-5".to_owned()));
    assert!(why.contains("column g_rad_s holds the same value in "), "{why}");
    assert!(why.contains("the sensor is stuck; check its supply and cable"), "{why}");
    let why = refused(&scratch, &mapped(sound, &["stage_rad"], |_| "0.25".to_owned()));
    assert!(why.contains("column stage_rad holds the same value in "), "{why}");
}

/// Twelve averaged dwells over the full circle, north at 60°.
fn dwells() -> String {
    let mut text = "# kind: dwells\n# latitude_deg: 48\n\
                    stage_rad,rate_rad_s,sigma_rad_s,seconds,fx_m_s2,fy_m_s2,fz_m_s2\n"
        .to_owned();
    let horizontal = 7.292_115e-5 * 48_f64.to_radians().cos();
    for index in 0..12_u32 {
        let angle = f64::from(index) * 30_f64.to_radians();
        let noise = 2e-8 * [0.3, -1.1, 0.7, 0.2, -0.6, 1.2, -0.1][index as usize % 7];
        let rate = horizontal * (angle + 60_f64.to_radians()).cos() + 1e-6 + noise;
        let [x, y] = [0.05 * angle.cos(), -0.05 * angle.sin()];
        writeln!(text, "{angle},{rate},2e-8,60,{x},{y},-9.81").expect("memory suffices");
    }
    text
}

#[test]
fn averaged_dwells_in_other_units_are_named() {
    let scratch = Scratch::new("dwells");
    let path = scratch.with("sound.csv", dwells());
    let output = meridian(&["replay", &path]);
    assert_eq!(code(&output), 0, "{}", reason(&output));
    let cases: [(&[&str], f64, &str); 6] = [
        (&["stage_rad"], DEGREES, "column stage_rad: in degrees"),
        (&["rate_rad_s", "sigma_rad_s"], DEGREES, "columns rate_rad_s and sigma_rad_s: in °/s"),
        (&["rate_rad_s"], DEGREES, "column rate_rad_s: in °/s"),
        (&["sigma_rad_s"], DEGREES * 3600.0, "column sigma_rad_s: in °/h"),
        (
            &["sigma_rad_s"],
            1e-4,
            "so much is no noise: check the units of all columns, and sigma_rad_s",
        ),
        (&FORCES, 1e3 / 9.806_65, "columns fx_m_s2 to fz_m_s2: in mg"),
    ];
    for (columns, factor, words) in cases {
        let why = refused(&scratch, &scaled(&dwells(), columns, factor));
        assert!(why.contains(words), "{why}");
    }
}

#[test]
fn a_turning_platform_in_other_units_or_with_a_stuck_gyro_is_named() {
    let scratch = Scratch::new("turning");
    let sound = unpacked("rotating-gyro");
    let cases: [(&[&str], f64, &str); 3] = [
        (
            &["stage_rad", "stage_rate_rad_s"],
            DEGREES,
            "columns stage_rad and stage_rate_rad_s: in degrees",
        ),
        (&["stage_rad"], DEGREES, "column stage_rad: in degrees"),
        (&["g_rad_s"], DEGREES, "column g_rad_s: in °/s"),
    ];
    for (columns, factor, words) in cases {
        let why = refused(&scratch, &scaled(&sound, columns, factor));
        assert!(why.contains(words), "{why}");
    }
    let why = refused(&scratch, &mapped(&sound, &["g_rad_s"], |_| "1e-5".to_owned()));
    assert!(why.contains("column g_rad_s holds the same value in "), "{why}");
    let why = refused(&scratch, &sound.replace("deg_sqrt_h: 0.002000", "deg_sqrt_h: 0.00001"));
    assert!(why.contains("key gyro_N_deg_sqrt_h says 0.00001 °/√h"), "{why}");
}

#[test]
fn a_record_at_rest_is_sent_to_allan() {
    let rest = stored("static-gyro-1h");
    for method in [&[][..], &["--method", "stepwise"], &["--method", "static"]] {
        let output = meridian(&[&["replay", &rest, "--latitude", "50"], method].concat());
        assert_eq!(code(&output), 1);
        assert!(reason(&output).contains("`meridian allan`"), "{}", reason(&output));
    }
}

#[test]
fn what_is_really_disturbed_keeps_its_reason() {
    let output = meridian(&["run", "--sway", "0.1", "--no-base-imu", "--rate", "50"]);
    assert_eq!(code(&output), 1);
    let why = reason(&output);
    assert!(why.contains("dwells were disturbed: keep the platform still"), "{why}");
}

#[test]
fn two_positions_are_refused_with_the_option_that_tells_their_azimuths_apart() {
    for run in [&["run", "--positions", "2"][..], &["run", "--positions", "2", "--json"]] {
        let output = meridian(run);
        assert_eq!(code(&output), 1);
        assert!(reason(&output).ends_with("--half east, or --half west"), "{}", reason(&output));
    }
}

#[test]
fn a_run_says_what_was_made_to_go_wrong_and_what_the_board_said_of_it() {
    let gyro = "\"gyro: at the limit of its range\"";
    for (fault, reported) in [("overload-once", "nothing wrong"), ("saturation-once", gyro)] {
        let run = ["run", "turntable", "--rate=100", "--fault", fault];
        let told = words(&text(&meridian(&run).stdout));
        let line = format!("fault {fault}, as asked for; the board reported {reported}");
        assert!(told.contains(&line), "{told}");
        let object = object(&meridian(&[&run[..], &["--json"]].concat()));
        assert_eq!(object["fault"], fault);
    }
    assert!(object(&meridian(&["run", "--json"])).get("fault").is_none());
}

#[test]
fn what_a_board_reported_and_mended_takes_from_the_badge() {
    for (fault, badge) in [("overload-once", "found"), ("saturation-once", "degraded")] {
        let (_, page) = page(&["run", "turntable", "--rate=100", "--fault", fault]);
        assert!(page.contains(&format!("<span class=\"badge {badge}\">")), "{fault}");
        assert_eq!(page.contains("reported on the way: "), badge == "degraded", "{fault}");
    }
}
