//! How far an axis reaches and where its ticks stand.
//!
//! A *place* is a value on a linear axis and its decimal logarithm on a logarithmic one, so that
//! places are drawn alike.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::Scale;

/// The part of its reach that an axis leaves free at each end.
const MARGIN: f64 = 0.03;

/// Ticks that an axis bears at most.
const TICKS: f64 = 8.0;

/// Decades over which the lines between powers of ten can still be distinguished.
const FINE_DECADES: f64 = 7.0;

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
    major: Vec<f64>,
    /// Where a faint line stands.
    minor: Vec<f64>,
    scale: Scale,
    step: f64,
}

/// The place of a value: minus infinity for what a logarithmic axis cannot show, being too low.
pub(super) fn place(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Logarithmic if value <= 0.0 => f64::NEG_INFINITY,
        Scale::Logarithmic => value.log10(),
        Scale::Linear => value,
    }
}

impl Span {
    /// An axis for these places; `None` where none is finite.
    pub fn new(scale: Scale, places: impl Iterator<Item = f64>) -> Option<Self> {
        let finite = places.filter(|place| place.is_finite());
        let reach = |[low, high]: [f64; 2], place| [f64::min(low, place), f64::max(high, place)];
        let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], reach);
        if low > high {
            return None;
        }
        let width = high - low;
        let margin = if width > 0.0 { MARGIN * width } else { half_width(scale, low) };
        Some(Self::between(scale, low - margin, high + margin))
    }

    /// An axis that reaches so far.
    fn between(scale: Scale, low: f64, high: f64) -> Self {
        let step = round_step((high - low) / TICKS);
        let mut span = Self { low, high, major: Vec::new(), minor: Vec::new(), scale, step };
        let is_wide = high.floor() > low.ceil();
        if scale == Scale::Logarithmic && is_wide {
            span.step = span.step.max(1.0).ceil();
        }
        span.major = if scale == Scale::Logarithmic && !is_wide {
            span.multiples(&[1.0, 2.0, 5.0])
        } else {
            ticks(low, high, span.step)
        };
        if scale == Scale::Logarithmic && high - low <= FINE_DECADES {
            span.minor = span.multiples(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        }
        span
    }

    /// The places of these multiples of the powers of ten.
    fn multiples(&self, factors: &[f64]) -> Vec<f64> {
        let decades = ticks(self.low - 1.0, self.high, 1.0);
        let places = decades.iter().flat_map(|d| factors.iter().map(move |f| d + f.log10()));
        places.filter(|place| (self.low..=self.high).contains(place)).collect()
    }

    /// As many decimal places as the step has.
    fn linear_label(&self, value: f64) -> String {
        let largest = self.low.abs().max(self.high.abs());
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

impl Ranged for Span {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, (first, last): (i32, i32)) -> i32 {
        let part = (place - self.low) / (self.high - self.low);
        first + (f64::from(last - first) * part).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let is_minor = hint.weight().allow_light_points();
        if is_minor { self.minor.clone() } else { self.major.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Span {
    fn format_ext(&self, place: &f64) -> String {
        match self.scale {
            Scale::Linear => self.linear_label(*place),
            Scale::Logarithmic => logarithmic_label(*place),
        }
    }
}

/// Half the reach of an axis for one place.
fn half_width(scale: Scale, place: f64) -> f64 {
    match scale {
        Scale::Linear if place != 0.0 => 0.1 * place.abs(),
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
