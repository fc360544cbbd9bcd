//! The level: pitch, roll and the turn about the vertical that a gyrovertical kept.

use orientation::attitude::Trust;
use orientation::math::quaternion::angles;

use crate::cause::{self, Cause};
use crate::methods::asked::Question;
use crate::methods::vertical::errors::{Errors, Off};
use crate::methods::vertical::{Moment, Replay, name};
use crate::outcome::keys::Keys;
use crate::outcome::{Finished, Outcome, of_biases};
use crate::output::{degrees, degrees_per_hour, in_degrees_per_hour, positive_zero, signed};
use crate::recording::{Body, Truth};
use crate::report::{
    Axis, Columns, Figure, Kind, Lane, Lines, Part, Point, Series, Stretch, Style, Timeline,
};

/// What the biases hold beside themselves while north is not known.
const EARTH_RATE_WITHIN: &str = ", including the horizontal Earth rate";

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let (last, is_found) = (&self.last, self.refusal.is_none());
        let errors = Errors::of(&self.moments, &truth.attitude);
        let biases = [last.biases, last.bias_sigmas].map(in_degrees_per_hour);
        let details = Keys::default()
            .with("turned_deg", degrees(self.turned))
            .with("state", last.state.to_string())
            .with("states", &self.states)
            .with("bias_dph", biases[0])
            .with("bias_sigma_dph", biases[1])
            .with("bias_beyond_stated", last.is_bias_beyond_stated)
            .with_all(errors.as_ref());
        let states = Columns::of("States that were met", &self.states)
            .column("state", |met| met.state)
            .fixed("time, s", 2, |met| met.seconds);
        let parts = errors
            .as_ref()
            .map(of_errors)
            .into_iter()
            .map(Part::from)
            .chain([Part::from(states).detail()])
            .collect();
        Outcome {
            sigma_deg: is_found.then(|| last.level_sigma.degrees()),
            pitch_deg: is_found.then(|| last.pitch.degrees()),
            roll_deg: is_found.then(|| last.roll.degrees()),
            seconds: self.seconds,
            assumed: self.assumed.clone(),
            facts: self.lines(biases).lines,
            circumstances: self.circumstances(),
            found: is_found.then(|| self.level()),
            ..Outcome::new("vertical", details, parts)
        }
        .settled(self.refusal.clone())
    }

    fn titles(&self) -> [&'static str; 2] {
        ["Pitch and roll kept in", "No pitch and roll from"]
    }

    fn figures(&self, _: &Outcome, truth: &Truth, _: Option<&Body>) -> Vec<Part> {
        let mut page = match Errors::of(&self.moments, &truth.attitude) {
            Some(errors) => vec![inclination(&errors.off), heading(&errors.off)],
            None => vec![sigma(&self.moments)],
        };
        page.extend([level(&self.moments), biases(&self.moments)]);
        page.into_iter().map(Part::from).chain([timeline(self).into()]).collect()
    }

    fn attitude(&self) -> Option<&[Moment]> {
        Some(&self.moments)
    }

    fn cause(&self, of: &Question) -> Option<Cause> {
        self.refusal.as_ref().and_then(|_| cause::of_level(of.body))
    }
}

impl Replay {
    /// Pitch and roll at the end, in words.
    fn level(&self) -> [String; 2] {
        let [pitch, roll] =
            [self.last.pitch, self.last.roll].map(|angle| positive_zero(angle.degrees(), 5e-5));
        let sigma = self.last.level_sigma.degrees();
        let words = format!("{pitch:.4}°, {roll:.4}° ± {sigma:.4}° (1σ)");
        ["pitch, roll".to_owned(), words]
    }

    /// Length of the record.
    fn circumstances(&self) -> Vec<[String; 2]> {
        let (seconds, count) = (self.seconds, self.moments.len());
        Lines::default().with("time", format!("{seconds:.2} s, {count} samples")).lines
    }

    fn lines(&self, biases_dph: [[f64; 3]; 2]) -> Lines {
        let last = &self.last;
        let turned = positive_zero(degrees(self.turned), 5e-5);
        let beyond = "five of the 1σ stated or assumed, which are not believed any more";
        Lines::default()
            .with(
                "turned",
                format!("{}° about the vertical since the beginning", signed(turned, 4)),
            )
            .with("gyro biases", of_biases(biases_dph, 1) + EARTH_RATE_WITHIN)
            .with_found("  beyond", last.is_bias_beyond_stated.then_some(beyond))
            .with("state at the end", last.state.to_string())
    }
}

fn of_errors(errors: &Errors) -> Lines {
    let Errors { inclination_rmse_deg, heading_rmse_deg, coverage_percent, compared, .. } = errors;
    let [one, two, three] = coverage_percent;
    Lines::new(&format!("Against the truth, in {compared} samples"))
        .with("inclination", format!("{inclination_rmse_deg:.4}° RMS"))
        .with("heading", format!("{heading_rmse_deg:.4}° RMS after one constant offset"))
        .with("within 1, 2, 3 σ", format!("{one:.1}, {two:.1}, {three:.1} % of the tilts"))
}

fn inclination(off: &[Off]) -> Figure {
    let tilt = |axis: usize| move |off: &Off| (off.time_s, off.tilts_deg[axis]);
    let limits = |off: &Off| Point::within(off.time_s, 0.0, off.sigma_deg);
    let series = vec![
        Series::of("±1σ", Style::Band, off, limits),
        Series::of("about north of the level frame", Style::Line, off, tilt(1)),
        Series::of("about east of the level frame", Style::Line, off, tilt(0)),
        Series::of("inclination", Style::Dashed, off, |off| (off.time_s, off.inclination_deg)),
    ];
    Figure::over_time("Error of the vertical, where the truth counts", ["tilt", "°"], series)
}

fn heading(off: &[Off]) -> Figure {
    let series = vec![Series::of("heading", Style::Line, off, |off| (off.time_s, off.heading_deg))];
    Figure::over_time("Error of the heading after one constant offset", ["heading", "°"], series)
}

fn sigma(moments: &[Moment]) -> Figure {
    let of = |moment: &Moment| (moment.time_s, degrees(moment.level_sigma));
    let series = vec![Series::of("1σ of pitch and of roll", Style::Line, moments, of)];
    // From what is known of them before the first sample, a half turn, down to arcseconds.
    let sigma = Axis::logarithmic("1σ", "°");
    Figure::new("How good pitch and roll are", ["time", "s"], sigma, series)
}

/// How far the level could be relied on when.
fn timeline(replay: &Replay) -> Timeline {
    let phases = &replay.phases;
    let ends = phases.iter().skip(1).map(|(from_s, _)| *from_s);
    let ends = ends.chain(replay.moments.last().map(|last| last.time_s));
    let stretch = |((from_s, trust), to_s): (&(f64, Trust), f64)| {
        let words = format!("{} for {:.1} s", name(*trust), to_s - from_s);
        Some(Stretch { from_s: *from_s, to_s, kind: kind(*trust)?, words })
    };
    Timeline::of(vec![Lane::new("level", phases.iter().zip(ends).filter_map(stretch))])
}

/// The accelerometers correct the level, the gyros carry it alone, or it is lost; none before there is one.
fn kind(trust: Trust) -> Option<Kind> {
    match trust {
        Trust::Level => Some(Kind::Used),
        Trust::Coasting | Trust::FreeFall | Trust::NoForce => Some(Kind::Coasting),
        Trust::RotationLost => Some(Kind::Wrong),
        Trust::Starting => None,
    }
}

fn level(moments: &[Moment]) -> Figure {
    let of = |index: usize| {
        move |moment: &Moment| (moment.time_s, degrees(angles(moment.attitude)[index]))
    };
    let series = vec![
        Series::of("pitch", Style::Line, moments, of(1)),
        Series::of("roll", Style::Line, moments, of(2)),
    ];
    Figure::over_time("Pitch and roll", ["angle", "°"], series)
}

fn biases(moments: &[Moment]) -> Figure {
    let axes = ["forward", "right", "down"].into_iter().enumerate();
    let series = axes.flat_map(|(axis, name)| {
        let bias = move |moment: &Moment| degrees_per_hour(moment.biases[axis].0);
        let sigma = move |moment: &Moment| degrees_per_hour(moment.bias_sigmas[axis].0);
        let limits =
            move |moment: &Moment| Point::within(moment.time_s, bias(moment), sigma(moment));
        [
            Series::of(&format!("{name} ±1σ"), Style::Band, moments, limits),
            Series::of(name, Style::Line, moments, move |moment| (moment.time_s, bias(moment))),
        ]
    });
    Figure::over_time(
        "Biases of the gyros, including the horizontal Earth rate, as they were learnt",
        ["bias", "°/h"],
        series,
    )
}
