//! A `spin` recording is read as strictly as the others; its true roll goes to the truth alone.

use host::recording::{Body, Recording, SpinRow};

use super::{changed, message, read};

/// A `spin` recording; its column names stand in line 4, its rows in lines 5 to 7.
const SPIN: &str = "\
# kind: spin
# rate_hz: 10000
# truth_scale_error: 0.001
t_s,gx_rad_s,ay_m_s2,az_m_s2,truth_roll_rad
0.0000,631.27,-7926.5,-3988.8,0.4
0.0001,631.28,-7927.3,-3990.5,nan
0.0002,631.29,-7928.2,-3992.2,0.526
";

/// The message when one thing of the recording is changed.
fn refused(from: &str, to: &str) -> String {
    message(changed(SPIN, from, to))
}

fn rows(recording: Recording) -> Vec<SpinRow> {
    match recording.body {
        Body::Spin(rows) => rows,
        other => panic!("is {}", other.kind()),
    }
}

#[test]
fn its_rows_come_with_their_lines_and_rates_of_a_hundred_turns_a_second() {
    let second = SpinRow {
        line: 6,
        time_s: 0.0001,
        rate_rad_s: 631.28,
        force_m_s2: [-7927.3, -3990.5],
        across_rad_s: None,
    };
    let recording = read(SPIN);
    assert_eq!(recording.header.rate_hz, Some(10_000.0));
    let rows = rows(recording);
    assert_eq!((rows.len(), rows[1]), (3, second));
}

#[test]
fn its_true_roll_is_parted_from_what_a_solver_gets() {
    let (header, body, truth) = read(SPIN).into_parts();
    let rolls = &truth.roll_rad;
    assert_eq!((rolls.len(), rolls[0], rolls[2]), (3, 0.4, 0.526));
    assert!(rolls[1].is_nan());
    assert_eq!(truth.others, [("truth_scale_error".to_owned(), "0.001".to_owned())]);
    assert!(!format!("{header:?}{body:?}").contains("0.526"));
    let bare = SPIN.replace(",truth_roll_rad", "").replace(",0.4\n", "\n").replace(",nan\n", "\n");
    let bare = read(bare.replace(",0.526\n", "\n"));
    assert!(bare.truth.roll_rad.is_empty());
    assert_eq!(bare.body, body);
}

#[test]
fn a_true_roll_that_is_no_angle_is_refused() {
    assert_eq!(
        refused("nan", "fast"),
        "walk.csv: line 6, column truth_roll_rad: \"fast\" is not a number"
    );
    assert_eq!(
        refused("nan", "1e9"),
        "walk.csv: line 6, column truth_roll_rad: \"1e9\" is outside the range of ±6283185 rad; check \
         the unit"
    );
}

#[test]
fn every_column_but_the_truth_is_needed_in_whatever_order() {
    let all = "t_s,gx_rad_s,ay_m_s2,az_m_s2";
    for name in all.split(',') {
        let names = changed(all, name, &name.replace('_', "-"));
        let expected = format!("walk.csv: line 4, column {name}: is missing; the kind needs {all}");
        assert_eq!(message(changed(SPIN, all, &names)), expected);
    }
    let turned = "# kind: spin\naz_m_s2,truth_roll_rad,gx_rad_s,colour,t_s,ay_m_s2\n1,2,3,x,4,5\n";
    let row = SpinRow {
        line: 3,
        time_s: 4.0,
        rate_rad_s: 3.0,
        force_m_s2: [5.0, 1.0],
        across_rad_s: None,
    };
    assert_eq!(rows(read(turned)), [row]);
}

#[test]
fn a_number_that_is_none_or_out_of_range_is_refused_with_its_place() {
    assert_eq!(
        refused("631.28", "fast"),
        "walk.csv: line 6, column gx_rad_s: \"fast\" is not a number"
    );
    assert_eq!(
        refused("-7927.3", "nan"),
        "walk.csv: line 6, column ay_m_s2: \"nan\" is allowed only in truth_ columns"
    );
    assert_eq!(
        refused("631.28", "36000"),
        "walk.csv: line 6, column gx_rad_s: \"36000\" is outside the range of ±10000 rad/s; check the \
         unit"
    );
    assert_eq!(
        refused("-3990.5", "-21474.9"),
        "walk.csv: line 6, column az_m_s2: \"-21474.9\" is outside the range of ±21474.83647 m/s²; \
         check the unit"
    );
}

#[test]
fn times_that_run_back_jump_or_contradict_the_rate_are_refused() {
    assert_eq!(
        refused("\n0.0002", "\n0.0001"),
        "walk.csv: line 7, column t_s: 0.0001 s does not come after 0.0001 s of line 6"
    );
    assert_eq!(
        refused("\n0.0002", "\n0.0005"),
        "walk.csv: line 7, column t_s: 0.0004 s after line 6 is a gap longer than three sample \
         periods of 0.0001 s; split the recording here"
    );
    assert_eq!(
        refused("hz: 10000", "hz: 5000"),
        "walk.csv: line 2, key rate_hz: 5000 Hz contradicts the times, which have 10000 Hz; correct it"
    );
}

/// A `spin` recording of so many samples at a rate, Hz, whose times have so many digits.
fn recorded(rate_hz: f64, digits: usize, count: u32) -> String {
    let rows = (0..count).map(|index| {
        let time_s = f64::from(index) / rate_hz;
        format!("{time_s:.digits$},600,-7900,-3900\n")
    });
    let head = "# kind: spin\n# rate_hz: 10000\nt_s,gx_rad_s,ay_m_s2,az_m_s2\n";
    head.to_owned() + &rows.collect::<String>()
}

#[test]
fn a_rate_more_than_one_per_cent_from_that_of_the_times_is_refused_with_both_figures() {
    for (rate_hz, found) in [(9_850.0, "9850"), (10_150.0, "10150"), (9_880.0, "9880")] {
        let why = message(recorded(rate_hz, 9, 500));
        let both = format!("10000 Hz contradicts the times, which have {found} Hz; correct it");
        assert_eq!(why, format!("walk.csv: line 2, key rate_hz: {both}"));
    }
    for rate_hz in [9_920.0, 10_000.0, 10_080.0] {
        assert_eq!(rows(read(recorded(rate_hz, 9, 500))).len(), 500);
    }
}

#[test]
fn times_of_few_digits_hide_no_wrong_rate_and_make_none() {
    // Steps of 0.09 and 0.1 ms, whose median alone says 10 000 Hz.
    let why = message(recorded(10_200.0, 5, 500));
    assert!(why.contains("10000 Hz contradicts the times, which have 10200"), "{why}");
    assert_eq!(rows(read(recorded(10_050.0, 5, 500))).len(), 500);
    assert_eq!(rows(read(recorded(10_000.0, 5, 12))).len(), 12);
}

#[test]
fn missing_samples_make_no_wrong_rate() {
    let text = recorded(10_000.0, 9, 500);
    let kept = text.lines().enumerate().filter(|(index, _)| *index < 4 || index % 10 != 0);
    let kept = kept.fold(String::new(), |all, (_, line)| all + line + "\n");
    assert!(rows(read(kept)).len() < 460);
}
