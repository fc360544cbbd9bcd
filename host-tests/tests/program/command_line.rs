//! The `meridian` program as a user meets it: output, exit codes, one clear line for each mistake.

use crate::support::files::{Scratch, stored};
use crate::support::program::{code, meridian, object, page, text};

#[test]
fn without_a_command_the_whole_board_finds_north_on_simulated_chips() {
    let output = meridian(&["-v"]);
    assert_eq!(code(&output), 0);
    let block = text(&output.stdout);
    for part in [
        "True north found in the simulated run",
        "azimuth of body x",
        "limit",
        "truth",
        "Error budget",
        "times real time",
    ] {
        assert!(block.contains(part), "{part} is missing in {block}");
    }
    let log = text(&output.stderr);
    for part in ["identity and self-test passed", "dwell 25 of 25", "positions 3/25"] {
        assert!(log.contains(part), "{part} is missing in {log}");
    }
}

#[test]
fn two_frames_find_north_and_leave_the_gyro_vertical() {
    let options = ["run", "two-frame", "--passes", "2", "--rate", "100"];
    let output = meridian(&[&options[..], &["-v"]].concat());
    assert_eq!(code(&output), 0);
    let block = text(&output.stdout);
    for part in
        ["found in the simulated run on two frames", "truth", "vertical, to store the azimuth"]
    {
        assert!(block.contains(part), "{part} is missing in {block}");
    }
    assert!(text(&output.stderr).contains("dwell 8 of 8"));
    let found = object(&meridian(&[&options[..], &["--json"]].concat()));
    assert_eq!(found["stored"], true);
    assert!(found["truth_off_vertical_deg"].as_f64().is_some_and(|off| off < 0.05));
    let refused = meridian(&[&options[..], &["--fault", "encoder-slip"]].concat());
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("stage"), "{}", text(&refused.stderr));
}

#[test]
fn what_is_run_is_what_was_asked_for() {
    let options = ["run", "--json", "--positions", "6", "--dwell", "3", "--rate", "100"];
    let place = ["--latitude", "-33.9", "--azimuth", "12.5", "--pitch", "2", "--roll=-3"];
    let output = meridian(&[&options[..], &place[..], &["--seed", "9"]].concat());
    assert_eq!(code(&output), 0);
    let object = object(&output);
    let number = |key: &str| object[key].as_f64().expect("a number");
    assert!((number("azimuth_deg") - 12.5).abs() < 4.0 * number("sigma_deg"));
    assert!((number("pitch_deg") - 2.0).abs() < 0.05 && (number("roll_deg") + 3.0).abs() < 0.05);
    // To the first one the stage comes once more at the end.
    assert_eq!(object["positions"], 7);
    assert_eq!(object["status"], "ok");
}

#[test]
fn a_fault_that_no_patience_mends_is_exit_one_with_its_reason() {
    let output = meridian(&["run", "--rate", "100", "--fault", "gyro-identity", "--json"]);
    assert_eq!(code(&output), 1);
    let object = object(&output);
    assert_eq!(object["status"], "refused");
    assert_eq!(object["reason"], "gyro: another chip answers, or none: check the wiring");
    assert!(text(&output.stderr).contains("meridian: gyro: another chip answers"));
}

#[test]
fn what_run_cannot_do_is_misuse_in_one_line() {
    for wrong in [
        &["run", "--latitude", "91"][..],
        &["run", "--rate", "2000"],
        &["run", "--gyro", "laser"],
        &["run", "--fault", "nothing"],
        &["run", "--positions", "1"],
        &["run", "--dwell", "0"],
        &["run", "--method", "static"],
        &["run", "--seed", "-1"],
        &["run", "--azimuth", "nan"],
    ] {
        let output = meridian(wrong);
        assert_eq!(code(&output), 2, "{wrong:?}");
        assert_eq!(text(&output.stderr).lines().count(), 1, "{wrong:?}");
    }
}

#[test]
fn json_is_one_object_with_the_documented_keys() {
    let output = meridian(&["replay", &stored("stepwise-nudged"), "--json"]);
    assert_eq!(code(&output), 0);
    let progress = text(&output.stderr);
    assert!(progress.lines().all(|line| line.starts_with("positions ")), "{progress}");
    let object = object(&output);
    let keys = [
        "method",
        "status",
        "azimuth_deg",
        "sigma_deg",
        "limit_deg",
        "budget",
        "positions",
        "seconds",
        "pitch_deg",
        "roll_deg",
        "earth_rate_ratio",
        "earth_rate_ratio_sigma",
        "model",
        "excluded",
    ];
    for key in keys {
        assert!(!object[key].is_null(), "{key} is missing in {object}");
    }
    assert_eq!((&object["method"], &object["status"]), (&"stepwise".into(), &"ok".into()));
    let parts = [
        "noise",
        "drift",
        "g_sensitivity",
        "accelerometer",
        "encoder",
        "latitude",
        "scale",
        "temperature",
    ];
    let squares = |part: &&str| object["budget"][part].as_f64().expect("a number").powi(2);
    let sigma = object["sigma_deg"].as_f64().expect("a number");
    assert!((parts.iter().map(squares).sum::<f64>().sqrt() / sigma - 1.0).abs() < 1e-9);
    assert_eq!(object["excluded"][0]["dwell"], 8);
    assert!(object["excluded"][0]["reason"].is_string());
}

#[test]
fn a_refusal_has_its_reason_no_azimuth_and_exit_code_one() {
    let file = stored("stepwise-circle");
    for option in [["--latitude", "86"], ["--require-sigma", "0.001"], ["--latitude", "-60"]] {
        let output = meridian(&["replay", &file, "--json", option[0], option[1]]);
        let object = object(&output);
        assert_eq!((code(&output), &object["status"]), (1, &"refused".into()));
        assert!(object["azimuth_deg"].is_null() && object["reason"].is_string(), "{object}");
    }
    let output = meridian(&["replay", &file, "--latitude", "86"]);
    assert_eq!(code(&output), 1);
    assert!(text(&output.stdout).contains("latitude 86.00° is beyond ±85°"));
}

#[test]
fn impossible_options_are_misuse() {
    let file = stored("stepwise-circle");
    let mistakes: [&[&str]; 14] = [
        &["replay"],
        &["replay", &file, "--latitude", "91"],
        &["replay", &file, "--latitude", "nan"],
        &["replay", &file, "--latitude", "north"],
        &["replay", &file, "--criterion", "best"],
        &["replay", &file, "--criterion", "within-squares"],
        &["replay", &file, "--criterion", "within-squares=-1"],
        &["replay", &file, "--criterion", "ml=3"],
        &["replay", &file, "--method", "magic"],
        &["replay", &file, "--require-sigma", "0"],
        &["campaign", "sokolov", "--runs", "0"],
        &["campaign", "unknown"],
        &["campaign", "sokolov", "--runs", "many"],
        &["fly"],
    ];
    for arguments in mistakes {
        let output = meridian(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        let message = text(&output.stderr);
        assert!(message.starts_with("error: "), "{arguments:?}: {message}");
        assert_eq!(message.lines().count(), 1, "{arguments:?}: {message}");
        assert_eq!(text(&output.stdout), "", "{arguments:?}");
    }
}

/// A small sound recording: four positions of 5 s at 50 Hz.
fn sound() -> String {
    let mut recording = String::from(
        "# kind: stage\n# latitude_deg: 47.58\n# rate_hz: 50\n# gyro_N_deg_sqrt_h: 0.001\n\
         t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2\n",
    );
    recording.extend((0..1000_u32).map(|index| {
        let (time, angle) = (f64::from(index) * 0.02, f64::from(index / 250) * 1.5);
        format!("{time:.2},{angle:.4},1e-5,0.0,0.0,-9.81\n")
    }));
    recording
}

/// A sound recording with one thing changed.
fn changed(from: &str, to: &str) -> String {
    let text = sound();
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

#[test]
fn a_malformed_recording_gets_one_line_that_names_file_line_and_column() {
    let row = "\n1.00,";
    let cases: [(&str, String, &str); 9] = [
        ("column.csv", changed(",g_rad_s,", ",gyro,"), "g_rad_s"),
        ("number.csv", changed(row, "\n1.0x,"), "line 56, column t_s"),
        ("backwards.csv", changed(row, "\n0.50,"), "line 56, column t_s"),
        ("nan.csv", changed(row, "\nnan,"), "line 56, column t_s"),
        ("kind.csv", changed("kind: stage", "kind: song"), "kind"),
        ("latitude.csv", changed("latitude_deg: 47.58", "latitude_deg: 91"), "latitude_deg"),
        ("empty.csv", String::new(), "empty"),
        ("long.csv", changed("\n1.00", &"7".repeat(10_000_000)), "65536 bytes"),
        ("cut.csv", sound()[..9000].to_owned(), "line"),
    ];
    for (name, content, part) in cases {
        let scratch = Scratch::new("bad");
        let output = meridian(&["replay", &scratch.with(name, content)]);
        let message = text(&output.stderr);
        assert_eq!(code(&output), 1, "{name}: {message}");
        assert_eq!(message.lines().count(), 1, "{name}: {message}");
        assert!(message.contains(name) && message.contains(part), "{name}: {message}");
    }
}

#[test]
fn a_gap_in_the_times_is_named() {
    let text_of = sound();
    let without: String = text_of.lines().filter(|line| !line.starts_with("2.")).fold(
        String::new(),
        |mut all, line| {
            all.push_str(line);
            all.push('\n');
            all
        },
    );
    let scratch = Scratch::new("gap");
    let output = meridian(&["replay", &scratch.with("gap.csv", without)]);
    let message = text(&output.stderr);
    assert_eq!(code(&output), 1);
    assert!(message.contains("gap.csv") && message.contains("line 106"), "{message}");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let output = meridian(&["replay", "no-such-file.csv", "--json"]);
    assert_eq!((code(&output), &object(&output)["status"]), (1, &"failed".into()));
    assert!(text(&output.stderr).contains("no-such-file.csv"));
}

#[test]
fn a_stage_that_never_stands_still_has_no_dwell() {
    let mut moving = String::from("# kind: stage\n# latitude_deg: 50\n");
    moving += "t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2\n";
    for i in 0..500 {
        let (time, angle) = (f64::from(i) * 0.02, f64::from(i) * 0.01);
        moving += &[time, angle, 1e-5, 0.0, 0.0, -9.8].map(|x| x.to_string()).join(",");
        moving += "\n";
    }
    let scratch = Scratch::new("moving");
    let output = meridian(&["replay", &scratch.with("moving.csv", moving)]);
    assert_eq!(code(&output), 1);
    assert!(text(&output.stderr).contains("stage_rad"), "{}", text(&output.stderr));
}

#[test]
fn a_campaign_prints_its_tables_as_text_and_as_json() {
    let output = meridian(&["campaign", "sokolov", "--runs", "20"]);
    assert_eq!(code(&output), 0);
    let block = text(&output.stdout);
    for part in
        ["28° arc", "full circle", "least-absolute", "7.3, 9.6, 6.0", "limit", "RMS / limit"]
    {
        assert!(block.contains(part), "{part} is missing in {block}");
    }
    let object = object(&meridian(&["campaign", "sokolov", "--runs", "20", "--json"]));
    assert_eq!(object["tables"][0]["rows"].as_array().map(Vec::len), Some(6));
    assert!(object["precision"][1]["ratio"].is_number());
}

#[test]
fn a_plan_gives_the_optimum_and_burovs_positions_beside_it() {
    let gyro = ["plan", "--arw", "0.001", "--ramp", "0.127", "--latitude", "0", "--json"];
    let output = meridian(&[&gyro[..], &["--seconds", "300"]].concat());
    assert_eq!(code(&output), 0);
    let plan = object(&output);
    let burov = &plan["burov"];
    assert_eq!(burov["positions"], 11);
    let error = burov["rate_error_deg_h"].as_f64().expect("a number");
    assert!((error / 3.650_503_146_508_27e-3 - 1.0).abs() < 1e-6);
    let [own, of_burov] =
        [&plan, burov].map(|schedule| schedule["sigma_deg"].as_f64().expect("a number"));
    assert!(own < of_burov);
    // The inverse question, for what this time gives.
    let inverse = object(&meridian(&[&gyro[..], &["--sigma", &own.to_string()]].concat()));
    let seconds = inverse["seconds"].as_f64().expect("a number");
    assert!((295.0..=303.0).contains(&seconds), "{seconds}");
}

#[test]
fn a_plan_that_cannot_be_says_why() {
    for (arguments, reason) in [
        (&["--arw", "0", "--latitude", "48", "--seconds", "300"][..], "N and Q are zero"),
        (&["--arw", "0.1", "--latitude", "48", "--seconds", "5"], "the time holds no schedule"),
        (&["--arw", "0.1", "--latitude", "89", "--seconds", "300"], "beyond ±85°"),
        (&["--arw", "0.1", "--latitude", "48", "--sigma", "1e-5"], "out of reach"),
    ] {
        let output = meridian(&[&["plan"], arguments].concat());
        assert_eq!(code(&output), 1, "{arguments:?}");
        assert!(text(&output.stderr).contains(reason), "{}", text(&output.stderr));
    }
    for wrong in [
        &["--arw", "0.1", "--latitude", "48"][..],
        &["--arw", "-1", "--latitude", "48", "--seconds", "300"],
        &["--arw", "nan", "--latitude", "48", "--seconds", "300"],
        &["--arw", "0.1", "--latitude", "91", "--seconds", "300"],
        &["--arw", "0.1", "--latitude", "48", "--seconds", "300", "--sigma", "1"],
    ] {
        assert_eq!(code(&meridian(&[&["plan"], wrong].concat())), 2, "{wrong:?}");
    }
}

#[test]
fn a_board_that_surveys_its_gyro_tells_what_it_found_and_planned() {
    let output = meridian(&["run", "-v", "--survey", "300", "--seconds", "200", "--rate", "100"]);
    assert_eq!(code(&output), 0);
    let log = text(&output.stderr);
    for part in ["survey: standing still for 300 s", "angle random walk N, °/√h: 0.00", "plan: "]
    {
        assert!(log.contains(part), "{part} is missing in\n{log}");
    }
    assert!(text(&output.stdout).contains("(surveyed)"));
}

#[test]
fn a_board_ends_when_its_accuracy_is_reached_or_says_that_it_cannot_be() {
    let reached = meridian(&["run", "--sigma", "0.05", "--rate", "100", "--json"]);
    assert_eq!(code(&reached), 0);
    assert!(object(&reached)["sigma_deg"].as_f64().expect("a number") <= 0.05);
    let hopeless = ["run", "--sigma", "0.01", "--seconds", "300", "--rate", "100", "--json"];
    let output = meridian(&hopeless);
    assert_eq!(code(&output), 1);
    let reason = object(&output)["reason"].as_str().expect("a reason").to_owned();
    assert!(reason.contains("0.0100° is out of reach"), "{reason}");
}

#[test]
fn two_positions_are_an_answer_only_where_the_half_is_stated() {
    let header = "# kind: dwells\n# latitude_deg: 48\nstage_rad,rate_rad_s,sigma_rad_s,seconds\n";
    // cos 60° of the horizontal Earth rate about a bias of 1e-6 rad/s.
    let rate = 7.292_115e-5 * 48.0_f64.to_radians().cos() * 0.5;
    let row = |angle: f64, sign: f64| format!("{angle},{},1e-8,100\n", 1e-6 + sign * rate);
    let rows: String =
        (0..3).flat_map(|_| [row(0.0, 1.0), row(std::f64::consts::PI, -1.0)]).collect();
    let scratch = Scratch::new("two-positions");
    let path = scratch.with("two-positions.csv", format!("{header}{rows}"));
    let refused = meridian(&["replay", &path, "--method", "positions", "--json"]);
    assert_eq!(code(&refused), 1);
    assert!(object(&refused)["reason"].as_str().expect("why").contains("east or west"));
    for (half, azimuth) in [("east", 60.0), ("west", 300.0)] {
        let output =
            meridian(&["replay", &path, "--method", "positions", "--half", half, "--json"]);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let found = object(&output);
        assert_eq!(found["method"], "positions");
        assert!((found["azimuth_deg"].as_f64().expect("a number") - azimuth).abs() < 0.01);
        assert!(found["earth_rate_ratio"].is_null());
    }
}

#[test]
fn pages_are_written_for_alignments_and_plans() {
    let recording = stored("positions-four-fog");
    for arguments in [
        &["replay", &recording][..],
        &["plan", "--arw", "0.01", "--latitude", "48", "--seconds", "300"],
    ] {
        let (_, html) = page(arguments);
        assert!(html.matches("<svg").count() >= 2, "{arguments:?}");
    }
    let nowhere = ["replay", &recording, "--report", "/nowhere/page.html"];
    let output = meridian(&nowhere);
    assert_eq!(code(&output), 1);
    assert!(text(&output.stderr).contains("/nowhere/page.html"));
}
