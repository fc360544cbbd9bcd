//! Causes of a refusal of three gyros and three accelerometers: columns in other units.

use orientation::alignment::refusal::Refusal;

use super::is_short;
use super::units::{self, MOST_ROWS, RATES, Unit};
use crate::methods::asked::Question;
use crate::methods::is_answered;
use crate::methods::stops::{self, samples};
use crate::recording::{Body, ImuRow};

/// The gyros' columns.
const GYROS: &str = "columns gx_rad_s to gz_rad_s";

/// The likely cause of a refusal of a vehicle's recording, with its remedy.
pub fn of_vehicle(of: &Question, refusal: &Refusal) -> Option<String> {
    let Question { header, body, asked } = *of;
    let force = units::force_unit(body);
    let of_force = units::of_forces(body);
    let rows = samples::rows(body).filter(|rows| rows.len() <= MOST_ROWS)?;
    if is_short(refusal) {
        return of_force;
    }
    let passes = |rate: &Unit| {
        let body = Body::Imu(converted(&rows, rate.0, force.map_or(1.0, |unit| unit.0)));
        stops::replay(header, &body, asked).is_ok_and(|replay| is_answered(&replay.session))
    };
    let of_rates = RATES.into_iter().find(passes).map(|unit| unit.describe(GYROS));
    let named: Vec<String> = of_rates.into_iter().chain(of_force).collect();
    (!named.is_empty()).then(|| named.join("; "))
}

/// The rows in other units.
fn converted(rows: &[ImuRow], rate: f64, force: f64) -> Vec<ImuRow> {
    let mut rows = rows.to_vec();
    for row in &mut rows {
        row.sample.rates_rad_s = row.sample.rates_rad_s.map(|part| part * rate);
        row.sample.force_m_s2 = row.sample.force_m_s2.map(|part| part * force);
    }
    rows
}
