//! Reference table (etalon): one quarter of the cosine on a 10″ grid, made at build time.
//!
//! Entry `k` is 2³¹ cos(k · 10″) rounded to nearest, as `u32` because a signed 32-bit fraction
//! cannot hold cos 0 = 1. Neighbours differ little from a straight line: of every sixteenth entry all bits are kept, and of
//! each the byte by which it is above the chord between two of these. By this and by symmetry 40 512 bytes of flash serve
//! the full circle, sine and cosine, and any step that is a multiple of 10″, exactly.

use crate::checksum::crc32;
use crate::units::Angle;

/// Grid steps in one turn; one step is 10″.
pub const TURN: i32 = 129_600;

/// Grid steps in half a turn.
pub(crate) const HALF: i32 = TURN / 2;

/// Grid steps in a quarter of a turn.
pub(crate) const QUARTER: i32 = TURN / 4;

/// Number of entries, both ends of the quarter included.
pub const ENTRIES: usize = 32_401;

/// One grid step (10″) in rad.
pub const STEP: f64 = core::f64::consts::TAU / TURN as f64;

/// [`STEP`] in units of 2⁻³² rad.
const STEP_IN_32_BITS: i64 = (STEP * 4_294_967_296.0) as i64;

/// The value of cos 0 in table units.
pub const ONE: f64 = 2_147_483_648.0;

/// Steps that a chord spans.
const SPAN: usize = 16;

/// The table as it is kept.
#[derive(Clone, Copy, Debug)]
pub struct Quarter {
    /// Every sixteenth entry: where a chord begins. The last one ends beyond the quarter.
    pub chords: [u32; ENTRIES / SPAN + 2],
    /// How far each entry is above its chord, the fraction of the chord cut off and less one.
    pub above: [u8; ENTRIES],
}

impl Quarter {
    /// Entry number `index`; [`None`] beyond the quarter. Some ten instructions.
    #[must_use]
    #[inline]
    pub fn entry(&self, index: usize) -> Option<u32> {
        let above = u32::from(*self.above.get(index)?);
        let [from, to] = [self.chords[index / SPAN], self.chords[index / SPAN + 1]];
        let below = (from.wrapping_sub(to)).wrapping_mul((index % SPAN) as u32) / SPAN as u32 + 1;
        Some(from.wrapping_add(above).wrapping_sub(below))
    }
}

/// The table as built. A board that wants it in a flash section of its own copies it into a
/// `static` there and passes that to [`Table::new`].
pub static QUARTER_COSINE: Quarter = include!(concat!(env!("OUT_DIR"), "/quarter_cosine.rs"));

/// CRC-32 (IEEE 802.3) of the entries as little-endian bytes, computed at build time.
pub const CHECKSUM: u32 = include!(concat!(env!("OUT_DIR"), "/quarter_cosine_crc.rs"));

/// Error of a table whose bits differ from those that were built: the flash is damaged and must be
/// programmed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChecksumMismatch {
    /// CRC-32 of the entries that were read.
    pub found: u32,
}

/// Full-circle access to a quarter table anywhere in memory.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// The quarter.
    quarter: &'static Quarter,
}

impl Table {
    /// Borrows `quarter`, laid out as [`QUARTER_COSINE`].
    #[must_use]
    pub const fn new(quarter: &'static Quarter) -> Self {
        Self { quarter }
    }

    /// The built-in table, where the linker placed it.
    #[must_use]
    pub fn built_in() -> Self {
        Self::new(&QUARTER_COSINE)
    }

    /// Compares the CRC-32 of the entries with [`CHECKSUM`] (about 2 M instructions).
    ///
    /// # Errors
    /// [`ChecksumMismatch`] when any entry differs.
    pub fn verify(self) -> Result<(), ChecksumMismatch> {
        let found = crc32((0..ENTRIES).filter_map(|index| self.quarter.entry(index)));
        if found == CHECKSUM { Ok(()) } else { Err(ChecksumMismatch { found }) }
    }

    /// Table value 2³¹ cos(`index` · 10″) for any index, within ±0.5 (+1e-6); the symmetries of the
    /// cosine hold exactly.
    #[must_use]
    #[inline]
    pub fn cos(self, index: i32) -> i64 {
        let run = Run::at(index.rem_euclid(TURN));
        self.quarter.entry(run.index as usize).map_or(0, |entry| run.signed(entry))
    }

    /// Table value 2³¹ sin(`index` · 10″) for any index, within ±0.5 (+1e-6).
    #[must_use]
    #[inline]
    pub fn sin(self, index: i32) -> i64 {
        self.cos(index.rem_euclid(TURN) - QUARTER)
    }

    /// Cosine and sine of any angle in units of 2⁻³⁰, within ±2 (at most 1.7 were found): the
    /// grid's values, rotated to the angle to first order. The second order, at most 0.32, is
    /// neglected, and fractions of a unit are cut off. Some 50 instructions.
    #[must_use]
    #[inline]
    pub fn at(self, angle: Angle) -> [i32; 2] {
        let steps = u64::from(angle.0) * TURN as u64;
        let index = ((steps + (1 << 31)) >> 32) as i32;
        // Distance beyond the grid point, in 2⁻³² of a step: at most half a step either way.
        let beyond = steps.wrapping_sub((index as u64) << 32) as i32;
        // Distance in units of 2⁻³² rad.
        let beyond = (i64::from(beyond) * STEP_IN_32_BITS) >> 32;
        let quarter = if index < QUARTER { index + TURN - QUARTER } else { index - QUARTER };
        let (cosine, sine) = (self.on_circle(index), self.on_circle(quarter));
        [(cosine - ((sine * beyond) >> 32)) >> 1, (sine + ((cosine * beyond) >> 32)) >> 1]
            .map(|value| value as i32)
    }

    /// Value of [`Self::cos`] for an index from 0 to [`TURN`].
    #[inline]
    fn on_circle(self, index: i32) -> i64 {
        let run = Run::at(if index == TURN { 0 } else { index });
        self.quarter.entry(run.index as usize).map_or(0, |entry| run.signed(entry))
    }

    /// Values of [`Self::cos`] and [`Self::sin`] as `f64`, exact.
    #[inline]
    pub(crate) fn phasor(self, index: i32) -> (f64, f64) {
        (self.cos(index) as f64, self.sin(index) as f64)
    }

    /// Calls `visit` with 2³¹ cos((`start` + i `step`) · 10″) − `values[i]` for every i.
    ///
    /// Inside one quadrant the walk is a plain stride, and the test that the entry exists is also
    /// the test that the quadrant ends: this loop is most of the cost of an exact evaluation.
    #[inline]
    pub(crate) fn residuals(
        self,
        start: i32,
        step: i32,
        values: &[i64],
        mut visit: impl FnMut(i64),
    ) {
        let (mut position, mut rest) = (start.rem_euclid(TURN), values.iter());
        loop {
            let mut run = Run::at(position);
            let stride = if run.mirrored { -step } else { step };
            while let Some(entry) = self.quarter.entry(run.index as usize) {
                let Some(value) = rest.next() else { return };
                visit(run.signed(entry) - value);
                run.index += stride;
            }
            position = run.position().rem_euclid(TURN);
        }
    }
}

/// Position of a walk over the circle in the quarter table.
struct Run {
    /// Index into the quarter; outside of it, also below zero, the quadrant has ended.
    index: i32,
    /// Position on the circle of index 0.
    origin: i32,
    /// Whether the index falls as the position rises.
    mirrored: bool,
    /// Sign mask: 0, or −1 where the cosine is negative.
    sign: i64,
}

impl Run {
    /// Run that begins at `position` on the circle, 0 to [`TURN`] − 1.
    #[inline]
    fn at(position: i32) -> Self {
        let (origin, mirrored, sign) = match position / QUARTER {
            0 => (0, false, 0),
            1 => (HALF, true, -1),
            2 => (HALF, false, -1),
            _ => (TURN, true, 0),
        };
        Self { index: (position - origin).abs(), origin, mirrored, sign }
    }

    /// Position on the circle, possibly outside of one turn.
    fn position(&self) -> i32 {
        if self.mirrored { self.origin - self.index } else { self.origin + self.index }
    }

    /// Entry with the quadrant's sign.
    #[inline]
    fn signed(&self, entry: u32) -> i64 {
        (i64::from(entry) ^ self.sign) - self.sign
    }
}
