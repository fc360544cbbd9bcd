//! Recordings of vehicles, between stops and where they stand.

use host::campaign::disturbed::{PLATFORMS, row};
use host::campaign::statistics::{Answer, coverage};
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

use super::{covered, healthy, runs};

campaigns! {
    every_class_of_a_vehicle_passes_in_few_runs;
    healthy_vehicles_are_answered_and_their_errors_covered;
}

fn every_class_of_a_vehicle_passes_in_few_runs(extent: Extent) {
    let [.., vehicle, _] = PLATFORMS;
    for class in (vehicle.classes)() {
        let row = row(&class, runs(extent), &|| ());
        println!("{row:?}");
        assert!(row.wrong as f64 <= class.wrong_allowed * row.answered as f64, "{row:?}");
        // Of so few runs one more or less is chance.
        assert!(row.harmless_answered as f64 >= 0.8 * row.harmless as f64, "{row:?}");
    }
}

fn healthy_vehicles_are_answered_and_their_errors_covered(extent: Extent) {
    let [.., vehicle, _] = PLATFORMS;
    let answers: Vec<Result<Answer, String>> =
        (1..=healthy(extent, 160) as u64).into_par_iter().map(vehicle.healthy).collect();
    let too_large = |reason: &String| reason.contains("above the accepted");
    let refused = answers.iter().filter_map(|answer| answer.as_ref().err());
    let refused: Vec<_> = refused.filter(|reason| !too_large(reason)).collect();
    assert!(refused.len() <= extent.count(3), "{refused:?}");
    let given: Vec<_> = answers.iter().flatten().collect();
    let percent = coverage(given.iter().map(|answer| [answer.error, answer.sigma]));
    println!("{percent:?} % of {}", given.len());
    assert!(covered(extent, [10.3, 5.4, 2.2], given.len())(percent), "{percent:?}");
    assert!(percent[0] < 68.3 + extent.share(15.7, 68.3, given.len()), "{percent:?}");
}
