//! `meridian allan` as a user meets it: units, keys, the page, and clear words for bad input.

use std::process::{Output, Stdio};

use hal_mock::noise::Generator;
use serde_json::Value;

use crate::support::files::{Scratch, stored};
use crate::support::pages::{figure, series};
use crate::support::program::{
    assert_drawn, assert_misuse, code, command, meridian, object, page, text, words,
};

fn allan(arguments: &[&str]) -> Output {
    meridian(&[&["allan"], arguments].concat())
}

fn hour() -> String {
    stored("static-gyro-1h")
}

/// The command on a file of this content and name.
fn on(name: &str, content: &str, options: &[&str]) -> Output {
    let scratch = Scratch::new("allan");
    allan(&[&[scratch.with(name, content).as_str()], options].concat())
}

/// A recording of white noise at 10 Hz; row i stands in line 4 + i. What is to be left out or written
/// otherwise is asked of `row`, by its number and its text.
fn noisy(rows: u32, row: impl Fn(u32, String) -> Option<String>) -> String {
    let mut generator = Generator::new(5);
    let lines = (0..rows).filter_map(|index| {
        let rate = 1e-5 * generator.gaussian();
        row(index, format!("{:.1},{rate:.6e}\n", f64::from(index) / 10.0))
    });
    "# kind: static\n# rate_hz: 10\nt_s,g_rad_s\n".to_owned() + &lines.collect::<String>()
}

/// A row of a time and a rate.
type Row = fn(&str, &str) -> String;

/// The message of a run that failed, in one line.
fn refusal(output: &Output) -> String {
    let message = text(&output.stderr);
    assert_eq!((code(output), message.lines().count()), (1, 1), "{message}");
    message
}

/// The notes of a recording of white noise whose rows are written otherwise, and whose column has this name.
fn notes(column: &str, row: impl Fn(u32, f64, f64) -> (f64, f64)) -> String {
    let rewritten = noisy(3000, |index, text| {
        let (time, rate) = text.trim().split_once(',').expect("two columns");
        let number = |text: &str| text.parse::<f64>().expect("a number");
        let (time, rate) = row(index, number(time), number(rate));
        Some(format!("{time},{rate:e}\n"))
    });
    let rewritten = rewritten.replace("g_rad_s", column).replace("# rate_hz: 10\n", "");
    let object = object(&on("notes.csv", &rewritten, &["--json", "--column", column]));
    assert_eq!(object["status"], "ok", "{object}");
    object["notes"].to_string()
}

#[test]
fn units_that_cannot_be_are_noted_with_what_was_read_and_what_to_do() {
    assert_eq!(notes("rate", |_, time, rate| (time, rate)), "[]");
    let milliseconds = notes("rate", |_, time, rate| (1e3 * time, rate));
    assert!(milliseconds.contains("t_s was read in s: the samples are 100"), "{milliseconds}");
    assert!(milliseconds.contains("divide them by 1000"), "{milliseconds}");
    for (bias, times) in [(0.5, 1.0), (0.0, 1e4)] {
        let other = notes("rate", |_, time, rate| (time, bias + times * rate));
        assert!(other.contains("rate was read in rad/s"), "{other}");
        assert!(other.contains("in °/s") && other.contains("--column"), "{other}");
    }
    let named = notes("gyro_dps", |_, time, rate| (time, rate));
    assert!(named.contains("its name says degrees"), "{named}");
}

#[test]
fn times_in_milliseconds_beside_a_stated_rate_are_told_as_such() {
    let rows = noisy(3000, |index, text| {
        let (_, rate) = text.split_once(',').expect("two columns");
        Some(format!("{},{rate}", 100 * index))
    });
    let object = object(&on("ms.csv", &rows, &["--json"]));
    let notes = object["notes"].to_string();
    assert!(notes.contains("in ms, as it seems: divide it by 1000"), "{notes}");
}

#[test]
fn a_sample_far_from_all_others_is_noted_with_its_line_and_size() {
    let spiked =
        notes("rate", |index, time, rate| (time, if index == 1234 { rate + 1e-2 } else { rate }));
    // The header has two lines less than that of the recording with its rate.
    assert!(spiked.contains("line 1237: one sample is "), "{spiked}");
    assert!(spiked.contains("σ off its neighbours, 0.57"), "{spiked}");
    let rounded = notes("rate", |_, time, rate| (time, (rate / 2e-5).round() * 2e-5));
    assert_eq!(rounded, "[]", "a coarse step is none");
}

#[test]
fn n_and_b_stand_first_however_little_is_told() {
    let first = |options: &[&str]| {
        let printed = text(&allan(&[&[&hour()[..]], options].concat()).stdout);
        printed.lines().skip(1).take(2).map(|line| line.trim()[..1].to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(first(&[]), ["N", "B"]);
    assert_eq!(first(&["-q"])[0], "N");
}

#[test]
fn the_stored_hour_gives_the_noise_that_its_simulator_had() {
    let object = object(&allan(&[&hour(), "--json"]));
    let number = |key: &str| object[key].as_f64().unwrap_or_else(|| panic!("{key}: {object}"));
    assert_eq!(object["status"], "ok");
    assert!((number("n_deg_sqrt_h") / 0.02 - 1.0).abs() < 0.02);
    for (key, truth) in [("b_deg_h", 0.3), ("k_deg_h_sqrt_h", 2.0)] {
        let sigma = number(&format!("{key}_sigma"));
        assert!((number(key) - truth).abs() < 2.0 * sigma, "{key}: {} ± {sigma}", number(key));
    }
    for key in ["q_arcsec", "r_deg_h2"] {
        assert!(object[key].is_null() && number(&format!("{key}_at_most")) > 0.0, "{key}");
    }
}

#[test]
fn the_curve_is_four_arrays_of_one_length_within_its_limits() {
    let object = object(&allan(&[&hour(), "--json"]));
    let array = |key: &str| -> Vec<f64> {
        let values = object[key].as_array().unwrap_or_else(|| panic!("{key}"));
        values.iter().map(|value| value.as_f64().expect("a number")).collect()
    };
    let [tau, deviation, lower, upper] = ["tau_s", "adev_deg_h", "lower", "upper"].map(array);
    assert!((tau[3] - 0.4).abs() < 1e-9);
    assert_eq!((tau.len(), deviation.len(), lower.len(), upper.len()), (28, 28, 28, 28));
    for i in 0..tau.len() {
        assert!(lower[i] < deviation[i] && deviation[i] < upper[i], "at {} s", tau[i]);
    }
    // The overlapping Allan deviation of the file by its definition in numpy, °/h. Beyond 256 samples not every window is
    // used.
    for (seconds, expected) in
        [(0.1, 3.818_997_516), (1.2, 1.119_345_607), (51.2, 0.301_604_066), (614.4, 0.479_155_550)]
    {
        let index = tau.iter().position(|tau| (tau / seconds - 1.0).abs() < 1e-6).expect("there");
        let within = if seconds < 25.6 { 1e-6 } else { 1e-3 };
        let error = deviation[index] / expected - 1.0;
        assert!(error.abs() < within, "{seconds}: {error}");
    }
}

#[test]
fn every_number_has_its_unit() {
    let output = allan(&[&hour(), "--verbose"]);
    assert_eq!(code(&output), 0);
    let block = text(&output.stdout);
    for unit in ["arcsec", "°/√h", "°/h", "°/h/√h", "°/h²", "τ, s", "Hz", "68.3 %"] {
        assert!(block.contains(unit), "{unit} is missing in {block}");
    }
    assert!(block.contains("not observable in this record (at most "), "{block}");
}

#[test]
fn the_page_has_the_curve_its_limits_the_fit_and_five_asymptotes() {
    let (_, html) = page(&["allan", &hour()]);
    let parts = [
        "averaging time τ, s",
        "Allan deviation σ, °/h",
        "limits of 68.3 %</li>",
        "overlapping Allan deviation</li>",
        "fit</li>",
        "Q quantisation, slope −1: not observable",
        "N angle random walk, slope −½: 0.0",
        "B bias instability, slope 0, at 0.664 B: ",
        "K rate random walk, slope +½: ",
        "R rate ramp, slope +1: not observable",
    ];
    assert_drawn(&html, &parts);
    let curve = figure(&html, "Allan deviation");
    let [known, pale] = ["overlapping", "fewer than 8"].map(|name| series(&curve, name).len());
    assert_eq!(known + pale, 28, "every point");
    assert!(pale > 0, "the longest times say little");
    let styles = |letter: &str| {
        let all = curve["series"].as_array().expect("it has series").iter();
        let of =
            all.filter(|series| series["name"].as_str().is_some_and(|it| it.starts_with(letter)));
        of.map(|series| series["style"].as_str().expect("a style")).collect::<Vec<_>>()
    };
    assert_eq!([styles("Q "), styles("R ")].concat(), ["dotted"; 2], "upper limits alone");
    assert_eq!([styles("N "), styles("B "), styles("K ")].concat(), ["dashed"; 3]);
    for name in ["Q −1", "N −½", "B 0", "K +½", "R +1"] {
        assert!(html.contains(&format!(">{name}</span>")), "{name} stands in the figure");
    }
}

#[test]
fn a_page_in_a_folder_that_is_not_there_is_named_before_anything_is_computed() {
    let output = allan(&[&hour(), "--json", "--report", "/no/such/folder/a.html"]);
    assert!(refusal(&output).contains("/no/such/folder/a.html: the report cannot be written"));
    let object = object(&output);
    assert_eq!(object["status"], "failed");
    assert!(object["n_deg_sqrt_h"].is_null());
}

#[cfg(target_os = "linux")]
#[test]
fn the_numbers_are_not_lost_with_a_page_that_does_not_fit() {
    let output = allan(&[&hour(), "--json", "--report", "/dev/full"]);
    assert!(refusal(&output).contains("/dev/full: the report cannot be written"));
    let object = object(&output);
    assert_eq!(object["status"], "failed");
    assert!(object["n_deg_sqrt_h"].is_number());
}

#[test]
fn an_inertial_measurement_unit_is_read_along_body_x_unless_said() {
    let mut generator = Generator::new(6);
    let rows = (0..300).map(|index| {
        let [x, y, z] = [1e-5, 2e-5, 3e-5].map(|sigma| sigma * generator.gaussian());
        format!("{:.2},{x:e},{y:e},{z:e},0,0,-9.8\n", f64::from(index) / 50.0)
    });
    let names = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2";
    let imu = format!("# kind: static\n{names}\n{}", rows.collect::<String>());
    let first = |options: &[&str]| {
        let object = object(&on("imu.csv", &imu, &[&["--json"], options].concat()));
        let column = object["column"].as_str().unwrap_or_default().to_owned();
        (column, object["adev_deg_h"][0].as_f64().expect("a number"))
    };
    let (column, x) = first(&[]);
    assert_eq!(column, "gx_rad_s");
    let (column, z) = first(&["--column", "gz_rad_s"]);
    assert_eq!(column, "gz_rad_s");
    assert!((z / x / 3.0 - 1.0).abs() < 0.3, "{z} and {x}");
    for wrong in ["g_rad_s", "ax_m_s2", "gyro"] {
        let output = on("imu.csv", &imu, &["--column", wrong]);
        let message = refusal(&output);
        let words = format!("no rate column \"{wrong}\"; there is gx_rad_s, gy_rad_s, gz_rad_s");
        assert!(message.contains("imu.csv") && message.contains(&words), "{message}");
    }
}

#[test]
fn a_column_of_any_name_is_analysed_beside_the_time_alone() {
    let mut generator = Generator::new(2);
    let rates: Vec<String> =
        (0..300).map(|_| format!("{:e}", 1e-5 * generator.gaussian())).collect();
    let analysed = |names: &str, row: &dyn Fn(usize, &str) -> String, options: &[&str]| {
        let rows = rates.iter().enumerate().map(|(index, rate)| row(index, rate) + "\n");
        let content = format!("# kind: static\n{names}\n{}", rows.collect::<String>());
        let mut found = object(&on("any.csv", &content, &[&["--json"], options].concat()));
        found["file"] = Value::Null;
        found
    };
    let time = |index: usize| format!("{:.2}", index as f64 / 50.0);
    let plain = analysed("t_s,g_rad_s", &|index, rate| format!("{},{rate}", time(index)), &[]);
    let beside: [(&str, Row); 3] = [
        ("t_s,rate", |time, rate| format!("{time},{rate}")),
        ("t_s,g_rad_s,rate", |time, rate| format!("{time},no number,{rate}")),
        ("rate,gx_rad_s,t_s", |time, rate| format!("{rate},1e99,{time}")),
    ];
    for (names, row) in beside {
        let mut named =
            analysed(names, &|index, rate| row(&time(index), rate), &["--column", "rate"]);
        assert_eq!(named["column"], "rate", "{names}");
        named["column"] = plain["column"].clone();
        assert_eq!(named, plain, "{names}");
    }
}

#[test]
fn what_is_wrong_in_a_column_of_any_name_names_it() {
    let refused = |names: &str, row: &str| {
        let content = format!("# kind: static\n{names}\n{row}\n");
        refusal(&on("any.csv", &content, &["--column", "rate"]))
    };
    for (names, row, words) in [
        ("t_s,rate", "0,abc", "line 3, column rate: \"abc\" is not a number"),
        ("t_s,rate,rate", "0,1,2", "line 2, column rate: is named twice"),
        ("time,rate", "0,1", "line 2, column t_s: is missing; the kind needs t_s,rate"),
        (
            "t_s,turn,temperature",
            "0,1,2",
            "line 2: there is no rate column \"rate\"; there is turn, temperature",
        ),
    ] {
        let message = refused(names, row);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_record_that_is_too_short_is_refused_with_what_it_needs() {
    for rows in [2, 20, 63] {
        let output = on("short.csv", &noisy(rows, |_, row| Some(row)), &["--json"]);
        let words = format!("column g_rad_s: record too short: {rows} samples, 64 needed");
        assert!(refusal(&output).contains(&words), "{}", text(&output.stderr));
        let object = object(&output);
        assert_eq!((&object["status"], &object["samples"]), (&"refused".into(), &rows.into()));
        assert!(object["tau_s"].is_null() && object["n_deg_sqrt_h"].is_null(), "{object}");
    }
    let output = on("one.csv", &noisy(1, |_, row| Some(row)), &[]);
    assert!(refusal(&output).contains("one.csv: record too short: one row"));
    let output = on("none.csv", &noisy(0, |_, row| Some(row)), &[]);
    assert!(refusal(&output).contains("none.csv: line 3: no rows follow the column names"));
}

#[test]
fn the_longest_times_of_a_short_record_are_reported_as_unsure() {
    let object = object(&on("brief.csv", &noisy(100, |_, row| Some(row)), &["--json"]));
    assert_eq!(object["status"], "ok");
    let last = |key: &str| object[key].as_array().and_then(|a| a.last()?.as_f64()).expect("one");
    assert!(last("upper") / last("lower") > 2.0);
    assert!(object["b_deg_h"].is_null() || object["b_deg_h_sigma"].is_number());
}

#[test]
fn a_constant_record_is_refused_as_stuck() {
    let row = |_, row: String| Some(row.split(',').next()?.to_owned() + ",1.5e-5\n");
    let output = on("constant.csv", &noisy(500, row), &[]);
    let message = refusal(&output);
    assert!(message.contains("constant.csv: column g_rad_s: all samples are equal"), "{message}");
    assert!(text(&output.stdout).contains("No noise from g_rad_s"));
}

#[test]
fn what_is_no_number_is_named_with_line_and_column() {
    for (wrong, words) in [
        ("nan", "\"nan\" is allowed only in truth_ columns"),
        ("inf", "\"inf\" is not a finite number"),
        ("1e-5x", "\"1e-5x\" is not a number"),
        ("", "the field is empty"),
    ] {
        let row = |index, row: String| {
            let (time, rate) = row.split_once(',')?;
            let rate = if index == 200 { format!("{wrong}\n") } else { rate.to_owned() };
            Some(format!("{time},{rate}"))
        };
        let output = on("number.csv", &noisy(500, row), &[]);
        let expected = format!("number.csv: line 204, column g_rad_s: {words}");
        assert!(refusal(&output).contains(&expected), "{}", text(&output.stderr));
    }
}

#[test]
fn time_that_runs_backwards_is_named_with_its_line() {
    let row =
        |index, row: String| Some(if index == 200 { row.replace("20.0,", "2.0,") } else { row });
    let output = on("backwards.csv", &noisy(500, row), &[]);
    let expected = "line 204, column t_s: 2 s does not come after 19.9 s of line 203";
    assert!(refusal(&output).contains(expected), "{}", text(&output.stderr));
}

#[test]
fn gaps_part_the_record_and_are_reported() {
    let row = |index, row| (!(500..600).contains(&index) && index != 1200).then_some(row);
    let gapped = noisy(2000, row);
    let output = on("gaps.csv", &gapped, &[]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let block = text(&output.stdout);
    assert!(block.contains("1899 samples at 10 Hz, 189.9 s in 3 segments"), "{block}");
    let reported = "2 gaps, 10.100 s in all, the first before line 504 after 49.9 s";
    assert!(words(&block).contains(reported), "{block}");
    let found = object(&on("gaps.csv", &gapped, &["--json"]));
    assert_eq!(found["gaps"].as_array().map(Vec::len), Some(2));
    assert_eq!(found["gaps"][1]["line"], 4 + 1100);
    assert_eq!(found["terms"][0], 1899 - 3);
    let whole = object(&on("whole.csv", &noisy(2000, |_, row| Some(row)), &["--json"]));
    let n = |object: &Value| object["n_deg_sqrt_h"].as_f64().expect("a number");
    assert!((n(&found) / n(&whole) - 1.0).abs() < 0.05, "{} and {}", n(&found), n(&whole));
}

#[test]
fn a_record_that_is_all_gaps_is_refused_with_its_gaps() {
    let row = |index: u32, row| (index % 3 != 2 || index < 40).then_some(row);
    let output = on("holes.csv", &noisy(90, row), &[]);
    let message = refusal(&output);
    assert!(message.contains("record too short: ") && message.contains(" gaps, "), "{message}");
}

#[test]
fn a_wrong_rate_is_reported_and_the_times_are_believed() {
    let right = noisy(500, |_, row| Some(row));
    let wrong = right.replace("rate_hz: 10", "rate_hz: 100");
    let [right, wrong] = [right, wrong].map(|text| object(&on("rate.csv", &text, &["--json"])));
    assert_eq!(wrong["tau_s"], right["tau_s"]);
    assert_eq!(wrong["n_deg_sqrt_h"], right["n_deg_sqrt_h"]);
    assert_eq!(right["notes"].as_array().map(Vec::len), Some(0));
    let note = wrong["notes"][0].as_str().expect("a note");
    assert!(note.contains("100 Hz contradicts the times, which have 10"), "{note}");
}

#[test]
fn a_recording_of_another_kind_is_refused_both_ways() {
    let moving = "# kind: dwells\nstage_rad,rate_rad_s,sigma_rad_s,seconds\n0,1e-5,1e-8,60\n";
    let output = on("dwells.csv", moving, &[]);
    assert!(refusal(&output).contains("dwells.csv: kind `dwells` is no record at rest"));
    let output = meridian(&["replay", &hour(), "--latitude", "50"]);
    assert!(refusal(&output).contains("kind `static` has no positions to align from"));
}

/// The most memory that a process has held so far, KiB.
#[cfg(target_os = "linux")]
fn most_memory(process: &std::process::Child) -> u64 {
    let status =
        std::fs::read_to_string(format!("/proc/{}/status", process.id())).expect("it runs");
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).expect("it is counted");
    line.split_whitespace().nth(1).and_then(|number| number.parse().ok()).expect("a number")
}

#[cfg(target_os = "linux")]
#[test]
fn two_million_rows_are_read_in_less_memory_than_they_would_take() {
    use std::io::{BufWriter, Write};
    let mut process = command()
        .args(["allan", "/dev/stdin"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut input = BufWriter::new(process.stdin.take().expect("a pipe"));
    let mut generator = Generator::new(7);
    input.write_all(b"# kind: static\nt_s,g_rad_s\n").expect("it reads");
    for index in 0..2_000_000_u32 {
        let (time, rate) = (f64::from(index) / 100.0, 1e-5 * generator.gaussian());
        writeln!(input, "{time:.2},{rate:.6e}").expect("it reads");
    }
    input.flush().expect("it reads");
    let memory = most_memory(&process);
    drop(input);
    let output = process.wait_with_output().expect("it ends");
    assert!(text(&output.stdout).contains("2000000 samples at 100 Hz"), "{}", text(&output.stdout));
    assert!(memory < 100 * 1024, "{memory} KiB");
}

#[test]
fn misuse_is_exit_two_in_one_line() {
    for arguments in [&[][..], &["a.csv", "--column"], &["a.csv", "--method", "x"]] {
        assert_misuse(&[&["allan"], arguments].concat(), "");
    }
    assert!(
        refusal(&allan(&["no-such-file.csv"])).contains("no-such-file.csv: there is no such file")
    );
}
