//! What the pages of recordings show: fits that lie within the error bars of what was measured, by the pages' own data.

use crate::support::files::{recordings, stored};
use crate::support::pages::{assert_well_formed, figure, figures, series};
use crate::support::program::page;

/// Most bytes of a page.
const LARGEST: usize = 500_000;

/// The names of the stored recordings that begin so.
fn named(prefix: &str) -> Vec<String> {
    let files = std::fs::read_dir(recordings()).expect("the folder is there");
    let names = files.filter_map(|file| file.ok()?.file_name().into_string().ok());
    let names = names.filter_map(|name| name.strip_suffix(".csv.gz").map(str::to_owned));
    let mut names: Vec<String> = names.filter(|name| name.starts_with(prefix)).collect();
    names.sort();
    names
}

/// Residuals over their own 1σ, of points x, y, lower and upper limit.
fn normalised(points: &[Vec<f64>]) -> Vec<f64> {
    points.iter().map(|point| point[1] / (0.5 * (point[3] - point[2]))).collect()
}

/// Panics unless numbers could be a normal distribution's of variance one: their mean square lies within five of its
/// standard deviations and what the parameters take of it, and none beyond 5.
#[track_caller]
fn assert_normal(name: &str, all: &[f64], parameters: usize) {
    let count = all.len() as f64;
    let square = all.iter().map(|z| z * z).sum::<f64>() / count;
    let spread = 5.0 * (2.0 / count).sqrt();
    let taken = parameters as f64 / count;
    assert!(square < 1.0 + spread, "{name}: mean square {square} of {count}");
    assert!(
        square > (1.0 - taken - spread).clamp(0.02, 0.5),
        "{name}: mean square {square} of {count}"
    );
    assert!(all.iter().all(|z| z.abs() < 5.0), "{name}: {all:?}");
}

/// Distance of a point from a curve along the vertical axis, at the curve's point that is nearest along the horizontal one.
fn off(curve: &[Vec<f64>], x: f64, y: f64) -> f64 {
    let at = curve.iter().filter(|point| (point[0] - x).abs() < 1e-3);
    at.map(|point| (point[1] - y).abs()).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_fitted_curve_lies_within_the_error_bars_of_the_dwells_on_every_recording_of_a_stage() {
    let names = [named("stepwise"), named("positions")].concat();
    assert!(names.len() >= 10, "{names:?}");
    for name in &names {
        let (_, page) = page(&["replay", &stored(name)]);
        assert_well_formed(&page);
        let fit = figure(&page, "Mean rate of each dwell");
        let (curve, dwells) = (series(&fit, "the whole model"), series(&fit, "dwells"));
        let residuals = series(&figure(&page, "Residuals of the fit"), "measured less");
        assert_eq!(dwells.len(), residuals.len(), "{name}");
        for (dwell, residual) in dwells.iter().zip(&residuals) {
            let sigma = 0.5 * (residual[3] - residual[2]);
            let model = dwell[1] - residual[1];
            // Six digits of the rate are shown.
            let missed = off(&curve, dwell[0], model);
            assert!(missed < 0.1 * sigma, "{name}: the curve passes {missed} beside {dwell:?}");
        }
        assert_normal(name, &normalised(&residuals), 4);
    }
}

/// The cells of the column with this heading in a page's table of this title.
fn column(page: &str, title: &str, heading: &str) -> Vec<String> {
    let (_, behind) = page.split_once(&format!("{title}</")).expect("the table is there");
    let (_, table) = behind.split_once("<table").expect("the table begins");
    let (table, _) = table.split_once("</table>").expect("the table ends");
    let cells = |row: &str, end: &str| -> Vec<String> {
        let parts = row.split(end).filter_map(|part| part.rsplit_once('>'));
        parts.map(|(_, text)| text.to_owned()).collect()
    };
    let mut rows = table.split("</tr>");
    let head = cells(rows.next().expect("a heading"), "</th>");
    let place = head.iter().position(|name| name == heading);
    let place = place.unwrap_or_else(|| panic!("no column {heading} in {head:?}"));
    rows.filter_map(|row| cells(row, "</td>").into_iter().nth(place)).collect()
}

#[test]
fn the_table_of_the_dwells_has_what_the_figure_shows_of_them() {
    for name in ["stepwise-tilted-drift", "stepwise-circle", "positions-four-fog"] {
        let (_, page) = page(&["replay", &stored(name)]);
        let [left, sigmas] =
            ["unexplained, °/h", "1σ, °/h"].map(|heading| column(&page, "Dwells", heading));
        let drawn = series(&figure(&page, "Residuals of the fit"), "measured less");
        let told = left.iter().zip(&sigmas).filter(|(left, _)| *left != "-");
        assert_eq!(told.clone().count(), drawn.len(), "{name}");
        for ((left, sigma), point) in told.zip(&drawn) {
            let [left, sigma] = [left, sigma].map(|cell| cell.parse::<f64>().expect("a number"));
            assert!((left - point[1]).abs() < 1e-5, "{name}: {left}, {point:?}");
            assert!(
                (sigma - 0.5 * (point[3] - point[2])).abs() < 1e-5,
                "{name}: {sigma}, {point:?}"
            );
        }
    }
}

#[test]
fn the_fold_of_a_turning_platform_lies_within_the_error_bars_of_its_sectors() {
    for name in named("rotating") {
        let (_, page) = page(&["replay", &stored(&name)]);
        assert_fold(&name, &page);
    }
}

/// Panics unless every stretch of a page's fold lies within its error bars.
#[track_caller]
fn assert_fold(name: &str, page: &str) {
    let left = figure(page, "What the solution leaves");
    for of in left["series"].as_array().expect("it has series") {
        let stretch = of["name"].as_str().expect("a name");
        let residuals = series(&left, stretch);
        assert_eq!(residuals.len(), 48, "{name}, {stretch}");
        assert_normal(&format!("{name}, {stretch}"), &normalised(&residuals), 4);
    }
}

/// The longest step to the right or left of a figure's first line, as a part of the figure's width.
fn longest_step(page: &str, title: &str) -> f64 {
    let (_, behind) = page.split_once(&format!("<figcaption>{title}")).expect("the figure");
    let (_, line) = behind.split_once("<path class=\"line\" d=\"").expect("a line");
    let (line, _) = line.split_once('"').expect("it ends");
    // Each piece: a place, then the steps from there.
    let steps = line.split('M').filter_map(|piece| piece.split_once('l'));
    let across = steps.flat_map(|(_, steps)| steps.split_whitespace().step_by(2));
    across.map(|step| step.parse::<f64>().expect("a number").abs()).fold(0.0, f64::max) / 1e4
}

#[test]
fn the_way_of_a_stage_is_broken_where_it_goes_round_however_often_it_goes_to_and_fro() {
    for run in [&["stage"][..], &["two-frame"], &["stage", "--seconds", "600"]] {
        let (_, page) = page(&[&["run"], run, &["--seed", "3", "--hold", "0"]].concat());
        let step = longest_step(&page, "Mean rate of each dwell");
        assert!(step < 0.05, "{run:?}: a line over {step} of the figure's width");
    }
}

#[test]
fn the_pages_of_simulated_runs_show_fits_within_error_bars_too() {
    for carrier in ["stage", "two-frame"] {
        let (_, page) = page(&["run", carrier, "--seed", "3", "--hold", "0"]);
        let residuals = series(&figure(&page, "Residuals of the fit"), "measured less");
        assert_normal(carrier, &normalised(&residuals), 4);
    }
    let (_, turntable) = page(&["run", "turntable", "--seed", "3", "--hold", "0"]);
    assert_fold("turntable", &turntable);
    let (_, vehicle) = page(&["run", "vehicle", "--seed", "3", "--hold", "60"]);
    let left = figure(&vehicle, "What the solution leaves of the vertical");
    let all = ["north", "east"].map(|axis| normalised(&series(&left, axis))).concat();
    assert!(all.iter().all(|z| z.abs() < 4.5), "{all:?}");
    let kept = series(&figure(&vehicle, "Azimuth as it was kept"), "kept ±1σ");
    assert!(kept.len() > 50, "a minute, a point a second");
}

#[test]
fn what_the_solution_leaves_of_a_vehicles_stops_lies_within_their_error_bars() {
    for name in named("drive") {
        let (_, page) = page(&["replay", &stored(&name)]);
        let left = figure(&page, "What the solution leaves of the vertical");
        let all = ["north", "east"].map(|axis| normalised(&series(&left, axis))).concat();
        assert!(all.len() >= 4 && all.iter().all(|z| z.abs() < 4.5), "{name}: {all:?}");
        let way = figure(&page, "Where the vehicle went");
        let (path, stops) = (series(&way, "way"), series(&way, "stops"));
        for stop in &stops {
            let metres = |point: &Vec<f64>| (point[0] - stop[0]).hypot(point[1] - stop[1]);
            let nearest = path.iter().map(metres).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1.0, "{name}: the way passes {nearest} m beside {stop:?}");
        }
    }
}

#[test]
fn the_azimuth_comes_to_stand_at_the_result_with_its_sigma_over_the_limit() {
    let names = ["stepwise-circle", "rotating-gyro", "drive-fog-three-stops", "parked-swaying"];
    for name in names {
        let (output, page) = page(&["replay", &stored(name)]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let line =
            text.lines().find(|line| line.contains("azimuth of body x")).expect("it is there");
        let found: f64 = line
            .split_whitespace()
            .find_map(|word| word.strip_suffix('°')?.parse().ok())
            .expect("a number of degrees");
        let sigmas = figure(&page, "σ and its limit");
        let azimuths = figures(&page)
            .into_iter()
            .find(|figure| {
                figure["title"].as_str().is_some_and(|it| it.contains("as it converged"))
            })
            .expect("it is drawn");
        let last = series(&azimuths, "what is known").last().cloned().expect("a point");
        assert!((last[1] - found).abs() < 0.01, "{name}: {last:?} is not {found}");
        let (sigma, limit) = (series(&sigmas, "σ"), series(&sigmas, "limit"));
        assert_eq!(sigma.len(), limit.len(), "{name}");
        for (sigma, limit) in sigma.iter().zip(&limit) {
            assert!(sigma[1] > 0.98 * limit[1], "{name}: σ {sigma:?} below the limit {limit:?}");
        }
        assert!(sigma[0][1] > sigma[sigma.len() - 1][1], "{name}: σ falls");
    }
}

#[test]
fn no_page_of_a_recording_is_too_large_to_be_sent_around() {
    for name in named("") {
        let command: &[&str] = match name.split('-').next() {
            Some("static") => &["allan"],
            Some("imu") => &["replay", "--method", "vertical"],
            _ => &["replay"],
        };
        let (_, page) = page(&[command, &[stored(&name).as_str()]].concat());
        assert!(page.len() < LARGEST, "{name}: {} bytes", page.len());
        assert_well_formed(&page);
    }
}
