//! Attitude and heading reference (AHRS): gyrovertical and heading hold together. It takes samples
//! from switch-on and reports pitch, roll and azimuth.

use super::heading::{Heading, Mark, Realigned, frame_rate, is_upright};
use super::report::{Report, State};
use super::restart::{self, RecallRefusal, Remembered};
use super::setting::{Gyro, Setting};
use super::vertical::{Trust, Vertical, rates};
use crate::math::quaternion::{angles, angles_of, quaternion};
use crate::signal::InertialSample;
use crate::units::{
    DEGREE, Instant, MetresPerSecond, MetresPerSecondSquared, Radians, Seconds, wrapped,
};

use crate::alignment::Azimuth;

/// Greatest 1σ of the gyros' biases with which a rate of turn is stated, rad/s: half a degree a minute, which is what a
/// ship's indicator of it may err by at rest.
const KNOWN: f32 = (0.5 / 60.0 * DEGREE) as f32;

/// Standard deviation at which an azimuth carries no information, 1σ: it is withdrawn.
const NOWHERE: Radians = Radians(0.5);

/// What is shown to users of an attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shown {
    /// End of the latest sample.
    pub time: Instant,
    /// Pitch and roll.
    pub level: [Radians; 2],
    /// Standard deviation of each, 1σ.
    pub level_sigma: Radians,
    /// Azimuth; none where it is unknown.
    pub azimuth: Option<Azimuth>,
    /// Reliability of the level.
    pub state: State,
}

/// Propagates pitch, roll and azimuth.
#[derive(Clone, Debug)]
pub struct Keeper {
    /// Configuration of the sensors.
    setting: Setting,
    /// Gyrovertical.
    vertical: Vertical,
    /// Azimuth that is held, if there is one.
    heading: Option<Heading>,
    /// Time at which the azimuth was handed over.
    handed: Instant,
    /// Course at the time to which an azimuth belongs that is being computed.
    mark: Option<Mark>,
    /// Speed north and east, where it is known.
    speed: Option<[MetresPerSecond; 2]>,
    /// Reliability of the level.
    trust: Trust,
    /// Time since which the reliability has been the same.
    since: Instant,
}

impl Keeper {
    /// Begins without an azimuth.
    #[must_use]
    pub fn new(setting: &Setting) -> Self {
        Self {
            setting: *setting,
            vertical: Vertical::new(setting),
            heading: None,
            handed: Instant::default(),
            mark: None,
            speed: None,
            trust: Trust::Starting,
            since: Instant::default(),
        }
    }

    /// Takes a sample. Every sample from switch-on must be passed, also while an alignment runs.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) {
        if self.vertical.push(sample) {
            self.judge(sample.time);
        }
    }

    /// Updates the reliability, and withdraws an azimuth that has become meaningless.
    #[inline(never)]
    fn judge(&mut self, now: Instant) {
        if self.trust != self.vertical.trust {
            self.trust = self.vertical.trust;
            self.since = now;
        }
        let is_nowhere = |heading: &Heading| heading.sigma(&self.vertical) > NOWHERE.0;
        // The test is made only where σ grows fast: otherwise a new alignment or the end comes before.
        let grows_fast = self.trust == Trust::RotationLost || self.vertical.has_unlearnt_bias();
        if grows_fast && self.heading.as_ref().is_some_and(is_nowhere) {
            self.withdraw();
        }
    }

    /// Withdraws the azimuth.
    fn withdraw(&mut self) {
        self.heading = None;
        self.vertical.lose_north(self.frame_rate());
    }

    /// Replaces the gyro of the down axis by another one.
    pub fn exchange_down(&mut self, gyro: Gyro) {
        self.close_mark();
        if let Some(heading) = &mut self.heading {
            heading.restart(&gyro, &mut self.vertical);
        }
        self.go_on_from_mark();
        self.setting = self.setting.with_down(gyro);
        self.vertical.exchange_down(&self.setting);
    }

    /// Replaces the accelerometers by others, whose biases have this 1σ.
    pub fn exchange_forces(&mut self, bias_sigma: MetresPerSecondSquared) {
        if let Some(heading) = &mut self.heading {
            heading.exchange_forces();
        }
        if let Some(mark) = &mut self.mark {
            mark.exchange_forces();
        }
        self.setting.force_bias_sigma = bias_sigma;
        self.vertical.exchange_forces(&self.setting);
    }

    /// Adopts an azimuth of body x at the present time, in place of any previous one.
    pub fn hand_over(&mut self, azimuth: Azimuth) {
        self.close_mark();
        let [.., gyro] = &self.setting.gyros;
        let is_first = self.heading.is_none();
        self.heading = Some(Heading::begin(azimuth, gyro, &mut self.vertical));
        self.go_on_from_mark();
        self.handed = self.vertical.time();
        if is_first {
            self.vertical.find_north(self.frame_rate());
        } else {
            self.turn_frame();
        }
    }

    /// Takes that the base has stood while an alignment ran, which found north: where it swayed and never rested, it is by this
    /// that the biases of its gyros are learnt. To be called before the azimuth is handed over.
    pub fn learn_from_sway(&mut self) {
        self.vertical.learn_from_sway();
    }

    /// Marks the present course as that of a time, to which an azimuth belongs that is being computed. The count of the turn's
    /// error is restarted, so that nothing that is learnt later corrects the turn before, unless it is still needed from the
    /// start on.
    pub(crate) fn mark(&mut self, at: Instant, is_start_needed: bool) {
        let [.., gyro] = &self.setting.gyros;
        match &mut self.heading {
            Some(heading) => heading.restart(gyro, &mut self.vertical),
            None if is_start_needed => {}
            None => self.vertical.begin_course(),
        }
        self.mark = Some(Mark::new(at, &self.vertical));
    }

    /// An azimuth of a time, carried on to the present; [`None`] where that time was not marked.
    pub(crate) fn carried(&mut self, at: Instant, azimuth: Azimuth) -> Option<Azimuth> {
        let [.., gyro] = &self.setting.gyros;
        let mark = self.mark.take().filter(|mark| mark.at == at)?;
        Some(mark.carry(azimuth, gyro, &self.vertical))
    }

    /// Closes the error of the turn since the mark, of an azimuth that is being computed, before its count restarts.
    fn close_mark(&mut self) {
        let [.., gyro] = &self.setting.gyros;
        if let Some(mark) = &mut self.mark {
            mark.close(gyro, &self.vertical);
        }
    }

    /// Goes on from there, after the count of the error has restarted, or not.
    fn go_on_from_mark(&mut self) {
        if let Some(mark) = &mut self.mark {
            mark.go_on(&self.vertical);
        }
    }

    /// Combines a new alignment with the held azimuth. Where they contradict each other the azimuth
    /// is withdrawn.
    pub(crate) fn realign(&mut self, azimuth: Azimuth) -> Realigned {
        self.close_mark();
        let [.., gyro] = &self.setting.gyros;
        let realigned = match &mut self.heading {
            None => Realigned::Taken,
            Some(heading) => heading.realign(azimuth, gyro, &mut self.vertical),
        };
        self.go_on_from_mark();
        match realigned {
            Realigned::Taken => self.hand_over(azimuth),
            Realigned::Fused { .. } => self.turn_frame(),
            Realigned::Disagrees { .. } => self.withdraw(),
        }
        realigned
    }

    /// Sets the speed of the vehicle north and east; none where it is not known.
    pub(crate) fn move_at(&mut self, speed: Option<[MetresPerSecond; 2]>) {
        self.speed = speed;
        self.turn_frame();
    }

    /// Updates the rate of the level frame.
    fn turn_frame(&mut self) {
        self.vertical.frame = self.frame_rate();
    }

    /// Rate of the level frame, rad/s.
    fn frame_rate(&self) -> [f32; 3] {
        let north = self.heading.as_ref().map(|heading| heading.frame);
        frame_rate(self.setting.latitude, north, self.speed)
    }

    /// Present azimuth of body x; none where it is unknown.
    pub(crate) fn azimuth(&self) -> Option<Azimuth> {
        self.heading.as_ref().map(|heading| heading.azimuth(&self.vertical))
    }

    /// Reliability of the level, and the time since which it has been the same.
    pub(crate) fn state(&self) -> State {
        let since = Seconds(self.vertical.time().seconds() - self.since.seconds());
        State { trust: self.trust, seconds: since }
    }

    /// Whether the body is at rest.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.vertical.is_at_rest()
    }

    /// Whether body x may be upright, so that it has no azimuth.
    pub(crate) fn is_upright(&self) -> bool {
        is_upright(&self.vertical)
    }

    /// Whether an azimuth is held.
    pub(crate) fn has_azimuth(&self) -> bool {
        self.heading.is_some()
    }

    /// Whether a gyro's bias exceeded its stated 1σ by far.
    pub(crate) fn is_bias_beyond_stated(&self) -> bool {
        self.vertical.is_bias_beyond_stated
    }

    /// Present attitude with its uncertainties.
    #[must_use]
    pub fn report(&self) -> Report {
        let vertical = &self.vertical;
        let azimuth = self.azimuth();
        let [course, pitch, roll] = angles(vertical.attitude().parts());
        let course = azimuth.map_or(course, |azimuth| azimuth.angle.0);
        let time = vertical.time();
        let seconds = azimuth.map_or(0.0, |_| time.seconds() - self.handed.seconds());
        Report {
            time,
            pitch: Radians(pitch),
            roll: Radians(roll),
            level_sigma: Radians(vertical.sigma().into()),
            azimuth,
            attitude: quaternion([course, pitch, roll]),
            state: self.state(),
            is_at_rest: vertical.is_at_rest(),
            biases: rates(vertical.bias),
            bias_sigmas: rates(vertical.bias_sigmas()),
            is_bias_beyond_stated: vertical.is_bias_beyond_stated,
            seconds: Seconds(seconds),
        }
    }

    /// What is shown to users of the present attitude, ten times a second: angles to within 3·10⁻⁶ rad.
    pub(crate) fn show(&self) -> Shown {
        let vertical = &self.vertical;
        let matrix = vertical.attitude().rough_matrix();
        let [course, pitch, roll] = angles_of(&matrix).map(f64::from);
        let azimuth = |heading: &Heading| heading.azimuth_of(&matrix, course, vertical);
        Shown {
            time: vertical.time(),
            level: [pitch, roll].map(Radians),
            level_sigma: Radians(vertical.sigma().into()),
            azimuth: self.heading.as_ref().map(azimuth),
            state: self.state(),
        }
    }

    /// Mean rates of the body about its axes forward, right and down since they were taken last, rad/s, less the biases, and
    /// what they make of the rate of the azimuth of body x; [`None`] where nothing was measured, or a gyro was at the limit of
    /// its range. There is no rate of the azimuth while the biases are not known well enough for it, or where body x is
    /// upright.
    pub(crate) fn take_rates(&mut self) -> Option<([f32; 3], Option<f32>)> {
        let body = self.vertical.take_rates()?;
        let is_known = self.vertical.bias_sigmas().into_iter().all(|sigma| sigma <= KNOWN);
        Some((body, self.vertical.turn_rate(&body).filter(|_| is_known)))
    }

    /// State to be saved against a loss of supply; only at rest, and with an azimuth.
    pub(crate) fn remember(&self) -> Option<Remembered> {
        let report = self.report();
        let is_known = |azimuth: &Azimuth| report.is_at_rest && azimuth.sigma <= NOWHERE;
        let azimuth = report.azimuth.filter(is_known)?;
        Some(Remembered {
            azimuth: azimuth.angle,
            sigma: azimuth.sigma,
            pitch: report.pitch,
            roll: report.roll,
            rates: self.vertical.rest_rates()?,
            rest: Seconds(self.vertical.course.stood.into()),
        })
    }

    /// Adopts the azimuth saved before a loss of supply, if the body has not moved since as far as
    /// the sensors show. A turn that they would not show is in its σ.
    ///
    /// # Errors
    /// Reason for which the saved azimuth is rejected.
    pub(crate) fn recall(&mut self, remembered: &Remembered) -> Result<(), RecallRefusal> {
        let course = &self.vertical.course;
        let rest = (self.vertical.rest_rates(), Seconds(course.stood.into()));
        let turned = Radians(course.turned.into());
        let unseen = Radians(libm::sqrt(self.vertical.turn_variance().into()));
        let hidden =
            restart::check(remembered, &self.report(), rest, [turned, unseen], &self.setting)?;
        let angle = Radians(wrapped(remembered.azimuth.0 + turned.0));
        let sigma = Radians(libm::hypot(remembered.sigma.0, hidden.0));
        self.hand_over(Azimuth { angle, sigma });
        Ok(())
    }
}
