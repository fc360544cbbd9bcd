//! Help: grouped, narrow enough, with examples that run; completions, manual pages, and the version.

use std::collections::BTreeSet;
use std::fs;
#[cfg(unix)]
use std::process::Command;
use std::process::Output;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_misuse, code, command, meridian, object, text};

/// The commands, and the platforms of `run`.
const COMMANDS: [&str; 22] = [
    "",
    "run",
    "run stage",
    "run two-frame",
    "run turntable",
    "run vehicle",
    "run spin",
    "replay",
    "plan",
    "allan",
    "campaign",
    "emulate",
    "log",
    "send",
    "settings",
    "settings get",
    "settings set",
    "settings save",
    "settings load",
    "doctor",
    "completions",
    "man",
];

/// Columns of a narrow terminal.
const COLUMNS: usize = 80;

fn words(line: &str) -> Vec<&str> {
    line.split(' ').filter(|word| !word.is_empty()).collect()
}

/// The help of a command on a narrow terminal.
fn help(name: &str) -> String {
    let output = command()
        .args(words(name))
        .arg("--help")
        .env("COLUMNS", COLUMNS.to_string())
        .output()
        .expect("it starts");
    assert_eq!(code(&output), 0, "{name}");
    text(&output.stdout)
}

/// The examples of a help, without the program's name.
fn examples(help: &str) -> Vec<String> {
    let (_, behind) = help.split_once("Examples:\n").unwrap_or_default();
    let lines = behind.lines().filter_map(|line| line.strip_prefix("  meridian"));
    lines.map(|line| line.trim().to_owned()).collect()
}

#[test]
fn no_line_of_any_help_is_wider_than_a_narrow_terminal() {
    for name in COMMANDS {
        for line in help(name).lines() {
            assert!(line.chars().count() <= COLUMNS, "{name}: {line}");
        }
    }
}

#[test]
fn every_help_has_examples_and_the_first_one_says_what_the_exit_codes_mean() {
    for name in COMMANDS {
        let help = help(name);
        let examples = examples(&help);
        assert!((1..=4).contains(&examples.len()), "{name}: {help}");
        let command = name.split(' ').next().unwrap_or_default();
        assert!(examples.iter().all(|example| example.starts_with(command)), "{name}");
    }
    let whole = help("");
    assert_eq!(examples(&whole).len(), 3);
    for part in ["The exit code is 0 with a result, 1 where it is refused", "2 for misuse"] {
        assert!(whole.contains(part), "{whole}");
    }
}

#[test]
fn the_first_help_names_what_carries_the_sensors_and_leaves_the_command_open() {
    let whole = help("");
    let first = whole.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    for carrier in ["stage", "two frames", "turntable", "vehicle", "spinning body"] {
        assert!(first.contains(carrier), "{first}");
    }
    assert!(whole.contains("Usage: meridian [OPTIONS] [COMMAND]\n"), "{whole}");
}

#[test]
fn options_stand_under_their_headings() {
    for (name, headings) in [
        ("run", &["Place", "Attitude", "Sensor", "Course", "Keeping", "Output"][..]),
        ("run stage", &["Place", "Attitude", "Sensor", "Course", "Keeping", "Output"]),
        ("run two-frame", &["Place", "Attitude", "Sensor", "Course", "Keeping", "Output"]),
        ("run turntable", &["Place", "Attitude", "Sensor", "Course", "Keeping", "Output"]),
        ("run vehicle", &["Place", "Attitude", "Sensor", "Course", "Keeping", "Output"]),
        ("run spin", &["Course", "Chance, disturbances and faults", "Output"]),
        ("replay", &["Arguments", "Output"]),
    ] {
        let help = help(name);
        for heading in headings {
            assert!(help.contains(&format!("\n{heading}:\n")), "{name}: {heading} in {help}");
        }
        let is_heading = |line: &&str| line.ends_with(':') && !line.starts_with(' ');
        let found: Vec<&str> = help.lines().filter(is_heading).collect();
        // Examples come behind them.
        let last = found.iter().rev().nth(1);
        assert_eq!(last, Some(&"Output:"), "{name}: {found:?}");
    }
}

/// The long options that a help lists.
fn options(help: &str) -> BTreeSet<String> {
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let long = lines.filter_map(|line| line.split([' ', ',']).find(|word| word.starts_with("--")));
    long.map(str::to_owned).collect()
}

#[test]
fn the_help_of_a_run_lists_the_options_that_it_takes_without_a_platform() {
    let [run, stage] = ["run", "run stage"].map(help);
    assert!(run.contains("Without a platform it is a stage, with the options below"), "{run}");
    assert_eq!(options(&run), options(&stage));
    assert!(options(&run).len() > 20, "{run}");
    let place = |help: &str| help.find("\nPlace:\n").map(|at| help[at..].to_owned());
    let listed = |help: &str| place(help)?.split_once("Examples:").map(|(all, _)| all.to_owned());
    let (run, stage) = (listed(&run), listed(&stage));
    assert!(run.is_some() && run.map(|all| all.len()) == stage.map(|all| all.len()));
}

/// A folder with what examples name.
fn named() -> Scratch {
    let scratch = Scratch::new("examples");
    for (name, of) in [
        ("stage.csv.gz", "stepwise-circle"),
        ("drive.csv.gz", "drive-fog-three-stops"),
        ("rest.csv.gz", "static-gyro-1h"),
    ] {
        fs::copy(stored(of), scratch.path(name)).expect("it is ours");
    }
    fs::create_dir(scratch.folder().join("recordings")).expect("the folder is ours");
    for name in ["stepwise-circle.csv.gz", "rotating-gyro.csv.gz"] {
        let path = stored(name.trim_end_matches(".csv.gz"));
        fs::copy(path, scratch.path(&format!("recordings/{name}"))).expect("it is ours");
    }
    scratch
}

/// Runs an example, without what a shell does of it.
fn run(scratch: &Scratch, example: &str) -> Output {
    let line = example.split(" > ").next().unwrap_or_default();
    let input = fs::File::open(scratch.path("stage.csv.gz")).expect("it is there");
    let mut command = command();
    command.current_dir(scratch.folder()).args(words(line)).stdin(input);
    command.output().expect("it starts")
}

/// Whether a command needs more than the program: an emulator, an image, an instrument.
fn needs_more(name: &str) -> bool {
    ["emulate", "log", "send", "settings"].iter().any(|command| name.starts_with(command))
}

#[test]
fn every_example_runs() {
    let scratch = named();
    for name in COMMANDS.iter().filter(|name| !needs_more(name)) {
        for example in examples(&help(name)) {
            let output = run(&scratch, &example);
            // A fault is refused, and so is a class of a campaign with few runs; a computer may lack something.
            let begins = ["campaign", "doctor"].iter().any(|command| example.starts_with(command));
            let fails = example.contains("--fault") || begins;
            let most = i32::from(fails);
            let said = text(&output.stderr);
            assert!((0..=most).contains(&code(&output)), "meridian {example}: {said}");
            assert!(!output.stdout.is_empty(), "meridian {example}");
        }
    }
}

#[test]
fn examples_that_need_more_than_the_program_are_no_misuse() {
    let scratch = named();
    let output = run(&scratch, &examples(&help("log"))[0]);
    assert_eq!(code(&output), 1, "{}", text(&output.stderr));
    let others = COMMANDS.iter().filter(|name| needs_more(name));
    for example in others.flat_map(|name| examples(&help(name))) {
        assert_misuse(&[&words(&example)[..], &["--no-such-option"]].concat(), "--no-such-option");
    }
}

#[test]
fn completions_of_every_shell_know_commands_and_options() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = meridian(&["completions", shell]);
        assert_eq!(code(&output), 0, "{shell}");
        let script = text(&output.stdout);
        for word in ["replay", "turntable", "modulated-turns", "attitude-out", "completions"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert_misuse(&["completions", "sh"], "sh");
}

/// What bash completes behind these words, of which the last one is begun.
#[cfg(unix)]
fn completed(scratch: &Scratch, line: &[&str]) -> BTreeSet<String> {
    let before = line.len() - 1;
    let script = format!(
        "source '{}'; COMP_WORDS=(\"$@\"); COMP_CWORD={before}; \
         _meridian meridian '{}' '{}' 2>/dev/null; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        scratch.path("meridian.bash"),
        line[before],
        line[before - 1]
    );
    let output = Command::new("bash").args(["-c", &script, "bash"]).args(line).output();
    text(&output.expect("there is bash").stdout).lines().map(str::to_owned).collect()
}

/// A folder with the completions of bash.
#[cfg(unix)]
fn with_completions() -> Scratch {
    let scratch = Scratch::new("completions");
    scratch.with("meridian.bash", text(&meridian(&["completions", "bash"]).stdout));
    scratch
}

#[cfg(unix)]
#[test]
fn a_shell_completes_the_options_of_a_run_with_and_without_a_platform() {
    let scratch = with_completions();
    for name in ["run", "run stage", "run two-frame", "run turntable", "run vehicle", "run spin"] {
        let line = [&["meridian"][..], &words(name), &["--"]].concat();
        assert_eq!(completed(&scratch, &line), options(&help(name)), "{name}");
    }
    let platforms = completed(&scratch, &["meridian", "run", ""]);
    assert!(platforms.contains("turntable") && platforms.contains("--azimuth"), "{platforms:?}");
}

#[cfg(unix)]
#[test]
fn a_shell_completes_the_names_of_every_closed_list() {
    let scratch = with_completions();
    for name in ["run", "run stage", "run two-frame", "run turntable", "run vehicle", "run spin"] {
        let listed = text(&meridian(&[&words(name)[..], &["--fault", "list"]].concat()).stdout);
        let faults: BTreeSet<_> = listed.lines().chain(["list"]).map(str::to_owned).collect();
        let line = [&["meridian"][..], &words(name), &["--fault", ""]].concat();
        assert_eq!(completed(&scratch, &line), faults, "{name}");
    }
    for (line, some) in [
        ("run --gyro", "fog-coarse"),
        ("run --half", "west"),
        ("replay --method", "siap"),
        ("campaign --platform", "two-frame"),
        ("campaign --class", "base-turn"),
        ("emulate --board", "all"),
        ("send", "realign"),
    ] {
        let line = [&["meridian"][..], &words(line), &[""]].concat();
        assert!(completed(&scratch, &line).contains(some), "{line:?}");
    }
}

#[test]
fn a_manual_page_has_a_whole_title_and_the_usage_of_the_help() {
    let version = text(&meridian(&["--version"]).stdout);
    for name in COMMANDS {
        let page = text(&meridian(&[&["man"][..], &words(name)].concat()).stdout);
        let title = [&["meridian"][..], &words(name)].concat().join("-");
        let title = format!(".TH {title} 1 \"\" \"{}\" \"Meridian manual\"", version.trim_end());
        assert!(page.lines().any(|line| line == title), "{name}: {page}");
        let synopsis = page.split("\n.SH ").find_map(|part| part.strip_prefix("SYNOPSIS\n"));
        let synopsis = ["\\fB", "\\fR", "\\"]
            .iter()
            .fold(synopsis.expect("it has one").to_owned(), |text, mark| text.replace(mark, ""));
        let help = help(name);
        let usage = help.lines().find_map(|line| line.strip_prefix("Usage: "));
        assert_eq!(Some(synopsis.as_str()), usage, "{name}");
    }
}

#[test]
fn every_command_has_a_manual_page_and_what_is_none_is_named() {
    for name in COMMANDS {
        let output = meridian(&[&["man"][..], &words(name)].concat());
        assert_eq!(code(&output), 0, "{name}");
        let page = text(&output.stdout);
        assert!(
            page.contains(".TH") && page.contains(".SH EXAMPLES\n  meridian"),
            "{name}: {page}"
        );
        let synopsis = page.split(".SH ").find_map(|part| part.strip_prefix("SYNOPSIS\n"));
        assert!(synopsis.is_some_and(|line| !line.contains("<\\fIsubcommands")), "{name}: {page}");
    }
    assert_misuse(&["man", "run", "ship"], "run has no command ship");
    assert!(object(&meridian(&["man", "--json"]))["text"].is_string());
}

#[test]
fn the_version_begins_with_that_of_the_package_and_names_the_commit_where_there_is_one() {
    let version = text(&meridian(&["--version"]).stdout);
    let package = concat!("meridian ", env!("CARGO_PKG_VERSION"));
    let rest = version.trim_end().strip_prefix(package).expect("it begins so");
    let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')'));
    let is_commit = |text: &str| {
        let text = text.strip_suffix(", changed").unwrap_or(text);
        text.len() >= 7 && text.chars().all(|digit| digit.is_ascii_hexdigit())
    };
    assert!(rest.is_empty() || commit.is_some_and(is_commit), "{version}");
}
