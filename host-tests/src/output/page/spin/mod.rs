//! The page of a spinning body's roll: errors of the methods, lift, scale error with its σ.

pub mod campaign;
mod figures;

use crate::output::named;
use crate::output::spin::json::{MethodObject, Object, object};
use crate::recording::Truth;
use crate::report::{Part, Report, Table};
use crate::spin::Replay;

/// The page for a replay of `name`; the truth is for its errors alone.
#[must_use]
pub fn report(name: &str, replay: &Replay, truth: &Truth) -> Report {
    let object = object(replay, truth);
    let mut parts: Vec<Part> = Vec::new();
    parts.extend(figures::errors(replay, truth).into_iter().map(Part::from));
    parts.push(figures::sigmas(replay, truth).into());
    parts.push(figures::lift(replay).into());
    parts.push(figures::scale(replay).into());
    parts.push(of_methods(&object).into());
    parts.push(of_states(replay).into());
    Report { title: format!("Roll of a spinning body: {name}"), subtitle: subtitle(&object), parts }
}

fn subtitle(object: &Object) -> Vec<String> {
    let first = match (object.roll_rad_end.zip(object.sigma_deg), &object.reason) {
        (Some((roll, sigma)), _) => format!("roll at the end {roll:.6} rad ± {sigma:.4}° (1σ)"),
        (None, reason) => reason.clone().unwrap_or_default(),
    };
    let limit = object.limit_deg.map(|limit| format!("limit {limit:.4}° (Cramér–Rao)"));
    [Some(first), limit].into_iter().flatten().collect()
}

fn of_methods(object: &Object) -> Table {
    let row = |method: &MethodObject| {
        vec![
            method.name.to_owned(),
            method.corrections.to_string(),
            method.rms_deg.map_or_else(String::new, |rms| format!("{rms:.5}")),
            method.turns_lost.map_or_else(String::new, |turns| turns.to_string()),
        ]
    };
    Table {
        title: "Methods, after the first 0.1 s".to_owned(),
        head: named(&["method", "corrections", "RMS error, °", "turns lost"]),
        rows: object.methods.iter().map(row).collect(),
    }
}

/// What the phase lock was doing when.
fn of_states(replay: &Replay) -> Table {
    let states = &replay.answer().states;
    let row = |(from_s, state): &(f64, _)| vec![format!("{from_s:.4}"), format!("{state}")];
    Table {
        title: "States of the phase lock".to_owned(),
        head: named(&["from, s", "state"]),
        rows: states.iter().map(row).collect(),
    }
}
