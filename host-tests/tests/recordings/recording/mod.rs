//! Reading of recordings: what is read, what is refused and with which words, and that no bytes
//! whatever make the reader panic, hang or fill the memory.

mod hostile;
mod imu;
mod malformed;
mod malformed_rows;
mod rotating;
mod spin;
mod stored;

use std::io::Write;

use flate2::{Compression, write::GzEncoder};
use host::recording::{Body, Header, Recording, Sensor, StageRow, read_from};
use proptest::prelude::*;

/// A `stage` recording; its column names stand in line 4, its rows in lines 5 to 8.
const STAGE: &str = "\
# kind: stage
# latitude_deg: 52.0
# rate_hz: 50
t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2
0.00,0.0,1.5e-5,0.125,-0.25,-9.81
0.02,0.0,2.5e-5,0.126,-0.26,-9.82
0.04,0.5,3.5e-5,0.127,-0.27,-9.83
0.06,0.5,4.5e-5,0.128,-0.28,-9.84
";

/// A `dwells` recording; its column names stand in line 2.
const DWELLS: &str = "\
# kind: dwells
stage_rad,rate_rad_s,sigma_rad_s,seconds,mid_s,fx_m_s2,fy_m_s2,fz_m_s2
0.0,1e-5,1e-8,60,30,0.1,0.2,-9.8
3.0,-1e-5,2e-8,50,100,0.3,0.4,-9.7
";

/// A `rotating` recording; its column names stand in line 4, its rows in lines 5 to 7.
const ROTATING: &str = "\
# kind: rotating
# rate_hz: 50
# sensor: met
t_s,stage_rad,stage_rate_rad_s,g_rad_s,a_m_s2
0.00,125.6,0.86,-1.25e-2,0.125
0.02,125.7,0.87,-1.26e-2,0.126
0.04,125.8,0.88,-1.27e-2,0.127
";

/// Reads bytes under the name that the messages show.
fn parse(bytes: impl AsRef<[u8]>) -> Result<Recording, String> {
    read_from("walk.csv", bytes.as_ref()).map_err(|error| error.to_string())
}

/// A recording that must be read.
fn read(bytes: impl AsRef<[u8]>) -> Recording {
    parse(bytes).unwrap_or_else(|message| panic!("{message}"))
}

/// The message for a recording that must be refused.
fn message(bytes: impl AsRef<[u8]>) -> String {
    parse(bytes).err().unwrap_or_else(|| panic!("was read"))
}

/// A text with one thing changed, which must be there.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is not in the text");
    text.replacen(from, to, 1)
}

/// The rows of a `stage` recording.
fn stage_rows(recording: Recording) -> Vec<StageRow> {
    match recording.body {
        Body::Stage(rows) => rows,
        other => panic!("is {}", other.kind()),
    }
}

/// Compresses as `gzip` does.
fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
}

#[test]
fn a_stage_recording_gives_its_rows_with_their_lines() {
    let rows = stage_rows(read(STAGE));
    assert_eq!(rows.len(), 4);
    let third = StageRow {
        line: 7,
        time_s: 0.04,
        stage_rad: 0.5,
        rate_rad_s: 3.5e-5,
        force_m_s2: [0.127, -0.27, -9.83],
        temperature_c: None,
        force_is_new: true,
        elevation_rad: None,
        base: None,
    };
    assert_eq!(rows[2], third);
}

#[test]
fn a_dwells_recording_gives_its_rows_with_what_is_optional() {
    let Body::Dwells(rows) = read(DWELLS).body else { panic!("is stage") };
    assert_eq!((rows.len(), rows[1].stage_rad, rows[1].rate_rad_s), (2, 3.0, -1e-5));
    assert_eq!((rows[1].sigma_rad_s, rows[1].seconds, rows[1].mid_s), (2e-8, 50.0, Some(100.0)));
    assert_eq!(rows[1].force_m_s2, Some([0.3, 0.4, -9.7]));
    let bare = "# kind: dwells\nseconds,stage_rad,rate_rad_s,sigma_rad_s\n60,0,1e-5,1e-8\n";
    let Body::Dwells(rows) = read(bare).body else { panic!("is stage") };
    assert_eq!((rows[0].seconds, rows[0].mid_s, rows[0].force_m_s2), (60.0, None, None));
}

#[test]
fn every_header_key_reaches_its_field() {
    let keys = "# kind: stage\n# gyro_N_deg_sqrt_h: 1\n# gyro_B_deg_h: 2\n\
        # gyro_K_deg_h_sqrt_h: 3\n# gyro_R_deg_h2: 4\n# gyro_bias_deg_h: 5\n\
        # gyro_scale_sigma: 0.6\n# accelerometer_bias_m_s2: 7\n\
        # g_sensitivity_deg_h_g: 8.5, -9\n# g_sensitivity_sigma_deg_h_g: 10\n\
        # encoder_zero_sigma_deg: 11\n# sensor: met";
    let header = Header {
        latitude_deg: Some(52.0),
        rate_hz: Some(50.0),
        gyro_n_deg_sqrt_h: Some(1.0),
        gyro_b_deg_h: Some(2.0),
        gyro_k_deg_h_sqrt_h: Some(3.0),
        gyro_r_deg_h2: Some(4.0),
        gyro_bias_deg_h: Some(5.0),
        gyro_scale_sigma: Some(0.6),
        accelerometer_bias_m_s2: Some(7.0),
        g_sensitivity_deg_h_g: Some([8.5, -9.0]),
        g_sensitivity_sigma_deg_h_g: Some(10.0),
        encoder_zero_sigma_deg: Some(11.0),
        sensor: Some(Sensor::Met),
        // Those of a vehicle: no stage has them.
        stops_s: None,
        displacements_m: None,
        session: None,
    };
    assert_eq!(read(changed(STAGE, "# kind: stage", keys)).header, header);
    assert_eq!(read("# kind: dwells\n".to_owned() + &DWELLS[15..]).header, Header::default());
}

#[test]
fn truth_is_parted_from_what_a_solver_gets() {
    let keys = "# kind: stage\n# truth_azimuth_deg: 17.5\n# truth_disturbed_s: 47-51";
    let (header, body, truth) = read(changed(STAGE, "# kind: stage", keys)).into_parts();
    assert_eq!(truth.azimuth_deg, Some(17.5));
    assert_eq!(truth.others, [("truth_disturbed_s".to_owned(), "47-51".to_owned())]);
    assert!(!format!("{header:?}{body:?}").contains("17.5"));
    let unknown = changed(STAGE, "# kind: stage", "# kind: stage\n# truth_azimuth_deg: nan");
    assert_eq!(read(unknown).truth.azimuth_deg, None);
}

#[test]
fn truth_columns_may_hold_nan_and_change_nothing() {
    let mut text = String::new();
    for line in STAGE.lines() {
        let more = match line {
            _ if line.starts_with('#') => "",
            _ if line.starts_with('t') => ",truth_roll_rad,remark",
            _ => ",nan,left as it is",
        };
        text += &format!("{line}{more}\n");
    }
    assert_eq!(read(text), read(STAGE));
}

#[test]
fn forms_of_writing_that_mean_the_same_read_the_same() {
    let recording = read(STAGE);
    assert_eq!(read(STAGE.replace('\n', "\r\n")), recording);
    assert_eq!(read(STAGE.replace(',', " ,\t")), recording);
    assert_eq!(read(STAGE.replace("# ", "#").replace(": ", " : ")), recording);
    assert_eq!(read(format!("\u{feff}{STAGE}")), recording);
    assert_eq!(read(STAGE.trim_end()), recording);
    assert_eq!(read(format!("{STAGE} \n\r\n\n")), recording);
    assert_eq!(read(format!("{STAGE}# a remark\n# note: and another\n")), recording);
    assert_eq!(read(format!("# remark\n# note: 1\n# note: 2\n{STAGE}")).header, recording.header);
    assert_eq!(read(format!("# latitude_deg: 52.0\n{STAGE}")).header, recording.header);
    assert_eq!(read(gzip(STAGE.as_bytes())), recording);
}

#[test]
fn a_blank_line_counts_in_the_numbers_of_lines() {
    let rows = stage_rows(read(changed(STAGE, "0.04", "\n0.04")));
    assert_eq!([rows[1].line, rows[2].line], [6, 8]);
}

#[test]
fn numbers_at_the_ends_of_their_ranges_are_read() {
    let ends = changed(STAGE, "1.5e-5,0.125", "-2.147483647,2147.483647");
    let row = stage_rows(read(ends))[0];
    assert_eq!((row.rate_rad_s, row.force_m_s2[0]), (-2.147_483_647, 2_147.483_647));
    assert_eq!(read(changed(STAGE, "52.0", "-90")).header.latitude_deg, Some(-90.0));
}

#[test]
fn a_latitude_is_read_as_the_command_line_takes_it() {
    for text in ["47.585", "47°35.1′", "47°35′06″", "47d35m6s", "47:35:06", "47:35:06N", "+47.585"]
    {
        let latitude = read(changed(STAGE, "52.0", text)).header.latitude_deg;
        assert!(
            latitude.is_some_and(|found| (found - 47.585).abs() < 1e-12),
            "{text}: {latitude:?}"
        );
    }
    assert_eq!(read(changed(STAGE, "52.0", "33°30′S")).header.latitude_deg, Some(-33.5));
}

#[test]
fn a_true_azimuth_is_read_as_the_command_line_takes_it() {
    for text in ["213.5", "213°30′", "213:30:00"] {
        let truth = read(format!("# truth_azimuth_deg: {text}\n{STAGE}")).truth;
        assert_eq!(truth.azimuth_deg, Some(213.5), "{text}");
    }
}

#[test]
fn without_a_rate_in_the_header_the_times_say_it() {
    let text = changed(STAGE, "# rate_hz: 50\n", "");
    assert_eq!(stage_rows(read(&text)).len(), 4);
    let one_row = &STAGE[..STAGE.find("0.02").unwrap_or(0)];
    assert_eq!(stage_rows(read(one_row)).len(), 1);
}

#[test]
fn two_missing_samples_are_no_gap_yet() {
    assert_eq!(stage_rows(read(changed(STAGE, "0.06", "0.10"))).len(), 4);
}

#[test]
fn times_written_with_few_digits_do_not_contradict_the_rate() {
    let head = STAGE[..STAGE.find("0.00").unwrap_or(0)].replace("50", "3000");
    let rows = (0..300).map(|i| format!("{:.4},0,0,0,0,-9.8\n", f64::from(i) / 3000.0));
    assert_eq!(stage_rows(read(head + &rows.collect::<String>())).len(), 300);
}

/// Writes a `stage` recording; numbers as short as they read back exactly.
fn written(rows: &[StageRow]) -> String {
    let mut text =
        "# kind: stage\nt_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2,temperature_c\n".to_owned();
    for row in rows {
        let [x, y, z] = row.force_m_s2;
        let temperature = row.temperature_c.unwrap_or_default();
        let (time, stage, rate) = (row.time_s, row.stage_rad, row.rate_rad_s);
        text += &format!("{time},{stage},{rate:e},{x},{y},{z},{temperature}\n");
    }
    text
}

proptest! {
    #[test]
    fn what_is_written_is_read_back_to_the_last_bit(
        start in -1e6..1e6_f64,
        rows in prop::collection::vec(
            (-10.0..10.0_f64, -2.0..2.0_f64, prop::array::uniform3(-90.0..90.0_f64), -40.0..90.0_f64),
            1..50,
        ),
    ) {
        let rows: Vec<StageRow> = rows.into_iter().enumerate().map(|(index, row)| StageRow {
            line: index as u64 + 3,
            time_s: start + index as f64 * 0.01,
            stage_rad: row.0,
            rate_rad_s: row.1,
            force_m_s2: row.2,
            temperature_c: Some(row.3),
            force_is_new: true,
            elevation_rad: None,
            base: None,
        }).collect();
        prop_assert_eq!(stage_rows(read(written(&rows))), rows);
    }
}
