//! The median of values.

/// The median, the upper one of two, in linear time, which leaves the values in another order; zero of none.
pub fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    match values {
        [] => 0.0,
        _ => *values.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}
