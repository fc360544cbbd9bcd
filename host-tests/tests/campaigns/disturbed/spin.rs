//! Recordings of spinning bodies.

use bench::campaign::disturbed::{classes, row, spin};
use bench::campaign::statistics::{Answer, coverage};
use rayon::prelude::*;

use super::RUNS;

#[test]
fn every_class_of_a_spinning_body_passes_in_few_runs() {
    let of_bodies: Vec<_> = classes().filter(|class| class.name.starts_with("spin-")).collect();
    assert_eq!(of_bodies.len(), 8);
    for class in of_bodies {
        let row = row(class, RUNS, &|| ());
        println!("{row:?}");
        assert_eq!((row.wrong, row.healthy_refused), (0, 0), "{row:?}");
        // Of so few runs one more or less is chance.
        assert!(row.harmless_answered as f64 >= 0.8 * row.harmless as f64, "{row:?}");
    }
}

#[test]
fn healthy_flights_are_answered_and_their_errors_covered() {
    let answers: Vec<Result<Answer, String>> =
        (1..401_u64).into_par_iter().map(spin::healthy).collect();
    let given: Vec<_> = answers.iter().flatten().collect();
    assert_eq!(given.len(), answers.len());
    let errors: Vec<f64> = given.iter().map(|answer| answer.error).collect();
    let sigmas: Vec<f64> = given.iter().map(|answer| answer.sigma).collect();
    let [one, two, three] = coverage(&errors, &sigmas);
    println!("{one} {two} {three} %");
    assert!((62.0..78.0).contains(&one) && two > 92.0 && three > 98.5, "{one} {two} {three}");
}
