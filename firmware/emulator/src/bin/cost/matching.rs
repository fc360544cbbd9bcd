//! Cost of the search of the reference table (etalon), in the setting of Sokolov 2019.

use hal_mock::noise::Generator;
use orientation::alignment::stepwise::etalon;
use orientation::alignment::stepwise::etalon::series::SeriesError;
use orientation::alignment::stepwise::etalon::{Acceptance, Criterion, Limit, Match, Series};
use orientation::math::reference_table::Table;
use orientation::math::reference_table::{ONE, STEP, TURN};

use crate::report::{Report, figure};
use crate::yardsticks;
use firmware::budget::MATCH_INSTRUCTIONS;
use measure::counter::Counter;
use measure::stack::stack_of;

/// Number of positions n.
const POSITIONS: u32 = 60;
/// Number of random series of each kind.
const SERIES: usize = 100;
/// White noise of a dwell of 1 s over the horizontal Earth rate: 0.015 °/h at 47°35′.
const SIGMA: f64 = 1.48e-3;
/// Constant drift over the horizontal Earth rate, 1σ: 0.01 °/h.
const DRIFT_SIGMA: f64 = 9.9e-4;
/// Ratio of α₁ to the expected sum of squares of noise alone.
const ACCEPTED_SQUARES: f64 = 1.5;
/// Bound α: 1.2 times the expectation for noise alone, (n − 1)·√2·σ·√(2/π), over the horizontal
/// Earth rate.
const ACCEPTED_ABSOLUTE: f64 = 1.2 * 59.0 * 1.414 * SIGMA * 0.798;

/// Schedule of the stage.
#[derive(Clone, Copy)]
struct Turn {
    /// Name in the report.
    name: &'static str,
    /// Step in grid steps of 10″.
    step: i32,
    /// First azimuth in grid steps.
    from: f64,
    /// Range of the first azimuths in grid steps.
    range: f64,
}

/// Schedules of the paper: 28′ towards north from 28° to 29°, and 6° from any azimuth.
const TURNS: [Turn; 2] = [
    Turn { name: "arc", step: -168, from: 10_080.0, range: 360.0 },
    Turn { name: "circle", step: 2160, from: 0.0, range: TURN as f64 },
];

impl Turn {
    /// A noisy series from a random azimuth.
    fn series(self, seed: u64) -> Result<Series, SeriesError> {
        let mut noise = Generator::stream(seed, 3);
        let first = self.from + self.range * noise.uniform();
        let drift = DRIFT_SIGMA * noise.gaussian();
        let ratio = |index| {
            let azimuth = (first + f64::from(index) * f64::from(self.step)) * STEP;
            libm::cos(azimuth) + drift + SIGMA * noise.gaussian()
        };
        Series::new((0..POSITIONS).map(ratio), self.step)
    }
}

/// Sorted costs or counts of many series.
struct Spread([u64; SERIES]);

impl Spread {
    /// Values of `figure` for each series.
    fn of(mut figure: impl FnMut(&Series) -> u64, turn: Turn) -> Result<Self, SeriesError> {
        let mut figures = [0; SERIES];
        for (seed, place) in (1..).zip(&mut figures) {
            *place = figure(&turn.series(seed)?);
        }
        sort(&mut figures);
        Ok(Self(figures))
    }

    /// Median value.
    fn median(&self) -> u64 {
        self.0[SERIES / 2]
    }

    /// Greatest value.
    fn greatest(&self) -> u64 {
        self.0[SERIES - 1]
    }
}

/// Sorts by insertion: the library's sort takes some kilobytes of the flash that is measured.
fn sort(figures: &mut [u64]) {
    for end in 1..figures.len() {
        for place in (1..=end).rev() {
            if figures[place - 1] > figures[place] {
                figures.swap(place - 1, place);
            }
        }
    }
}

/// Measures every criterion on both schedules.
pub fn report(counter: &Counter, report: &mut Report) -> Result<(), SeriesError> {
    for turn in TURNS {
        let likeliest = searched(counter, turn, Criterion::MaximumLikelihood)?;
        budgeted(report, turn, "maximum likelihood", &likeliest);
        let least_squares = searched(counter, turn, Criterion::LeastSquares)?;
        budgeted(report, turn, "least squares", &least_squares);
        budgeted(report, turn, "within squares", &within(counter, turn, squares_limit())?);
        rows(turn, "within absolute", &within(counter, turn, absolute_limit())?);
        let criterion = Criterion::LeastAbsolute;
        rows(turn, "least absolute", &searched(counter, turn, criterion)?);
        let evaluations = |series: &Series| u64::from(search(series, criterion).evaluations);
        rows(turn, "least absolute, evaluations", &Spread::of(evaluations, turn)?);
    }
    yardsticks::exhaustive(counter, report, &TURNS[0].series(1)?);
    Ok(())
}

/// Reports the stack of each kind of match.
pub fn report_stack() -> Result<(), SeriesError> {
    let series = TURNS[0].series(1)?;
    let of = |criterion| stack_of(|| search(&series, criterion)).0 as u64;
    figure("stack of a match, maximum likelihood", of(Criterion::MaximumLikelihood));
    figure("stack of a match, least absolute", of(Criterion::LeastAbsolute));
    let within = stack_of(|| accepted(&series, squares_limit())).0 as u64;
    figure("stack of a match, within squares", within);
    Ok(())
}

/// Search that is measured, not inlined.
#[inline(never)]
fn search(series: &Series, criterion: Criterion) -> Match {
    etalon::search(Table::built_in(), series, criterion)
}

/// Acceptance that is measured, not inlined.
#[inline(never)]
fn accepted(series: &Series, limit: Limit) -> Acceptance {
    etalon::accepted(Table::built_in(), series, limit)
}

/// Bound α₁: a multiple of the n − 1 differences' noise, in squared table units.
fn squares_limit() -> Limit {
    let expected = f64::from(POSITIONS - 1) * 2.0 * SIGMA * SIGMA;
    Limit::WithinSquares((ACCEPTED_SQUARES * expected * ONE * ONE) as u128)
}

/// Costs of the search by a criterion.
fn searched(counter: &Counter, turn: Turn, criterion: Criterion) -> Result<Spread, SeriesError> {
    Spread::of(|series| counter.measure(|| search(series, criterion)).0.instructions(), turn)
}

/// Costs of the acceptance within a bound.
fn within(counter: &Counter, turn: Turn, limit: Limit) -> Result<Spread, SeriesError> {
    Spread::of(|series| counter.measure(|| accepted(series, limit)).0.instructions(), turn)
}

/// Bound α, in table units.
fn absolute_limit() -> Limit {
    Limit::WithinAbsolute((ACCEPTED_ABSOLUTE * ONE) as u64)
}

/// Reports the two rows of a criterion without a budget.
fn rows(Turn { name: turn, .. }: Turn, name: &str, spread: &Spread) {
    figure(format_args!("match of 60, {turn}, {name}, median"), spread.median());
    figure(format_args!("match of 60, {turn}, {name}, greatest"), spread.greatest());
}

/// Reports the two rows of a criterion with a budget.
fn budgeted(report: &mut Report, turn: Turn, name: &str, spread: &Spread) {
    let turn = turn.name;
    figure(format_args!("match of 60, {turn}, {name}, median"), spread.median());
    report.budget(
        format_args!("match of 60, {turn}, {name}, greatest"),
        spread.greatest(),
        MATCH_INSTRUCTIONS,
    );
}
