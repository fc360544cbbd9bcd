//! An encoder that slipped, or a base that was turned, so far that no residual is small: two headings.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::Refusal as Stepwise;
use orientation::alignment::stepwise::session::Session;
use orientation::math::regression::{Column, Regression};
use orientation::signal::dwell::Dwell;
use orientation::units::{DEGREES_PER_RADIAN, TURN, wrapped};

/// Fewest dwells of either heading.
const FEWEST: usize = 3;
/// Fewest dwells beyond what two headings and a bias take.
const FREE: usize = 3;
/// Part of what one heading leaves over that two may leave, each by its degrees of freedom.
const LEFT: f64 = 0.05;
/// By how much the Earth rates of both may differ, relative.
const ALIKE: f64 = 0.2;

/// What two headings are: what they leave over, and where the second begins.
struct Two {
    left: f64,
    angle: f64,
    after: f64,
}

/// Two headings where one does not do.
pub fn of(session: &Session, refusal: &Refusal) -> Option<String> {
    let is_scattered = matches!(
        refusal,
        Refusal::ResidualsNotWhite { .. }
            | Refusal::ResidualsCorrelated { .. }
            | Refusal::EarthRateMismatch { .. }
            | Refusal::Stepwise(Stepwise::NoiseNotAsStated { .. } | Stepwise::Disturbed { .. })
    );
    let (dwells, rate) = (session.dwells(), session.setting.site.latitude.horizontal_rate());
    if !is_scattered || dwells.len() < 5 + FREE {
        return None;
    }
    let (_, chi_square) = solved(dwells, dwells.len(), rate.0)?;
    let one = chi_square / (dwells.len() - 3) as f64;
    let places = FEWEST..=dwells.len() - FEWEST;
    let two = places.filter_map(|place| two(dwells, place, rate.0));
    let Two { left, angle, after } = two.min_by(|a, b| a.left.total_cmp(&b.left))?;
    (left < LEFT * one).then(|| {
        format!(
            "after {after:.1} s the dwells show a heading {:.1}° from that before: the encoder slipped, or the base \
             was turned",
            angle * DEGREES_PER_RADIAN
        )
    })
}

/// Cosine and sine of the azimuth before and after a dwell, and the bias, in horizontal Earth rates; and what they leave
/// over.
fn solved(dwells: &[Dwell], place: usize, rate: f64) -> Option<([f64; 5], f64)> {
    let mut regression = Regression::<5>::default();
    for (index, dwell) in dwells.iter().enumerate() {
        let (sine, cosine) = dwell.stage.rad().sin_cos();
        let columns = if index < place {
            [cosine, -sine, 0.0, 0.0, 1.0]
        } else {
            [0.0, 0.0, cosine, -sine, 1.0]
        };
        regression.push(&columns, (dwell.rate.0 - dwells[0].rate.0) / rate);
    }
    let after = if place < dwells.len() { Column::Free } else { Column::Absent };
    let model = [Column::Free, Column::Free, after, after, Column::Free];
    let solution = regression.solve(&model)?;
    Some((solution.coefficients, solution.chi_square))
}

/// Two headings that meet at a dwell, where both show one Earth rate.
fn two(dwells: &[Dwell], place: usize, rate: f64) -> Option<Two> {
    let ([a, b, c, d, _], chi_square) = solved(dwells, place, rate)?;
    let (before, after) = (a.hypot(b), c.hypot(d));
    let is_one = (before - after).abs() < ALIKE * before.max(after);
    let turn = wrapped(d.atan2(c) - b.atan2(a));
    let angle = if turn > 0.5 * TURN { turn - TURN } else { turn };
    let left = chi_square / (dwells.len() - 5) as f64;
    is_one.then(|| Two { left, angle, after: dwells[place].start().0 })
}
