//! Recordings of spinning bodies.

use host::campaign::disturbed::{PLATFORMS, row};
use host::campaign::statistics::{Answer, coverage};
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

use super::{covered, healthy, runs};

campaigns! {
    every_class_of_a_spinning_body_passes_in_few_runs;
    healthy_flights_are_answered_and_their_errors_covered;
}

fn every_class_of_a_spinning_body_passes_in_few_runs(extent: Extent) {
    let [.., spin] = PLATFORMS;
    let of_bodies = (spin.classes)();
    assert_eq!(of_bodies.len(), 8);
    for class in &of_bodies {
        let row = row(class, runs(extent), &|| ());
        println!("{row:?}");
        assert_eq!((row.wrong, row.healthy_refused), (0, 0), "{row:?}");
        // Of so few runs one more or less is chance.
        assert!(row.harmless_answered as f64 >= 0.8 * row.harmless as f64, "{row:?}");
    }
}

fn healthy_flights_are_answered_and_their_errors_covered(extent: Extent) {
    let [.., spin] = PLATFORMS;
    let answers: Vec<Result<Answer, String>> =
        (1..=healthy(extent, 400) as u64).into_par_iter().map(spin.healthy).collect();
    let given: Vec<_> = answers.iter().flatten().collect();
    assert_eq!(given.len(), answers.len());
    let percent = coverage(given.iter().map(|answer| [answer.error, answer.sigma]));
    println!("{percent:?} %");
    assert!(covered(extent, [6.3, 3.4, 1.2], given.len())(percent), "{percent:?}");
    assert!(percent[0] < 68.3 + extent.share(9.7, 68.3, given.len()), "{percent:?}");
}
