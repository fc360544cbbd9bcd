//! A refusal names what a recording is spoilt by beside units: columns that stick or count the other way, an encoder
//! that slips, keys that are missing; and it blames nothing that is sound.

use std::cell::Cell;
use std::fmt::Write;

use hal_mock::noise::Generator;

use crate::support::files::{Scratch, stored, unpacked};
use crate::support::program::{code, meridian, reason, text};

use super::{mapped, recorded, refused, scaled};

const DEGREES: f64 = 57.295_779_513_082_32;
const IMU_FORCES: [&str; 3] = ["ax_m_s2", "ay_m_s2", "az_m_s2"];
const IMU_RATES: [&str; 3] = ["gx_rad_s", "gy_rad_s", "gz_rad_s"];
const IN_G: f64 = 1.0 / 9.806_65;

/// How many rows a recording has.
fn rows(recording: &str) -> usize {
    recording.lines().filter(|line| !line.starts_with('#')).count() - 1
}

/// A recording whose column is made anew from the middle on.
fn from_middle(recording: &str, column: &str, value: impl Fn(&str) -> String) -> String {
    let (row, middle) = (Cell::new(0), rows(recording) / 2);
    mapped(recording, &[column], |text| {
        row.set(row.get() + 1);
        if row.get() > middle { value(text) } else { text.to_owned() }
    })
}

/// The first part of a recording.
fn beginning(recording: &str, part: usize) -> String {
    let (row, count) = (Cell::new(0), rows(recording) / part);
    let is_kept = |line: &&str| {
        row.set(row.get() + usize::from(!line.starts_with('#')));
        row.get() <= count + 1
    };
    recording.lines().filter(is_kept).fold(String::new(), |all, line| all + line + "\n")
}

/// The header without a key.
fn without(recording: &str, key: &str) -> String {
    let start = format!("# {key}:");
    let kept = recording.lines().filter(|line| !line.starts_with(&start));
    kept.fold(String::new(), |all, line| all + line + "\n")
}

#[test]
fn a_gyro_that_sticks_half_way_is_named_with_the_line_where_it_begins() {
    let scratch = Scratch::new("half-stuck");
    for name in ["stepwise-circle", "positions-four-fog", "stepwise-mems", "rotating-gyro"] {
        let sound = unpacked(name);
        let middle = rows(&sound) / 2;
        let above = sound.lines().take_while(|line| line.starts_with('#')).count() + 1;
        let why = refused(&scratch, &from_middle(&sound, "g_rad_s", |_| "1.1e-5".to_owned()));
        let count = rows(&sound) - middle;
        let line = above + middle + 1;
        let words =
            format!("column g_rad_s holds the same value in {count} rows from line {line} on");
        assert!(why.contains(&words), "{name}: {why}");
    }
}

#[test]
fn a_stage_angle_that_counts_the_other_way_is_named() {
    let scratch = Scratch::new("reversed");
    for name in ["stepwise-circle", "stepwise-tilted-drift", "positions-four-fog"] {
        let why = refused(&scratch, &scaled(&unpacked(name), &["stage_rad"], -1.0));
        let words =
            "column stage_rad: counted the other way, as it seems, not clockwise from above";
        assert!(why.contains(words), "{name}: {why}");
    }
}

/// Dwells on an arc of so many degrees that does not come back, of a stage at 50° of latitude that is tilted by
/// 0.06°; its accelerometer warms up by so much towards an angle, rad.
fn warming_arc(arc_deg: f64, change_mg: f64, towards: f64) -> String {
    const COUNT: u32 = 9;
    const HORIZONTAL: f64 = 4.687e-5;
    const VERTICAL: f64 = 5.586e-5;
    const TILT: f64 = 1e-3;
    let mut noise = Generator::stream(3, u64::from(arc_deg as u32));
    let mut recording = "# kind: dwells\n# latitude_deg: 50\n# gyro_bias_deg_h: 10\n\
        stage_rad,rate_rad_s,sigma_rad_s,seconds,mid_s,fx_m_s2,fy_m_s2,fz_m_s2\n"
        .to_owned();
    for dwell in 0..COUNT {
        let part = f64::from(dwell) / f64::from(COUNT - 1);
        let stage = part * arc_deg / DEGREES;
        let [x, y] = [TILT * stage.cos(), -TILT * stage.sin()];
        let rate = HORIZONTAL * (1.0 + stage).cos() + VERTICAL * x + 1e-7 * noise.gaussian();
        let warm = 1e-3 * change_mg * (1.0 - (-3.0 * part).exp());
        let [x, y] = [x + warm * towards.cos(), y + warm * towards.sin()]
            .map(|force| (force + 3e-6 * noise.gaussian()) / IN_G);
        let middle = 30.0 * part * f64::from(COUNT);
        let _ = writeln!(recording, "{stage},{rate:e},1e-7,30,{middle},{x},{y},-9.81");
    }
    recording
}

#[test]
fn an_accelerometer_that_warms_up_on_an_arc_is_named_and_no_sense_of_the_stage_is_blamed() {
    let scratch = Scratch::new("warming");
    let mut named = 0;
    for arc_deg in [100.0, 120.0, 140.0, 160.0, 180.0] {
        for change_mg in [1.0, 3.0, 6.0] {
            for towards in [0.0, 1.0, 2.0, 3.0, 4.0, 5.0] {
                let arc = warming_arc(arc_deg, change_mg, towards);
                let output = meridian(&["replay", &scratch.with("arc.csv", arc)]);
                let why = text(&output.stderr);
                assert!(!why.contains("multiply by -1"), "{arc_deg}°, {change_mg} mg: {why}");
                named += usize::from(why.contains("as while it warms up, explain the forces"));
            }
        }
    }
    assert!(named > 5, "only {named} are named");
}

#[test]
fn an_encoder_that_slips_far_is_named_with_its_angle_and_no_unit_is_blamed() {
    let scratch = Scratch::new("slipped");
    for name in ["stepwise-circle", "positions-four-fog"] {
        for slip_deg in [5.0, 45.0, 120.0] {
            let slipped = from_middle(&unpacked(name), "stage_rad", |text| {
                (text.parse::<f64>().expect("a number") + slip_deg / DEGREES).to_string()
            });
            let why = refused(&scratch, &slipped);
            // What the encoder shows too much, the heading seems to lack.
            let words = format!("the dwells show a heading -{slip_deg:.1}° from that before");
            let is_step = why.contains("the heading steps by -");
            assert!(is_step || why.contains(&words), "{name} {slip_deg}°: {why}");
            assert!(why.contains("the encoder slipped, or the base was turned"), "{why}");
            assert!(!why.contains("unit"), "{why}");
        }
    }
}

#[test]
fn the_rate_of_a_platform_that_its_angle_contradicts_is_named() {
    let scratch = Scratch::new("platform-rate");
    for name in ["rotating-gyro", "rotating-met-two-speeds"] {
        for (factor, words) in [
            (DEGREES, "column stage_rate_rad_s: in °/s, as it seems, not rad/s"),
            (60.0 / 360.0 * DEGREES, "column stage_rate_rad_s: in turns a minute"),
            (-1.0, "column stage_rate_rad_s: its sign is the other way"),
        ] {
            let why = refused(&scratch, &scaled(&unpacked(name), &["stage_rate_rad_s"], factor));
            assert!(why.contains(words), "{name}: {why}");
        }
    }
}

#[test]
fn accelerometers_in_g_or_mg_are_named_whatever_carries_them() {
    let scratch = Scratch::new("heavy");
    for name in ["rotating-gyro", "rotating-met-two-speeds"] {
        let why = refused(&scratch, &scaled(&unpacked(name), &["a_m_s2"], 1e3 * IN_G));
        assert!(why.contains("column a_m_s2: in mg, as it seems, not m/s²"), "{why}");
        assert!(!why.contains("level it"), "{why}");
    }
    for name in ["drive-fog-1dph", "drive-ideal", "parked-swaying"] {
        for (factor, unit) in [(IN_G, "g"), (1e3 * IN_G, "mg")] {
            let why = refused(&scratch, &scaled(&unpacked(name), &IMU_FORCES, factor));
            let words = format!("columns ax_m_s2 to az_m_s2: in {unit}, as it seems, not m/s²");
            assert!(why.contains(&words), "{name}: {why}");
        }
    }
    let path = scratch.with("x.csv", scaled(&unpacked("imu-broad-06"), &IMU_FORCES, IN_G));
    let output = meridian(&["replay", &path, "--method", "vertical"]);
    let why = reason(&output);
    assert!(why.contains("columns ax_m_s2 to az_m_s2: in g, as it seems"), "{why}");
}

#[test]
fn a_platform_that_is_nearly_level_tells_what_its_accelerometer_does_not_show() {
    for (name, factor) in [("rotating-gyro", 1.0), ("rotating-gyro", IN_G)] {
        let scratch = Scratch::new("light");
        let path = scratch.with("x.csv", scaled(&unpacked(name), &["a_m_s2"], factor));
        let reported = text(&meridian(&["replay", &path, "-v"]).stdout);
        for words in ["accelerometer in m/s²", "sense of the platform,"] {
            assert!(reported.contains(words), "{reported}");
        }
    }
}

#[test]
fn gyros_of_a_vehicle_in_degrees_a_second_are_named() {
    let scratch = Scratch::new("vehicle-rates");
    for name in ["drive-fog-1dph", "drive-fog-three-stops", "drive-ideal"] {
        let why = refused(&scratch, &scaled(&unpacked(name), &IMU_RATES, DEGREES));
        assert!(why.contains("columns gx_rad_s to gz_rad_s: "), "{name}: {why}");
        assert!(why.contains("°/s"), "{name}: {why}");
    }
    let both = scaled(&unpacked("drive-fog-1dph"), &IMU_RATES, DEGREES);
    let why = refused(&scratch, &scaled(&both, &IMU_FORCES, IN_G));
    for words in ["gz_rad_s: in °/s", "az_m_s2: in g"] {
        assert!(why.contains(words), "{why}");
    }
}

#[test]
fn keys_of_drift_and_g_sensitivity_that_are_missing_are_named_as_unknown_not_zero() {
    let scratch = Scratch::new("missing-keys");
    let tilted = unpacked("stepwise-tilted-drift");
    let pair = without(&tilted, "g_sensitivity_deg_h_g");
    let why = refused(&scratch, &pair);
    let words = "key g_sensitivity_deg_h_g is missing, which is unknown, not zero";
    assert!(why.contains(words), "{why}");
    let why = refused(&scratch, &without(&pair, "g_sensitivity_sigma_deg_h_g"));
    let words = "keys g_sensitivity_deg_h_g, g_sensitivity_sigma_deg_h_g are missing";
    assert!(why.contains(words), "{why}");
    let why = refused(&scratch, &without(&unpacked("stepwise-mems"), "gyro_B_deg_h"));
    assert!(why.contains("keys gyro_B_deg_h, gyro_K_deg_h_sqrt_h, gyro_R_deg_h2 are"), "{why}");
    assert!(why.contains("unknown, not zero"), "{why}");
}

#[test]
fn a_gyros_scale_and_a_latitude_that_are_wrong_blame_no_key_that_is_missing() {
    let scratch = Scratch::new("blamed");
    for name in ["stepwise-circle", "positions-four-fog"] {
        let sound = unpacked(name);
        let elsewhere = without(&sound, "latitude_deg").replacen('#', "# latitude_deg: 30\n#", 1);
        for spoilt in [scaled(&sound, &["g_rad_s"], 1.2), elsewhere] {
            let why = refused(&scratch, &spoilt);
            assert!(why.ends_with("check latitude and gyro scale"), "{name}: {why}");
        }
    }
}

/// Averaged dwells over the full circle with one rate and σ, as text.
fn dwells(rate: &str, sigma: &str) -> String {
    let mut text = "# kind: dwells\n# latitude_deg: 48\n\
                    stage_rad,rate_rad_s,sigma_rad_s,seconds,mid_s\n"
        .to_owned();
    for index in 0..12_u32 {
        let angle = f64::from(index) * 30_f64.to_radians();
        let rate = match rate {
            "" => (4.88e-5 * (angle + 1.0).cos()).to_string(),
            rate => rate.to_owned(),
        };
        writeln!(text, "{angle},{rate},{sigma},60,{}", 30 + 60 * index).expect("memory suffices");
    }
    text
}

#[test]
fn averaged_dwells_that_are_all_alike_or_too_sure_are_named_and_no_arc_is() {
    let scratch = Scratch::new("alike");
    for (rate, sigma, words) in [
        ("1e-5", "2e-8", "column rate_rad_s: all 12 dwells show the same 0.00001 rad/s"),
        ("0", "2e-8", "column rate_rad_s: all 12 dwells show the same 0 rad/s"),
        ("", "1e-300", "column sigma_rad_s: 1e-300 rad/s is less than the noise of any gyro"),
    ] {
        let why = refused(&scratch, &dwells(rate, sigma));
        assert!(why.contains(words), "{why}");
        assert!(!why.contains("longer arc") && !why.contains("full circle"), "{why}");
    }
}

#[test]
fn a_number_of_very_many_zeros_is_printed_in_short() {
    let scratch = Scratch::new("zeros");
    let sound = dwells("", "2e-8");
    let back = sound.replace(",60,90\n", ",60,1e-300\n");
    let why = refused(&scratch, &back);
    assert!(why.ends_with("column mid_s: 1e-300 s does not come after 30 s of line 4"), "{why}");
    for (key, value) in [("rate_hz", "100"), ("gyro_N_deg_sqrt_h", "0.000250")] {
        let (from, to) = (format!("{key}: {value}"), format!("{key}: 1e-300"));
        let why = refused(&scratch, &unpacked("stepwise-circle").replace(&from, &to));
        assert!(why.contains("1e-300 ") && why.len() < 400, "{why}");
    }
}

#[test]
fn the_beginning_of_a_sound_recording_is_too_short_and_nothing_else() {
    let scratch = Scratch::new("short");
    for name in [
        "stepwise-bumped",
        "stepwise-circle",
        "stepwise-mems",
        "stepwise-nudged",
        "stepwise-paper-1",
        "stepwise-tilted-drift",
        "stepwise-unknown-g",
        "positions-four-fog",
        "rotating-gyro",
        "drive-ideal",
        "drive-fog-1dph",
    ] {
        let keys = ["stops_s", "displacements_north_east_m"];
        let sound = keys.iter().fold(unpacked(name), |text, key| without(&text, key));
        let path = scratch.with("short.csv", beginning(&sound, 10));
        let output = meridian(&["replay", &path]);
        let why = reason(&output);
        let is_blamed = ["as it seems", "stuck", "missing", "column", "key "]
            .into_iter()
            .find(|words| why.contains(words));
        assert!(code(&output) == 0 || is_blamed.is_none(), "{name}: {why}");
    }
}

#[test]
fn a_spinning_bodys_gyro_of_another_scale_is_not_stuck() {
    let scratch = Scratch::new("spin-scale");
    for factor in [0.9, 1.1] {
        let path = scratch.with("x.csv", scaled(&unpacked("spin-100rps"), &["gx_rad_s"], factor));
        let output = meridian(&["replay", &path]);
        assert!(!reason(&output).contains("stuck"), "{}", reason(&output));
    }
    let noisy = unpacked("spin-80rps-noisy");
    let path = scratch.with("x.csv", mapped(&noisy, &["gx_rad_s"], |_| "500".to_owned()));
    let why = reason(&meridian(&["replay", &path]));
    assert!(why.contains("stuck") || why.contains("gx_rad_s"), "{why}");
}

#[test]
fn only_a_vehicle_is_sent_to_the_method_that_needs_no_latitude() {
    let scratch = Scratch::new("nowhere-on-earth");
    for (recording, has_level) in [
        (recorded().to_owned(), false),
        (unpacked("rotating-gyro"), false),
        (dwells("", "2e-8"), false),
        (unpacked("parked-swaying"), true),
    ] {
        let why = refused(&scratch, &without(&recording, "latitude_deg"));
        assert!(why.contains("key latitude_deg is missing: add it or give --latitude"), "{why}");
        assert_eq!(why.contains("--method vertical"), has_level, "{why}");
    }
    let why = reason(&meridian(&["replay", &stored("imu-broad-06")]));
    assert!(why.contains("--method vertical gives pitch and roll without it"), "{why}");
}

#[test]
fn a_half_of_the_circle_that_the_dwells_contradict_is_the_cause_and_not_the_way_an_angle_is_counted()
 {
    for name in ["circle", "mems", "bumped", "nudged", "paper-1", "paper-2", "paper-3"] {
        let path = stored(&format!("stepwise-{name}"));
        let outputs = ["east", "west"].map(|half| meridian(&["replay", &path, "--half", half]));
        let refused: Vec<_> = outputs.iter().filter(|output| code(output) != 0).collect();
        assert_eq!(refused.len(), 1, "{name}");
        assert!(
            text(&refused[0].stdout).contains("reason             no azimuth of the stated half"),
            "{name}"
        );
    }
}
