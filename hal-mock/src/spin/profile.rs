//! Quantities that change slowly over a flight.

/// A quantity over the time: straight from point to point (time in s, rising, and value), constant before
/// the first point and after the last; zero without any.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile<'a>(pub &'a [(f64, f64)]);

impl Profile<'_> {
    /// Value of the quantity at a time in s; at a jump, of two points at one time, that of the later point.
    #[must_use]
    pub fn value(&self, time_s: f64) -> f64 {
        let after = self.0.partition_point(|(at_s, _)| *at_s <= time_s);
        match (after.checked_sub(1).and_then(|index| self.0.get(index)), self.0.get(after)) {
            (Some(from), Some(to)) => between(*from, *to, time_s),
            (Some((_, value)), None) | (None, Some((_, value))) => *value,
            (None, None) => 0.0,
        }
    }

    /// Integral of the profile from zero to a time in s, ≥ 0: exact, as trapezia are.
    #[must_use]
    pub fn integral(&self, time_s: f64) -> f64 {
        let corners = self.0.iter().map(|(at_s, _)| *at_s);
        let inside = corners.filter(|at_s| *at_s > 0.0 && *at_s < time_s).chain([time_s]);
        let mut from_s = 0.0;
        let area = |to_s: f64| {
            // The value just before the end: a jump is two points of one time.
            let middle = self.value(0.5 * (from_s + to_s));
            let part = (to_s - from_s) * middle;
            from_s = to_s;
            part
        };
        inside.map(area).sum()
    }
}

/// The value at a time on the line between two points.
fn between((from_s, from): (f64, f64), (to_s, to): (f64, f64), time_s: f64) -> f64 {
    from + (to - from) * (time_s - from_s) / (to_s - from_s)
}
