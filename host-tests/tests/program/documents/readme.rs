//! The README: short, its table of gyros computed anew, the first lines of its first command verbatim.

use host::planning::{Request, Wanted};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;

use super::command_line::{commands, options, options_of};
use super::{marked, page};
use crate::support::program::{code, meridian, text};

/// The page.
const PAGE: &str = "README.md";
/// Most lines of it.
const MOST_LINES: usize = 120;
/// Latitude of its table of gyros, °.
const LATITUDE_DEG: f64 = 48.0;
/// Time of a rotation there, s.
const ROTATION: f64 = 2.0;
/// Total times of its columns, min.
const MINUTES: [f64; 3] = [1.0, 5.0, 20.0];
/// 1σ beyond which a gyro finds no north, °.
const GREATEST_DEG: f64 = 30.0;
/// How a command of the program begins.
const COMMAND: &str = "cargo run --release -- ";

/// A 1σ as the table has it: two significant digits, or none where it is too great.
fn shown(sigma_deg: f64) -> String {
    if sigma_deg > GREATEST_DEG {
        return "no".to_owned();
    }
    let decimals = (1.0 - sigma_deg.log10().floor()).max(0.0) as usize;
    format!("{sigma_deg:.decimals$}°")
}

/// 1σ of a full azimuth as the planner predicts it, °.
fn planned(noise: GyroNoise, minutes: f64) -> f64 {
    let latitude = Latitude::from_degrees(LATITUDE_DEG).expect("a latitude");
    let wanted = Wanted::Seconds(60.0 * minutes);
    let request = Request { noise, latitude, rotation: ROTATION, wanted };
    request.plan().expect("there is a schedule").optimum.sigma_deg
}

#[test]
fn the_readme_is_short() {
    let lines = page(PAGE).lines().count();
    assert!(lines <= MOST_LINES, "{lines} lines");
}

#[test]
fn every_cell_of_the_table_of_gyros_is_what_the_planner_predicts() {
    let rows = marked(&page(PAGE), "the gyros");
    assert_eq!(rows.len(), 8, "a heading and six gyros");
    for row in &rows[2..] {
        let cells: Vec<_> = row.trim_matches('|').split('|').map(str::trim).collect();
        let number = |cell: &str| cell.parse::<f64>().expect("a number");
        let [n, b, k, r] = [1, 2, 3, 4].map(|index| number(cells[index]));
        let noise = GyroNoise::from_field_units(n, b, k, r);
        let found = MINUTES.map(|minutes| shown(planned(noise, minutes)));
        assert_eq!(cells[5..], found, "{row}");
    }
}

#[test]
fn the_first_lines_of_the_first_command_are_verbatim() {
    let page = page(PAGE);
    let (_, behind) = page.split_once("<!-- the first lines -->\n```text\n").expect("the mark");
    let (block, _) = behind.split_once("```").expect("a block has an end");
    assert!(block.lines().count() >= 10, "{block}");
    let output = meridian(&[]);
    assert_eq!(code(&output), 0);
    let printed = text(&output.stdout);
    assert!(printed.starts_with(block), "{printed}");
}

#[test]
fn the_ratios_that_it_quotes_are_those_of_the_campaign() {
    let (readme, accuracy) = (page(PAGE), page("host-tests/ACCURACY.md"));
    for (gyro, ratio) in [("| N 0.001,", "1.035"), ("| N 0.06,", "1.007")] {
        let row = accuracy.lines().find(|line| line.starts_with(gyro)).expect("the row is there");
        assert!(row.contains(&format!("| {ratio} |")), "{row}");
        assert!(readme.contains(&format!("{ratio} times")), "{ratio}");
    }
}

#[test]
fn every_command_of_the_program_that_it_names_exists_with_its_options() {
    let commands = commands();
    let page = page(PAGE);
    let named: Vec<_> = page.split(COMMAND).skip(1).collect();
    assert!(named.len() >= 4);
    for behind in named {
        let line = behind.split(['\n', '`']).next().unwrap_or_default();
        let words: Vec<_> = line.split(' ').collect();
        let command = commands.iter().find(|command| command.as_str() == words[0]);
        let command = command.unwrap_or_else(|| panic!("no command: {line}"));
        let has = options_of(command, &commands);
        let unknown: Vec<_> = options(line).difference(&has).cloned().collect();
        assert!(unknown.is_empty(), "{command} has no {unknown:?}");
    }
}
