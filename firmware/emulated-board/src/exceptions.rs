//! Exceptions of the ARMv7-M: which is pending, which goes before which (Architecture Reference Manual, B1.5).

/// Number of the interrupt that nothing masks.
pub const NOT_MASKABLE: u32 = 2;
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

/// Some of the exceptions, by their numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Set(u128);

impl Set {
    /// Those of these numbers.
    const fn of(numbers: &[u32]) -> Self {
        let (mut bits, mut place) = (0, 0);
        while place < numbers.len() {
            bits |= 1 << numbers[place];
            place += 1;
        }
        Self(bits)
    }

    /// Whether an exception is one of them.
    #[must_use]
    pub const fn has(self, number: u32) -> bool {
        number < u128::BITS && self.0 >> number & 1 != 0
    }

    /// Puts an exception in, or takes it out.
    pub const fn put(&mut self, number: u32, is_in: bool) {
        self.0 = self.0 & !(1 << number) | (is_in as u128) << number;
    }

    /// Those of 32 interrupts of peripherals from this one on, as bits of a register.
    #[must_use]
    pub const fn interrupts(self, first: u32) -> u32 {
        (self.0 >> (FIRST_INTERRUPT + first)) as u32
    }

    /// Puts interrupts of peripherals in, or takes them out, by the bits of a register of 32 from this one on.
    pub const fn put_interrupts(&mut self, first: u32, bits: u32, are_in: bool) {
        let bits = (bits as u128) << (FIRST_INTERRUPT + first) & ((1 << EXCEPTIONS) - 1);
        self.0 = if are_in { self.0 | bits } else { self.0 & !bits };
    }

    /// Whether one of them is not of the others.
    #[must_use]
    pub const fn has_other_than(self, others: Self) -> bool {
        self.0 & !others.0 != 0
    }

    /// Whether it is none.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Their numbers, in rising order.
    fn numbers(self) -> impl Iterator<Item = u32> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let number = rest.trailing_zeros();
            rest &= rest.wrapping_sub(1);
            (number < 128).then_some(number)
        })
    }
}

/// State of all exceptions.
#[derive(Clone, Debug)]
pub struct Exceptions {
    /// Those that are enabled.
    pub enabled: Set,
    /// Those that are pending by a latch.
    pub pending: Set,
    /// Those of which the line is active, which makes them pending again.
    pub lines: Set,
    /// Those that are active: entered, and not returned from.
    pub active: Set,
    /// Priority of each, the lower the more urgent; fixed for those below four.
    pub priorities: [u8; EXCEPTIONS],
}

impl Default for Exceptions {
    fn default() -> Self {
        // Those of the core need no bit, but for the three faults that SHCSR enables.
        let enabled = Set::of(&[
            1,
            NOT_MASKABLE,
            HARD_FAULT,
            SUPERVISOR_CALL,
            12,
            PENDABLE_SERVICE,
            SYSTEM_TICK,
        ]);
        let none = Set::default();
        Self { enabled, pending: none, lines: none, active: none, priorities: [0; EXCEPTIONS] }
    }
}

impl Exceptions {
    /// Priority of an exception.
    fn priority(&self, number: u32) -> i32 {
        match number {
            1..4 => number.cast_signed() - 4,
            _ => i32::from(self.priorities[number as usize]),
        }
    }

    /// Priority at which the core executes.
    fn executing(&self, masks: Masks) -> i32 {
        let by_exception =
            self.active.numbers().map(|number| self.priority(number)).min().unwrap_or(THREAD);
        let by_base = if masks.base == 0 { THREAD } else { masks.base.into() };
        let by_mask = if masks.faults {
            -1
        } else if masks.all {
            0
        } else {
            THREAD
        };
        by_exception.min(by_base).min(by_mask)
    }

    /// Those that are enabled and wait to be taken.
    #[must_use]
    pub const fn waiting(&self) -> Set {
        Set(self.enabled.0 & self.requested().0 & !self.active.0)
    }

    /// Those that are pending: a line that is active does not make an exception pending that is being handled.
    #[must_use]
    pub const fn requested(&self) -> Set {
        Set(self.pending.0 | self.lines.0 & !self.active.0)
    }

    /// Whether an exception waits to be taken, masks aside.
    #[must_use]
    pub const fn waits(&self) -> bool {
        !self.waiting().is_empty()
    }

    /// The most urgent of these: of two that are as urgent, that of the lower number.
    fn first(&self, set: Set) -> Option<u32> {
        set.numbers().min_by_key(|number| self.priority(*number))
    }

    /// The most urgent one that is enabled and pending, whether it can be taken or not.
    #[must_use]
    pub fn most_urgent(&self) -> Option<u32> {
        self.first(Set(self.enabled.0 & self.requested().0))
    }

    /// The exception that is to be taken now: the most urgent that is pending, where it is more urgent than what is
    /// executed.
    #[must_use]
    pub fn next(&self, masks: Masks) -> Option<u32> {
        let next = self.first(self.waiting())?;
        (self.priority(next) < self.executing(masks)).then_some(next)
    }

    /// Whether an exception ends the wait for an interrupt: one that would be taken if the mask of all were not
    /// (B1.5.19).
    #[must_use]
    pub fn wakes(&self, masks: Masks) -> bool {
        self.next(Masks { all: false, ..masks }).is_some()
    }

    /// Whether a fault of this kind is taken as such, or becomes a hard fault: where it is disabled, or not urgent
    /// enough.
    #[must_use]
    pub fn escalates(&self, number: u32, masks: Masks) -> bool {
        !self.enabled.has(number) || self.priority(number) >= self.executing(masks)
    }

    /// Whether no exception is active but this one, if it is.
    #[must_use]
    pub const fn is_base(&self, number: u32) -> bool {
        self.active.0 & !(1 << number) == 0
    }

    /// Takes an exception.
    pub const fn enter(&mut self, number: u32) {
        self.pending.put(number, false);
        self.active.put(number, true);
    }

    /// Returns from an exception; one that is not active stays so.
    pub const fn leave(&mut self, number: u32) {
        if self.active.has(number) {
            self.active.put(number, false);
        }
    }

    /// Whether the core is in a handler that hard faults cannot interrupt.
    #[must_use]
    pub fn is_locked(&self, masks: Masks) -> bool {
        self.executing(masks) < 0
    }
}
