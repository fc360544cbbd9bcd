//! Recordings of vehicles, between stops and where they stand.

use bench::campaign::disturbed::{classes, row, vehicle};
use bench::campaign::statistics::{Answer, coverage};
use rayon::prelude::*;

use super::RUNS;

#[test]
fn every_class_of_a_vehicle_passes_in_few_runs() {
    let of_vehicles = |name: &str| name.starts_with("vehicle") || name.starts_with("standing");
    for class in classes().filter(|class| of_vehicles(class.name)) {
        let row = row(class, RUNS, &|| ());
        println!("{row:?}");
        assert!(row.wrong as f64 <= class.wrong_allowed * row.answered as f64, "{row:?}");
        // Of so few runs one more or less is chance.
        assert!(row.harmless_answered as f64 >= 0.8 * row.harmless as f64, "{row:?}");
    }
}

#[test]
fn healthy_vehicles_are_answered_and_their_errors_covered() {
    let answers: Vec<Result<Answer, String>> =
        (1..161_u64).into_par_iter().map(vehicle::healthy).collect();
    let too_large = |reason: &String| reason.contains("above the accepted");
    let refused = answers.iter().filter_map(|answer| answer.as_ref().err());
    let refused: Vec<_> = refused.filter(|reason| !too_large(reason)).collect();
    assert!(refused.len() <= 3, "{refused:?}");
    let given: Vec<_> = answers.iter().flatten().collect();
    let errors: Vec<f64> = given.iter().map(|answer| answer.error).collect();
    let sigmas: Vec<f64> = given.iter().map(|answer| answer.sigma).collect();
    let [one, two, three] = coverage(&errors, &sigmas);
    println!("{one} {two} {three} % of {}", given.len());
    assert!((58.0..84.0).contains(&one) && two > 90.0 && three > 97.5, "{one} {two} {three}");
}
