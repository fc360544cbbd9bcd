//! Where a vehicle stood, as the header of an `imu` recording says: stops, and how far each lay from the
//! first.

use super::error::Fault;
use super::header::{Collector, DISPLACEMENTS, Header, STOPS};
use super::number::{number, pair};
use super::problem::Problem;
use super::range::Range;
use super::rows::{ImuRow, TIME};

/// Displacements of vehicles, m: no drive between two alignments goes further.
const DISPLACEMENT: Range = Range::symmetric(1e6, " m");
/// Most stops and displacements that are read.
const MOST: usize = 1000;

/// Takes stops and displacements from the header of a kind that has them.
pub(super) fn read(entries: &Collector, header: &mut Header) -> Result<(), Fault> {
    header.stops_s = entries.parse(STOPS, stops)?;
    header.displacements_m = entries.parse(DISPLACEMENTS, displacements)?;
    check_count(entries, header)
}

/// Stops `from-to;from-to;…`, s: each ends after it begins, and begins no earlier than the one before ends.
fn stops(text: &str) -> Result<Vec<[f64; 2]>, Problem> {
    let stops = list(text, stop)?;
    if let Some([from, to]) = stops.iter().find(|[from, to]| to <= from) {
        return Err(Problem::Backwards(*from, *to));
    }
    match stops.windows(2).find(|pair| pair[1][0] < pair[0][1]) {
        Some(pair) => Err(Problem::Overlap(pair[0], pair[1])),
        None => Ok(stops),
    }
}

/// Displacements `north,east;north,east;…` of the stops from the first, m.
///
/// # Errors
/// What is wrong with the text, in words.
pub fn displacements(text: &str) -> Result<Vec<[f64; 2]>, Problem> {
    let list = list(text, displacement)?;
    match list.first() {
        Some(first) if *first != [0.0; 2] => Err(Problem::NotFromFirst(*first)),
        _ => Ok(list),
    }
}

/// What stands between semicolons.
fn list(text: &str, item: fn(&str) -> Result<[f64; 2], Problem>) -> Result<Vec<[f64; 2]>, Problem> {
    if text.split(';').nth(MOST).is_some() {
        return Err(Problem::TooMany(MOST as u64, "of them"));
    }
    text.split(';').map(|text| item(text.trim_ascii())).collect()
}

/// `from-to`. A minus may also belong to a number: the first one with a number on either side parts them.
fn stop(text: &str) -> Result<[f64; 2], Problem> {
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    let mut parted = text
        .match_indices('-')
        .map(|(at, _)| (text[..at].trim_ascii(), text[at + 1..].trim_ascii()));
    let (from, to) = parted
        .find(|(from, to)| is_number(from) && is_number(to))
        .ok_or_else(|| Problem::NotAStop(text.to_owned()))?;
    Ok([number(from, &TIME)?, number(to, &TIME)?])
}

/// `north,east`.
fn displacement(text: &str) -> Result<[f64; 2], Problem> {
    pair(text, &DISPLACEMENT, Problem::NotADisplacement)
}

/// Refuses displacements that are not one for each stop.
fn check_count(entries: &Collector, header: &Header) -> Result<(), Fault> {
    let (Some(stops), Some(displacements)) = (&header.stops_s, &header.displacements_m) else {
        return Ok(());
    };
    if stops.len() == displacements.len() {
        return Ok(());
    }
    let problem = Problem::StopCount { displacements: displacements.len(), stops: stops.len() };
    Err(Fault::key(entries.line(DISPLACEMENTS), DISPLACEMENTS, problem))
}

/// Refuses a stop of which these rows hold less than the whole. The first row's sample began a period
/// before its time, and stops are stated to no more than a period.
pub(super) fn check_inside(
    entries: &Collector,
    header: &Header,
    rows: &[ImuRow],
) -> Result<(), Fault> {
    let (Some(stops), [first, .., last]) = (&header.stops_s, rows) else { return Ok(()) };
    let period = (last.time_s - first.time_s) / (rows.len() - 1) as f64;
    let (begin, end) = (first.time_s - 2.0 * period, last.time_s + period);
    let outside = stops.iter().find(|[from, to]| *from < begin || *to > end);
    outside.map_or(Ok(()), |stop| {
        let problem = Problem::StopOutside { stop: *stop, recording: [first.time_s, last.time_s] };
        Err(Fault::key(entries.line(STOPS), STOPS, problem))
    })
}
