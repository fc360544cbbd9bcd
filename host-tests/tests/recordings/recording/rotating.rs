//! A `rotating` recording is read as strictly as the others.

use host::recording::{Body, RotatingRow, Sensor};

use super::{ROTATING, changed, message, read};

/// The message when one thing of the recording is changed.
fn refused(from: &str, to: &str) -> String {
    message(changed(ROTATING, from, to))
}

fn rows(text: impl AsRef<[u8]>) -> Vec<RotatingRow> {
    match read(text).body {
        Body::Rotating(rows) => rows,
        other => panic!("is {}", other.kind()),
    }
}

#[test]
fn its_rows_come_with_their_lines_and_the_sensor_by_name() {
    let second = RotatingRow {
        line: 6,
        time_s: 0.02,
        stage_rad: 125.7,
        stage_rate_rad_s: 0.87,
        rate_rad_s: -1.26e-2,
        force_m_s2: 0.126,
        across_m_s2: None,
        force_is_new: true,
    };
    let read_rows = rows(ROTATING);
    assert_eq!((read_rows.len(), read_rows[1]), (3, second));
    assert_eq!(read(ROTATING).header.sensor, Some(Sensor::Met));
    assert_eq!(rows(changed(ROTATING, "0.87", "1000"))[1].stage_rate_rad_s, 1000.0);
}

#[test]
fn every_column_is_needed_in_whatever_order() {
    let all = "t_s,stage_rad,stage_rate_rad_s,g_rad_s,a_m_s2";
    for name in all.split(',') {
        let names = changed(all, name, &name.replace('_', "-"));
        let expected = format!("walk.csv: line 4, column {name}: is missing; the kind needs {all}");
        assert_eq!(message(changed(ROTATING, all, &names)), expected);
    }
    let turned =
        "# kind: rotating\na_m_s2,g_rad_s,t_s,note,stage_rate_rad_s,stage_rad\n1,2,3,x,4,5\n";
    let row = rows(turned)[0];
    assert_eq!((row.force_m_s2, row.rate_rad_s, row.time_s), (1.0, 2.0, 3.0));
    assert_eq!((row.stage_rate_rad_s, row.stage_rad), (4.0, 5.0));
}

#[test]
fn a_number_that_is_none_or_out_of_range_is_refused_with_its_place() {
    assert_eq!(
        refused("-1.26e-2", "abc"),
        "walk.csv: line 6, column g_rad_s: \"abc\" is not a number"
    );
    assert_eq!(
        refused("0.126", "nan"),
        "walk.csv: line 6, column a_m_s2: \"nan\" is allowed only in truth_ columns"
    );
    assert_eq!(
        refused("0.87", "1001"),
        "walk.csv: line 6, column stage_rate_rad_s: \"1001\" is outside the range of ±1000 rad/s; \
         check the unit"
    );
    assert_eq!(
        refused("125.7", "7e6"),
        "walk.csv: line 6, column stage_rad: \"7e6\" is outside the range of ±6283185 rad; check \
         the unit"
    );
}

#[test]
fn times_that_run_back_jump_or_contradict_the_rate_are_refused() {
    assert_eq!(
        refused("0.04", "0.01"),
        "walk.csv: line 7, column t_s: 0.01 s does not come after 0.02 s of line 6"
    );
    assert_eq!(
        refused("0.04", "0.10"),
        "walk.csv: line 7, column t_s: 0.08 s after line 6 is a gap longer than three sample \
         periods of 0.02 s; split the recording here"
    );
    assert_eq!(
        refused("hz: 50", "hz: 100"),
        "walk.csv: line 2, key rate_hz: 100 Hz contradicts the times, which have 50 Hz; correct it"
    );
}

#[test]
fn an_unknown_sensor_is_refused() {
    assert!(
        refused("met", "sextant").contains("line 3, key sensor"),
        "{}",
        refused("met", "sextant")
    );
}
