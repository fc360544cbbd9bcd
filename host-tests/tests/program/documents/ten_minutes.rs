//! The first ten minutes: what the page has a reader type is run, and prints what stands there.

use std::process::Output;

use super::{page, place};
use crate::support::files::Scratch;
use crate::support::program::{code, command, reason, text};

/// The page.
const PAGE: &str = "docs/ten-minutes.md";
/// How a command of the program begins.
const COMMAND: &str = "cargo run --release -- ";

/// A fenced block, with what a comment in the line above calls it.
struct Block<'p> {
    name: &'p str,
    language: &'p str,
    text: String,
}

/// The fenced blocks of a page, in their order.
fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut lines = page.lines();
    let (mut above, mut blocks) = ("", Vec::new());
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let text = lines.by_ref().take_while(|line| *line != "```");
            let text = text.flat_map(|line| [line, "\n"]).collect();
            let name = above.strip_prefix("<!-- ").and_then(|name| name.strip_suffix(" -->"));
            blocks.push(Block { name: name.unwrap_or_default(), language, text });
        }
        above = line;
    }
    blocks
}

/// Runs a line of the page, at the top of the project where it names a file of it, else among the reader's files.
fn run(arguments: &str, files: &Scratch) -> Output {
    let at = if arguments.contains("host-tests/") { place("") } else { files.folder().to_owned() };
    command().args(arguments.split(' ')).current_dir(at).output().expect("it starts")
}

#[test]
fn every_command_of_the_first_ten_minutes_prints_what_the_page_shows() {
    let page = page(PAGE);
    let files = Scratch::new("ten-minutes");
    let (mut last, mut compared) = (None, 0);
    for Block { name, language, text: block } in blocks(&page) {
        if language == "csv" {
            files.with(name, block);
            continue;
        }
        let commands = block.lines().filter_map(|line| line.strip_prefix(COMMAND));
        for arguments in commands {
            last = Some(run(arguments, &files));
        }
        let (expected, output) = match (name, &last) {
            ("printed", Some(output)) => (0, output),
            ("refused", Some(output)) => (1, output),
            (_, Some(output)) if language == "sh" => {
                assert!(matches!(code(output), 0 | 1), "{block}: {}", reason(output));
                continue;
            }
            _ => continue,
        };
        assert_eq!(code(output), expected, "{block}: {}", reason(output));
        let printed = text(&output.stdout);
        assert!(printed.starts_with(&block), "{block} is not what is printed: {printed}");
        compared += 1;
    }
    assert_eq!(compared, 4, "results are compared");
    for page in ["first.html", "mine.html"] {
        assert!(files.read(page).starts_with("<!DOCTYPE"), "{page}");
    }
}
