//! Holds the etalon search to a brute force on 10 000 ordinary cases (or as many as the first
//! argument says), a tenth of that of the paper's and as many adversarial ones; exits with 1 on a
//! mismatch.
//!
//! ```text
//! cargo run --release --example etalon_exhaustive -- 10000
//! ```

#[allow(dead_code, reason = "the tests of the search use the rest of it")]
#[path = "../tests/cores/etalon/oracle.rs"]
mod oracle;

use std::process::ExitCode;

use hal_mock::noise::Generator;
use rayon::prelude::*;

use oracle::{CRITERIA, Case, Outcome, adversarial, compare, ordinary, paper};

/// Makes case number `index` of a family.
type Family = fn(&mut Generator, usize) -> Case;

/// The value below which `share` of the sorted `values` lie.
fn quantile(values: &[u32], share: f64) -> u32 {
    values[((values.len() - 1) as f64 * share).round() as usize]
}

/// Runs a family and prints a line for each criterion; the result is the number of mismatches.
fn run(name: &str, family: Family, cases: usize) -> usize {
    let outcomes: Vec<[Outcome; 5]> = (0..cases)
        .into_par_iter()
        .map(|index| {
            let mut random = Generator::new(index as u64);
            let case = family(&mut random, index);
            let outcomes = compare(&case, &mut random);
            for (outcome, criterion) in outcomes.iter().zip(CRITERIA) {
                if !outcome.agrees {
                    println!("{name} case {index}, {criterion}: {} {case:?}", outcome.answers);
                }
            }
            outcomes
        })
        .collect();
    let mut total = 0;
    for (column, criterion) in CRITERIA.iter().enumerate() {
        let mismatches = outcomes.iter().filter(|row| !row[column].agrees).count();
        let mut counts: Vec<u32> = outcomes.iter().map(|row| row[column].evaluations).collect();
        counts.sort_unstable();
        let [median, p99, most] = [0.5, 0.99, 1.0].map(|share| quantile(&counts, share));
        println!(
            "{name:12} {criterion:19} cases {cases:6}  mismatches {mismatches:4}  \
             evaluations median {median}, p99 {p99}, most {most}"
        );
        total += mismatches;
    }
    total
}

fn main() -> ExitCode {
    let cases = std::env::args().nth(1).and_then(|count| count.parse().ok()).unwrap_or(10_000);
    let mismatches = run("ordinary", |random, _| ordinary(random), cases)
        + run("paper", |random, _| paper(random), cases.div_ceil(10))
        + run("adversarial", adversarial, cases.div_ceil(10));
    ExitCode::from(u8::from(mismatches > 0))
}
