//! From the motor's field to the stage: steps, hard ends, backlash, ringing, reference switches.
//!
//! The motor turns at a constant velocity from one command to the next. Within such a segment the
//! rotor first crosses what is left of the backlash, then takes the stage along, and stops for good
//! where the stage meets an end; the moments of both are known when the segment begins, so the
//! motion does not depend on how often it is looked at.

use embassy_time::Instant;

use super::ringing::Ringing;
use crate::stage::{StageState, Unevenness};

/// Period of a hybrid stepper motor: four full steps of 256 microsteps. A field that jumps takes the
/// rotor to the nearest of its equal positions, which are so far apart.
const PERIOD_MICROSTEPS: f64 = 1024.0;

/// A microstep (1/256 of a full step) of the stage, rad: 200 full steps in a turn of the motor, which is behind
/// a worm gear of 1:90.
const RAD_PER_MICROSTEP: f64 = core::f64::consts::TAU / (200.0 * 256.0 * 90.0);

/// Mechanics of the stage; angles clockwise from above, not wrapped. Ends, switches and start are
/// angles of the gear, which an uneven one shows as up to Σ `ε_k`/k more or less at the stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageConfiguration {
    /// Angle at power-on, where the motor counts zero, rad, within the travel.
    pub start_rad: f64,
    /// Hard ends, rad, lower first: the stage stops there and the motor loses steps. Default −10° and
    /// +370°.
    pub travel_rad: [f64; 2],
    /// The left switch is closed below the first of these angles, the right one above the second,
    /// rad. Default −5° and +365°.
    pub switches_rad: [f64; 2],
    /// A mark on the stage itself that closes the left switch from the first of these angles to the second of
    /// every turn, rad, both within a turn, in place of the switches at the ends. Default none.
    pub mark_rad: Option<[f64; 2]>,
    /// Play between motor and stage, rad at the stage, ≥ 0: half of it to either side at power-on.
    pub backlash_rad: f64,
    /// Undamped frequency at which the stage rings, Hz; zero (the default) for a rigid stage.
    pub ringing_hz: f64,
    /// Damping ratio of the ringing, [0, 1): it decays as exp(−2π·ratio·frequency·t).
    pub ringing_damping: f64,
    /// Unevenness of the last gear.
    pub unevenness: Unevenness,
}

impl StageConfiguration {
    /// A stage that turns without end, its cables led through a slip ring: no hard ends, and in place of
    /// reference switches a mark from 30° to 40°. Everything else is the default.
    #[must_use]
    pub fn endless() -> Self {
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        let mark_rad = Some([30.0, 40.0].map(f64::to_radians));
        Self { travel_rad: everywhere, switches_rad: everywhere, mark_rad, ..Self::default() }
    }
}

impl Default for StageConfiguration {
    fn default() -> Self {
        Self {
            start_rad: 0.0,
            travel_rad: [-10.0, 370.0].map(f64::to_radians),
            switches_rad: [-5.0, 365.0].map(f64::to_radians),
            mark_rad: None,
            backlash_rad: 0.0,
            ringing_hz: 0.0,
            ringing_damping: 0.0,
            unevenness: Unevenness::default(),
        }
    }
}

/// Resolution of the clock, s: play that is used up sooner is used up now.
const NOW_S: f64 = 1e-6;

/// A stretch of time in which the motor's field turns at one velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Segment {
    /// When the segment began.
    since: Instant,
    /// Field at the beginning, microsteps.
    field: f64,
    /// Rotor at the beginning, rad at the stage.
    rotor_rad: f64,
    /// Gear's output at the beginning, rad at the stage.
    output_rad: f64,
    /// Velocity of the field, rad/s at the stage.
    rate_rad_s: f64,
    /// When the stage goes along, s after the beginning; infinite for never.
    engaged_s: f64,
    /// When the stage meets an end, s after the beginning; infinite for never.
    ended_s: f64,
}

/// An angle within one turn, rad: from zero to 2π.
fn within_turn(angle_rad: f64) -> f64 {
    angle_rad - core::f64::consts::TAU * libm::floor(angle_rad / core::f64::consts::TAU)
}

/// The drive of the stage at work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Train {
    /// What the drive is like.
    configuration: StageConfiguration,
    /// What goes on since the latest command.
    segment: Segment,
    /// Rotor less field, microsteps: steps lost.
    lost: f64,
    /// Whether something holds the stage.
    held: bool,
    /// How the stage rings behind the gear.
    ringing: Ringing,
    /// Until when the ringing is followed.
    now: Instant,
    /// Stage angle and rate at that moment.
    pub(crate) state: StageState,
}

impl Train {
    /// A drive at rest, at the start of the clock.
    pub(crate) fn new(configuration: &StageConfiguration) -> Self {
        let c = *configuration;
        let segment = Segment {
            since: Instant::MIN,
            field: 0.0,
            rotor_rad: c.start_rad,
            output_rad: c.start_rad,
            rate_rad_s: 0.0,
            engaged_s: f64::INFINITY,
            ended_s: f64::INFINITY,
        };
        Self {
            configuration: c,
            segment,
            lost: 0.0,
            held: false,
            ringing: Ringing::new(c.ringing_hz, c.ringing_damping),
            now: Instant::MIN,
            state: c.unevenness.stage(StageState { angle_rad: c.start_rad, rate_rad_s: 0.0 }),
        }
    }

    /// Moves on to `now`; a moment in the past changes nothing. Free while the stage stands.
    #[inline]
    pub(crate) fn advance(&mut self, now: Instant) {
        if now <= self.now {
            return;
        }
        if self.segment.rate_rad_s != 0.0 || !self.ringing.is_at_rest() {
            self.swing(self.elapsed_s(self.now), self.elapsed_s(now));
            self.now = now;
            self.state = self.state_now();
        }
        self.now = now;
    }

    /// The field stands at `microsteps` and turns at `microsteps_per_s` from now on.
    pub(crate) fn drive(&mut self, microsteps: f64, microsteps_per_s: f64) {
        let jump = microsteps - self.field_now();
        let periods = libm::rint(jump / PERIOD_MICROSTEPS);
        self.begin(microsteps, microsteps_per_s, periods * PERIOD_MICROSTEPS, self.held);
    }

    /// The field stops where it is, as when its driver loses the supply.
    pub(crate) fn stop(&mut self) {
        self.begin(self.field_now(), 0.0, 0.0, self.held);
    }

    /// Something holds the stage, or lets it go; the field turns on.
    pub(crate) fn hold(&mut self, held: bool) {
        let microsteps_per_s = self.segment.rate_rad_s / RAD_PER_MICROSTEP;
        self.begin(self.field_now(), microsteps_per_s, 0.0, held);
    }

    /// Whether the motor cannot follow: the stage is held, or pushed against an end.
    pub(crate) fn is_blocked(&self) -> bool {
        self.held || self.elapsed_s(self.now) >= self.segment.ended_s
    }

    /// Left and right reference switch.
    pub(crate) fn switches(&self) -> [bool; 2] {
        if let Some([from, to]) = self.configuration.mark_rad {
            let angle_rad = within_turn(self.state.angle_rad);
            return [from <= angle_rad && angle_rad < to, false];
        }
        let [left, right] = self.configuration.switches_rad;
        let output = self.output_at(self.elapsed_s(self.now));
        [output < left, output > right]
    }

    /// How far the stage has turned beyond the edge of the mark that it met last, microsteps; zero without a
    /// mark.
    pub(crate) fn beyond_edge(&self) -> f64 {
        let Some([from, to]) = self.configuration.mark_rad else { return 0.0 };
        let StageState { angle_rad, rate_rad_s } = self.state;
        let since = |edge: f64| within_turn(angle_rad - edge);
        let [from, to] = if rate_rad_s < 0.0 {
            [from, to].map(|edge| since(edge) - core::f64::consts::TAU)
        } else {
            [from, to].map(since)
        };
        (if from.abs() < to.abs() { from } else { to }) / RAD_PER_MICROSTEP
    }

    /// Seconds from the beginning of the segment.
    fn elapsed_s(&self, at: Instant) -> f64 {
        at.as_micros().saturating_sub(self.segment.since.as_micros()) as f64 * 1e-6
    }

    /// Where the field stands, microsteps.
    fn field_now(&self) -> f64 {
        let turned_rad = self.segment.rate_rad_s * self.elapsed_s(self.now);
        self.segment.field + turned_rad / RAD_PER_MICROSTEP
    }

    /// Rotor, rad at the stage.
    fn rotor_at(&self, elapsed_s: f64) -> f64 {
        let segment = &self.segment;
        if self.held || segment.rate_rad_s == 0.0 {
            return segment.rotor_rad;
        }
        segment.rotor_rad + segment.rate_rad_s * elapsed_s.min(segment.ended_s)
    }

    /// Where the gear holds the stage, rad.
    fn output_at(&self, elapsed_s: f64) -> f64 {
        self.follow(self.segment.output_rad, self.rotor_at(elapsed_s))
    }

    /// Velocity of the gear's output, rad/s.
    fn output_rate_at(&self, elapsed_s: f64) -> f64 {
        let segment = &self.segment;
        let driven = segment.engaged_s <= elapsed_s && elapsed_s < segment.ended_s;
        if driven { segment.rate_rad_s } else { 0.0 }
    }

    /// For how long the motor has turned the stage since the latest command, s.
    pub(crate) fn driven_s(&self) -> f64 {
        let Segment { engaged_s, ended_s, .. } = self.segment;
        (self.elapsed_s(self.now).min(ended_s) - engaged_s).max(0.0)
    }

    /// An output that a rotor takes along when the play between them is used up, within the travel.
    fn follow(&self, output_rad: f64, rotor_rad: f64) -> f64 {
        let play = 0.5 * self.configuration.backlash_rad;
        let [low, high] = self.configuration.travel_rad;
        output_rad.max(rotor_rad - play).min(rotor_rad + play).max(low).min(high)
    }

    /// Begins a segment now, with a field that has jumped by some whole periods of the rotor.
    fn begin(&mut self, field: f64, microsteps_per_s: f64, jumped: f64, held: bool) {
        let elapsed_s = self.elapsed_s(self.now);
        let (output_rad, rate_rad_s) = (self.output_at(elapsed_s), self.output_rate_at(elapsed_s));
        if self.held || elapsed_s > self.segment.ended_s {
            self.lost = self.microsteps(self.rotor_at(elapsed_s)) - self.field_now();
        }
        self.lost -= jumped;
        let rotor_rad = if held { self.rotor_at(elapsed_s) } else { self.rotor_within(field) };
        self.held = held;
        self.segment = self.segment_from(field, rotor_rad, output_rad, microsteps_per_s);
        if held {
            self.ringing.quench();
        } else {
            let jump_rad = self.segment.output_rad - output_rad;
            self.ringing.kick(jump_rad, self.output_rate_at(0.0) - rate_rad_s);
        }
        self.state = self.state_now();
    }

    /// The rotor where a field takes it, rad; it loses what an end does not let it turn.
    fn rotor_within(&mut self, field: f64) -> f64 {
        let play = 0.5 * self.configuration.backlash_rad;
        let [low, high] = self.configuration.travel_rad;
        let free = self.configuration.start_rad + (field + self.lost) * RAD_PER_MICROSTEP;
        let rotor_rad = free.max(low - play).min(high + play);
        if rotor_rad != free {
            self.lost = self.microsteps(rotor_rad) - field;
        }
        rotor_rad
    }

    /// Microsteps from power-on to a rotor's angle.
    fn microsteps(&self, rotor_rad: f64) -> f64 {
        (rotor_rad - self.configuration.start_rad) / RAD_PER_MICROSTEP
    }

    /// The segment that begins now with a rotor, a stage and a velocity.
    fn segment_from(&self, field: f64, rotor: f64, output: f64, microsteps_per_s: f64) -> Segment {
        let [low, high] = self.configuration.travel_rad;
        let rate_rad_s = microsteps_per_s * RAD_PER_MICROSTEP;
        let play = libm::copysign(0.5 * self.configuration.backlash_rad, rate_rad_s);
        let end = if rate_rad_s < 0.0 { low } else { high };
        let output_rad = self.follow(output, rotor);
        let (mut engaged_s, mut ended_s) = (f64::INFINITY, f64::INFINITY);
        if rate_rad_s != 0.0 && !self.held {
            engaged_s = (output_rad + play - rotor) / rate_rad_s;
            engaged_s = if engaged_s < NOW_S { 0.0 } else { engaged_s };
            ended_s = ((end + play - rotor) / rate_rad_s).max(0.0);
        }
        let since = self.now;
        Segment { since, field, rotor_rad: rotor, output_rad, rate_rad_s, engaged_s, ended_s }
    }

    /// Follows the ringing through a part of the segment.
    fn swing(&mut self, from_s: f64, to_s: f64) {
        let Segment { rate_rad_s, engaged_s, ended_s, .. } = self.segment;
        let mut reached_s = from_s;
        if from_s < engaged_s && engaged_s <= to_s && engaged_s < ended_s {
            self.ringing.pass(engaged_s - from_s);
            self.ringing.kick(0.0, rate_rad_s);
            reached_s = engaged_s;
        }
        self.ringing.pass(to_s - reached_s);
        if ended_s <= to_s {
            self.ringing.quench();
        }
    }

    /// Angle and rate of the stage now.
    fn state_now(&self) -> StageState {
        let elapsed_s = self.elapsed_s(self.now);
        let [low, high] = self.configuration.travel_rad;
        self.configuration.unevenness.stage(StageState {
            angle_rad: (self.output_at(elapsed_s) + self.ringing.offset_rad).max(low).min(high),
            rate_rad_s: self.output_rate_at(elapsed_s) + self.ringing.rate_rad_s,
        })
    }
}
