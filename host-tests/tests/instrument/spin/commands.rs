//! `replay`, `run` and `campaign` of a spinning body from the command line, and their misuse.

use serde_json::Value;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_drawn, meridian, object, page, text};

#[test]
fn the_kind_chooses_the_method_and_the_object_has_every_figure() {
    let output = meridian(&["replay", &stored("spin-80rps-noisy"), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let object = object(&output);
    assert_eq!((&object["method"], &object["status"]), (&"spin".into(), &"ok".into()));
    let number = |key: &str| object[key].as_f64().unwrap_or(f64::NAN);
    assert!((number("roll_rad_end") - 510.660_7).abs() < 0.01, "{object}");
    assert!(number("rms_deg") < 0.2 && number("error_deg").abs() < 0.4, "{object}");
    assert!((number("scale_error") - 1e-3).abs() < 3e-5, "{object}");
    // Twice a twentieth over the root of 10 000 samples, and a lift that has grown since: 0.06°.
    assert!((number("limit_deg") - 0.061).abs() < 0.003, "{object}");
    assert!(number("limit_rms_deg") < number("rms_deg"), "{object}");
    assert_eq!((&object["turns_lost"], &object["state"]), (&0.into(), &"locked".into()));
    let methods = object["methods"].as_array().expect("a list");
    let names: Vec<&Value> = methods.iter().map(|method| &method["name"]).collect();
    assert_eq!(names, ["extrema", "interpolated", "phase-locked"]);
    assert!(methods[0]["rms_deg"].as_f64().is_some_and(|rms| rms > 90.0), "{object}");
    let stated = meridian(&["replay", &stored("spin-80rps-noisy"), "--json", "--method", "spin"]);
    assert_eq!(stated.stdout, output.stdout);
}

#[test]
fn the_block_tells_roll_limit_and_every_method() {
    let output = meridian(&["replay", &stored("spin-100rps"), "--verbose"]);
    let block = text(&output.stdout);
    for words in [
        "Roll of the spinning body",
        "152.50",
        "100 since the beginning",
        "Cramér–Rao",
        "gyro's scale error +",
        "extrema",
        "interpolated",
        "phase-locked",
        "turns lost",
    ] {
        assert!(block.contains(words), "{words}: {block}");
    }
}

#[test]
fn the_page_draws_errors_sigma_lift_and_scale() {
    let (_, page) = page(&["replay", &stored("spin-100rps")]);
    let titles = [
        "Roll error of the methods",
        "between corrections (Nekrasova 2017, Fig. 8)",
        "Error of the roll by phase lock, and its stated 1σ",
        "σ of the roll",
        "Lift",
        "Scale error of the gyro",
        "States of the phase lock",
    ];
    assert_drawn(&page, &titles);
    assert!(!page.contains("There are no points to draw"));
}

#[test]
fn a_body_without_lift_is_refused_with_exit_code_1_and_the_reason() {
    let mut rows = "# kind: spin\n# rate_hz: 10000\nt_s,gx_rad_s,ay_m_s2,az_m_s2\n".to_owned();
    for index in 0..3000 {
        let noise = f64::from((index * 7919) % 997) / 997.0;
        let row = format!("{:.4},500,{:.3},{:.3}\n", f64::from(index) * 1e-4, noise, 1.0 - noise);
        rows.push_str(&row);
    }
    let scratch = Scratch::new("falling");
    let output = meridian(&["replay", &scratch.with("falling.csv", rows), "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let object = object(&output);
    assert_eq!(object["status"], "refused");
    assert!(object["reason"].as_str().is_some_and(|why| why.contains("not known")), "{object}");
    assert!(object.get("roll_rad_end").is_none() && object.get("sigma_deg").is_none(), "{object}");
}

#[test]
fn an_accuracy_that_is_not_reached_is_refused() {
    let wanted = ["--require-sigma", "0.001", "--json"];
    let output = meridian(&[&["replay", &stored("spin-80rps-noisy")][..], &wanted].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(object(&output)["reason"].as_str().is_some_and(|why| why.contains("more than")));
}

#[test]
fn methods_that_do_not_fit_are_refused_and_options_that_do_not_are_misuse() {
    let (spin, stage) = (stored("spin-100rps"), stored("stepwise-bumped"));
    let failed = meridian(&["replay", &stage, "--method", "spin"]);
    assert_eq!(failed.status.code(), Some(1));
    assert!(text(&failed.stderr).contains("has no spinning body"), "{}", text(&failed.stderr));
    let failed = meridian(&["replay", &spin, "--method", "stepwise"]);
    assert_eq!(failed.status.code(), Some(1));
    for misuse in [
        &["--criterion", "least-squares"][..],
        &["--half", "east"],
        &["--latitude", "50"],
        &["--displacements", "0,0"],
    ] {
        let output = meridian(&[&["replay", &spin, "--method", "spin"][..], misuse].concat());
        assert_eq!(output.status.code(), Some(2), "{misuse:?}: {}", text(&output.stderr));
    }
}

#[test]
fn the_simulated_board_follows_a_flight() {
    let arguments = ["run", "spin", "--flight-seconds", "1", "--json", "-v"];
    let output = meridian(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let object = object(&output);
    let number = |key: &str| object[key].as_f64().unwrap_or(f64::NAN);
    assert!(number("error_deg").abs() < 4.0 * number("sigma_deg"), "{object}");
    assert_eq!((&object["health"]["missing"], &object["turns_lost"]), (&0.into(), &0.into()));
    assert!(text(&output.stderr).contains("roll: locked"), "{}", text(&output.stderr));
}

#[test]
fn the_faults_of_a_spinning_body_are_listed() {
    let listed = meridian(&["run", "spin", "--fault", "list"]);
    assert!(text(&listed.stdout).contains("lift-fades"));
}

#[test]
fn the_campaign_prints_the_papers_figures_and_draws_them() {
    let (output, page) = page(&["campaign", "spin", "--runs", "2"]);
    let reported = text(&output.stdout);
    for words in ["Fig. 7", "Fig. 8", "between corrections", "a turn", "noise of 1.5 m/s²", "limit"]
    {
        assert!(reported.contains(words), "{words}: {reported}");
    }
    let titles = ["(Fig. 7)", "(Fig. 8)", "without correction", "The phase lock at a moment"];
    assert_drawn(&page, &titles);
    let object = object(&meridian(&["campaign", "spin", "--runs", "1", "--json"]));
    assert_eq!(object["flights"].as_array().map(Vec::len), Some(4), "{object}");
    let uncorrected = object["paper"]["uncorrected_deg"].as_f64().unwrap_or(f64::NAN);
    assert!((uncorrected - 36.13).abs() < 0.05, "{object}");
}
