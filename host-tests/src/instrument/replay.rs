//! Drives both halves of an instrument again by the inputs of a run, without a board: they do what they did.

use std::path::Path;

use hal_mock::earth::Attitude;
use orientation::alignment::setup::SetupError;
use orientation::alignment::{Method, Request, rotating, stepwise, stops};
use orientation::attitude::{Keeper, Report};
use orientation::navigation::{self, Aligner, Navigator, Order, Output, aligner};
use orientation::signal::{InertialSample, Sample, Timed};
use serde::de::DeserializeOwned;

use super::kept::{Kept, Point, Realignments};
use super::latest::Latest;
use super::recorder::turning_rows;
use crate::interrupt;
use crate::methods::{Course, rotating as turning, stepwise as standing, stops as stopping};
use crate::outcome::Finished;
use crate::outcome::kept::finished;
use crate::recording::inputs::{Carrier, End, Given, Line, Reader};
use crate::recording::{Body, GIVEN, Problem, ReadError, Truth};
use crate::report::Stretch;

/// What came of the inputs of a run.
pub struct Replayed {
    /// The alignment, or that an azimuth was kept where none stands.
    pub finished: Box<dyn Finished>,
    /// The rows that figures show, where there are any.
    pub body: Option<Body>,
    /// What was kept beside and after it.
    pub done: Done,
}

/// What both halves did, beside the truth.
#[derive(Default)]
pub struct Done {
    /// What was kept, with the truth, which is not a number where the file lacks it.
    pub kept: Kept,
    /// How later azimuths agreed with what was kept.
    pub realignments: Realignments,
    /// Whether the inputs break off, in the file or by an interruption.
    breaks_off: bool,
    /// What was true at the end; for errors alone.
    pub truth: Truth,
    /// That the file breaks off, where it does.
    pub warning: Option<String>,
    /// Whether the alignment was concluded before its own end, because the inputs end there.
    pub is_cut_short: bool,
    /// What earlier alignments did that found an azimuth, too.
    pub earlier: Vec<Stretch>,
}

impl Done {
    /// The session, concluded with what it has been given where the inputs break off while no azimuth is known.
    fn concluded<S, M: Method<S> + Course>(&mut self, session: Latest<M>) -> M {
        self.earlier = session.earlier::<S>();
        let breaks_off = self.breaks_off && self.kept.with_azimuth().next().is_none();
        let (session, is_cut_short) = session.into_session(breaks_off);
        self.is_cut_short = is_cut_short;
        session
    }
}

/// Replays a file of inputs.
///
/// # Errors
/// The file cannot be read, or a line does not do; the words name both.
pub fn replay(path: &Path) -> Result<Replayed, ReadError> {
    let (header, mut lines) = Reader::open(path)?;
    replay_lines(&header.given, &mut lines)
}

/// Replays the lines below a header.
///
/// # Errors
/// As [`replay`].
pub fn replay_lines(given: &Given, lines: &mut Reader<'_>) -> Result<Replayed, ReadError> {
    match &given.carrier {
        Carrier::Stage(of) => positions(false, of, given, lines),
        Carrier::TwoFrame(of) => positions(true, of, given, lines),
        Carrier::Turntable(of) => turntable(of, given, lines),
        Carrier::Vehicle(of) => vehicle(of, given, lines),
    }
}

/// Replays a stage, or a mount of two frames.
fn positions(
    is_mounted: bool,
    of: &(stepwise::setting::Setting, stepwise::session::procedure::Procedure),
    given: &Given,
    lines: &mut Reader<'_>,
) -> Result<Replayed, ReadError> {
    let mut session = Latest::of(begun(standing::mounted(is_mounted, of.clone()), lines)?);
    let mut done = drive(&mut session, given, lines, |_: &Sample| ())?;
    let session = done.concluded::<Sample, _>(session);
    let method = if is_mounted { standing::POSITIONS } else { standing::name_of(&session) };
    let assumed = standing::given_with(session.setting.half);
    let is_aligned = session.conclusion().is_some();
    let site = session.setting.site;
    let finished = finished(is_aligned, &site, standing::Replay { method, session, assumed });
    Ok(Replayed { finished, body: None, done })
}

/// Replays a platform that turns all the time.
fn turntable(
    (setting, procedure): &(rotating::Setting, rotating::session::Procedure),
    given: &Given,
    lines: &mut Reader<'_>,
) -> Result<Replayed, ReadError> {
    let begun = begun(rotating::Session::new(*setting, procedure.clone()), lines)?;
    let mut session = Latest::of(begun);
    let mut samples = Vec::new();
    let mut done = drive(&mut session, given, lines, |sample: &Sample| samples.push(*sample))?;
    let session = done.concluded::<Sample, _>(session);
    let (is_aligned, site) = (session.conclusion().is_some(), session.setting.site);
    let finished = finished(is_aligned, &site, turning::Replay::of_run(session));
    Ok(Replayed { finished, body: Some(Body::Rotating(turning_rows(&samples))), done })
}

/// Replays a vehicle; its stop criteria are those of a session that is given the samples alone, as in the run.
fn vehicle(
    (setting, procedure): &(stops::Setting, stops::session::Procedure),
    given: &Given,
    lines: &mut Reader<'_>,
) -> Result<Replayed, ReadError> {
    let begin = || begun(stops::Session::new(*setting, procedure.clone()), lines);
    let (mut session, beside) = (Latest::of(begin()?), begin()?);
    let mut seen = stopping::Replay::of(stopping::SIAP, beside, 0.0, vec![GIVEN.to_owned()]);
    let mut done = drive(&mut session, given, lines, |sample| seen.push(sample))?;
    let session = done.concluded::<InertialSample, _>(session);
    let is_aligned = session.conclusion().is_some();
    let site = session.setting.site;
    let finished = finished(is_aligned, &site, stopping::Replay { session, ..seen });
    Ok(Replayed { finished, body: None, done })
}

/// The session of the header, where that is possible.
fn begun<T>(session: Result<T, SetupError>, lines: &Reader<'_>) -> Result<T, ReadError> {
    session.map_err(|error| lines.error(Problem::InputsHeader(error.to_string())))
}

/// Drives a method and a navigator by all lines; `seen` gets the samples, too.
fn drive<S: Timed + DeserializeOwned>(
    method: &mut dyn Method<S>,
    given: &Given,
    lines: &mut Reader<'_>,
    mut seen: impl FnMut(&S),
) -> Result<Done, ReadError> {
    let (mut attitudes, mut done) = (Vec::new(), Done::default());
    let mut keeper = Keeper::new(&given.attitude);
    let mut halves = Halves::new(method, Navigator::new(&mut keeper, &given.policy));
    while let Some(line) = lines.read()? {
        match line {
            Line::Sample(sample) => {
                seen(&sample);
                halves.sample(&sample);
            }
            Line::Aligner(input) => halves.align(&input),
            Line::Navigator(input) => halves.navigate(&input),
            Line::TruthAttitude([azimuth_rad, pitch_rad, roll_rad]) => {
                attitudes.push(Attitude { azimuth_rad, pitch_rad, roll_rad });
            }
            Line::End(End { truth_azimuth_deg, truth_start_azimuth_deg, .. }) => {
                done.truth.azimuth_deg = truth_azimuth_deg;
                done.truth.start_azimuth_deg = truth_start_azimuth_deg;
            }
        }
        if halves.has_diverged {
            return Err(lines.error(Problem::Diverged));
        }
    }
    let Halves { reports, realignments, .. } = halves;
    attitudes.resize(reports.len(), UNKNOWN);
    let both = reports.into_iter().zip(attitudes);
    done.kept.points = both.map(|(report, truth)| Point { report, truth }).collect();
    let breaks_off = lines.breaks_off();
    // An interruption is told elsewhere.
    let warning = if interrupt::ended().is_some() { None } else { lines.warning() };
    Ok(Done { realignments, breaks_off, warning, ..done })
}

/// An attitude that the file does not hold.
const UNKNOWN: Attitude =
    Attitude { azimuth_rad: f64::NAN, pitch_rad: f64::NAN, roll_rad: f64::NAN };

/// Both halves of an instrument, and what they did.
struct Halves<'h, S> {
    aligner: Aligner<'h, S>,
    navigator: Navigator<'h>,
    /// The navigator's orders.
    orders: Vec<Order>,
    reports: Vec<Report>,
    realignments: Realignments,
    /// Whether an input is none that the halves have come to.
    has_diverged: bool,
}

impl<'h, S: Timed> Halves<'h, S> {
    fn new(method: &'h mut dyn Method<S>, navigator: Navigator<'h>) -> Self {
        let (orders, reports, realignments, has_diverged) = Default::default();
        let mut aligner = Aligner::new(method);
        let request = aligner.begin(&mut |_| ());
        let mut this = Self { aligner, navigator, orders, reports, realignments, has_diverged };
        this.compute(request);
        this
    }

    /// Computes what the latest request announced, before anything else comes.
    fn compute(&mut self, mut request: Request) {
        while request == Request::Compute {
            request = self.aligner.compute(&mut |_| ());
        }
    }

    /// Gives the aligner a sample.
    fn sample(&mut self, sample: &S) {
        let request = self.aligner.sample(sample, &mut |_| ());
        self.compute(request);
    }

    /// Gives the aligner another input. Only the navigator begins and skips alignments.
    fn align(&mut self, input: &aligner::Input) {
        if let aligner::Input::Ordered(order @ (Order::Restart | Order::Skip)) = input {
            self.has_diverged |= !self.orders.contains(order);
        }
        let request = self.aligner.take(input, &mut |_| ());
        self.compute(request);
    }

    /// Gives the navigator an input. What was found is what the aligner hands over.
    fn navigate(&mut self, input: &navigation::Input) {
        if let navigation::Input::Found(at, azimuth) = input {
            self.has_diverged |= self.aligner.hand_over() != Some((*at, *azimuth));
            self.realignments.found.push((*at, *azimuth));
        }
        self.navigator.take(input, &mut |output| match output {
            Output::Report(report) => self.reports.push(report),
            Output::Order(order) => self.orders.push(order),
            Output::Progress(progress) => self.realignments.take(&progress),
            _ => {}
        });
    }
}
