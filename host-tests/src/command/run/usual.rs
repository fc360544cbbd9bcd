//! The platform of a run whose command line names none: a stage.

use std::ffi::OsString;

use clap::{Arg, Command};
use host::methods;
use simulated::fault::Platform;

/// The options that every command takes: they may stand before it, and name no platform.
const GLOBAL: [&str; 5] = ["--json", "-v", "--verbose", "-q", "--quiet"];

fn is_global(argument: &OsString) -> bool {
    GLOBAL.iter().any(|global| argument == global)
}

/// The platform of a run that names none.
pub const USUAL: Platform = Platform::Stage;

/// The program, of which a run shows the options that it takes without a platform. It is given none of them:
/// [`named`] puts the platform before them.
#[must_use]
pub fn optional(program: Command) -> Command {
    program.mut_subcommand("run", |run| {
        let usual = run.find_subcommand(USUAL.name());
        let options: Vec<Arg> =
            usual.into_iter().flat_map(Command::get_arguments).cloned().collect();
        run.args(options)
    })
}

/// The arguments, without the program's name, with the platform of a run in its place; without a command it is a run.
#[must_use]
pub fn named(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let is_option = |argument: &OsString| argument.to_string_lossy().starts_with('-');
    let Some(place) = arguments.iter().position(|argument| !is_option(argument)) else {
        let is_plain = arguments.iter().all(is_global);
        arguments
            .extend(["run", USUAL.name()].map(OsString::from).into_iter().filter(|_| is_plain));
        return arguments;
    };
    if arguments[place] == "run" {
        name_method(&mut arguments, place + 1);
    }
    let first = arguments[place + 1..].iter().find(|argument| !is_global(argument));
    let names =
        |argument: &OsString| !is_option(argument) || argument == "--help" || argument == "-h";
    if arguments[place] == "run" && !first.is_some_and(names) {
        arguments.insert(place + 1, USUAL.name().into());
    }
    arguments
}

/// Puts the platform of a method into its place before the other arguments of a run, for `--method NAME`: so platforms
/// were chosen before they had names of their own.
fn name_method(arguments: &mut Vec<OsString>, place: usize) {
    let texts: Vec<_> = arguments.iter().map(|text| text.to_string_lossy().into_owned()).collect();
    let found =
        texts.iter().enumerate().find_map(|(at, text)| match text.strip_prefix("--method")? {
            "" => Some((at..at + 2, texts.get(at + 1)?.as_str())),
            name => Some((at..at + 1, name.strip_prefix('=')?)),
        });
    if let Some((there, name)) = found
        && let Some(platform) = methods::named(name).and_then(|method| method.platform)
    {
        arguments.drain(there);
        arguments.insert(place, platform.name().into());
    }
}
