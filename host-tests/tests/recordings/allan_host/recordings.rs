//! Recordings of kind `static`: one gyro or an inertial measurement unit, with gaps that are kept.

use std::io::Read;

use host::allan::rest::{LEARNT, Rest, RestError};
use host::recording::{
    Body, Gap, ImuSample, MOST_GAPS, Recording, RestRows, Spacing, StaticRow, Unsteady, read_from,
};

use crate::support::files::{recording, unpacked};

/// A gyro at 10 Hz; its column names stand in line 3, its rows in lines 4 to 9.
const GYRO: &str = "\
# kind: static
# rate_hz: 10
t_s,g_rad_s
0.0,1e-5
0.1,2e-5
0.2,3e-5
0.3,4e-5
0.4,5e-5
0.5,6e-5
";

/// An inertial measurement unit at 100 Hz.
const IMU: &str = "\
# kind: static
t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2
0.00,1e-5,2e-5,3e-5,0.1,0.2,-9.8
0.01,2e-5,3e-5,4e-5,0.1,0.2,-9.8
";

fn parse(text: &str) -> Result<Recording, String> {
    read_from("rest.csv", text.as_bytes()).map_err(|error| error.to_string())
}

fn rows(text: &str) -> Vec<StaticRow> {
    match parse(text).unwrap_or_else(|message| panic!("{message}")).body {
        Body::Static(rows) => rows,
        other => panic!("is {}", other.kind()),
    }
}

fn message(text: &str) -> String {
    parse(text).err().unwrap_or_else(|| panic!("was read"))
}

fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is not in the text");
    text.replacen(from, to, 1)
}

/// What the command reads of a text.
fn rest(text: &str) -> Result<Rest, RestError> {
    let opened = RestRows::open("rest.csv", text.as_bytes(), None).map_err(RestError::Read)?;
    Rest::read(opened, &mut Vec::new())
}

/// The spacing of rows below a header with this rate.
fn spacing(text: &str, rate_hz: Option<f64>) -> Spacing {
    let key = rate_hz.map_or_else(String::new, |rate| format!("# rate_hz: {rate}\n"));
    let rest = rest(&changed(text, "# rate_hz: 10\n", &key));
    rest.unwrap_or_else(|error| panic!("{error}")).spacing
}

#[test]
fn a_gyro_at_rest_gives_its_rates() {
    let rows = rows(GYRO);
    assert_eq!(rows.len(), 6);
    let third = StaticRow { line: 6, time_s: 0.2, rate_rad_s: Some(3e-5), imu: None };
    assert_eq!(rows[2], third);
}

#[test]
fn an_inertial_measurement_unit_at_rest_gives_rates_and_forces() {
    let imu = ImuSample { rates_rad_s: [2e-5, 3e-5, 4e-5], force_m_s2: [0.1, 0.2, -9.8] };
    let second = StaticRow { line: 4, time_s: 0.01, rate_rad_s: None, imu: Some(imu) };
    assert_eq!(rows(IMU)[1], second);
    let both = changed(IMU, "t_s,", "t_s,g_rad_s,").replace("0,1e-5", "0,7e-6,1e-5");
    let both = both.replace("1,2e-5", "1,8e-6,2e-5");
    assert_eq!(rows(&both)[1], StaticRow { rate_rad_s: Some(8e-6), ..second });
}

#[test]
fn a_missing_column_is_named() {
    let place = "rest.csv: line 3, column g_rad_s: ";
    let text = changed(GYRO, "g_rad_s", "rate");
    assert_eq!(message(&text), format!("{place}is missing; the kind needs t_s,g_rad_s"));
    assert_eq!(
        message(&changed(IMU, "ay_m_s2", "ay")),
        "rest.csv: line 2, column ay_m_s2: is missing; the kind needs \
         t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2"
    );
}

#[test]
fn what_is_no_rate_and_time_that_runs_backwards_are_named_with_line_and_column() {
    for (from, to, text) in [
        ("3e-5", "nan", "column g_rad_s: \"nan\" is allowed only in truth_ columns"),
        ("3e-5", "inf", "column g_rad_s: \"inf\" is not a finite number"),
        ("3e-5", "3e-5x", "column g_rad_s: \"3e-5x\" is not a number"),
        (
            "3e-5",
            "3",
            "column g_rad_s: \"3\" is outside the range of ±2.147483647 rad/s; check the unit",
        ),
        ("0.2,", "0.05,", "column t_s: 0.05 s does not come after 0.1 s of line 5"),
        ("0.2,", "nan,", "column t_s: \"nan\" is allowed only in truth_ columns"),
    ] {
        assert_eq!(message(&changed(GYRO, from, to)), format!("rest.csv: line 6, {text}"));
    }
}

#[test]
fn a_whole_record_is_one_segment_at_the_rate_of_its_times() {
    let spacing = spacing(GYRO, Some(10.0));
    assert!((spacing.period_s - 0.1).abs() < 1e-12);
    assert_eq!((spacing.gap_count, spacing.contradicted_rate_hz), (0, None));
    let one = changed(GYRO, "0.1,2e-5\n0.2,3e-5\n0.3,4e-5\n0.4,5e-5\n0.5,6e-5\n", "");
    assert_eq!(rest(&one).err(), Some(RestError::OneRow));
}

#[test]
fn a_missing_sample_parts_the_record_and_is_reported() {
    let spacing = spacing(&changed(GYRO, "0.3,4e-5\n", ""), None);
    let Gap { row, line, from_s, seconds } = spacing.gaps[0];
    assert_eq!((spacing.gap_count, row, line, from_s), (1, 3, 6, 0.2));
    assert!((spacing.missing_s - 0.1).abs() < 1e-12);
    assert!((seconds - 0.2).abs() < 1e-12 && (spacing.period_s - 0.1).abs() < 1e-12);
}

#[test]
fn times_that_jitter_by_less_than_half_a_period_have_no_gap() {
    let jittering = changed(&changed(GYRO, "0.2,", "0.16,"), "0.4,", "0.44,");
    let spacing = spacing(&jittering, Some(10.0));
    assert_eq!((spacing.gap_count, spacing.contradicted_rate_hz), (0, None));
    assert!((spacing.period_s - 0.1).abs() < 1e-12);
}

#[test]
fn a_rate_that_misses_by_more_than_one_per_cent_is_reported_and_the_times_are_believed() {
    for (rate, contradicted) in
        [(10.09, None), (9.91, None), (10.2, Some(10.2)), (100.0, Some(100.0))]
    {
        let spacing = spacing(GYRO, Some(rate));
        assert_eq!(spacing.contradicted_rate_hz, contradicted, "{rate}");
        assert!((spacing.period_s - 0.1).abs() < 1e-12);
    }
}

#[test]
fn the_stored_hour_is_complete() {
    let recording = recording("static-gyro-1h");
    assert_eq!(recording.header.gyro_n_deg_sqrt_h, None);
    let truth =
        [("truth_N_deg_sqrt_h", "0.02"), ("truth_B_deg_h", "0.3"), ("truth_K_deg_h_sqrt_h", "2.0")];
    let truth = truth.map(|(key, value)| (key.to_owned(), value.to_owned()));
    assert_eq!(recording.truth.others, truth);
    let rest = rest(&unpacked("static-gyro-1h")).expect("it is a record at rest");
    let spacing = &rest.spacing;
    assert_eq!((rest.samples, spacing.gap_count, spacing.contradicted_rate_hz), (36_000, 0, None));
    assert!((spacing.period_s - 0.1).abs() < 1e-9);
    let table = include_str!("../../../data/README.md");
    let row = table.lines().find(|line| line.contains("static-gyro-1h")).expect("it is listed");
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    assert_eq!((cells[2], cells[3]), ("36000", "10"));
}

/// A recording whose rows come one by one: each a time, s, or another text.
struct Rows<I> {
    rows: I,
    text: Vec<u8>,
}

impl<I: Iterator<Item = String>> Read for Rows<I> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        while self.text.len() < buffer.len() {
            let Some(row) = self.rows.next() else { break };
            self.text.extend_from_slice(row.as_bytes());
        }
        let length = buffer.len().min(self.text.len());
        buffer[..length].copy_from_slice(&self.text[..length]);
        self.text.drain(..length);
        Ok(length)
    }
}

/// What rows at these times come to; the first stands in line 3.
fn at_times(times: impl Iterator<Item = String>) -> Result<Rest, RestError> {
    let rates = (0_u32..).map(|index| f64::from(index.wrapping_mul(2_654_435_761) >> 12) * 1e-12);
    let rows = times.zip(rates).map(|(time, rate)| format!("{time},{rate:.12}\n"));
    let text = b"# kind: static\nt_s,g_rad_s\n".to_vec();
    let opened = RestRows::open("rest.csv", Rows { rows, text }, None).map_err(RestError::Read)?;
    Rest::read(opened, &mut Vec::new())
}

#[test]
fn a_gap_and_a_wrong_field_behind_the_first_million_rows_are_found_as_in_them() {
    let samples = LEARNT + 1000;
    let time = |index: usize| {
        format!("{:.2}", (index + usize::from(index >= LEARNT + 500)) as f64 / 100.0)
    };
    let rest = at_times((0..samples).map(time)).expect("it is a record at rest");
    assert_eq!(rest.samples, samples as u64);
    let [gap] = rest.spacing.gaps[..] else { panic!("{:?}", rest.spacing) };
    assert_eq!((gap.row, gap.line), (LEARNT as u64 + 500, LEARNT as u64 + 503));
    assert_eq!(rest.points[0].terms, samples as u64 - 2);
    let wrong =
        (0..samples).map(|index| if index == LEARNT + 7 { "x".to_owned() } else { time(index) });
    let words = format!("rest.csv: line {}, column t_s: \"x\" is not a number", LEARNT + 10);
    assert_eq!(at_times(wrong).expect_err("it is none").to_string(), words);
}

#[test]
fn a_record_whose_later_part_has_another_rate_is_refused() {
    let slow = (0..LEARNT).map(|index| format!("{:.1}", index as f64 / 10.0));
    let quick = (0..2 * LEARNT).map(|index| format!("{:.2}", (10 * LEARNT + index) as f64 / 100.0));
    let refusal = at_times(slow.chain(quick)).expect_err("it has two rates");
    let RestError::Unsteady(Unsteady(first, all)) = refusal else { panic!("{refusal}") };
    assert!((first - 0.1).abs() < 1e-6 && (all - 0.01).abs() < 1e-4, "{first}, {all}");
    assert!(refusal.to_string().ends_with("split the recording where its rate changes"));
}

#[test]
fn more_gaps_than_are_kept_are_counted_all() {
    let times = (0..4 * MOST_GAPS).map(|index| format!("{}", index + index / 3));
    let rest = at_times(times).expect("it is a record at rest");
    let gaps = (4 * MOST_GAPS - 1) / 3;
    assert_eq!((rest.spacing.gaps.len(), rest.spacing.gap_count), (MOST_GAPS, gaps as u64));
    assert_eq!(rest.spacing.missing_s, gaps as f64);
}
