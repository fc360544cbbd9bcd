//! Curves over two axes, as data.

/// Curves over common axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The heading.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves; later ones are drawn over earlier ones.
    pub series: Vec<Series>,
    /// Words at places of the figure.
    pub notes: Vec<Note>,
    /// The area that it takes.
    pub shape: Shape,
}

/// The area that a figure takes on a page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// As high as figures are.
    #[default]
    Usual,
    /// Half as high, for what stands below another figure with the same horizontal axis.
    Low,
    /// A unit is as long on the one axis as on the other, as on a map.
    Map,
}

/// Words at a place of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// On the horizontal axis.
    pub x: f64,
    /// On the vertical axis.
    pub y: f64,
    /// The words.
    pub text: String,
}

/// An axis of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub label: String,
    /// Unit of the axis; empty where it has none.
    pub unit: String,
    /// How values are laid along it.
    pub scale: Scale,
    /// The least and the greatest value that it shows; without them it reaches as far as its points.
    pub reach: Option<[f64; 2]>,
}

/// How values are laid along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally long.
    Linear,
    /// Equal ratios are equally long; values must be above zero.
    Logarithmic,
    /// Angles in degrees that go on beyond a turn, so that there is no step at north, named within a turn.
    Circle,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name of the series in the legend.
    pub name: String,
    /// How it is drawn.
    pub style: Style,
    /// Points of the series, in the order in which a line joins them. A point that is not finite interrupts the line.
    pub points: Vec<Point>,
}

/// How a curve is drawn. Limits are error bars, but in [`Style::Band`] and [`Style::WideBand`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line through the points.
    Line,
    /// A thin broken line through the points, for what only guides the eye.
    Dashed,
    /// A thin dotted line through the points, for what is only an upper limit.
    Dotted,
    /// Dots.
    Points,
    /// Circles, for what took no part.
    Hollow,
    /// Pale dots, for what is hardly known.
    Pale,
    /// Dots with a line through them.
    LineAndPoints,
    /// The area between the limits; the points themselves are not drawn.
    Band,
    /// The paler area between wider limits, behind a [`Style::Band`].
    WideBand,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// On the horizontal axis.
    pub x: f64,
    /// On the vertical axis.
    pub y: f64,
    /// Lower and upper limit on the vertical axis; what leaves the figure is cut at its edge.
    pub limits: Option<[f64; 2]>,
}

impl Figure {
    /// Curves over two axes.
    pub fn new(
        title: impl Into<String>,
        x: impl Into<Axis>,
        y: impl Into<Axis>,
        series: impl IntoIterator<Item = Series>,
    ) -> Self {
        let series = series.into_iter().collect();
        let (notes, shape) = Default::default();
        Self { title: title.into(), x: x.into(), y: y.into(), series, notes, shape }
    }

    /// Curves over the time in seconds.
    pub fn over_time(
        title: impl Into<String>,
        y: impl Into<Axis>,
        series: impl IntoIterator<Item = Series>,
    ) -> Self {
        Self::new(title, ["time", "s"], y, series)
    }

    /// Whether no point of it can be drawn.
    pub(super) fn is_empty(&self) -> bool {
        !self.series.iter().any(|series| self.draws(series))
    }

    /// Whether a point of a series can be drawn.
    pub(super) fn draws(&self, series: &Series) -> bool {
        series.points.iter().any(|point| self.x.shows(point.x) && self.y.shows(point.y))
    }

    /// The figure in another shape.
    #[must_use]
    pub fn shaped(self, shape: Shape) -> Self {
        Self { shape, ..self }
    }

    /// The figure with words at these places.
    #[must_use]
    pub fn noted(self, notes: impl IntoIterator<Item = Note>) -> Self {
        Self { notes: notes.into_iter().collect(), ..self }
    }
}

impl From<[&str; 2]> for Axis {
    /// An axis of a quantity and its unit, empty for a plain number, on which equal differences are equally long.
    fn from([label, unit]: [&str; 2]) -> Self {
        let (label, unit) = (label.to_owned(), unit.to_owned());
        Self { label, unit, scale: Scale::Linear, reach: None }
    }
}

impl Axis {
    /// An axis on which equal ratios are equally long; `unit` is empty for a plain number.
    #[must_use]
    pub fn logarithmic(label: &str, unit: &str) -> Self {
        Self { scale: Scale::Logarithmic, ..[label, unit].into() }
    }

    /// An axis of directions, which are named from 0 to 360°.
    #[must_use]
    pub fn circle(label: &str) -> Self {
        Self { scale: Scale::Circle, ..[label, "°"].into() }
    }

    /// The axis from this value to that, whatever its points are.
    #[must_use]
    pub fn between(self, reach: [f64; 2]) -> Self {
        Self { reach: Some(reach), ..self }
    }

    /// Whether the axis has a place for a value.
    fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale != Scale::Logarithmic || value > 0.0)
    }

    /// What stands beside the axis.
    pub(super) fn title(&self) -> String {
        let Self { label, unit, .. } = self;
        if unit.is_empty() { label.clone() } else { format!("{label}, {unit}") }
    }
}

impl Point {
    /// A point with limits of one σ on either side.
    #[must_use]
    pub fn within(x: f64, y: f64, sigma: f64) -> Self {
        Self { x, y, limits: Some([y - sigma, y + sigma]) }
    }
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self { x, y, limits: None }
    }
}

/// Most points of a series that a figure draws: more could hardly be distinguished.
pub const POINTS: usize = 600;

/// A point at which a curve is interrupted.
pub const BREAK: (f64, f64) = (f64::NAN, f64::NAN);

/// Whether a curve is interrupted here.
fn is_break(point: &Point) -> bool {
    !point.x.is_finite() || !point.y.is_finite()
}

/// The least and the greatest point of a stretch without breaks, in their order.
fn extremes(stretch: &[Point]) -> Vec<Point> {
    let places = || stretch.iter().enumerate();
    let by_height = |a: &(usize, &Point), b: &(usize, &Point)| a.1.y.total_cmp(&b.1.y);
    let least = places().min_by(by_height).map(|(place, _)| place);
    let greatest = places().max_by(by_height).map(|(place, _)| place);
    let mut kept: Vec<usize> = [least, greatest].into_iter().flatten().collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|place| stretch[place]).collect()
}

/// A piece of a curve without breaks, thinned to the extremes of each stretch of so many points; its ends stay.
fn thinned(piece: &[Point], stretch: usize) -> Vec<Point> {
    let [first, inner @ .., last] = piece else { return piece.to_vec() };
    let inner = inner.chunks(stretch).flat_map(extremes);
    std::iter::once(*first).chain(inner).chain([*last]).collect()
}

impl Series {
    /// As many of the points as can be distinguished: of a curve the least and the greatest of each stretch, so that no
    /// peak is lost; of dots and bands points at even distances in their order.
    pub(super) fn distinguished(&self) -> Vec<Point> {
        let (all, step) = (&self.points, self.points.len().div_ceil(POINTS));
        if step <= 1 {
            return all.clone();
        }
        let is_curve = !matches!(
            self.style,
            Style::Points | Style::Hollow | Style::Pale | Style::Band | Style::WideBand
        );
        if !is_curve {
            return all.iter().step_by(step).copied().collect();
        }
        let pieces: Vec<Vec<Point>> =
            all.split(is_break).map(|piece| thinned(piece, 2 * step)).collect();
        pieces.join(&Point::from(BREAK))
    }

    /// A curve through (x, y).
    pub fn new(
        name: &str,
        style: Style,
        points: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        let points = points.into_iter().map(Into::into).collect();
        Self { name: name.to_owned(), style, points }
    }

    /// A series with a point of each of some rows.
    pub fn of<T, P: Into<Point>>(
        name: &str,
        style: Style,
        all: &[T],
        point: impl FnMut(&T) -> P,
    ) -> Self {
        Self::new(name, style, all.iter().map(point))
    }
}
