//! The table that the image `cost` prints.

use host::emulate::cost;

const TABLE: &str = "
     count     budget       checks, instructions
      1004       1000 ok    a thousand instructions in a row

     count     budget       INSTRUCTIONS (not cycles) on a Cortex-M4F
       185        150 OVER  filter and dwell, a sample
    125271          -       match of 60, arc, median

FAILED
";

#[test]
fn the_table_of_the_cores_is_read_with_its_headings() {
    let rows = cost::parse(TABLE).expect("a table");
    let row = |heading: &str, what: &str, count, budget, verdict: &str| cost::Row {
        heading: heading.to_owned(),
        what: what.to_owned(),
        count,
        budget,
        verdict: verdict.to_owned(),
    };
    let heading = "INSTRUCTIONS (not cycles) on a Cortex-M4F";
    let expected = [
        row("checks, instructions", "a thousand instructions in a row", 1004, Some(1000), "ok"),
        row(heading, "filter and dwell, a sample", 185, Some(150), "OVER"),
        row(heading, "match of 60, arc, median", 125_271, None, ""),
    ];
    assert_eq!(rows, expected);
}

#[test]
fn what_is_no_table_is_shown_as_it_is() {
    let error = cost::parse("panicked at somewhere: overflow").expect_err("no table");
    assert!(error.ends_with("panicked at somewhere: overflow"), "{error}");
    assert_eq!(cost::parse("\n").expect_err("empty"), "the image `cost` printed no table");
    assert!(cost::parse(&TABLE.replace("125271", "1252x1")).is_err());
}
