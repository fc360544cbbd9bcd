//! Draws a figure as SVG.

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::{
    Cartesian2d, ChartBuilder, ChartContext, Circle, Color, DashedLineSeries, DrawingArea,
    EmptyElement, IntoDrawingArea, LineSeries, PathElement, Polygon, RGBColor, SVGBackend, WHITE,
};

use super::span::{Span, place};
use super::{Figure, Series, Style};

/// Width and height in units of the drawing; a page shows it at half of that, so that the whole
/// units to which points are rounded are fine enough.
const SIZE: (u32, u32) = (1800, 1000);
const TEXT: f64 = 34.0;
const HEADING: f64 = 36.0;
const X_LABELS: u32 = 100;
const Y_LABELS: u32 = 170;
const LINE: u32 = 4;
const THIN: u32 = 3;
const DOT: u32 = 7;
/// Half the width of an error bar's ends.
const BAR: i32 = 8;
const DASH: u32 = 16;
const BAND_OPACITY: f64 = 0.2;

/// Colours that people who cannot distinguish red from green can distinguish (Okabe and Ito 2008, with grey and
/// brown for its black and yellow).
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(80, 80, 80),
    RGBColor(148, 103, 60),
];

/// The colour of the series at this place.
pub(super) fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// Why a figure could not be drawn.
pub(super) type DrawError = DrawingAreaErrorKind<std::io::Error>;
type Drawn = Result<(), DrawError>;
type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Span, Span>>;

/// A point in places, with its limits.
type Placed = ((f64, f64), Option<[f64; 2]>);

/// The reach of both axes.
struct Frame {
    x: Span,
    y: Span,
}

/// The figure as an SVG element; `None` where there is nothing to draw.
pub(super) fn svg(figure: &Figure) -> Result<Option<String>, DrawError> {
    let Some(frame) = Frame::around(figure) else { return Ok(None) };
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    draw(&area, figure, &frame)?;
    area.present()?;
    drop(area);
    Ok(Some(text))
}

impl Frame {
    /// The axes that hold every point.
    fn around(figure: &Figure) -> Option<Self> {
        let points = || figure.series.iter().flat_map(|series| placed(figure, series));
        let heights = points().flat_map(|((_, y), limits)| {
            let [low, high] = limits.unwrap_or([y; 2]);
            [y, low, high]
        });
        Some(Self {
            x: Span::new(figure.x.scale, points().map(|((x, _), _)| x))?,
            y: Span::new(figure.y.scale, heights)?,
        })
    }

    /// The limits, cut at the figure's edges.
    fn cut(&self, limits: [f64; 2]) -> [f64; 2] {
        limits.map(|limit| limit.clamp(self.y.low, self.y.high))
    }
}

/// The points of a series that can be drawn.
fn placed<'a>(figure: &'a Figure, series: &'a Series) -> impl Iterator<Item = Placed> + 'a {
    let [horizontal, vertical] = [figure.x.scale, figure.y.scale];
    let points = series.points.iter().map(move |point| {
        let limits = point.limits.filter(|limits| !limits.iter().any(|limit| limit.is_nan()));
        let limits = limits.map(|limits| limits.map(|limit| place(vertical, limit)));
        ((place(horizontal, point.x), place(vertical, point.y)), limits)
    });
    points.filter(|((x, y), _)| x.is_finite() && y.is_finite())
}

fn draw(area: &DrawingArea<SVGBackend<'_>, Shift>, figure: &Figure, frame: &Frame) -> Drawn {
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(area)
        .margin(20)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(frame.x.clone(), frame.y.clone())?;
    mesh(&mut chart, figure)?;
    for (index, series) in figure.series.iter().enumerate() {
        let points: Vec<Placed> = placed(figure, series).collect();
        curve(&mut chart, series.style, &points, frame, colour(index))?;
    }
    Ok(())
}

fn mesh(chart: &mut Chart<'_>, figure: &Figure) -> Drawn {
    chart
        .configure_mesh()
        .x_desc(figure.x.title())
        .y_desc(figure.y.title())
        .label_style(("sans-serif", TEXT))
        .axis_desc_style(("sans-serif", HEADING))
        .bold_line_style(RGBColor(190, 190, 190))
        .light_line_style(RGBColor(235, 235, 235))
        .draw()
}

/// Draws one series.
fn curve(
    chart: &mut Chart<'_>,
    style: Style,
    points: &[Placed],
    frame: &Frame,
    colour: RGBColor,
) -> Drawn {
    let line = || points.iter().map(|(point, _)| *point);
    match style {
        Style::Band => return band(chart, points, frame, colour),
        Style::Dashed => {
            let style = colour.stroke_width(THIN);
            chart.draw_series(DashedLineSeries::new(line(), DASH, DASH, style))?;
        }
        Style::Line | Style::LineAndPoints => {
            chart.draw_series(LineSeries::new(line(), colour.stroke_width(LINE)))?;
        }
        Style::Points => {}
    }
    if matches!(style, Style::Points | Style::LineAndPoints) {
        chart.draw_series(line().map(|point| Circle::new(point, DOT, colour.filled())))?;
    }
    error_bars(chart, points, frame, colour)
}

/// Draws the area between the limits.
fn band(chart: &mut Chart<'_>, points: &[Placed], frame: &Frame, colour: RGBColor) -> Drawn {
    let limits = points.iter().filter_map(|((x, _), limits)| Some((*x, frame.cut((*limits)?))));
    let lower = limits.clone().map(|(x, [low, _])| (x, low));
    let upper = limits.map(|(x, [_, high])| (x, high));
    let outline: Vec<(f64, f64)> = lower.chain(upper.rev()).collect();
    chart.draw_series([Polygon::new(outline, colour.mix(BAND_OPACITY).filled())])?;
    Ok(())
}

/// Draws a bar with ends through every point that has limits.
fn error_bars(chart: &mut Chart<'_>, points: &[Placed], frame: &Frame, colour: RGBColor) -> Drawn {
    for ((x, _), limits) in points {
        let Some([low, high]) = limits.map(|limits| frame.cut(limits)) else { continue };
        let style = colour.stroke_width(THIN);
        chart.draw_series([PathElement::new(vec![(*x, low), (*x, high)], style)])?;
        let end =
            |y| EmptyElement::at((*x, y)) + PathElement::new(vec![(-BAR, 0), (BAR, 0)], style);
        chart.draw_series([end(low), end(high)])?;
    }
    Ok(())
}
