//! An `imu` recording is read as strictly as the others, and so are the stops of its header.

use host::recording::{Body, ImuRow, ImuSample, Problem, Recording, displacements, read_from};
use proptest::prelude::*;

use super::{changed, message, parse, read};

/// An `imu` recording; its column names stand in line 6, its rows in lines 7 to 11.
const IMU: &str = "\
# kind: imu
# rate_hz: 50
# stops_s: 0-0.04;0.06-0.10
# displacements_north_east_m: 0.0,0.0;-867.9,3298.0
# gyro_bias_deg_h: 1.5
t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2
0.02,1e-5,2e-5,3e-5,0.1,0.2,-9.8
0.04,1e-5,2e-5,4e-5,0.1,0.2,-9.8
0.06,1e-5,-12.5,5e-5,0.1,0.3,-9.8
0.08,1e-5,2e-5,6e-5,0.1,0.2,-9.7
0.10,1e-5,2e-5,7e-5,0.1,0.2,-9.8
";

/// The message when one thing of the recording is changed.
fn refused(from: &str, to: &str) -> String {
    message(changed(IMU, from, to))
}

/// The message when the stops are others.
fn of_stops(stops: &str) -> String {
    refused("0-0.04;0.06-0.10", stops)
}

/// The message when the displacements are others.
fn of_displacements(displacements: &str) -> String {
    refused("0.0,0.0;-867.9,3298.0", displacements)
}

fn rows(recording: Recording) -> Vec<ImuRow> {
    match recording.body {
        Body::Imu(rows) => rows,
        other => panic!("is {}", other.kind()),
    }
}

#[test]
fn its_rows_come_with_their_lines_and_rates_beyond_those_of_a_stage() {
    let recording = read(IMU);
    assert_eq!(recording.header.gyro_bias_deg_h, Some(1.5));
    let rows = rows(recording);
    let sample = ImuSample { rates_rad_s: [1e-5, -12.5, 5e-5], force_m_s2: [0.1, 0.3, -9.8] };
    assert_eq!(
        (rows.len(), rows[2]),
        (5, ImuRow { line: 9, time_s: 0.06, sample, force_is_new: true })
    );
}

#[test]
fn stops_and_displacements_reach_the_header() {
    let header = read(IMU).header;
    assert_eq!(header.stops_s, Some(vec![[0.0, 0.04], [0.06, 0.1]]));
    assert_eq!(header.displacements_m, Some(vec![[0.0, 0.0], [-867.9, 3298.0]]));
    let bare = changed(IMU, "# stops_s: 0-0.04;0.06-0.10\n", "");
    assert_eq!(read(&bare).header.stops_s, None);
    // Displacements alone wait for the stops that are found.
    assert_eq!(read(&bare).header.displacements_m.map(|list| list.len()), Some(2));
}

#[test]
fn a_minus_of_a_number_does_not_part_a_stop() {
    let times = ["0.02", "0.04", "0.06", "0.08", "0.10"];
    let text = times.iter().enumerate().fold(IMU.to_owned(), |text, (index, time)| {
        let earlier = format!("\n{:.2},", -1.0 + 0.02 * index as f64);
        changed(&text, &format!("\n{time},"), &earlier)
    });
    let text = changed(&text, "0-0.04;0.06-0.10", " -1--0.98 ; -9.4e-1 - -92e-2 ");
    assert_eq!(read(text).header.stops_s, Some(vec![[-1.0, -0.98], [-0.94, -0.92]]));
}

#[test]
fn every_column_is_needed_in_whatever_order() {
    let all = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2";
    for name in all.split(',') {
        let names = changed(all, name, &name.replace('_', "-"));
        let expected = format!("walk.csv: line 6, column {name}: is missing; the kind needs {all}");
        assert_eq!(message(changed(IMU, all, &names)), expected);
    }
    let turned = "# kind: imu\naz_m_s2,t_s,gz_rad_s,truth_qw,gx_rad_s,ay_m_s2,gy_rad_s,ax_m_s2\n\
        1,2,3,nan,4,5,6,7\n";
    let row = rows(read(turned))[0];
    assert_eq!(row.sample, ImuSample { rates_rad_s: [4.0, 6.0, 3.0], force_m_s2: [7.0, 5.0, 1.0] });
    assert_eq!(row.time_s, 2.0);
}

#[test]
fn a_number_that_is_none_or_out_of_range_is_refused_with_its_place() {
    assert_eq!(
        refused("-12.5", "fast"),
        "walk.csv: line 9, column gy_rad_s: \"fast\" is not a number"
    );
    assert_eq!(
        refused("-12.5", "nan"),
        "walk.csv: line 9, column gy_rad_s: \"nan\" is allowed only in truth_ columns"
    );
    assert_eq!(
        refused("-12.5", "-100.5"),
        "walk.csv: line 9, column gy_rad_s: \"-100.5\" is outside the range of ±100 rad/s; check the \
         unit"
    );
}

#[test]
fn times_that_run_back_jump_or_contradict_the_rate_are_refused() {
    assert_eq!(
        refused("\n0.08", "\n0.05"),
        "walk.csv: line 10, column t_s: 0.05 s does not come after 0.06 s of line 9"
    );
    assert_eq!(
        refused("\n0.10", "\n0.15"),
        "walk.csv: line 11, column t_s: 0.07 s after line 10 is a gap longer than three sample \
         periods of 0.02 s; split the recording here"
    );
    assert_eq!(
        refused("hz: 50", "hz: 80"),
        "walk.csv: line 2, key rate_hz: 80 Hz contradicts the times, which have 50 Hz; correct it"
    );
}

#[test]
fn stops_that_are_none_are_refused_with_line_and_key() {
    for (stops, shown) in [
        ("", "\"\""),
        ("0-0.04;", "\"\""),
        ("0-0.04;walk", "\"walk\""),
        ("0-0.04;0.06", "\"0.06\""),
        ("0-0.04,0.06-0.1", "\"0-0.04,0.06-0.1\""),
        ("0..0.04", "\"0..0.04\""),
        ("0-", "\"0-\""),
    ] {
        let expected = format!(
            "walk.csv: line 3, key stops_s: {shown} is not a stop; write from-to;from-to in seconds"
        );
        assert_eq!(of_stops(stops), expected, "{stops}");
    }
    assert_eq!(
        of_stops("0-nan"),
        "walk.csv: line 3, key stops_s: \"nan\" is allowed only in truth_ columns"
    );
    assert!(of_stops("0-inf").contains("is not a finite number"));
    assert!(of_stops("0-1e11").contains("is outside the range of ±10000000000 s"));
}

#[test]
fn stops_out_of_order_are_refused_with_line_and_key() {
    assert_eq!(
        of_stops("0.04-0;0.06-0.1"),
        "walk.csv: line 3, key stops_s: the stop 0.04-0 does not end after it begins; correct it"
    );
    assert_eq!(
        of_stops("0-0.04;0.06-0.06"),
        "walk.csv: line 3, key stops_s: the stop 0.06-0.06 does not end after it begins; correct it"
    );
    let expected = "walk.csv: line 3, key stops_s: the stop 0.03-0.1 begins before 0-0.04 ends; name \
        the stops one after the other";
    assert_eq!(of_stops("0-0.04;0.03-0.1"), expected);
    assert!(of_stops("0.06-0.1;0-0.04").contains("the stop 0-0.04 begins before 0.06-0.1 ends"));
    // One that follows another at once is none the less another.
    assert!(parse(changed(IMU, "0-0.04;0.06-0.10", "0-0.04;0.04-0.1")).is_ok());
}

#[test]
fn a_stop_outside_of_the_recording_is_refused_with_line_and_key() {
    for (stops, shown) in [("0-0.04;0.06-0.13", "0.06-0.13"), ("-0.05-0.04;0.06-0.1", "-0.05-0.04")]
    {
        let expected = format!(
            "walk.csv: line 3, key stops_s: the stop {shown} lies outside of the recording, which \
             goes from 0.02 s to 0.1 s; correct it"
        );
        assert_eq!(of_stops(stops), expected);
    }
}

#[test]
fn displacements_that_are_none_or_too_many_are_refused_with_line_and_key() {
    for (displacements, shown) in
        [("", "\"\""), ("0,0;12", "\"12\""), ("0,0;north", "\"north\""), ("0-0;1-1", "\"0-0\"")]
    {
        let expected = format!(
            "walk.csv: line 4, key displacements_north_east_m: {shown} is not a displacement; write \
             north,east;north,east in metres"
        );
        assert_eq!(of_displacements(displacements), expected, "{displacements}");
    }
    assert_eq!(
        of_displacements("0,0;1,x"),
        "walk.csv: line 4, key displacements_north_east_m: \"x\" is not a number"
    );
    assert!(of_displacements("0,0;1,2e6").contains("is outside the range of ±1000000 m"));
    assert_eq!(
        of_displacements("0,0;1,2;3,4"),
        "walk.csv: line 4, key displacements_north_east_m: 3 for 2 stops; give one for each stop"
    );
    assert!(of_displacements("0,0").contains("1 for 2 stops"));
    assert_eq!(
        of_displacements("1,0;2,3"),
        "walk.csv: line 4, key displacements_north_east_m: the first stop lies 1,0 m from itself; \
         displacements count from the first stop, which is at 0,0"
    );
}

#[test]
fn stops_below_the_column_names_or_given_twice_are_refused() {
    let late = format!("{IMU}# stops_s: 0-0.04\n");
    let expected =
        "walk.csv: line 12, key stops_s: stands below the column names; move it above them";
    assert_eq!(message(late), expected);
    let twice = changed(IMU, "# rate_hz: 50", "# rate_hz: 50\n# stops_s: 0-0.04");
    assert_eq!(
        message(twice),
        "walk.csv: line 4, key stops_s: \"0-0.04;0.06-0.10\" contradicts \"0-0.04\" of line 3; keep \
         one of them"
    );
}

#[test]
fn more_stops_than_a_session_takes_are_refused() {
    let many: Vec<String> = (0..1001).map(|i| format!("{i}-{i}.5")).collect();
    assert!(of_stops(&many.join(";")).contains("more than 1000 of them"));
}

#[test]
fn both_truths_are_parted_from_what_a_solver_gets() {
    let keys = "# kind: imu\n# truth_azimuth_deg: 212.25\n# truth_start_azimuth_deg: 72.125";
    let (header, body, truth) = read(changed(IMU, "# kind: imu", keys)).into_parts();
    assert_eq!((truth.azimuth_deg, truth.start_azimuth_deg), (Some(212.25), Some(72.125)));
    let given = format!("{header:?}{body:?}");
    assert!(!given.contains("212.25") && !given.contains("72.125"));
}

/// With a true attitude in three rows, of which one is not known and one does not count.
const TRUE: &str = "\
# kind: imu
t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2,truth_qw,truth_qx,truth_qy,truth_qz,moving
0.02,0,0,0,0,0,-9.8,0.8,0.6,0,0,1
0.04,0,0,0,0,0,-9.8,nan,nan,nan,nan,1
0.06,0,0,0,0,0,-9.8,0.96,0,0,0.28,0
";

#[test]
fn the_true_attitude_is_parted_too_and_only_where_it_counts() {
    let (header, body, truth) = read(TRUE).into_parts();
    assert_eq!(truth.attitude, [Some([0.8, 0.6, 0.0, 0.0]), None, None]);
    assert!(!format!("{header:?}{body:?}").contains("0.6,"));
    let all = read(TRUE.replace(",moving", ",still")).truth.attitude;
    assert_eq!(all[2], Some([0.96, 0.0, 0.0, 0.28]));
    assert!(read(TRUE.replace("truth_qz", "truth_z")).truth.attitude.is_empty());
    // A quaternion without a length is no attitude.
    assert_eq!(read(changed(TRUE, "0.8,0.6", "0,0")).truth.attitude[0], None);
    assert_eq!(
        message(changed(TRUE, "0.8,0.6", "1.8,0.6")),
        "walk.csv: line 3, column truth_qw: \"1.8\" is outside the range of ±1.001; check the unit"
    );
}

#[test]
fn a_stop_problem_can_be_distinguished_from_others() {
    let text = changed(IMU, "0-0.04;0.06-0.10", "0.04-0");
    let error = read_from("walk.csv", text.as_bytes()).expect_err("it ends before it begins");
    assert_eq!(error.problem, Problem::Backwards(0.04, 0.0));
}

proptest! {
    #[test]
    fn whatever_the_header_says_of_stops_it_is_read_or_refused_in_one_line(
        stops in "[-0-9.;,e ]{0,24}", displaced in "[-0-9.;,e ]{0,24}",
    ) {
        let text = changed(IMU, "0-0.04;0.06-0.10", &stops);
        let text = changed(&text, "0.0,0.0;-867.9,3298.0", &displaced);
        if let Err(message) = parse(text) {
            prop_assert!(message.starts_with("walk.csv: line ") && !message.contains('\n'));
        }
    }

    #[test]
    fn displacements_are_read_back_to_the_last_bit(
        rest in prop::collection::vec(prop::array::uniform2(-1e6..1e6_f64), 0..9),
    ) {
        let all: Vec<[f64; 2]> = [[0.0; 2]].into_iter().chain(rest).collect();
        let text: Vec<String> = all.iter().map(|[n, e]| format!("{n},{e}")).collect();
        prop_assert_eq!(displacements(&text.join(";")).ok(), Some(all));
    }

    #[test]
    fn stops_are_read_back_to_the_last_bit(
        lengths in prop::collection::vec((1e-3..1e3_f64, 0.0..1e3_f64), 1..9), start in -1e3..1e3_f64,
    ) {
        let mut at = start;
        let stops: Vec<[f64; 2]> = lengths.iter().map(|(length, pause)| {
            let stop = [at, at + length];
            at = stop[1] + pause;
            stop
        }).collect();
        let text: Vec<String> = stops.iter().map(|[from, to]| format!("{from}-{to}")).collect();
        let head = format!("# kind: imu\n# stops_s: {}\n", text.join(";"));
        let names = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
        let row = format!("{start},0,0,0,0,0,-9.8\n");
        prop_assert_eq!(read(head + names + &row).header.stops_s, Some(stops));
    }
}
