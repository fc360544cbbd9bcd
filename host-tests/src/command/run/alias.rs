//! The command line of `run` with its platform named: `stage` where none is, and what `--method` and `--mount` stand for.

use std::ffi::OsString;

/// What a plan of positions is made for where no time is stated: `--method positions`.
const PLANNED: [&str; 2] = ["--seconds", "300"];

/// The arguments, without the program's name, with the platform of a run in its place; without a command it is a run of
/// a stage.
///
/// # Errors
/// A method or a mount that there is not; the words name those that there are.
pub fn expanded(mut arguments: Vec<OsString>) -> Result<Vec<OsString>, String> {
    let is_option = |argument: &OsString| argument.to_string_lossy().starts_with('-');
    let Some(place) = arguments.iter().position(|argument| !is_option(argument)) else {
        let is_plain = arguments.iter().all(|argument| argument == "--json");
        arguments.extend(["run", "stage"].map(OsString::from).into_iter().filter(|_| is_plain));
        return Ok(arguments);
    };
    if arguments[place] != "run" {
        return Ok(arguments);
    }
    let mut after = arguments[place + 1..].iter().filter(|argument| *argument != "--json");
    let first = after.next().map(|argument| argument.to_string_lossy());
    if first.is_some_and(|first| !first.starts_with('-') || first == "--help" || first == "-h") {
        return Ok(arguments);
    }
    let method = taken(&mut arguments, "--method");
    let platform = match method.as_deref() {
        Some("rotating") => "turntable",
        Some("siap") => "vehicle",
        Some("spin") => "spin",
        None | Some("stepwise" | "positions") => mount(&mut arguments)?,
        Some(other) => {
            return Err(format!(
                "--method {other}: not one of stepwise, positions, rotating, siap, spin"
            ));
        }
    };
    let is_timed = |argument: &OsString| {
        let argument = argument.to_string_lossy();
        ["--seconds", "--sigma"].iter().any(|option| argument.starts_with(option))
    };
    if method.as_deref() == Some("positions") && !arguments.iter().any(is_timed) {
        arguments.splice(place + 1..=place, PLANNED.map(OsString::from));
    }
    arguments.insert(place + 1, platform.into());
    Ok(arguments)
}

/// The platform of `--mount`.
fn mount(arguments: &mut Vec<OsString>) -> Result<&'static str, String> {
    match taken(arguments, "--mount").as_deref() {
        None | Some("stage") => Ok("stage"),
        Some("two-frame") => Ok("two-frame"),
        Some(other) => Err(format!("--mount {other}: not one of stage, two-frame")),
    }
}

/// The value of an option, which is taken out of the arguments; an option without one is left to their parser.
fn taken(arguments: &mut Vec<OsString>, option: &str) -> Option<String> {
    let is_it = |argument: &OsString| {
        let text = argument.to_string_lossy();
        text.strip_prefix(option).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
    };
    let at = arguments.iter().position(is_it)?;
    let text = arguments[at].to_string_lossy().into_owned();
    if let Some((_, value)) = text.split_once('=') {
        arguments.remove(at);
        return Some(value.to_owned());
    }
    let value = arguments.get(at + 1)?.to_string_lossy().into_owned();
    arguments.drain(at..=at + 1);
    Some(value)
}
