//! Exceptions of the ARMv7-M: which is pending, which goes before which (Architecture Reference Manual, B1.5).

/// Number of the hard fault.
pub const HARD_FAULT: u32 = 3;
/// Number of the memory-management fault.
pub const MEMORY_FAULT: u32 = 4;
/// Number of the bus fault.
pub const BUS_FAULT: u32 = 5;
/// Number of the usage fault.
pub const USAGE_FAULT: u32 = 6;
/// Number of the supervisor call.
pub const SUPERVISOR_CALL: u32 = 11;
/// Number of the pendable request for system service.
pub const PENDABLE_SERVICE: u32 = 14;
/// Number of the core's timer.
pub const SYSTEM_TICK: u32 = 15;
/// Number of the first interrupt of a peripheral.
pub const FIRST_INTERRUPT: u32 = 16;
/// How many exceptions there are: 82 interrupts of this controller (RM0351, table 57) after those of the core.
pub const EXCEPTIONS: usize = 16 + 82;

/// Bits of a priority that the controller has: the upper four.
pub const PRIORITY_MASK: u8 = 0xF0;

/// Priority of code that no exception has interrupted: below all.
const THREAD: i32 = 256;

/// Registers of the core that hold exceptions back.
#[derive(Clone, Copy, Debug, Default)]
pub struct Masks {
    /// PRIMASK: all but faults.
    pub all: bool,
    /// FAULTMASK: faults too.
    pub faults: bool,
    /// BASEPRI: those of this priority and below it; zero for none.
    pub base: u8,
}

/// State of all exceptions.
#[derive(Clone, Debug)]
pub struct Exceptions {
    /// Whether each is enabled.
    pub enabled: [bool; EXCEPTIONS],
    /// Whether each is pending by a latch.
    pub pending: [bool; EXCEPTIONS],
    /// Whether the line of each is active, which makes it pending again.
    pub lines: [bool; EXCEPTIONS],
    /// Whether each is active: entered, and not returned from.
    pub active: [bool; EXCEPTIONS],
    /// Priority of each, the lower the more urgent; fixed for those below four.
    pub priorities: [u8; EXCEPTIONS],
}

impl Default for Exceptions {
    fn default() -> Self {
        let mut enabled = [false; EXCEPTIONS];
        // Those of the core need no bit, but for the three faults that SHCSR enables.
        [1, 2, HARD_FAULT, SUPERVISOR_CALL, 12, PENDABLE_SERVICE, SYSTEM_TICK]
            .iter()
            .for_each(|number| enabled[*number as usize] = true);
        let none = [false; EXCEPTIONS];
        Self { enabled, pending: none, lines: none, active: none, priorities: [0; EXCEPTIONS] }
    }
}

impl Exceptions {
    /// Priority of an exception.
    fn priority(&self, number: usize) -> i32 {
        match number {
            1..4 => number as i32 - 4,
            _ => i32::from(self.priorities[number]),
        }
    }

    /// Priority at which the core executes.
    fn executing(&self, masks: Masks) -> i32 {
        let active = (1..EXCEPTIONS).filter(|number| self.active[*number]);
        let by_exception = active.map(|number| self.priority(number)).min().unwrap_or(THREAD);
        let by_base = if masks.base == 0 { THREAD } else { masks.base.into() };
        let by_mask = if masks.faults { -1 } else if masks.all { 0 } else { THREAD };
        by_exception.min(by_base).min(by_mask)
    }

    /// Whether an exception waits to be taken, masks aside.
    pub fn waits(&self) -> bool {
        (1..EXCEPTIONS).any(|number| self.is_pending(number))
    }

    /// Whether an exception is enabled and pending.
    fn is_pending(&self, number: usize) -> bool {
        self.enabled[number] && (self.pending[number] || self.lines[number]) && !self.active[number]
    }

    /// The exception that is to be taken now: the most urgent that is pending, where it is more urgent than what is
    /// executed.
    pub fn next(&self, masks: Masks) -> Option<u32> {
        let pending = (1..EXCEPTIONS).filter(|number| self.is_pending(*number));
        let next = pending.min_by_key(|number| self.priority(*number))?;
        (self.priority(next) < self.executing(masks)).then_some(next as u32)
    }

    /// Whether a fault of this kind is taken as such, or becomes a hard fault: where it is disabled, or not urgent
    /// enough.
    pub fn escalates(&self, number: u32, masks: Masks) -> bool {
        let number = number as usize;
        !self.enabled[number] || self.priority(number) >= self.executing(masks)
    }

    /// Takes an exception.
    pub fn enter(&mut self, number: u32) {
        self.pending[number as usize] = false;
        self.active[number as usize] = true;
    }

    /// Returns from an exception.
    pub fn leave(&mut self, number: u32) {
        self.active[number as usize] = false;
    }

    /// Whether the core is in a handler that hard faults cannot interrupt.
    pub fn is_locked(&self, masks: Masks) -> bool {
        self.executing(masks) < 0
    }
}
