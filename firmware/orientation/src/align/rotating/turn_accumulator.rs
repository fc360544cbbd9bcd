//! Follows a turning platform by its encoder: what was an uneven turn, what was a whole even one.
//!
//! ```text
//!  sample ─▶ block ─▶ eighth of a turn ─even, as before?─▶ turn ─▶ stretch (sense, speed)
//!                                        └─no──▶ the uneven stretch, or nothing
//! ```
//!
//! Only the encoder counts, wherever the command came from, so that a recording is followed as a
//! platform is.

use heapless::Vec;

use super::part::{AXES, Broken, EIGHTH, Ellipse, Forces, Part, Uneven, is_jump};
use super::solution::SPEEDS;
use super::turn::{Sense, Stretch, Turn};
use crate::align::etalon::Table;
use crate::device::Trouble;
use crate::math::Complex;
use crate::signal::Sample;
use crate::signal::phasor::{Block, Blocks, Reference, Sums};
use crate::units::{Angle, SpecificForce, TURN as WHOLE_TURN};

/// Most stretches: two speeds, both senses.
pub const STRETCHES: usize = 4;

/// Eighths in a turn.
const EIGHTHS: u32 = 8;
/// Blocks after which an eighth is given up: the platform stands.
const LONGEST_EIGHTH: u32 = 4096;
/// Part of an eighth with which the last one of a turn is whole enough: what is missing costs nothing,
/// since the fit knows of it.
const NEARLY: f64 = 0.8;
/// What the speeds of a stretch's turns may differ by.
const SAME_SPEED: f64 = 0.03;
/// By how much an encoder may have moved against the platform in what broke a turn, rad: 0.3°, twice
/// what an unevenness of 0.2 % makes of a quarter turn.
const SLIP: f64 = 0.3 / 360.0 * WHOLE_TURN;
/// Most that a slip breaks, rad, three eighths of a turn: after more the platform stood, or turned unevenly
/// and took on the speed again.
const LONGEST_BREAK: f64 = 0.375 * WHOLE_TURN;

/// Force at which an accelerometer of ±2 g clips, µm/s²: 97 % of it.
const FORCE_LIMIT: i32 = 19_000_000;
/// Forces at the limit, or equal ones in a row, that may be chance.
const FEW_FORCES: u32 = 64;

/// What is to be followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Nothing: the platform starts, stops or reverses.
    Ignore,
    /// A turn that is uneven on purpose.
    Uneven,
    /// Even turns.
    Even,
    /// Whatever comes: an uneven stretch first, then even turns.
    Recorded,
}

/// The turn accumulator at work.
#[derive(Clone, Debug)]
pub struct TurnAccumulator {
    blocks: Blocks,
    mode: Mode,
    /// The two latest blocks: one is taken when the platform's acceleration in it is known.
    latest: [Option<Block>; 2],
    reference: Option<Reference>,
    part: Part,
    turn: Sums,
    turn_forces: Forces,
    turn_seconds: f32,
    turn_ellipse: Ellipse,
    eighths: u32,
    /// What the eighths show of the encoder's error twice a turn, rad, summed over so many turns.
    ellipse: Complex,
    ellipse_turns: u32,
    /// Rate of the turn's first eighth, rad/s.
    speed: f32,
    uneven: Vec<Uneven, SPEEDS>,
    /// Whether the next uneven eighth does not count: the sensor still answers to what was before.
    is_settling: bool,
    stretches: Vec<Stretch, STRETCHES>,
    broken: Option<Broken>,
    /// The greatest slip of the encoder, rad.
    slip: f64,
    last_force: SpecificForce,
    /// Equal forces in a row, now and at most; forces at the limit.
    repeated: u32,
    most_repeated: u32,
    clipped: u32,
}

impl TurnAccumulator {
    /// A turn accumulator with blocks of so many sample periods.
    #[must_use]
    pub fn new(periods: u32, mode: Mode) -> Self {
        Self {
            blocks: Blocks::of(periods),
            mode,
            latest: [None; 2],
            reference: None,
            part: Part::default(),
            turn: Sums::default(),
            turn_forces: Forces::default(),
            turn_seconds: 0.0,
            turn_ellipse: Ellipse::default(),
            eighths: 0,
            ellipse: Complex::default(),
            ellipse_turns: 0,
            speed: 0.0,
            uneven: Vec::new(),
            is_settling: true,
            stretches: Vec::new(),
            broken: None,
            slip: 0.0,
            last_force: SpecificForce(0),
            repeated: 0,
            most_repeated: 0,
            clipped: 0,
        }
    }

    /// What is followed.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The stretches of even turns so far.
    #[must_use]
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The uneven stretches so far, one for each speed.
    #[must_use]
    pub fn uneven(&self) -> &[Uneven] {
        &self.uneven
    }

    /// By how much the encoder slipped, rad; zero where it did not.
    #[must_use]
    pub fn slip(&self) -> f64 {
        self.slip
    }

    /// The error ε sin(2θ + ψ) of the encoder that would make the platform turn as evenly as can be, as ε e^{jψ}, rad.
    #[must_use]
    pub fn ellipse(&self) -> Complex {
        self.ellipse.scaled(1.0 / f64::from(self.ellipse_turns.max(1)))
    }

    /// What is followed from now on.
    pub fn follow(&mut self, mode: Mode) {
        self.mode = mode;
        self.restart();
    }

    /// Follows another uneven stretch, modulated by a line of this half width over its frequency.
    pub fn follow_uneven(&mut self, width: f64) {
        self.follow(Mode::Uneven);
        // One beyond the speeds goes on with the last.
        let _ = self.uneven.push(Uneven { width, ..Uneven::default() });
    }

    /// There will be no more: a turn that lacks a little is whole enough.
    pub fn finish(&mut self) {
        if self.is_nearly_whole() {
            self.end_part();
        }
    }

    /// Forgets what is in progress: the next sample does not join on to the one before.
    pub fn restart(&mut self) {
        self.blocks.restart();
        self.is_settling = true;
        self.latest = [None; 2];
        self.broken = None;
        self.part = Part::default();
        self.begin_turn();
        if self.mode != Mode::Recorded || !self.stretches.is_empty() {
            self.reference = None;
        }
    }

    /// Takes a sample; whether it completed a turn. The platform's rate, rad/s, is that of the encoder's
    /// angles unless it was measured by itself.
    #[inline]
    pub fn push(&mut self, sample: &Sample, turning: Option<f32>) -> bool {
        let block = self.blocks.push(sample, turning);
        if self.mode == Mode::Ignore {
            if let Some(block) = block {
                self.latest(block, turning.is_some());
            }
            return false;
        }
        if let Some([along, across, _]) = sample.force {
            self.force([along, across], sample.stage);
        }
        block.is_some_and(|block| self.take(block, turning.is_some()))
    }

    /// The block before the latest one, with its neighbours, once there are three. By how much the encoder
    /// shows more or less in it alone than goes with its neighbours, and with its own rate where that was
    /// measured, is a slip, in whatever mode.
    fn latest(&mut self, next: Block, is_measured: bool) -> Option<[Block; 3]> {
        let [before, block] = self.latest;
        self.latest = [block, Some(next)];
        let (before, block) = (before?, block?);
        let (mut least, mut greatest) =
            (before.turning.min(next.turning), before.turning.max(next.turning));
        if is_measured {
            (least, greatest) = (least.min(block.turning), greatest.max(block.turning));
        }
        let shown = block.turned as f32 * (Angle::STEP as f32) / block.seconds;
        let beyond = shown - shown.max(least).min(greatest);
        if beyond != 0.0 {
            self.note_slip(f64::from(beyond * block.seconds));
        }
        Some([before, block, next])
    }

    fn note_slip(&mut self, slip: f64) {
        if slip.abs() > SLIP.max(self.slip.abs()) {
            self.slip = slip;
        }
    }

    /// Takes a force, unless it stands at the limit of its range.
    fn force(&mut self, forces: [SpecificForce; AXES], stage: Angle) {
        let [along, _] = forces;
        self.repeated = if along == self.last_force { self.repeated + 1 } else { 0 };
        self.most_repeated = self.most_repeated.max(self.repeated);
        self.last_force = along;
        if along.0.abs() >= FORCE_LIMIT {
            self.clipped += 1;
        } else {
            let phasor = Table::built_in().at(stage);
            self.part.forces.push(phasor, forces.map(|force| force.0));
        }
    }

    /// What is wrong with the accelerometer, if anything is.
    #[must_use]
    pub fn accelerometer(&self) -> Option<Trouble> {
        if self.clipped > FEW_FORCES {
            Some(Trouble::Saturated)
        } else if self.most_repeated > FEW_FORCES {
            Some(Trouble::Stuck)
        } else {
            None
        }
    }

    /// Takes the block before the latest two, whose neighbours are both known.
    #[inline(never)]
    fn take(&mut self, next: Block, is_measured: bool) -> bool {
        let Some([before, block, next]) = self.latest(next, is_measured) else { return false };
        let seconds = block.seconds + 0.5 * (before.seconds + next.seconds);
        let quickening = (next.turning - before.turning) / seconds;
        // A block beside a jump may hold a part of it.
        let is_beside = is_jump(block.turning, next.turning);
        let has_turned = (is_beside || self.part.jumps_to(block.turning)) && self.cut();
        if is_beside {
            self.note_break(block.turned, block.seconds);
            return has_turned;
        }
        let reference = *self.reference.get_or_insert_with(|| Reference::of(&block));
        self.part.push(&block, quickening, &reference);
        if self.part.reached() >= EIGHTH {
            return self.end_part();
        }
        if self.part.rows > LONGEST_EIGHTH {
            self.restart();
        }
        has_turned
    }

    /// Ends the eighth in progress before the platform's rate jumps: it counts where it is the last of a
    /// turn and nearly whole; whether that completed the turn.
    fn cut(&mut self) -> bool {
        if self.is_nearly_whole() {
            return self.end_part();
        }
        let part = core::mem::take(&mut self.part);
        self.judge_slip(&part, false, false);
        if self.eighths > 0 {
            self.give_up_turn();
        }
        if !self.is_before_even() {
            self.reference = None;
        }
        false
    }

    /// Whether the eighth in progress is the last of a turn and lacks but a little.
    fn is_nearly_whole(&self) -> bool {
        let reached = self.part.reached() as f64;
        self.eighths == EIGHTHS - 1 && reached > NEARLY * EIGHTH as f64
    }

    /// Puts an eighth where it belongs; whether it completed a turn.
    fn end_part(&mut self) -> bool {
        let ahead = (self.part.reached() - EIGHTH).max(0);
        let part = core::mem::replace(&mut self.part, Part { ahead, ..Part::default() });
        if self.mode == Mode::Uneven {
            self.take_uneven(&part);
            return false;
        }
        let (is_even, is_alike) = (part.is_even(), part.is_alike(self.speed));
        self.judge_slip(&part, is_even, is_alike);
        if self.eighths > 0 && !(is_even && is_alike) {
            self.give_up_turn();
        }
        if is_even {
            return self.take_even(&part);
        }
        self.leave(&part);
        false
    }

    /// Adds an even eighth to the turn; whether that completed it.
    fn take_even(&mut self, part: &Part) -> bool {
        if self.eighths == 0 {
            self.speed = part.speed();
        }
        self.turn.absorb(&part.products);
        self.turn_forces.add(&part.forces);
        self.turn_seconds += part.seconds;
        self.turn_ellipse.push(part);
        self.eighths += 1;
        self.eighths == EIGHTHS && self.end_turn()
    }

    /// Completes a turn; whether it counts.
    fn end_turn(&mut self) -> bool {
        let reference = self.reference.take().unwrap_or_default();
        let (sense, speed) = (Sense::of(f64::from(self.speed)), f64::from(self.speed.abs()));
        let seconds = f64::from(self.turn_seconds);
        let forces = [0, 1].map(|axis| self.turn_forces.regression(axis));
        let Some(stretch) = self.stretch(sense, speed, reference.time) else {
            self.begin_turn();
            return false;
        };
        self.ellipse = self.ellipse + self.turn_ellipse.error(seconds);
        self.ellipse_turns += 1;
        let since = self.stretches[stretch].since();
        let turn = Turn::of(&self.turn, &reference, since, seconds, &forces);
        self.begin_turn();
        let Some(turn) = turn else { return false };
        self.stretches[stretch].push(turn);
        true
    }

    /// The place of the stretch at a speed; `None` where there are too many.
    fn stretch(&mut self, sense: Sense, speed: f64, since: u64) -> Option<usize> {
        let is_it = |stretch: &Stretch| {
            let is_same = (stretch.speed() - speed).abs() <= SAME_SPEED * speed;
            stretch.sense == sense && (is_same || stretch.turns().is_empty())
        };
        let found = self.stretches.iter().position(is_it);
        found.or_else(|| {
            self.stretches.push(Stretch::new(sense, since)).ok()?;
            Some(self.stretches.len() - 1)
        })
    }

    /// A turn that does not go on as it began: in a recording that has no turn yet it belongs to the
    /// uneven stretch.
    fn give_up_turn(&mut self) {
        if self.is_before_even() {
            let share = f64::from(self.eighths) / f64::from(EIGHTHS);
            let turned = Sense::of(f64::from(self.speed)).signed(share * WHOLE_TURN);
            let (turn, seconds) = (self.turn, f64::from(self.turn_seconds));
            if let Some(uneven) = self.uneven_in_progress() {
                uneven.sums.add(&turn);
                uneven.seconds += seconds;
                uneven.turned += turned;
            }
        }
        self.begin_turn();
    }

    /// Leaves an uneven eighth out, or keeps it with the uneven stretch.
    fn leave(&mut self, part: &Part) {
        if self.is_before_even() {
            self.take_uneven(part);
        } else {
            self.reference = None;
        }
    }

    fn take_uneven(&mut self, part: &Part) {
        if core::mem::take(&mut self.is_settling) || part.products.is_astray {
            return;
        }
        if let Some(uneven) = self.uneven_in_progress() {
            uneven.sums.absorb(&part.products);
            uneven.seconds += f64::from(part.seconds);
            uneven.turned += part.turned as f64 * Angle::STEP;
        }
    }

    fn uneven_in_progress(&mut self) -> Option<&mut Uneven> {
        if self.uneven.is_empty() {
            // There is room in an empty one.
            let _ = self.uneven.push(Uneven::default());
        }
        self.uneven.last_mut()
    }

    fn is_before_even(&self) -> bool {
        self.mode == Mode::Recorded && self.stretches.is_empty()
    }

    fn begin_turn(&mut self) {
        self.turn = Sums::default();
        self.turn_forces = Forces::default();
        self.turn_seconds = 0.0;
        self.turn_ellipse = Ellipse::default();
        self.eighths = 0;
    }

    /// Where the platform goes on as before after something broke a turn, what the encoder shows beyond
    /// that speed is a slip.
    fn judge_slip(&mut self, part: &Part, is_even: bool, is_alike: bool) {
        if is_even {
            let is_short =
                |broken: &Broken| f64::from(self.speed.abs() * broken.seconds) < LONGEST_BREAK;
            let broken = self.broken.take().filter(|broken| is_alike && is_short(broken));
            let slip = broken.map_or(0.0, |broken| broken.slip(self.speed));
            self.note_slip(slip);
        } else {
            self.note_break(part.turned, part.seconds);
        }
    }

    /// Adds to what breaks the even turns, where there were any.
    fn note_break(&mut self, turned: i64, seconds: f32) {
        if !self.stretches.is_empty() {
            let broken = self.broken.get_or_insert_default();
            broken.turned += turned;
            broken.seconds += seconds;
        }
    }
}
