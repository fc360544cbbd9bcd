//! Segmentation of a rotating platform's recording by its encoder: into rate-modulated stretches
//! and whole turns at constant rate.
//!
//! ```text
//!  sample ─▶ block ─▶ eighth of a turn ─same rate as before?─▶ turn ─▶ stretch (sense, speed)
//!                                        └─no──▶ rate-modulated stretch, or discarded
//! ```
//!
//! Segmentation uses the encoder alone, not the commands, so that a recording is treated as a live
//! platform is.

use heapless::Vec;

use super::part::{AXES, Broken, EIGHTH, Ellipse, Forces, Modulated, Part, is_jump};
use super::turn::{SPEEDS, STRETCHES, Sense, Stretch, Turn};
use crate::device::Trouble;
use crate::math::{Complex, Table};
use crate::signal::Sample;
use crate::signal::phasor::{Block, Blocks, Sums};
use crate::units::{Angle, SpecificForce, TURN as WHOLE_TURN};

/// Number of eighths in a turn.
const EIGHTHS: u32 = 8;
/// Number of blocks after which an eighth is abandoned: the platform stands.
const LONGEST_EIGHTH: u32 = 4096;
/// Part of an eighth that suffices for the last one of a turn: the missing part costs nothing,
/// because the fit takes the true angles.
const NEARLY: f64 = 0.8;
/// Greatest relative difference between the speeds of a stretch's turns.
const SAME_SPEED: f64 = 0.03;
/// Least slip of the encoder that is detected in an interruption of a turn, rad: 0.3°, twice the
/// effect of 0.2 % of unevenness over a quarter turn.
const SLIP: f64 = 0.3 / 360.0 * WHOLE_TURN;
/// Longest interruption that counts as a slip, rad: three eighths of a turn. After a longer one the
/// platform stood, or turned unevenly and regained its speed.
const LONGEST_BREAK: f64 = 0.375 * WHOLE_TURN;

/// Force at which an accelerometer of ±2 g clips, µm/s²: 97 % of its range.
const FORCE_LIMIT: u32 = 19_000_000;
/// Number of forces at the limit, or equal in succession, that may be chance.
const FEW_FORCES: u32 = 64;

/// Kind of motion that is accumulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Nothing is accumulated: the platform starts, stops or reverses.
    Ignore,
    /// A rate-modulated turn.
    Modulated,
    /// Turns at constant rate.
    Even,
    /// A recording: a rate-modulated stretch first, if there is one, then turns at constant rate.
    Recorded,
}

/// Complete eighths of a turn.
#[derive(Clone, Copy, Debug, Default)]
struct Eighths {
    /// Sums of their blocks.
    sums: Sums,
    /// Force products.
    forces: Forces,
    /// Length, s.
    seconds: f32,
    /// Second-harmonic sums.
    ellipse: Ellipse,
    /// Number of eighths.
    count: u32,
}

/// State of the segmentation.
#[derive(Clone, Debug)]
pub struct TurnAccumulator {
    /// Averages samples into blocks.
    blocks: Blocks,
    /// Kind of motion that is accumulated.
    pub(crate) mode: Mode,
    /// The two latest blocks: a block is used when the platform's acceleration in it is known.
    latest: [Option<Block>; 2],
    /// Block from whose values those of the turn in progress are counted.
    reference: Option<Block>,
    /// Eighth in progress.
    part: Part,
    /// Complete eighths of the turn in progress.
    turn: Eighths,
    /// Encoder error twice per turn from the eighths, rad, summed over turns, and their number.
    ellipse: Complex,
    ellipse_turns: u32,
    /// Rate of the turn's first eighth, rad/s.
    speed: f32,
    /// Rate-modulated stretches so far, one for each speed.
    pub modulated: Vec<Modulated, SPEEDS>,
    /// Whether the next modulated eighth is skipped, because the sensor still responds to the
    /// previous motion.
    is_settling: bool,
    /// Stretches at constant rate so far.
    pub stretches: Vec<Stretch, STRETCHES>,
    /// Interruption in progress.
    broken: Option<Broken>,
    /// Greatest slip of the encoder so far, rad; zero without a slip.
    pub(super) slip: f64,
    /// Latest force along the sensitive axis.
    last_force: SpecificForce,
    /// Number of equal forces in succession, at present and at most; number of forces at the limit.
    repeated: u32,
    most_repeated: u32,
    clipped: u32,
}

impl TurnAccumulator {
    /// Accumulator with blocks of this many sample periods.
    #[must_use]
    pub fn new(periods: u32, mode: Mode) -> Self {
        Self {
            blocks: Blocks::of(periods),
            mode,
            latest: [None; 2],
            reference: None,
            part: Part::default(),
            turn: Eighths::default(),
            ellipse: Complex::default(),
            ellipse_turns: 0,
            speed: 0.0,
            modulated: Vec::new(),
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

    /// Discards all turns, in place; nothing is accumulated until [`Self::follow`].
    pub(crate) fn clear(&mut self) {
        self.stretches.clear();
        self.modulated.clear();
        self.follow(Mode::Ignore);
        (self.ellipse, self.ellipse_turns) = (Complex::default(), 0);
        (self.slip, self.speed) = (0.0, 0.0);
        (self.last_force, self.clipped) = (SpecificForce(0), 0);
        (self.repeated, self.most_repeated) = (0, 0);
    }

    /// Encoder error ε sin(2θ + ψ) that would make the platform's rotation as uniform as possible,
    /// as ε e^{jψ}, rad.
    pub(super) fn ellipse(&self) -> Complex {
        self.ellipse.scaled(1.0 / f64::from(self.ellipse_turns.max(1)))
    }

    /// Changes the kind of motion that is accumulated, and discards what is in progress.
    pub(crate) fn follow(&mut self, mode: Mode) {
        self.mode = mode;
        self.restart();
    }

    /// Begins another rate-modulated stretch, modulated by a spectral line of this half width over
    /// its frequency.
    pub(super) fn follow_modulated(&mut self, width: f64) {
        self.follow(Mode::Modulated);
        // With more stretches than speeds, the last one is continued.
        let _ = self.modulated.push(Modulated { width, ..Modulated::default() });
    }

    /// Ends the recording: a turn that is nearly complete counts.
    pub(crate) fn finish(&mut self) {
        if self.is_nearly_whole() {
            self.end_part();
        }
    }

    /// Discards the turn in progress, so that the next sample does not join on to the previous one.
    pub(crate) fn restart(&mut self) {
        self.blocks.restart();
        self.is_settling = true;
        self.latest = [None; 2];
        self.broken = None;
        self.part = Part::default();
        self.turn = Eighths::default();
        if self.mode != Mode::Recorded || !self.stretches.is_empty() {
            self.reference = None;
        }
    }

    /// Takes a sample; returns whether it completed a turn. The platform's rate, rad/s, follows
    /// from the encoder's angles unless it is given.
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

    /// The block before the latest one with its neighbours, once there are three. An encoder angle
    /// that in this block alone differs from its neighbours' rates, and from its own measured rate,
    /// is a slip, in any mode.
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

    /// Stores a slip, rad, if it is the greatest so far and beyond the limit.
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
        if along.0.unsigned_abs() >= FORCE_LIMIT {
            self.clipped += 1;
        } else {
            let phasor = Table::built_in().at(stage);
            self.part.forces.push(phasor, forces.map(|force| force.0));
        }
    }

    /// Fault of the accelerometer, if there is one: saturated or stuck.
    pub(super) fn accelerometer(&self) -> Option<Trouble> {
        let stuck = (self.most_repeated > FEW_FORCES).then_some(Trouble::Stuck);
        if self.clipped > FEW_FORCES { Some(Trouble::Saturated) } else { stuck }
    }

    /// Processes the block before the latest one, whose neighbours are both known.
    #[inline(never)]
    fn take(&mut self, next: Block, is_measured: bool) -> bool {
        let Some([before, block, next]) = self.latest(next, is_measured) else { return false };
        let seconds = block.seconds + 0.5 * (before.seconds + next.seconds);
        let quickening = (next.turning - before.turning) / seconds;
        // A block beside a jump of the rate may contain a part of it.
        let is_beside = is_jump(block.turning, next.turning);
        let has_turned = (is_beside || self.part.jumps_to(block.turning)) && self.cut();
        if is_beside {
            self.note_break(block.turned, block.seconds);
            return has_turned;
        }
        let reference = *self.reference.get_or_insert(block);
        self.part.push(&block, quickening, &reference);
        if self.part.reached() >= EIGHTH {
            return self.end_part();
        }
        if self.part.rows > LONGEST_EIGHTH {
            self.restart();
        }
        has_turned
    }

    /// Ends the eighth in progress before a jump of the platform's rate: it counts where it is the
    /// last of a turn and nearly complete. Returns whether that completed the turn.
    fn cut(&mut self) -> bool {
        if self.is_nearly_whole() {
            return self.end_part();
        }
        let part = core::mem::take(&mut self.part);
        self.judge_slip(&part, false, false);
        if self.turn.count > 0 {
            self.give_up_turn();
        }
        if !self.is_before_even() {
            self.reference = None;
        }
        false
    }

    /// Whether the eighth in progress is the last of a turn and nearly complete.
    fn is_nearly_whole(&self) -> bool {
        let reached = self.part.reached() as f64;
        self.turn.count == EIGHTHS - 1 && reached > NEARLY * EIGHTH as f64
    }

    /// Assigns a complete eighth; returns whether it completed a turn.
    fn end_part(&mut self) -> bool {
        let ahead = (self.part.reached() - EIGHTH).max(0);
        let part = core::mem::replace(&mut self.part, Part { ahead, ..Part::default() });
        if self.mode == Mode::Modulated {
            self.take_modulated(&part);
            return false;
        }
        let (is_even, is_alike) = (part.is_even(), part.is_alike(self.speed));
        self.judge_slip(&part, is_even, is_alike);
        if self.turn.count > 0 && !(is_even && is_alike) {
            self.give_up_turn();
        }
        if is_even {
            return self.take_even(&part);
        }
        if self.is_before_even() {
            self.take_modulated(&part);
        } else {
            self.reference = None;
        }
        false
    }

    /// Adds an eighth at constant rate to the turn; returns whether it completed the turn.
    fn take_even(&mut self, part: &Part) -> bool {
        if self.turn.count == 0 {
            self.speed = part.speed();
        }
        self.turn.sums.absorb(&part.products);
        self.turn.forces.add(&part.forces);
        self.turn.seconds += part.seconds;
        self.turn.ellipse.push(part);
        self.turn.count += 1;
        self.turn.count == EIGHTHS && self.end_turn()
    }

    /// Completes a turn; returns whether it could be used.
    fn end_turn(&mut self) -> bool {
        let reference = self.reference.take().unwrap_or_default();
        let (sense, speed) = (Sense::of(f64::from(self.speed)), f64::from(self.speed.abs()));
        let seconds = f64::from(self.turn.seconds);
        let forces = [0, 1].map(|axis| self.turn.forces.regression(axis));
        let Some(stretch) = self.stretch(sense, speed, reference.time) else {
            self.turn = Eighths::default();
            return false;
        };
        self.ellipse += self.turn.ellipse.error(seconds);
        self.ellipse_turns += 1;
        let since = self.stretches[stretch].since;
        let turn = Turn::of(&self.turn.sums, &reference, since, seconds, &forces);
        self.turn = Eighths::default();
        let Some(turn) = turn else { return false };
        self.stretches[stretch].push(turn);
        true
    }

    /// Index of the stretch at a speed, created if necessary; `None` where there are too many.
    fn stretch(&mut self, sense: Sense, speed: f64, since: u64) -> Option<usize> {
        let is_it = |stretch: &Stretch| {
            let is_same = (stretch.speed() - speed).abs() <= SAME_SPEED * speed;
            stretch.sense == sense && (is_same || stretch.turns.is_empty())
        };
        let found = self.stretches.iter().position(is_it);
        found.or_else(|| {
            self.stretches.push(Stretch::new(sense, since)).ok()?;
            Some(self.stretches.len() - 1)
        })
    }

    /// Abandons a turn that does not continue as it began. In a recording without complete turns it
    /// belongs to the rate-modulated stretch.
    fn give_up_turn(&mut self) {
        if self.is_before_even() {
            let share = f64::from(self.turn.count) / f64::from(EIGHTHS);
            let turned = Sense::of(f64::from(self.speed)).signed(share * WHOLE_TURN);
            let (turn, seconds) = (self.turn.sums, f64::from(self.turn.seconds));
            if let Some(modulated) = self.modulated_in_progress() {
                modulated.sums.add(&turn);
                modulated.seconds += seconds;
                modulated.turned += turned;
            }
        }
        self.turn = Eighths::default();
    }

    /// Adds an eighth to the rate-modulated stretch, unless the sensor settles or its rate is
    /// implausible.
    fn take_modulated(&mut self, part: &Part) {
        if core::mem::take(&mut self.is_settling) || part.products.is_clamped {
            return;
        }
        if let Some(modulated) = self.modulated_in_progress() {
            modulated.sums.absorb(&part.products);
            modulated.seconds += f64::from(part.seconds);
            modulated.turned += part.turned as f64 * Angle::STEP;
        }
    }

    /// Rate-modulated stretch in progress, created if there is none.
    fn modulated_in_progress(&mut self) -> Option<&mut Modulated> {
        if self.modulated.is_empty() {
            // An empty vector has room, so the push cannot fail.
            let _ = self.modulated.push(Modulated::default());
        }
        self.modulated.last_mut()
    }

    /// Whether a recording has not yet had a whole turn at constant rate.
    fn is_before_even(&self) -> bool {
        self.mode == Mode::Recorded && self.stretches.is_empty()
    }

    /// Detects a slip: where the platform continues at its speed after an interruption, the encoder
    /// angle beyond that speed is a slip.
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

    /// Extends the interruption, where there were turns at constant rate before.
    fn note_break(&mut self, turned: i64, seconds: f32) {
        if !self.stretches.is_empty() {
            let broken = self.broken.get_or_insert_default();
            broken.turned += turned;
            broken.seconds += seconds;
        }
    }
}
