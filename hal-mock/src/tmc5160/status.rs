//! Flags: what the chip reports of its ramp, its switches, its load and its bridges.

use super::map::address;
use super::ramp::Stops;
use super::{ChipFault, FREE_RUNNING, Tmc5160};

/// `RAMP_STAT` (6.3.2.2).
mod ramp_stat {
    /// The left switch is active.
    pub const STOP_L: u32 = 1;
    /// The right switch is active.
    pub const STOP_R: u32 = 1 << 1;
    /// XLATCH was taken at the left switch.
    pub const LATCH_L: u32 = 1 << 2;
    /// XLATCH was taken at the right switch.
    pub const LATCH_R: u32 = 1 << 3;
    /// The left switch stops the motor.
    pub const EVENT_STOP_L: u32 = 1 << 4;
    /// The right switch stops the motor.
    pub const EVENT_STOP_R: u32 = 1 << 5;
    /// A stall has stopped the motor.
    pub const EVENT_STOP_SG: u32 = 1 << 6;
    /// The target was reached since the bit was cleared.
    pub const EVENT_POS_REACHED: u32 = 1 << 7;
    /// The velocity is that of VMAX.
    pub const VELOCITY_REACHED: u32 = 1 << 8;
    /// XACTUAL is XTARGET.
    pub const POSITION_REACHED: u32 = 1 << 9;
    /// VACTUAL is zero.
    pub const VZERO: u32 = 1 << 10;
    /// The rest after a stop lasts.
    pub const ZEROWAIT: u32 = 1 << 11;
    /// The ramp had to turn back to reach the target.
    pub const SECOND_MOVE: u32 = 1 << 12;
    /// The motor stalls.
    pub const STATUS_SG: u32 = 1 << 13;
    /// Bits that a written one clears.
    pub const CLEARABLE: u32 = LATCH_L | LATCH_R | EVENT_STOP_SG | EVENT_POS_REACHED | SECOND_MOVE;
}

/// A driver was switched off for an error (`drv_err`, 6.1).
const DRV_ERR: u32 = 1 << 1;
/// The charge pump's voltage is too low (`uv_cp`, 6.1).
const UV_CP: u32 = 1 << 2;

/// The motor stalls (`StallGuard`, 6.5.5).
const STALLED: u32 = 1 << 24;
/// The motor has not moved for some time (stst).
const STANDSTILL: u32 = 1 << 31;

/// TSTEP at rest (6.2).
const REST: u32 = (1 << 20) - 1;

/// Clocks until a motor counts as standing, by `GCONF.faststandstill`.
const STILL: [u64; 2] = [1 << 20, 1 << 18];

/// TSTEP·velocity, with the ramp's fine velocity.
const STEP_PRODUCT: u64 = 1 << 41;

/// A bit where something holds, else zero.
const fn flag(is_set: bool, bit: u32) -> u32 {
    if is_set { bit } else { 0 }
}

impl Tmc5160 {
    /// What a register holds.
    fn written(&self, address: u8) -> u32 {
        self.registers[usize::from(address)]
    }

    /// What a read of a register gives.
    pub(super) fn value(&self, address: u8) -> u32 {
        match address {
            address::IOIN => self.inputs(),
            address::TSTEP => self.step_time(),
            address::XACTUAL => self.ramp.position().cast_unsigned(),
            address::VACTUAL => self.ramp.velocity().cast_unsigned() & 0x00FF_FFFF,
            address::RAMP_STAT => self.ramp_status(),
            address::MSCNT => self.wave_index(),
            address::MSCURACT => wave(self.wave_index()) | wave(self.wave_index() + 256) << 16,
            address::DRV_STATUS => self.driver_status(),
            _ => self.written(address),
        }
    }

    /// Clears flags by ones.
    pub(super) fn clear(&mut self, address: u8, ones: u32) {
        match address {
            address::GSTAT => {
                self.registers[usize::from(address::GSTAT)] &= !ones;
                self.catch_errors();
            }
            address::RAMP_STAT => {
                self.events &= !(ones & ramp_stat::CLEARABLE);
                self.ramp.stalled &= ones & ramp_stat::EVENT_STOP_SG == 0;
                self.ramp.second_move &= ones & ramp_stat::SECOND_MOVE == 0;
            }
            _ => self.registers[usize::from(address)] &= !ones,
        }
    }

    /// Global flags of errors that persist; a short stays until the bridges are switched off.
    pub(super) fn catch_errors(&mut self) {
        let errors = match self.chip_fault {
            ChipFault::Overheated => DRV_ERR,
            ChipFault::Short => flag(self.is_enabled(), DRV_ERR),
            ChipFault::ChargePumpLow => UV_CP,
            _ => 0,
        };
        self.registers[usize::from(address::GSTAT)] |= errors;
    }

    /// Notes events.
    pub(super) fn note(&mut self) {
        let is_reached = self.ramp.reached();
        self.events |= flag(is_reached && !self.was_reached, ramp_stat::EVENT_POS_REACHED);
        self.was_reached = is_reached;
        self.catch_errors();
    }

    /// Takes the status at the end of an access, for the next datagram (4.1.2).
    pub(super) fn latch(&mut self) {
        self.latched = self.spi_status();
    }

    /// `SPI_STATUS` (4.1.2).
    fn spi_status(&self) -> u8 {
        let (ramp, driver) = (self.ramp_status(), self.driver_status());
        let low = self.written(address::GSTAT) & 3;
        let middle = (driver >> 24 & 1) << 2 | (driver >> 31) << 3;
        let high = (ramp >> 8 & 3) << 4 | (ramp & 3) << 6;
        (low | middle | high) as u8
    }

    /// The register `RAMP_STAT` of this moment.
    fn ramp_status(&self) -> u32 {
        let [left, right] = self.switches();
        self.events
            | flag(left, ramp_stat::STOP_L)
            | flag(right, ramp_stat::STOP_R)
            | flag(self.ramp.is_stopped(-1), ramp_stat::EVENT_STOP_L)
            | flag(self.ramp.is_stopped(1), ramp_stat::EVENT_STOP_R)
            | flag(self.ramp.at_peak(), ramp_stat::VELOCITY_REACHED)
            | flag(self.ramp.reached(), ramp_stat::POSITION_REACHED)
            | flag(self.ramp.velocity() == 0, ramp_stat::VZERO)
            | flag(self.ramp.is_resting(), ramp_stat::ZEROWAIT)
            | flag(self.ramp.second_move, ramp_stat::SECOND_MOVE)
            | flag(self.is_stalling(), ramp_stat::STATUS_SG)
    }

    /// The register `DRV_STATUS` of this moment.
    fn driver_status(&self) -> u32 {
        let is_still = self.is_still();
        let load = if self.is_stalling() { 0 } else { FREE_RUNNING };
        let errors = match self.chip_fault {
            ChipFault::Overheated => 1 << 25 | 1 << 26,
            ChipFault::Short => flag(self.is_enabled(), 1 << 27),
            ChipFault::OpenLoad => flag(self.is_enabled() && !is_still, 1 << 29),
            _ => 0,
        };
        load | errors
            | flag(self.is_stalling(), STALLED)
            | flag(is_still, STANDSTILL)
            | self.current() << 16
    }

    /// IRUN, and IHOLD after the power-down delay.
    fn current(&self) -> u32 {
        let delay = u64::from(self.written(address::TPOWERDOWN)) << 18;
        let currents = self.written(address::IHOLD_IRUN);
        let is_held = self.is_still() && self.still > delay + self.stillness();
        (if is_held { currents } else { currents >> 8 }) & 0x1F
    }

    /// Clocks without a step after which the motor counts as standing.
    fn stillness(&self) -> u64 {
        STILL[(self.written(address::GCONF) >> 1 & 1) as usize]
    }

    /// Whether the motor counts as standing.
    fn is_still(&self) -> bool {
        self.still >= self.stillness()
    }

    /// Whether the bridges are on: an off time, and the enable pin.
    fn is_enabled(&self) -> bool {
        self.written(address::CHOPCONF) & 0xF != 0 && self.chip_fault != ChipFault::Disabled
    }

    /// The register IOIN of this moment.
    fn inputs(&self) -> u32 {
        let [left, right] = self.pins;
        let version = if self.chip_fault == ChipFault::Foreign { 0x11 } else { 0x30 };
        flag(left, 1)
            | flag(right, 1 << 1)
            | flag(self.chip_fault == ChipFault::Disabled, 1 << 4)
            | flag(self.chip_fault == ChipFault::StepMode, 1 << 6)
            | version << 24
    }

    /// The register TSTEP of this moment, clocks.
    fn step_time(&self) -> u32 {
        let speed = self.ramp.motion.velocity.unsigned_abs();
        STEP_PRODUCT.checked_div(speed).map_or(REST, |time| time.min(u64::from(REST)) as u32)
    }

    /// The register MSCNT of this moment.
    fn wave_index(&self) -> u32 {
        self.field().rem_euclid(super::PERIOD) as u32
    }

    /// The switches after swapping and polarity: 1 is active.
    fn switches(&self) -> [bool; 2] {
        let mode = self.written(address::SW_MODE);
        let [left, right] = self.pins;
        let (left, right) = if mode & (1 << 4) == 0 { (left, right) } else { (right, left) };
        [left ^ (mode & (1 << 2) != 0), right ^ (mode & (1 << 3) != 0)]
    }

    /// Takes over the switches and latches the position at their edges.
    pub(super) fn latch_switches(&mut self) {
        let mode = self.written(address::SW_MODE);
        let is_touched = [self.stops_seen & 1 != 0, self.stops_seen & 2 != 0];
        let edges = [(0, 5, ramp_stat::LATCH_L), (1, 7, ramp_stat::LATCH_R)];
        let switches = self.switches();
        for (side, bit, latch) in edges {
            let bit = if switches[side] { bit } else { bit + 1 };
            if switches[side] != is_touched[side] && mode & (1 << bit) != 0 {
                self.events |= latch;
                let edge = self.ramp.position().wrapping_sub(self.beyond);
                self.registers[usize::from(address::XLATCH)] = edge.cast_unsigned();
            }
        }
        self.stops_seen = u8::from(switches[0]) | u8::from(switches[1]) << 1;
        self.set_stops();
    }

    /// Shuts the directions of active switches; without `sg_stop` a stall is released.
    pub(super) fn set_stops(&mut self) {
        let mode = self.written(address::SW_MODE);
        let [left, right] = self.switches();
        self.ramp.obey(Stops {
            backward: left && mode & 1 != 0,
            forward: right && mode & 2 != 0,
            soft: mode & (1 << 11) != 0,
        });
        self.ramp.stalled &= mode & (1 << 10) != 0;
    }

    /// Stops on a stall above TCOOLTHRS (13.4), with the hysteresis of 6.2.
    pub(super) fn watch_load(&mut self) {
        let threshold = u64::from(self.written(address::TCOOLTHRS));
        let speed = self.ramp.motion.velocity.unsigned_abs();
        let shift = if self.written(address::GCONF) & (1 << 14) == 0 { 4 } else { 5 };
        let upper = (threshold - (threshold >> shift)).saturating_sub(1);
        let limit = if self.fast { threshold } else { upper };
        self.fast = speed * limit >= STEP_PRODUCT;
        if self.is_stalling() && self.written(address::SW_MODE) & (1 << 10) != 0 {
            self.events |= ramp_stat::EVENT_STOP_SG;
            self.ramp.stalled = true;
            self.ramp.halt();
        }
    }

    /// A blocked motor above the threshold, or one that a stall has stopped.
    fn is_stalling(&self) -> bool {
        self.ramp.stalled || (self.fast && self.blocked && self.ramp.velocity() != 0)
    }
}

/// The sine table after a reset (6.5), nine bits.
fn wave(index: u32) -> u32 {
    let phase = core::f64::consts::PI * (f64::from(2 * index + 1) / 1024.0);
    let value = libm::floor(248.0 * libm::sin(phase) + 0.5) as i32 - 1;
    value.cast_unsigned() & 0x1FF
}
