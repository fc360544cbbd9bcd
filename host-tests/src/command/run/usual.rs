//! The platform of a run whose command line names none: a stage.

use std::ffi::OsString;

/// The arguments, without the program's name, with the platform of a run in its place; without a command it is a run.
#[must_use]
pub fn named(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let is_option = |argument: &OsString| argument.to_string_lossy().starts_with('-');
    let Some(place) = arguments.iter().position(|argument| !is_option(argument)) else {
        let is_plain = arguments.iter().all(|argument| argument == "--json");
        arguments.extend(["run", "stage"].map(OsString::from).into_iter().filter(|_| is_plain));
        return arguments;
    };
    let first = arguments[place + 1..].iter().find(|argument| *argument != "--json");
    let names =
        |argument: &OsString| !is_option(argument) || argument == "--help" || argument == "-h";
    if arguments[place] == "run" && !first.is_some_and(names) {
        arguments.insert(place + 1, "stage".into());
    }
    arguments
}
