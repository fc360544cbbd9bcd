//! A board as it is shipped, set up by the program `meridian`: what stands in `firmware/README.md`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use execution::built::{executable, of};
use firmware::platform::Platform;
use firmware::settings::{Editable, Settings, StageSchedule};
use simulated::scenario::Scenario;

use crate::angles::distance;
use crate::started::{Waiting, text};

/// The program, built.
fn meridian() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let messages = of(&["--release", "--package", "meridian"]).expect("it builds");
        executable(&messages, "meridian").expect("it was built")
    })
}

/// What a command of the program prints, which succeeds.
fn printed(arguments: &[&str]) -> String {
    let output = Command::new(meridian()).args(arguments).output().expect("it starts");
    let [printed, said] = [&output.stdout, &output.stderr].map(|bytes| text(bytes));
    assert!(output.status.success(), "{arguments:?}: {printed}{said}");
    printed
}

/// Settings of a stage by names and values as a file has them.
fn stated(mut settings: Settings<StageSchedule>) -> Vec<(&'static str, String)> {
    let settings: &mut dyn Editable = &mut settings;
    settings.all().map(|stated| (stated.name, stated.to_string())).collect()
}

/// The text of a file of settings, with other values.
fn with_values(file: &str, values: &[(&'static str, String)]) -> String {
    file.lines().fold(String::new(), |mut text, line| {
        let name = line.split(" = ").next().unwrap_or_default();
        let value = values.iter().find(|(other, _)| *other == name).map(|(_, value)| value);
        match value {
            Some(value) if value.parse::<f64>().is_ok() => writeln!(text, "{name} = {value}"),
            Some(word) => writeln!(text, "{name} = \"{word}\""),
            None => writeln!(text, "{line}"),
        }
        .expect("memory takes it");
        text
    })
}

#[test]
fn a_board_as_it_is_shipped_is_set_up_and_started_by_the_program_until_its_heading_is_valid() {
    let scenario = Scenario { positions: 3, dwell_s: 2.0, ..simulated::executed::stage(1) };
    let wanted = stated(scenario.settings().expect("the scenario has a latitude"));
    let waiting = Waiting::new(Platform::Stage, &["--as-shipped"]);
    waiting.connect().heard("$PMRDS,waiting,");
    let port = format!("tcp:{}", waiting.address);

    let folder = std::env::temp_dir().join(format!("meridian-setting-up-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("it is new");
    let file = folder.join("stage.toml");
    let name = file.to_str().expect("a name in UTF-8");
    printed(&["settings", &port, "save", name]);
    let shipped = fs::read_to_string(&file).expect("it was written");
    assert!(shipped.contains("carrier = \"stage\"\n"), "{shipped}");
    assert!(shipped.contains("latitude = \"none\"\n"), "{shipped}");
    fs::write(&file, with_values(&shipped, &wanted)).expect("it is there");
    printed(&["settings", &port, "set", "latitude", "47.58"]);
    printed(&["settings", &port, "load", name]);
    fs::remove_dir_all(&folder).expect("it is there");
    let kept = printed(&["settings", &port, "get"]);
    for (name, value) in &wanted {
        assert!(
            kept.lines().any(|line| line.split_whitespace().eq([name, value.as_str()])),
            "{kept}"
        );
    }

    printed(&["send", &port, "start"]);
    let mut client = waiting.connect();
    client.heard("$PMRDS,aligning,");
    let line = client.heard("$PMRDS,ready,");
    let sentence = client.heard("$HETHS,");
    let fields: Vec<&str> = sentence.split([',', '*']).collect();
    let [heading, mode] = fields[1..3] else { panic!("{sentence}") };
    assert_eq!(mode, "A", "{line}\n{sentence}");
    let heading: f64 = heading.parse().expect("a heading");
    assert!(
        distance(heading, scenario.azimuth_deg) < 30.0,
        "{heading}°, with so short an alignment"
    );
}
