//! Options: what a method ignores is refused by name, and a minus may begin a number.

use crate::support::files::stored;
use crate::support::program::{assert_misuse, code, meridian, object, reason, text};

/// Platforms, and all options that each does not take.
const IGNORED: [(&str, &str); 5] = [
    (
        "spin",
        "--latitude=1 --azimuth=1 --pitch=1 --roll=1 --gyro=fog --rate=100 --seconds=60 --sigma=1 --survey=60 \
         --passes=1 --half=east --positions=6 --dwell=5 --sensor=gyro --speeds=0.1 --turns=3 \
         --modulated-turns=5 --flash=x --stops=3 --stop-seconds=50 --drive-seconds=300 --no-displacement --hold=5 \
         --realign --handover=1,1 --sway=0.1",
    ),
    (
        "vehicle",
        "--pitch=1 --roll=1 --seconds=60 --sigma=1 --survey=60 --passes=1 --half=east \
         --positions=6 --dwell=5 --sensor=gyro --speeds=0.1 --turns=3 --modulated-turns=5 --flash=x \
         --flight-seconds=1 --turns-per-second=90 --sway=0.1",
    ),
    (
        "turntable",
        "--seconds=60 --sigma=1 --survey=60 --passes=1 --half=east --positions=6 --dwell=5 \
         --stops=3 --stop-seconds=50 --drive-seconds=300 --no-displacement --flight-seconds=1 \
         --turns-per-second=90 --sway=0.1 --no-base-imu",
    ),
    ("two-frame", "--positions=6 --turns=3 --stops=3"),
    ("stage", "--passes=1 --turns=3 --stops=3 --flight-seconds=1"),
];
#[test]
fn an_option_that_a_platform_does_not_take_is_refused_with_both_named() {
    for (platform, options) in IGNORED {
        for option in options.split_whitespace() {
            let name = option.split('=').next().unwrap_or_default();
            let words =
                format!("unexpected argument '{name}' found; see `meridian run {platform} --help`");
            assert_misuse(&["run", platform, option], &words);
        }
    }
}

#[test]
fn a_run_that_names_no_platform_is_one_of_a_stage() {
    for after in
        [&["--fault", "list"][..], &["--nothing"], &["--seed", "x"], &["--json", "--seed=x"]]
    {
        let unnamed = meridian(&[&["run"], after].concat());
        assert_eq!(unnamed, meridian(&[&["run", "stage"], after].concat()), "{after:?}");
    }
    let words = "'--seconds <SECONDS>' cannot be used with";
    assert_misuse(&["run", "--seconds", "300", "--positions", "4"], words);
}

#[test]
fn a_fault_of_another_platform_is_refused() {
    for (platform, fault, having) in [
        ("turntable", "never-drives", "a fault of vehicle, not of turntable"),
        ("vehicle", "base-nudge", "not of vehicle"),
        ("spin", "never-drives", "a fault of vehicle, not of spin"),
        ("stage", "inner-frame-reset", "a fault of two-frame, not of stage"),
        ("two-frame", "encoder-slip", "a fault of stage and turntable, not of two-frame"),
    ] {
        assert_misuse(&["run", platform, "--fault", fault], having);
    }
    let without = ["run", "--sway", "0.1", "--no-base-imu", "--fault", "coarse-imu-silent"];
    assert_misuse(&without, "--no-base-imu leaves out");
    assert_misuse(&["run", "--rate", "20"], "take more, or --hold 0");
    assert_misuse(&["run", "--fault", "list", "--record", "x.csv"], "--record: ");
}

#[test]
fn keeping_and_handing_over_are_refused_where_nothing_comes_of_them() {
    let nothing = "nothing is kept after this run";
    assert_misuse(&["run", "--realign", "--hold", "0"], nothing);
    assert_misuse(&["run", "--handover", "1,1", "--sigma", "0.1"], nothing);
    assert_misuse(&["run", "--realign", "--fault", "base-nudge"], nothing);
    assert_misuse(&["run", "--handover", "1,1", "--dwell", "3"], "--dwell: --handover takes");
    assert_misuse(&["run", "--handover", "1,1", "--gyro", "mems"], "--gyro: --handover takes");
    for option in ["--stops=7", "--no-displacement"] {
        assert_misuse(&["run", "vehicle", "--handover", "1,1", option], "--handover takes");
    }
    assert_misuse(&["run", "--realign", "--hold", "299"], "--realign: the first stop");
    assert_misuse(&["run", "turntable", "--realign", "--hold", "500"], "--realign: the first stop");
    assert_misuse(
        &["run", "turntable", "--flash", "x", "--hold", "60"],
        "--flash: the next run begins where this one began",
    );
    assert_misuse(&["run", "--handover", "1,1", "--record", "x.csv"], "leave --handover out");
}

#[test]
fn an_option_that_a_replay_ignores_is_refused_with_both_named() {
    let stage = stored("stepwise-circle");
    for (method, options) in [
        ("spin", &["--latitude=1", "--criterion=ml", "--half=east", "--displacements=0,0"][..]),
        ("vertical", &["--criterion=ml", "--half=east", "--displacements=0,0"]),
        ("static", &["--criterion=ml", "--half=east", "--displacements=0,0", "--attitude-out=x"]),
        ("siap", &["--criterion=ml", "--half=east", "--attitude-out=x"]),
        ("rotating", &["--criterion=ml", "--half=east", "--displacements=0,0", "--attitude-out=x"]),
        ("stepwise", &["--displacements=0,0", "--attitude-out=x"]),
        ("positions", &["--displacements=0,0", "--attitude-out=x"]),
    ] {
        for option in options {
            let name = option.split('=').next().unwrap_or_default();
            let words = format!("{name}: --method {method} does not take it: ");
            assert_misuse(&["replay", &stage, "--method", method, option], &words);
        }
    }
}

#[test]
fn an_option_that_the_kind_of_a_recording_ignores_is_a_misuse_without_a_method_too() {
    for (name, option, method) in [
        ("stepwise-circle", "--attitude-out=x.csv", "stepwise"),
        ("positions-four-fog", "--displacements=0,0", "stepwise"),
        ("rotating-gyro", "--criterion=ml", "rotating"),
        ("drive-ideal", "--half=east", "siap"),
        ("parked-swaying", "--displacements=0,0", "static"),
        ("spin-100rps", "--latitude=1", "spin"),
    ] {
        let option_name = option.split('=').next().unwrap_or_default();
        let words = format!("{option_name}: --method {method} does not take it: ");
        let path = stored(name);
        assert_misuse(&["replay", &path, option], &words);
        assert_misuse(&["replay", &path, option, "--json"], &words);
        assert_misuse(&["replay", &path, option, "--method", method], &words);
    }
}

#[test]
fn keeping_for_no_time_is_as_good_as_not_asking_for_it() {
    let short = ["run", "--rate", "50", "--dwell", "2", "--record", "/dev/null"];
    for hold in ["0", "0.0"] {
        let output = meridian(&[&short[..], &["--hold", hold]].concat());
        assert_eq!(code(&output), 0, "{}", reason(&output));
    }
    assert_misuse(&["run", "--realign", "--record", "x.csv"], "leave --realign out");
}

#[test]
fn each_platform_lists_its_own_faults_and_takes_every_one_of_them() {
    let listed = |platform: &str| {
        let output = meridian(&["run", platform, "--fault", "list"]);
        let text = text(&output.stdout);
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let [stage, frames, platform, vehicle, body] =
        ["stage", "two-frame", "turntable", "vehicle", "spin"].map(listed);
    // Stage and platform are one board, whose chips fail alike.
    assert_eq!(stage, platform);
    let counts = [&stage, &frames, &platform, &vehicle, &body].map(Vec::len);
    assert_eq!(counts, [58, 85, 58, 51, 55]);
    for (platform, own, other) in
        [("vehicle", &vehicle, &stage), ("spin", &body, &vehicle), ("stage", &stage, &body)]
    {
        assert!(own != other, "{platform}");
        let alien = other.iter().find(|fault| !own.contains(fault)).expect("they differ");
        assert_misuse(&["run", platform, "--fault", alien], "--fault: ");
    }
}

#[test]
fn a_campaign_refuses_what_it_ignores() {
    assert_misuse(
        &["campaign", "spin", "--platform", "spin"],
        "--platform: campaign spin does not",
    );
    assert_misuse(&["campaign", "faults", "--platform", "table"], "there are stage, two-frame");
    assert_misuse(&["campaign", "spin", "--class", "x"], "--class: campaign spin does not take it");
    assert_misuse(&["campaign", "disturbed", "--class", "x"], "--class: the classes are ");
}

#[test]
fn a_number_may_be_negative_where_its_quantity_may() {
    let place = ["--latitude", "-47.5", "--azimuth", "-10", "--pitch", "-1", "--roll", "-.5"];
    let short = ["run", "--json", "--rate", "50", "--dwell", "2", "--hold", "0"];
    let output = meridian(&[&short[..], &place].concat());
    assert_eq!(code(&output), 0, "{}", reason(&output));
    assert!((object(&output)["pitch_deg"].as_f64().expect("a number") + 1.0).abs() < 0.1);
    let handed = ["run", "--json", "--rate", "50", "--handover", "-1,0.2"];
    let output = meridian(&handed);
    assert_eq!(code(&output), 0, "{}", reason(&output));
    assert_eq!(object(&output)["status"], "ok");
}

#[test]
fn a_negative_number_is_refused_in_words_where_its_quantity_has_none() {
    let stage = stored("stepwise-circle");
    for (arguments, words) in [
        (&["run", "turntable", "--modulated-turns", "-1"][..], "neither 0 nor a number"),
        (&["run", "turntable", "--speeds", "-0.1,0.2"], "not a speed from"),
        (&["run", "turntable", "--turns", "-3"], "not a whole number from 2 to 1000"),
        (&["run", "--handover", "-1,-0.2"], "not an azimuth within"),
        (&["run", "--handover", "-361,1"], "not an azimuth within"),
        (&["run", "--dwell", "-1"], "not a number of seconds"),
        (&["run", "--sigma", "-0.1"], "not a number of degrees above 0"),
        (&["run", "--sway", "-0.1"], "not an amplitude"),
        (&["run", "--rate", "-100"], "not one of the converter's rates"),
        (&["run", "--positions", "-6"], "not a whole number from 2 to 64"),
        (&["run", "--latitude", "-91"], "outside ±90°"),
        (&["run", "--latitude", "-inf"], "outside ±90°"),
        (&["run", "--azimuth", "--json"], "not a number"),
        (&["replay", &stage, "--require-sigma", "-1"], "not a number of degrees above 0"),
        (&["replay", &stage, "--latitude", "-90.1"], "outside ±90°"),
        (&["replay", &stage, "--criterion", "-1"], "--criterion"),
        (&["plan", "--arw", "-1", "--latitude", "1", "--sigma", "1"], "not a number from 0"),
        (&["campaign", "spin", "--runs", "-1"], "not a whole number from 1 to 1000000"),
    ] {
        assert_misuse(arguments, words);
    }
}
