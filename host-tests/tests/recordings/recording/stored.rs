//! The stored recordings are complete, and `data/README.md` says what they are.

use host::recording::{Body, Header, Sensor};

use crate::support::files::recording;

use super::stage_rows;

/// What is asserted of a stored recording.
struct Expected {
    name: &'static str,
    /// As `wc -l` counts, and how many of them are header lines.
    lines: usize,
    header_lines: usize,
    azimuth_deg: f64,
    header: Header,
}

/// A header with what every stored recording has.
fn header(latitude_deg: f64, rate_hz: f64, n: f64) -> Header {
    Header {
        latitude_deg: Some(latitude_deg),
        rate_hz: Some(rate_hz),
        gyro_n_deg_sqrt_h: Some(n),
        ..Header::default()
    }
}

fn paper(name: &'static str, azimuth_deg: f64) -> Expected {
    let accelerometer_bias_m_s2 = Some(2e-5);
    let header = Header { accelerometer_bias_m_s2, ..header(47.583_333, 100.0, 0.000_25) };
    Expected { name, lines: 6007, header_lines: 6, azimuth_deg, header }
}

fn disturbed(name: &'static str, azimuth_deg: f64) -> Expected {
    Expected { name, lines: 6557, header_lines: 6, azimuth_deg, header: header(52.0, 50.0, 0.005) }
}

fn circle() -> Expected {
    let accelerometer_bias_m_s2 = Some(0.05);
    let header = Header { accelerometer_bias_m_s2, ..header(47.583_333, 100.0, 0.000_25) };
    Expected {
        name: "stepwise-circle",
        lines: 8957,
        header_lines: 6,
        azimuth_deg: 211.4137,
        header,
    }
}

fn mems() -> Expected {
    let header = Header {
        gyro_b_deg_h: Some(0.75),
        gyro_scale_sigma: Some(0.03),
        g_sensitivity_deg_h_g: Some([15.0, 8.0]),
        g_sensitivity_sigma_deg_h_g: Some(1.0),
        accelerometer_bias_m_s2: Some(0.2),
        ..header(52.0, 50.0, 0.036)
    };
    Expected {
        name: "stepwise-mems",
        lines: 19761,
        header_lines: 10,
        azimuth_deg: 163.2929,
        header,
    }
}

fn tilted_drift() -> Expected {
    let header = Header {
        gyro_k_deg_h_sqrt_h: Some(0.2),
        gyro_r_deg_h2: Some(2.0),
        g_sensitivity_deg_h_g: Some([9.0, -5.0]),
        g_sensitivity_sigma_deg_h_g: Some(0.05),
        accelerometer_bias_m_s2: Some(0.05),
        ..header(55.75, 50.0, 0.004)
    };
    let name = "stepwise-tilted-drift";
    Expected { name, lines: 13161, header_lines: 10, azimuth_deg: 137.2513, header }
}

fn unknown_g() -> Expected {
    let header = Header {
        g_sensitivity_deg_h_g: Some([0.0, 0.0]),
        g_sensitivity_sigma_deg_h_g: Some(20.0),
        ..header(55.75, 50.0, 0.004)
    };
    let name = "stepwise-unknown-g";
    Expected { name, lines: 13158, header_lines: 7, azimuth_deg: 41.8871, header }
}

fn four_positions() -> Expected {
    let header = Header {
        gyro_b_deg_h: Some(0.007),
        gyro_r_deg_h2: Some(0.127),
        accelerometer_bias_m_s2: Some(0.05),
        ..header(52.0, 50.0, 0.001)
    };
    let name = "positions-four-fog";
    Expected { name, lines: 12709, header_lines: 8, azimuth_deg: 301.0249, header }
}

/// All that are stored.
fn all() -> [Expected; 10] {
    [
        paper("stepwise-paper-1", 28.167_617),
        paper("stepwise-paper-2", 28.500_717),
        paper("stepwise-paper-3", 28.834_517),
        circle(),
        tilted_drift(),
        unknown_g(),
        mems(),
        disturbed("stepwise-bumped", 17.0333),
        disturbed("stepwise-nudged", 254.6111),
        four_positions(),
    ]
}

#[test]
fn each_stored_recording_has_its_rows_header_and_truth() {
    for expected in all() {
        let recording = recording(expected.name);
        assert_eq!(recording.header, expected.header, "{}", expected.name);
        assert_eq!(recording.truth.azimuth_deg, Some(expected.azimuth_deg), "{}", expected.name);
        let rows = stage_rows(recording);
        assert_eq!(rows.len(), expected.lines - expected.header_lines - 1, "{}", expected.name);
        assert_eq!(rows.last().map(|row| row.line), Some(expected.lines as u64));
        let has_temperature = expected.name == "stepwise-mems";
        assert!(rows.iter().all(|row| row.temperature_c.is_some() == has_temperature));
    }
}

/// The two whose stage turns all the time.
fn rotating() -> [Expected; 2] {
    let one_speed = Header {
        sensor: Some(Sensor::Gyro),
        g_sensitivity_deg_h_g: Some([8.0, -5.0]),
        ..header(55.75, 50.0, 0.002)
    };
    let two_speeds = Header { sensor: Some(Sensor::Met), ..header(55.75, 50.0, 0.002) };
    [
        Expected {
            name: "rotating-gyro",
            lines: 13148,
            header_lines: 7,
            azimuth_deg: 37.3123,
            header: one_speed,
        },
        Expected {
            name: "rotating-met-two-speeds",
            lines: 18007,
            header_lines: 6,
            azimuth_deg: 252.6391,
            header: two_speeds,
        },
    ]
}

#[test]
fn each_rotating_recording_has_its_rows_header_and_truth() {
    for expected in rotating() {
        let recording = recording(expected.name);
        assert_eq!(recording.header, expected.header, "{}", expected.name);
        assert_eq!(recording.truth.azimuth_deg, Some(expected.azimuth_deg), "{}", expected.name);
        let Body::Rotating(rows) = recording.body else { panic!("is {}", recording.body.kind()) };
        assert_eq!(rows.len(), expected.lines - expected.header_lines - 1, "{}", expected.name);
        assert_eq!(rows.last().map(|row| row.line), Some(expected.lines as u64));
    }
}

/// The vehicles: three that drove, and one that stood and swayed.
fn vehicles() -> [Expected; 4] {
    let drive = |name, n, bias, azimuth_deg, stops: &[[f64; 2]], displaced: &[[f64; 2]]| Expected {
        name,
        lines: 25_508 + [n, bias].iter().filter(|key: &&Option<f64>| key.is_some()).count(),
        header_lines: 7 + [n, bias].iter().filter(|key: &&Option<f64>| key.is_some()).count(),
        azimuth_deg,
        header: Header {
            gyro_n_deg_sqrt_h: n,
            gyro_bias_deg_h: bias,
            stops_s: Some(stops.to_vec()),
            displacements_m: Some(displaced.to_vec()),
            ..header(52.0, 25.0, 0.0)
        },
    };
    let ends = [[0.0, 60.0], [960.0, 1020.0]];
    let middle = [ends[0], [480.0, 540.0], ends[1]];
    let [ideal, fog] = [[-2134.0, 2737.8], [-867.9, 3298.0]].map(|last| [[0.0; 2], last]);
    let three = [[0.0; 2], [-470.4, 2239.7], [4.3, 2703.7]];
    let parked = Header { gyro_bias_deg_h: Some(0.02), ..header(52.0, 25.0, 0.01) };
    [
        drive("drive-ideal", None, None, 212.5621, &ends, &ideal),
        drive("drive-fog-1dph", Some(0.05), Some(1.0), 212.5621, &ends, &fog),
        drive("drive-fog-three-stops", Some(0.03), Some(1.0), 12.5621, &middle, &three),
        Expected {
            name: "parked-swaying",
            lines: 16_513,
            header_lines: 7,
            azimuth_deg: 72.5621,
            header: parked,
        },
    ]
}

#[test]
fn each_recording_of_a_vehicle_has_its_rows_header_and_truth() {
    for expected in vehicles() {
        let recording = recording(expected.name);
        assert_eq!(recording.header, expected.header, "{}", expected.name);
        assert_eq!(recording.truth.azimuth_deg, Some(expected.azimuth_deg), "{}", expected.name);
        assert_eq!(recording.truth.start_azimuth_deg, Some(72.5621), "{}", expected.name);
        let Body::Imu(rows) = recording.body else { panic!("is {}", recording.body.kind()) };
        assert_eq!(rows.len(), expected.lines - expected.header_lines - 1, "{}", expected.name);
        assert_eq!(rows.last().map(|row| row.line), Some(expected.lines as u64));
    }
}

#[test]
fn each_recording_of_a_spinning_body_has_its_rows_and_the_true_roll_of_each() {
    for (name, first, last) in
        [("spin-100rps", 0.4, 630.980_24), ("spin-80rps-noisy", 0.0, 510.660_7)]
    {
        let recording = recording(name);
        assert_eq!(recording.header, Header { rate_hz: Some(10_000.0), ..Header::default() });
        assert_eq!(recording.truth.others, [("truth_scale_error".to_owned(), "0.001".to_owned())]);
        let rolls = &recording.truth.roll_rad;
        assert_eq!((rolls.len(), rolls[0], rolls[9_999]), (10_000, first, last), "{name}");
        let Body::Spin(rows) = recording.body else { panic!("it is a spinning body") };
        assert_eq!(rows.len(), 10_000);
        let text = include_str!("../../../data/README.md");
        let table = || text.lines().filter(|line| line.starts_with('|'));
        let row = table().find(|line| line.contains(name));
        let row = row.unwrap_or_else(|| panic!("{name} is not in the table"));
        assert!(row.contains("| 10000 | 10000 | - |"), "{row}");
    }
}

/// Those of BROAD, which know neither latitude nor noise.
fn broad() -> [Expected; 6] {
    [
        ("imu-broad-01", 31_434),
        ("imu-broad-06", 20_006),
        ("imu-broad-08", 31_434),
        ("imu-broad-11", 28_577),
        ("imu-broad-21", 28_577),
        ("imu-broad-24", 20_006),
    ]
    .map(|(name, lines)| Expected {
        name,
        lines,
        header_lines: 5,
        azimuth_deg: f64::NAN,
        header: Header { rate_hz: Some(285.714_286), ..Header::default() },
    })
}

#[test]
fn the_recordings_of_broad_know_the_attitude_where_errors_count() {
    for (expected, known) in broad().into_iter().zip([21_708, 9230, 16_655, 19_201, 18_074, 7198]) {
        let recording = recording(expected.name);
        assert_eq!(recording.header, expected.header, "{}", expected.name);
        let attitude = &recording.truth.attitude;
        assert_eq!(attitude.iter().flatten().count(), known, "{}", expected.name);
        let Body::Imu(rows) = recording.body else { panic!("is {}", recording.body.kind()) };
        assert_eq!(rows.len(), expected.lines - expected.header_lines - 1, "{}", expected.name);
        assert_eq!(attitude.len(), rows.len());
    }
}

#[test]
fn the_disturbances_are_known_to_the_truth_only() {
    for (name, span) in [("stepwise-bumped", "47-51"), ("stepwise-nudged", "79-83")] {
        let expected = [("truth_disturbed_s".to_owned(), span.to_owned())];
        assert_eq!(recording(name).truth.others, expected);
    }
}

#[test]
fn the_table_of_the_data_agrees_with_the_files() {
    let text = include_str!("../../../data/README.md");
    let table = || text.lines().filter(|line| line.starts_with('|'));
    for Expected { name, lines, header_lines, header, .. } in
        all().into_iter().chain(rotating()).chain(vehicles()).chain(broad())
    {
        let row = table().find(|line| line.contains(name)).or_else(|| {
            let series = name.rsplit_once('-').map_or(name, |(series, _)| series);
            table().find(|line| line.contains(series))
        });
        let row = row.unwrap_or_else(|| panic!("{name} is not in the table"));
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let rows = lines - header_lines - 1;
        assert_eq!(cells[2].trim_end_matches(" each"), rows.to_string(), "{name}");
        assert_eq!(cells[3].parse().ok(), header.rate_hz, "{name}");
        assert_eq!(cells[4].parse().ok(), header.latitude_deg, "{name}");
    }
}
