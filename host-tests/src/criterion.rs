//! The criteria by the names of the command line.

use orientation::alignment::stepwise::criterion::Criterion;
use orientation::units::DEGREE_PER_HOUR;

/// Parses `ml`, `table` (maximum likelihood over the table), `least-squares`, `least-absolute`, `within-squares=A1` or `within-absolute=A`,
/// with A1 in (°/h)² and A in °/h.
///
/// # Errors
/// One line that names the possible values.
pub fn parse(text: &str) -> Result<Criterion, String> {
    let (name, bound) = match text.split_once('=') {
        Some((name, bound)) => (name, Some(self::bound(bound)?)),
        None => (text, None),
    };
    match (name, bound) {
        ("ml", None) => Ok(Criterion::MaximumLikelihood),
        ("table", None) => Ok(Criterion::OnTable),
        ("least-squares", None) => Ok(Criterion::LeastSquares),
        ("least-absolute", None) => Ok(Criterion::LeastAbsolute),
        ("within-squares", Some(bound)) => {
            Ok(Criterion::WithinSquares(bound * DEGREE_PER_HOUR * DEGREE_PER_HOUR))
        }
        ("within-absolute", Some(bound)) => Ok(Criterion::WithinAbsolute(bound * DEGREE_PER_HOUR)),
        ("within-squares" | "within-absolute", None) => {
            Err(format!("{name} needs a bound: {name}=NUMBER"))
        }
        _ => Err("possible values: ml, table, least-squares, least-absolute, within-squares=A1, \
                  within-absolute=A"
            .to_owned()),
    }
}

fn bound(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err(format!("the bound {text:?} is not a positive number")),
    }
}

/// The name that [`parse`] reads.
pub(crate) fn name(criterion: Criterion) -> String {
    match criterion {
        Criterion::MaximumLikelihood => "ml".to_owned(),
        Criterion::OnTable => "table".to_owned(),
        Criterion::LeastSquares => "least-squares".to_owned(),
        Criterion::LeastAbsolute => "least-absolute".to_owned(),
        Criterion::WithinSquares(bound) => {
            format!("within-squares={}", bound / DEGREE_PER_HOUR / DEGREE_PER_HOUR)
        }
        Criterion::WithinAbsolute(bound) => format!("within-absolute={}", bound / DEGREE_PER_HOUR),
    }
}
