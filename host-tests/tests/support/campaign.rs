//! Campaigns: one body, which runs in a tenth in `.ci/run` and whole in `.ci/full`; `cargo test` leaves it out.
//!
//! The figures of `ACCURACY.md` are those of the whole. Seeds are fixed, so what passes once passes always. A
//! bound of chance is four standard errors of the sample that it is of.

use std::fs;
use std::path::Path;

/// How much of a campaign is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// A tenth of the runs, but no fewer than [`LEAST`].
    Tenth,
    /// All.
    Whole,
}

/// Runs of the smallest sample.
pub const LEAST: usize = 20;

/// Standard errors that chance may make.
const SIGMAS: f64 = 4.0;

impl Extent {
    /// How many of so many runs.
    pub fn of(self, whole: usize) -> usize {
        match self {
            Self::Tenth => (whole / 10).max(LEAST.min(whole)),
            Self::Whole => whole,
        }
    }

    /// `ACCURACY.md` has these rows, if the campaign was whole.
    #[track_caller]
    pub fn assert_in_accuracy(self, rows: &[String]) {
        println!("{}", rows.join("\n"));
        if self == Self::Whole {
            assert_in_accuracy(rows);
        }
    }

    /// How many runs may be so: `whole` of all; of a tenth, what chance makes of a tenth of that, n + 4√n.
    pub fn count(self, whole: usize) -> usize {
        let expected = whole as f64 / 10.0;
        match self {
            Self::Tenth => (expected + SIGMAS * expected.sqrt()) as usize,
            Self::Whole => whole,
        }
    }

    /// How far an RMS of so many errors may be from its expectation, as a part of it: `whole` where all are run; of
    /// fewer, what chance makes, 4/√(2n).
    pub fn rms(self, whole: f64, runs: usize) -> f64 {
        match self {
            Self::Tenth => whole.max(SIGMAS / (2.0 * runs as f64).sqrt()),
            Self::Whole => whole,
        }
    }

    /// How far a share of so many runs may be from its expectation, per cent: `whole` where all are run; of fewer,
    /// what chance makes, 4 √(p (1 − p)/n), or a run and a half, for a share of nearly all is not normal.
    pub fn share(self, whole: f64, expected_percent: f64, runs: usize) -> f64 {
        let p = expected_percent / 100.0;
        match self {
            Self::Tenth => {
                let count = (SIGMAS * (p * (1.0 - p) * runs as f64).sqrt()).max(1.5);
                whole.max(100.0 * count / runs as f64)
            }
            Self::Whole => whole,
        }
    }
}

/// `ACCURACY.md` has these rows.
#[track_caller]
pub fn assert_in_accuracy(rows: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("ACCURACY.md");
    let page = fs::read_to_string(path).expect("the page is there");
    let lacks: Vec<_> = rows.iter().filter(|row| !page.contains(*row)).collect();
    assert!(lacks.is_empty(), "ACCURACY.md lacks {lacks:#?}");
}

/// Two tests of one body, `fn(Extent)`: in a tenth, and whole.
macro_rules! campaigns {
    ($($name:ident;)+) => {$(
        mod $name {
            use crate::support::campaign::Extent;

            #[test]
            #[ignore = "a campaign: a tenth in .ci/run"]
            fn in_a_tenth() {
                super::$name(Extent::Tenth);
            }

            #[test]
            #[ignore = "a campaign: whole in .ci/full"]
            fn whole() {
                super::$name(Extent::Whole);
            }
        }
    )+};
}
pub(crate) use campaigns;
