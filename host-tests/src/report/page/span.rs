//! How far an axis reaches and where its ticks stand.
//!
//! A *place* is a value on a linear axis and its decimal logarithm on a logarithmic one, so that
//! places are drawn alike.

use crate::report::{Axis, Scale};

/// The part of its reach that an axis leaves free at each end.
const MARGIN: f64 = 0.03;

/// Ticks that an axis bears at least.
const FEWEST_TICKS: usize = 3;

/// A step that is divided by this is rounded to the next smaller one: of 1, 2, 5 and 10 none is farther from its neighbour.
const CLOSER: f64 = 2.6;

/// Decades over which the lines between powers of ten can still be distinguished.
const FINE_DECADES: f64 = 7.0;

/// A turn, and the steps of directions that divide it, °.
const TURN: f64 = 360.0;
const CIRCLE_STEPS: [f64; 6] = [10.0, 15.0, 30.0, 45.0, 90.0, 180.0];

/// Powers of ten up to this are written as plain numbers.
const PLAIN: i32 = 3;

/// The reach of an axis, in places.
#[derive(Clone)]
pub(super) struct Span {
    /// Least value of the axis.
    pub low: f64,
    /// Greatest value of the axis.
    pub high: f64,
    /// Where a tick with its number stands.
    pub major: Vec<f64>,
    /// Where a faint line stands.
    pub minor: Vec<f64>,
    scale: Scale,
    /// Ticks that it bears at most.
    most: f64,
    step: f64,
    /// Whether the ticks of a logarithmic axis are multiples of powers of ten.
    is_in_powers: bool,
}

/// The place of a value: minus infinity for what a logarithmic axis cannot show, being too low.
pub(super) fn place(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Logarithmic if value <= 0.0 => f64::NEG_INFINITY,
        Scale::Logarithmic => value.log10(),
        Scale::Linear | Scale::Circle => value,
    }
}

impl Span {
    /// An axis of at most so many ticks for these places, or as far as it is told to reach; `None` where no place is finite.
    pub fn of(axis: &Axis, ticks: f64, places: impl Iterator<Item = f64>) -> Option<Self> {
        let finite = places.filter(|place| place.is_finite());
        let reach = |[low, high]: [f64; 2], place| [f64::min(low, place), f64::max(high, place)];
        let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], reach);
        if low > high {
            return None;
        }
        if let Some(reach) = axis.reach {
            let [low, high] = reach.map(|value| place(axis.scale, value));
            return Some(Self::between(axis.scale, ticks, [low, high]));
        }
        let width = high - low;
        let margin = if width > 0.0 { MARGIN * width } else { half_width(axis.scale, low) };
        Some(Self::between(axis.scale, ticks, [low - margin, high + margin]))
    }

    /// Widens the shorter of two axes about its middle until a unit is as long on both, in a square.
    pub fn match_units(x: &mut Self, y: &mut Self) {
        let width = (x.high - x.low).max(y.high - y.low);
        for span in [x, y] {
            let middle = 0.5 * (span.low + span.high);
            let reach = [middle - 0.5 * width, middle + 0.5 * width];
            *span = Self::between(span.scale, span.most, reach);
        }
    }

    /// Where a place lies between the ends, from 0 to 1.
    pub fn part(&self, place: f64) -> f64 {
        (place - self.low) / (self.high - self.low)
    }

    /// Whether zero lies inside a linear axis.
    pub fn crosses_zero(&self) -> bool {
        self.scale == Scale::Linear && self.low < 0.0 && self.high > 0.0
    }

    /// The number at a tick.
    pub fn label(&self, place: f64) -> String {
        match self.scale {
            Scale::Linear => self.linear_label(place),
            // A tick at north is often a rounding error away from it.
            Scale::Circle => self.linear_label((place + 1e-6 * self.step).rem_euclid(TURN)),
            Scale::Logarithmic if self.is_in_powers => logarithmic_label(place),
            Scale::Logarithmic => self.linear_label(10_f64.powf(place)),
        }
    }

    /// An axis that reaches so far.
    fn between(scale: Scale, most: f64, [low, high]: [f64; 2]) -> Self {
        let step = (high - low) / most;
        let of_circle = CIRCLE_STEPS.into_iter().find(|round| *round >= step);
        let is_wide = scale == Scale::Circle && step > CIRCLE_STEPS[0] / 2.0;
        let step = of_circle.filter(|_| is_wide).unwrap_or_else(|| round_step(step));
        let (major, minor) = (Vec::new(), Vec::new());
        let span = Self { low, high, major, minor, scale, most, step, is_in_powers: false };
        match scale {
            Scale::Linear | Scale::Circle => span.linear(),
            Scale::Logarithmic => span.logarithmic(),
        }
    }

    /// A linear axis with its ticks, closer where the next round step leaves but one or two.
    fn linear(mut self) -> Self {
        self.major = ticks(self.low, self.high, self.step);
        if self.major.len() < FEWEST_TICKS {
            self.step = round_step(self.step / CLOSER);
            self.major = ticks(self.low, self.high, self.step);
        }
        self
    }

    /// A logarithmic axis with its ticks: at powers of ten, at round multiples of them where it is short, at equal
    /// differences where it is shorter.
    fn logarithmic(mut self) -> Self {
        if self.high - self.low <= FINE_DECADES {
            self.minor = self.multiples(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        }
        self.is_in_powers = true;
        self.major = self.multiples(&[1.0, 2.0, 5.0]);
        if self.high.floor() > self.low.ceil() {
            self.step = self.step.max(1.0).ceil();
            self.major = ticks(self.low, self.high, self.step);
        } else if self.major.len() < FEWEST_TICKS {
            let [low, high] = [self.low, self.high].map(|place| 10_f64.powf(place));
            self.step = round_step((high - low) / self.most);
            self.is_in_powers = false;
            self.major = ticks(low, high, self.step).into_iter().map(f64::log10).collect();
        }
        self
    }

    /// The places of these multiples of the powers of ten.
    fn multiples(&self, factors: &[f64]) -> Vec<f64> {
        let decades = ticks(self.low - 1.0, self.high, 1.0);
        let places = decades.iter().flat_map(|d| factors.iter().map(move |f| d + f.log10()));
        places.filter(|place| (self.low..=self.high).contains(place)).collect()
    }

    /// As many decimal places as the step has.
    fn linear_label(&self, value: f64) -> String {
        let largest = value.abs().max(self.low.abs()).max(self.high.abs());
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        // A tick at zero is often a rounding error away from it.
        let value = if value.abs() < self.step / 2.0 { 0.0 } else { value };
        if largest < 1e6 && decimals <= 5 {
            return format!("{value:.decimals$}");
        }
        let digits = (largest / self.step).log10().ceil().max(0.0) as usize;
        format!("{value:.digits$e}")
    }
}

/// Half the reach of an axis for one place.
fn half_width(scale: Scale, place: f64) -> f64 {
    match scale {
        Scale::Linear | Scale::Circle if place != 0.0 => 0.1 * place.abs(),
        _ => 1.0,
    }
}

/// The next 1, 2 or 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let round = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= step);
    round.unwrap_or(10.0) * power
}

/// The multiples of the step between both ends.
fn ticks(low: f64, high: f64, step: f64) -> Vec<f64> {
    let [first, last] = [(low / step).ceil() as i64, (high / step).floor() as i64];
    (first..=last).map(|index| index as f64 * step).collect()
}

/// A power of ten, or a small multiple of one.
fn logarithmic_label(place: f64) -> String {
    let power = (place + 1e-9).floor() as i32;
    let factor = 10_f64.powf(place - f64::from(power)).round();
    if power.abs() <= PLAIN {
        let decimals = (-power).max(0) as usize;
        return format!("{:.decimals$}", factor * 10_f64.powi(power));
    }
    let factor = if factor == 1.0 { String::new() } else { format!("{factor}·") };
    format!("{factor}10{}", superscript(power))
}

/// An exponent in raised digits.
fn superscript(power: i32) -> String {
    let raised = |digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(digit),
    };
    power.to_string().chars().map(raised).collect()
}
