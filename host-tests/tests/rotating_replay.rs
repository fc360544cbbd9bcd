//! The recordings of a turning platform, replayed through the session.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "rotating/oracle.rs"]
mod oracle;

use std::path::Path;

use bench::output::azimuth_error;
use bench::recording::{self, Body, Header, RotatingRow};
use bench::replay::Options;
use bench::rotating::{Replay, replay};
use orientation::align::rotating::conclusion::Conclusion;

/// A recording with its truth.
struct Recorded {
    header: Header,
    rows: Vec<RotatingRow>,
    truth_deg: f64,
}

fn recorded(name: &str) -> Recorded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/recordings").join(name);
    let (header, body, truth) =
        recording::read(&path.with_extension("csv.gz")).expect("it reads").into_parts();
    let Body::Rotating(rows) = body else { panic!("is {}", body.kind()) };
    Recorded { header, rows, truth_deg: truth.azimuth_deg.expect("it carries a truth") }
}

impl Recorded {
    fn replayed(&self) -> Replay {
        let body = Body::Rotating(self.rows.clone());
        replay(&self.header, &body, &Options::default()).expect("it replays")
    }
}

fn conclusion(replay: &Replay) -> &Conclusion {
    replay.conclusion().expect("the session has ended")
}

const BOTH: [&str; 2] = ["rotating-gyro", "rotating-met-two-speeds"];

#[test]
fn both_recordings_give_north_within_three_and_a_half_sigma() {
    for name in BOTH {
        let recorded = recorded(name);
        let replay = recorded.replayed();
        let conclusion = conclusion(&replay);
        println!("{name}: {conclusion:#?}");
        for part in replay.parts(&recorded.rows) {
            println!("{part} {} {}", part.rows[0].time_s, part.rows.last().unwrap().time_s);
        }
        let azimuth = conclusion.verdict.expect("there is an azimuth");
        let error = azimuth_error(azimuth.angle.to_degrees(), recorded.truth_deg);
        let sigma = azimuth.sigma.to_degrees();
        println!("{name}: {error:+.4}° ± {sigma:.4}°");
        assert!(error.abs() <= 3.5 * sigma, "{name}: {error}° ± {sigma}°");
    }
}
