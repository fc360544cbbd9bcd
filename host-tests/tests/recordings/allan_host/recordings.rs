//! Recordings of kind `static`: one gyro or an inertial measurement unit, with gaps that are kept.

use host::recording::{Body, Gap, ImuSample, Recording, Spacing, StaticRow, read_from};

use crate::support::files::recording;

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

fn spacing(text: &str, rate_hz: Option<f64>) -> Spacing {
    Spacing::of(&rows(text), rate_hz).expect("there are rows enough")
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
    assert_eq!((spacing.gaps.len(), spacing.contradicted_rate_hz), (0, None));
    assert_eq!(spacing.segments().next(), Some(0..6));
    assert_eq!(spacing.segments().count(), 1);
    let one = changed(GYRO, "0.1,2e-5\n0.2,3e-5\n0.3,4e-5\n0.4,5e-5\n0.5,6e-5\n", "");
    assert_eq!(Spacing::of(&rows(&one), None), None);
}

#[test]
fn a_missing_sample_parts_the_record_and_is_reported() {
    let spacing = spacing(&changed(GYRO, "0.3,4e-5\n", ""), None);
    let Gap { row, line, from_s, seconds } = spacing.gaps[0];
    assert_eq!((spacing.gaps.len(), row, line, from_s), (1, 3, 7, 0.2));
    assert!((seconds - 0.2).abs() < 1e-12 && (spacing.period_s - 0.1).abs() < 1e-12);
    assert_eq!(spacing.segments().collect::<Vec<_>>(), [0..3, 3..5]);
}

#[test]
fn times_that_jitter_by_less_than_half_a_period_have_no_gap() {
    let jittering = changed(&changed(GYRO, "0.2,", "0.16,"), "0.4,", "0.44,");
    let spacing = spacing(&jittering, Some(10.0));
    assert_eq!((spacing.gaps.len(), spacing.contradicted_rate_hz), (0, None));
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
    let Body::Static(rows) = &recording.body else { panic!("is {}", recording.body.kind()) };
    let spacing = Spacing::of(rows, recording.header.rate_hz).expect("there are rows");
    assert_eq!((rows.len(), spacing.gaps.len(), spacing.contradicted_rate_hz), (36_000, 0, None));
    assert!((spacing.period_s - 0.1).abs() < 1e-9);
    let table = include_str!("../../../data/README.md");
    let row = table.lines().find(|line| line.contains("static-gyro-1h")).expect("it is listed");
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    assert_eq!((cells[2], cells[3]), ("36000", "10"));
}
