//! The median of values, and the least and the greatest of them.

/// The median, the upper one of two, in linear time; zero of none.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    let middle = values.len() / 2;
    match &mut values[..] {
        [] => 0.0,
        values => *values.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}

/// The least and the greatest value; ∞ and −∞ of none.
pub fn extremes(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let wider = |[least, most]: [f64; 2], value: f64| [least.min(value), most.max(value)];
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], wider)
}
