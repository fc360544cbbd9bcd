//! Misuses drawn by chance: each is reported in one line, with exit code 2, and nothing is done.

use std::fs;

use hal_mock::noise::Generator;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_misuse, code, command, meridian, text};

/// How many are drawn.
const COUNT: usize = 200;
const SEED: u64 = 16;

/// A draw of chance.
struct Chance(Generator);

impl Chance {
    /// One of these.
    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        let place = self.0.uniform() * all.len() as f64;
        all[place as usize]
    }
}

/// Options with what each of them cannot be: of a run, a replay, a plan and a campaign.
const NUMBERS: [(&str, &[&str]); 23] = [
    ("run --latitude", &["91", "-91", "nan", "inf", "north", "", "47,58", "1e3"]),
    ("run --azimuth", &["361", "-1000", "east", "0x10", "--json"]),
    ("run --pitch", &["90.1", "NaN", "-", "1 2"]),
    ("run --roll", &["181", "-181", "upside"]),
    ("run --rate", &["0", "-400", "401", "1e400", "fast"]),
    ("run --seconds", &["59", "36001", "-60", "nan"]),
    ("run --sigma", &["0", "-0.1", "181", "small"]),
    ("run --survey", &["0", "-1", "1e9"]),
    ("run --positions", &["1", "65", "-6", "6.5", "18446744073709551616"]),
    ("run --dwell", &["0", "-1", "601", "inf"]),
    ("run --hold", &["-1", "14401", "nan"]),
    ("run --handover", &["1", "1,", ",1", "1,0", "-1,-1", "361,1", "1,2,3", "a,b"]),
    ("run --sway", &["-0.1", "2.1", "nan"]),
    ("run --seed", &["-1", "18446744073709551616", "1.5", "x"]),
    ("run turntable --speeds", &["0", "-0.1", "0.1,0.1", "0.1,0.2,0.3", "1"]),
    ("run turntable --modulated-turns", &["-1", "3", "1001"]),
    ("run vehicle --stops", &["1", "9", "-2", "two"]),
    ("run vehicle --drive-seconds", &["29", "3601", "-60"]),
    ("run spin --flight-seconds", &["0", "61", "-1"]),
    ("run spin --turns-per-second", &["19", "106", "-100"]),
    ("plan --latitude 48 --sigma 1 --arw", &["-1", "nan", "1e7", "much"]),
    ("plan --latitude 48 --arw 1 --seconds", &["0", "-5", "86401"]),
    ("campaign spin --runs", &["0", "-1", "1000001", "many"]),
];
/// Names that nothing bears.
const NAMES: [&str; 13] = [
    "run --method magic",
    "run --gyro laser",
    "run --fault nothing",
    "run --half north",
    "run --sensor laser",
    "replay FILE --method magic",
    "replay FILE --criterion best",
    "replay FILE --half up",
    "campaign unknown",
    "campaign disturbed --class nothing",
    "fly",
    "run --sead 1",
    "plan --gyro fog",
];
/// What needs something else, or does not go with it.
const LONELY: [&str; 12] = [
    "replay",
    "allan",
    "plan",
    "plan --arw 1 --latitude 48",
    "plan --arw 1 --latitude 48 --sigma 1 --seconds 300",
    "run --sway-hertz 1",
    "run --no-base-imu",
    "run turntable --date 2026-03-14",
    "run --seconds 100 --positions 6",
    "run --sigma 1 --dwell 3",
    "run --seed 1 --seed 2",
    "allan FILE FILE",
];
/// Methods, and options that each ignores.
const IGNORED: [(&str, &[&str]); 6] = [
    ("run spin", &["--latitude=1", "--dwell=3", "--stops=2", "--hold=9"]),
    ("run vehicle", &["--pitch=1", "--positions=6", "--turns=3", "--sway=0.1"]),
    ("run turntable", &["--half=east", "--sway=0.1", "--stops=2"]),
    ("run two-frame", &["--positions=6", "--turns=3"]),
    ("replay FILE --method spin", &["--latitude=1", "--half=east", "--attitude-out=x"]),
    ("replay FILE --method rotating", &["--criterion=ml", "--displacements=0,0"]),
];
/// What writes to a file.
const WRITING: [&str; 8] = [
    "replay FILE --report",
    "replay FILE --method vertical --attitude-out",
    "allan FILE --report",
    "run --record",
    "run --report",
    "run turntable --flash",
    "plan --arw 1 --latitude 48 --sigma 1 --report",
    "campaign spin --report",
];

/// A misuse; `FILE` stands for a sound recording, `FOLDER` for a folder.
fn drawn(chance: &mut Chance) -> Vec<String> {
    let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    match chance.of(&[0, 0, 0, 1, 2, 3, 3, 4, 5]) {
        0 => {
            let (option, values) = chance.of(&NUMBERS);
            let mut arguments = words(option);
            arguments.push(chance.of(values).to_owned());
            arguments
        }
        1 => words(chance.of(&NAMES)),
        2 => words(chance.of(&LONELY)),
        3 => {
            let (method, options) = chance.of(&IGNORED);
            let mut arguments = words(method);
            arguments.push(chance.of(options).to_owned());
            arguments
        }
        4 => {
            let writing = chance.of(&WRITING);
            let onto = if writing.contains("FILE") { "FILE" } else { "FOLDER" };
            let mut arguments = words(writing);
            arguments.push(chance.of(&[onto, "FOLDER", ""]).to_owned());
            arguments
        }
        _ => {
            let (command, second) =
                (chance.of(&["replay", "allan"]), chance.of(&["FOLDER", "FILE"]));
            let is_folder = second == "FOLDER" && command == "allan";
            let option = if is_folder { "--json" } else { "--no-such-option" };
            [command, second, option].map(str::to_owned).to_vec()
        }
    }
}

#[test]
fn two_hundred_drawn_misuses_are_reported_in_one_line_each_and_do_nothing() {
    let scratch = Scratch::new("misuses");
    let (file, folder) = (scratch.path("sound.csv.gz"), scratch.folder().display().to_string());
    fs::copy(stored("stepwise-bumped"), &file).expect("the folder is ours");
    let content = fs::read(&file).expect("it is there");
    let mut chance = Chance(Generator::new(SEED));
    for _ in 0..COUNT {
        let arguments = drawn(&mut chance);
        let named = |word: &String| match word.as_str() {
            "FILE" => file.clone(),
            "FOLDER" => folder.clone(),
            other => other.to_owned(),
        };
        let arguments: Vec<String> = arguments.iter().map(named).collect();
        assert_misuse(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), "");
    }
    assert!(fs::read(&file).expect("it is there") == content);
    assert_eq!(fs::read_dir(scratch.folder()).expect("it is there").count(), 1);
}

#[test]
fn whatever_stands_in_an_argument_the_message_is_one_line() {
    for odd in ["a\nb", "a\r\nUsage: b", "\u{7}", "\u{1b}[31m", "°/√h", "--=", "--report=", "-"]
    {
        assert_misuse(&["run", "--latitude", odd], "");
        assert_misuse(&["run", "--method", odd], "");
        assert_misuse(&[odd], "");
    }
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        let odd = std::ffi::OsStr::from_bytes(b"--gyro=\xff\xfe");
        let output = command().arg("run").arg(odd).output();
        let output = output.expect("it starts");
        let lines = text(&output.stderr).lines().count();
        assert_eq!((output.status.code(), lines), (Some(2), 1));
    }
}

/// Options of `run` that do not go together or are impossible, and what is named of them.
const APART: [(&str, &str); 41] = [
    ("--flash x", "--flash"),
    ("--modulated-turns 6", "--modulated-turns"),
    ("--speeds 0.1", "--speeds"),
    ("--sensor met", "--sensor"),
    ("--stops 3", "--stops"),
    ("--drive-seconds 300", "--drive-seconds"),
    ("--flight-seconds 2", "--flight-seconds"),
    ("--no-base-imu", "--sway"),
    ("--sway 3", "--sway"),
    ("--sway -0.1", "--sway"),
    ("--sway nan", "--sway"),
    ("--sway 0.1 --sway-hertz 9", "--sway-hertz"),
    ("turntable --date 2026-03-14", "--flash"),
    ("turntable --dwell 3", "--dwell"),
    ("turntable --sigma 0.1", "--sigma"),
    ("turntable --sway 0.1", "--sway"),
    ("turntable --sensor met --gyro fog", "--gyro"),
    ("turntable --no-displacement", "--no-displacement"),
    ("turntable --flash x --date=2026-02-29", "--date"),
    ("turntable --flash x --date=14.3.2026", "--date"),
    ("turntable --flash x --date=2026-03-14-1", "--date"),
    ("turntable --flash x --modulated-turns=3", "--modulated-turns"),
    ("turntable --flash x --modulated-turns=-1", "--modulated-turns"),
    ("turntable --speeds=0", "--speeds"),
    ("turntable --speeds=0.6", "--speeds"),
    ("turntable --speeds=0.1,0.11", "--speeds"),
    ("turntable --speeds=0.1,0.2,0.3", "--speeds"),
    ("turntable --speeds=fast", "--speeds"),
    ("turntable --speeds=-0.1", "--speeds"),
    ("vehicle --stops 1", "--stops"),
    ("vehicle --dwell 3", "--dwell"),
    ("vehicle --turns 3", "--turns"),
    ("vehicle --sway 0.1", "--sway"),
    ("vehicle --fault nothing", "nothing"),
    ("spin --positions 12", "--positions"),
    ("spin --sway 1", "--sway"),
    ("spin --stops 3", "--stops"),
    ("spin --fault blocked", "blocked"),
    ("stage --fault lift-fades", "a fault of spin"),
    ("--fault never-drives", "a fault of vehicle"),
    ("--method vertical", "--method"),
];

#[test]
fn what_cannot_go_together_is_misuse_with_the_option_named() {
    for (arguments, named) in APART {
        let arguments: Vec<&str> = ["run"].into_iter().chain(arguments.split(' ')).collect();
        assert_misuse(&arguments, named);
    }
}

#[test]
fn help_is_whole_and_no_misuse() {
    for arguments in [&["--help"][..], &["run", "--help"], &["help", "replay"], &["--version"]] {
        let output = meridian(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}");
        assert!(!output.stdout.is_empty() && output.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn a_recording_in_the_place_of_a_command_is_told_which_command_takes_it() {
    for name in ["stage.csv", "run.jsonl.gz"] {
        assert_misuse(&[name], &format!("`meridian replay {name}` replays a recording"));
    }
    assert_misuse(&["plans"], "unrecognized subcommand");
}

/// The long options of a command, as its help lists them.
fn options(command: &[&str]) -> Vec<String> {
    let help = text(&meridian(&[command, &["--help"]].concat()).stdout);
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let long = lines.filter_map(|line| line.split([' ', ',']).find(|word| word.starts_with("--")));
    long.map(str::to_owned).collect()
}

#[test]
fn every_option_that_lacks_its_last_letter_is_asked_for_whole() {
    for command in [
        &["run"][..],
        &["run", "two-frame"],
        &["run", "turntable"],
        &["run", "vehicle"],
        &["run", "spin"],
        &["replay"],
        &["plan"],
        &["allan"],
        &["campaign"],
        &["emulate"],
    ] {
        let options = options(command);
        assert!(options.len() > 3, "{command:?}");
        for option in options {
            let short = &option[..option.len() - 1];
            let question = format!("--help`; did you mean `{option}`?");
            assert_misuse(&[command, &[short]].concat(), &question);
        }
    }
}

#[test]
fn a_mistyped_name_of_a_command_or_a_value_is_asked_for_as_it_is() {
    for (typed, meant) in [
        ("replya", "replay"),
        ("camapign", "campaign"),
        ("run stgae", "stage"),
        ("run vehicel", "vehicle"),
        ("run --gyro fog-corse", "fog-coarse"),
        ("run --half eats", "east"),
        ("run --fault encoder-slp", "encoder-slip"),
        ("run vehicle --fault never-drive", "never-drives"),
        ("replay x.csv --method verticle", "vertical"),
        ("campaign disturbd", "disturbed"),
        ("campaign disturbed --class base-trun", "base-turn"),
        ("campaign faults --platform turntabel", "turntable"),
        ("emulate --board vehicel", "vehicle"),
        ("completions bsh", "bash"),
        ("man run vehicel", "vehicle"),
    ] {
        let arguments: Vec<&str> = typed.split(' ').collect();
        assert_misuse(&arguments, &format!("; did you mean `{meant}`?"));
    }
}

#[test]
fn what_resembles_nothing_is_asked_for_by_no_other_name() {
    for typed in
        ["fly", "run --criterion", "run --gyro laser", "run --fault nothing", "plan --gyro"]
    {
        let output = meridian(&typed.split(' ').collect::<Vec<_>>());
        assert!(!text(&output.stderr).contains("did you mean"), "{}", text(&output.stderr));
    }
}

#[test]
fn an_option_of_another_platform_is_said_to_be_one_of_it() {
    for (arguments, having) in [
        ("--stops 3", "vehicle"),
        ("vehicle --half east", "stage, two-frame"),
        ("vehicle --flight-seconds 1", "spin"),
        ("spin --stop-seconds 40", "vehicle"),
    ] {
        let arguments: Vec<&str> = ["run"].into_iter().chain(arguments.split(' ')).collect();
        assert_misuse(&arguments, &format!("--help`; it is an option of run {having}"));
    }
}
