//! `meridian settings save` and `load`: all settings in a file.

use std::fs;
use std::path::Path;

use host::new_file::NewFile;
use host::outcome::keys::Keys;
use host::output::manner::Manner;
use host::report::{Columns, Lines, Report};
use host::settings::load::{self, Loaded};
use host::settings::{Snapshot, file, read, value};
use host::{interrupt, recording, refused};
use serde_json::json;

use super::super::files::{Written, check};
use super::super::{Answer, Failure};
use super::{LoadOptions, SaveOptions, SettingsOptions, in_lines, in_object};

/// Writes all settings to a file.
pub(super) fn save(
    of: &SettingsOptions,
    options: &SaveOptions,
    manner: Manner,
) -> Result<Answer, Failure> {
    let path = &options.file;
    check(None, &[Written::settings(path)]).map_err(Failure::misuse)?;
    if path.is_file() && !options.overwrite {
        let there = format!(
            "{}: it is there already; name another file, or let it be replaced by --overwrite",
            path.display()
        );
        return Err(there.into());
    }
    let place = NewFile::open("the settings", path)?;
    let snapshot = read::all(&mut of.open()?)?;
    let text = file::text(&snapshot);
    place.write(|path| {
        fs::write(path, text).map_err(|error| refused::unwritten("the settings", path, &error))
    })?;
    let count = snapshot.settings.len();
    let object = of
        .keys()
        .with("file", path.display().to_string())
        .with("identity", in_object(&snapshot.identity))
        .with("settings", in_object(&snapshot.settings));
    let report = || {
        let lines = Lines::default()
            .with("file", path.display().to_string())
            .with("settings", count.to_string());
        let parts = [lines.into(), in_lines("", &snapshot.identity).into()];
        Report::new(of.title("Saved settings"), parts)
    };
    Ok(Answer::reported(None, manner, &object, report)?)
}

/// Reads a file of settings.
fn read_file(path: &Path) -> Result<Snapshot, String> {
    let name = path.display().to_string();
    let bytes = fs::read(path).map_err(|error| recording::unread(&name, &error).message())?;
    let text = String::from_utf8(bytes).map_err(|_| format!("{name}: it is no text in UTF-8"))?;
    file::parse(&name, &text)
}

/// Loads the settings of a file.
pub(super) fn load(
    of: &SettingsOptions,
    options: &LoadOptions,
    manner: Manner,
) -> Result<Answer, Failure> {
    let path = &options.file;
    let name = path.display();
    let wanted = read_file(path)?;
    // What was begun is undone first.
    interrupt::heed();
    let mut instrument = of.open()?;
    let there = read::all(&mut instrument)?;
    let plan = load::plan(&wanted, &there, options.other_board);
    let plan = plan.map_err(|why| format!("{name}: {why}"))?;
    let loaded =
        load::load(&mut instrument, plan, &wanted).map_err(|why| format!("{name}: {why}"))?;
    let object = loaded_object(of, path, &loaded);
    let warnings = loaded_warnings(&loaded, &wanted, &there);
    let report = || loaded_report(of, path, &loaded);
    Ok(Answer::reported(None, manner, &object, report)?.with_warnings(warnings))
}

/// What was loaded, as an object.
fn loaded_object(of: &SettingsOptions, path: &Path, loaded: &Loaded) -> Keys {
    let plan = &loaded.plan;
    let changed = plan.changes.iter().map(|[name, before, now]| {
        let [before, now] = [before, now].map(|it| value::object(name, it));
        json!({ "name": name, "before": before, "now": now })
    });
    of.keys()
        .with("file", path.display().to_string())
        .with("changed", changed.collect::<Vec<_>>())
        .with("same", plan.same)
        .with("left_out", &plan.left_out)
        .with("not_in_file", &plan.not_in_file)
        .with("saved", true)
}

/// What there is to be said beside what was loaded.
fn loaded_warnings(loaded: &Loaded, file: &Snapshot, instrument: &Snapshot) -> Vec<String> {
    let plan = &loaded.plan;
    let names = |what: &str, names: &[String]| {
        (!names.is_empty()).then(|| format!("{what}: {}", names.join(", ")))
    };
    let [saved_by, firmware] = [file, instrument].map(|it| it.identity("firmware"));
    let other = saved_by.zip(firmware).filter(|(one, other)| one != other);
    let other = other.map(|(one, other)| {
        format!("the settings were saved by the firmware {one}, and this is {other}")
    });
    let left = names("calibrations of another board, which were left out", &plan.left_out);
    let missing = names("not in the file, and left as they are", &plan.not_in_file);
    loaded.rounded.iter().cloned().chain(other).chain(left).chain(missing).collect()
}

/// What was loaded, as a report.
fn loaded_report(of: &SettingsOptions, path: &Path, loaded: &Loaded) -> Report {
    let plan = &loaded.plan;
    let lines = Lines::default()
        .with("file", path.display().to_string())
        .with("changed", format!("{}, kept in flash and read back", plan.changes.len()))
        .with("the same already", plan.same.to_string())
        .with_found("left out", plan.left_out.iter().cloned());
    let changes = Columns::of("Changed settings", &plan.changes)
        .column("setting", |[name, ..]| name)
        .column("before", |[_, before, _]| before)
        .column("now", |[.., now]| now);
    Report::new(of.title("Loaded settings"), [lines.into(), changes.into()])
}
