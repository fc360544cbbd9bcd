//! `meridian completions` and `meridian man`: what a shell and a manual are to know about the program.

use clap::{Args, Command};
use clap_complete::{Shell, generate};
use clap_mangen::Man;
use host::output::manner::Manner;
use serde_json::json;

use super::{Answer, Failure};

/// Which shell.
#[derive(Args)]
pub struct CompletionsOptions {
    /// The shell that is to complete commands, options and their values.
    shell: Shell,
}

/// Which command.
#[derive(Args)]
pub struct ManOptions {
    /// The command whose page is wanted, as `run vehicle`; the page of the program where there is none.
    #[arg(value_name = "COMMAND")]
    command: Vec<String>,
}

/// Prints what a shell needs to complete the program's command lines.
pub fn completions(
    options: &CompletionsOptions,
    mut program: Command,
    manner: Manner,
) -> Result<Answer, Failure> {
    let (mut script, name) = (Vec::new(), program.get_name().to_owned());
    generate(options.shell, &mut program, name, &mut script);
    text(&script, manner)
}

/// Prints the page of a command for `man`.
pub fn man(options: &ManOptions, mut program: Command, manner: Manner) -> Result<Answer, Failure> {
    program.build();
    let mut command = &program;
    for name in &options.command {
        let found = command.find_subcommand(name);
        let parent = command.get_name();
        let wrong = || Failure::misuse(format!("COMMAND: {parent} has no command {name}"));
        command = found.ok_or_else(wrong)?;
    }
    let mut page = Vec::new();
    // Without a command, or without a platform, there is a usual one.
    let rendered = Man::new(command.clone().subcommand_required(false)).render(&mut page);
    rendered.map_err(|error| error.to_string())?;
    let page = String::from_utf8_lossy(&page).replace(UNNAMED, EXAMPLES);
    text(page.as_bytes(), manner)
}

/// What the page has above the examples, which it takes for any text.
const UNNAMED: &str = ".SH EXTRA\nExamples:\n";
/// What stands there instead: a heading, and that lines are to be left as they are.
const EXAMPLES: &str = ".SH EXAMPLES\n";

/// A text, as it is or in an object.
fn text(bytes: &[u8], manner: Manner) -> Result<Answer, Failure> {
    let text = String::from_utf8_lossy(bytes).into_owned();
    let object = json!({ "status": "ok", "text": text });
    Ok(Answer::of(None, manner, &object, || text.trim_end().to_owned())?)
}
