//! Registers of the flash (RM0351, chapter 3) before its cells.

use std::time::Duration;

use execution::report::FlashUse;
use hal_mock::flash::{
    Bank, Cells, Ecc, Flash as Array, PAGE, ROW, Refused as NotProgrammed, SIZE, Times,
};

use super::Refused;
use crate::time::Time;

/// `FLASH_ACR`: the data cache is on.
const CACHES_DATA: u32 = 1 << 10;
/// `FLASH_CR`: stores program rows.
const PROGRAM: u32 = 1;
/// `FLASH_CR`: a page is erased.
const ERASE_PAGE: u32 = 2;
/// `FLASH_CR`: the page is one of the upper bank.
const IN_UPPER: u32 = 1 << 11;
/// `FLASH_CR`: the lower bank is erased.
const ERASE_LOWER: u32 = 4;
/// `FLASH_CR`: the upper bank is erased.
const ERASE_UPPER: u32 = 1 << 15;
/// `FLASH_CR`: the erasure begins.
const START: u32 = 1 << 16;
/// `FLASH_CR`: it cannot be written.
const LOCK: u32 = 1 << 31;
/// `FLASH_CR`: the option bytes cannot be written.
const LOCK_OPTIONS: u32 = 1 << 30;
/// `FLASH_CR`: the option bytes are programmed.
const START_OPTIONS: u32 = 1 << 17;
/// `FLASH_CR`: the option bytes are loaded, by a reset.
const LAUNCH: u32 = 1 << 27;
/// `FLASH_CR`: fast programming, interrupts of protected areas.
const UNUSUAL: u32 = 1 << 18 | 1 << 26;
/// The fastest clock of the core for each wait state and for none, Hz (RM0351, 3.3.3: 16 MHz in range 1 of the voltage,
/// with 5 % for an oscillator that no crystal holds).
const HERTZ_A_WAIT_STATE: u64 = 16_800_000;
/// The most wait states that serve it: `FLASH_ACR`, LATENCY.
const WAIT_STATES: u32 = 4;
/// `FLASH_ACR`: powers the flash down while the core runs or sleeps.
const POWER_DOWN: u32 = 3 << 13;
/// `FLASH_SR`: an operation has ended.
const DONE: u32 = 1;
/// `FLASH_SR`: the row was programmed before.
const PROGRAMMED: u32 = 1 << 3;
/// `FLASH_SR`: the stores are not those of a row.
const UNALIGNED: u32 = 1 << 5;
/// `FLASH_SR`: a store was shorter than a word.
const SIZE_ERROR: u32 = 1 << 6;
/// `FLASH_SR`: the control register does not ask for what is done.
const SEQUENCE: u32 = 1 << 7;
/// `FLASH_SR`: any error.
const ERRORS: u32 = 0x3FA;
/// `FLASH_SR`: an operation is under way.
const BUSY: u32 = 1 << 16;
/// `FLASH_CR`: the end of an operation interrupts.
const TELLS_END: u32 = 1 << 24;
/// `FLASH_ECCR`: a row that was corrected interrupts.
const TELLS_FINDING: u32 = 1 << 24;
/// `FLASH_ECCR`: a row was corrected.
const CORRECTED: u32 = 1 << 30;
/// `FLASH_ECCR`: a row cannot be corrected.
const BROKEN: u32 = 1 << 31;
/// `FLASH_CR`: an error interrupts.
const TELLS_ERROR: u32 = 1 << 25;
/// The keys that open the control register, in their order.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
/// The keys that open the option bytes, in their order (RM0351, 3.4.2).
const OPTION_KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];
/// The option bytes as delivered (RM0351, 3.4.1), brown-out level 0.
const DELIVERED: u32 = 0xFFEF_F8AA;
/// The brown-out level in them.
const BROWN_OUT_LEVEL: u32 = 7 << 8;
/// The option bytes of a board that has been started before: brown-out level 4.
const STARTED: u32 = DELIVERED | 4 << 8;
/// Time that the option bytes take: a page is erased, rows are programmed (DS10969, flash memory characteristics).
const OPTIONS_TAKE: Time = Time::microseconds(25_000);

/// A loss of supply that is injected: within an operation, at its beginning or at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Whether it falls in an operation on the pages of the log; otherwise in one on any other.
    pub is_in_log: bool,
    /// How many such operations, rows and pages, are begun before the one in which it falls.
    pub after: u64,
    /// Which part of that operation is over: 0 at its beginning, 1 where it has just been completed.
    pub reached: f64,
}

/// The flash with its registers.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own; all combine")]
pub struct Flash {
    /// The cells.
    pub array: Array<Box<Cells>>,
    /// `FLASH_ACR`.
    access: u32,
    /// `FLASH_SR` without the bit that says busy.
    status: u32,
    /// `FLASH_CR`.
    control: u32,
    /// `FLASH_ECCR`.
    ecc: u32,
    /// The first key was written.
    is_half_open: bool,
    /// The first half of a row: its offset and data.
    half: Option<(u32, u32)>,
    /// Whether something is under way whose end is to be told.
    is_running: bool,
    /// Whether a row was read that cannot be corrected, which interrupts.
    pub is_broken: bool,
    /// The bank that the core executes its program from. The core would wait for its instructions while that bank is
    /// erased or programmed, which is not modelled.
    pub program: Option<Bank>,
    /// What was done to it, but for the pages of the log.
    pub used: FlashUse,
    /// Operations on the pages of the log, rows and pages.
    pub log_operations: u64,
    /// `FLASH_OPTR`, as it was loaded or written.
    options: u32,
    /// The option bytes themselves.
    programmed_options: u32,
    /// The first key of the option bytes was written.
    are_options_half_open: bool,
    /// Until when the option bytes are programmed.
    options_busy: Time,
    /// Whether the program asks for the reset that loads the option bytes.
    pub launches: bool,
    /// When the supply is to be lost: a fault that is injected. It is over with the reset that follows.
    pub cut: Option<Cut>,
    /// When that is, once its operation has begun.
    cut_at: Time,
}

/// The time of the cells.
fn since_start(now: Time) -> Duration {
    Duration::from_nanos(now.as_nanoseconds())
}

impl Flash {
    /// An erased flash with typical times. The seed decides what a lost supply leaves.
    pub fn new(seed: u64) -> Self {
        // Vectors become boxes without a copy on the stack.
        let cells: Box<Cells> = vec![0; size_of::<Cells>()]
            .into_boxed_slice()
            .try_into()
            .unwrap_or_else(|_| unreachable!());
        Self {
            array: Array::erased(cells, Times::TYPICAL, seed),
            access: 0x600,
            status: 0,
            control: LOCK | LOCK_OPTIONS,
            ecc: 0,
            is_half_open: false,
            half: None,
            is_running: false,
            is_broken: false,
            program: None,
            used: FlashUse::default(),
            log_operations: 0,
            options: STARTED,
            programmed_options: STARTED,
            are_options_half_open: false,
            options_busy: Time::ZERO,
            launches: false,
            cut: None,
            cut_at: Time::NEVER,
        }
    }

    /// A reset: what is under way is torn, where the supply was cut as far as it was then.
    pub fn reset(&mut self, now: Time) {
        self.array.lose_supply(since_start(now.min(self.cut_at)));
        (self.access, self.status, self.control, self.ecc) = (0x600, 0, LOCK | LOCK_OPTIONS, 0);
        (self.is_half_open, self.half, self.is_running, self.is_broken) =
            (false, None, false, false);
        (self.cut, self.cut_at) = (None, Time::NEVER);
        (self.are_options_half_open, self.launches, self.options_busy) = (false, false, Time::ZERO);
    }

    /// Has the option bytes as delivered.
    pub fn deliver(&mut self) {
        (self.options, self.programmed_options) = (DELIVERED, DELIVERED);
    }

    /// Loads the option bytes, as a reset by the supply does, and one that is asked for.
    pub fn load_options(&mut self) {
        self.options = self.programmed_options;
    }

    /// Whether the supply at which the controller is reset is above the lowest at which it works, so that RAM keeps its
    /// content where the supply does not go on falling: any level but 0, which is 1.7 V.
    pub fn resets_before_ram_is_lost(&self) -> bool {
        self.options & BROWN_OUT_LEVEL != 0
    }

    /// Whether it is set to enough wait states for a clock of the core, Hz.
    pub fn keeps_up(&self, hertz: u64) -> bool {
        hertz <= HERTZ_A_WAIT_STATE * u64::from((self.access & 7).min(WAIT_STATES) + 1)
    }

    /// Whether an operation is under way.
    fn is_busy(&mut self, now: Time) -> bool {
        let is_busy = self.array.busy(since_start(now)).is_some();
        if !is_busy && std::mem::take(&mut self.is_running) && self.control & TELLS_END != 0 {
            self.status |= DONE;
        }
        is_busy
    }

    /// When the operation that is under way ends, or the supply is lost.
    pub fn due(&mut self, now: Time) -> Time {
        if !self.is_running {
            return self.cut_at;
        }
        let busy = self.array.busy(since_start(now));
        busy.map_or(now, |busy| Time::nanoseconds(busy.until.as_nanos() as u64)).min(self.cut_at)
    }

    /// Whether the supply is lost.
    pub fn is_cut(&self, now: Time) -> bool {
        self.cut_at <= now
    }

    /// An operation has begun. The supply may be lost in it.
    fn run(&mut self, now: Time) {
        self.is_running = true;
        let [log, others] = [self.log_operations, self.used.rows + self.used.pages];
        if let Some(Cut { reached, .. }) =
            self.cut.take_if(|cut| cut.after < if cut.is_in_log { log } else { others })
            && let Some(busy) = self.array.busy(since_start(now))
        {
            let lasts = busy.until.saturating_sub(since_start(now));
            self.cut_at = now + Time::seconds(lasts.mul_f64(reached).as_secs_f64());
        }
    }

    /// Completes what has ended.
    pub fn advance(&mut self, now: Time) {
        self.is_busy(now);
    }

    /// Whether it interrupts: an end or an error, where they are enabled.
    pub fn interrupts(&self) -> bool {
        self.control & TELLS_END != 0 && self.status & DONE != 0
            || self.control & TELLS_ERROR != 0 && self.status & ERRORS != 0
            || self.ecc & TELLS_FINDING != 0 && self.ecc & CORRECTED != 0
    }

    /// Reads a register.
    pub fn read(&mut self, offset: u32, now: Time) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 => self.access,
            0x10 if self.options_busy > now => BUSY | self.status,
            0x10 => (if self.is_busy(now) { BUSY } else { 0 }) | self.status,
            0x14 => self.control,
            0x18 => self.ecc,
            0x20 => self.options,
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32, now: Time) -> Result<(), Refused> {
        match offset {
            0x00 => self.write_access(value)?,
            0x08 => self.write_key(value)?,
            0x0C => self.write_option_key(value)?,
            0x20 if self.control & LOCK_OPTIONS == 0 => self.options = value,
            0x10 => self.status &= !value,
            0x14 if self.control & LOCK == 0 => self.write_control(value, now)?,
            // Locked, they keep what they hold.
            0x14 | 0x20 => {}
            0x18 => {
                let kept = self.ecc & !(value & (CORRECTED | BROKEN)) & !TELLS_FINDING;
                self.ecc = kept | (value & TELLS_FINDING);
            }
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// Writes `FLASH_ACR`.
    fn write_access(&mut self, value: u32) -> Result<(), Refused> {
        if value & POWER_DOWN != 0 {
            return Err(Refused::NotModelled("a flash without its power"));
        }
        self.array.switch_cache(value & CACHES_DATA != 0);
        if value & 1 << 12 != 0 {
            self.array.reset_cache();
        }
        self.access = value & !0x1800;
        Ok(())
    }

    /// Writes `FLASH_KEYR`, which opens the control register.
    fn write_key(&mut self, value: u32) -> Result<(), Refused> {
        match (self.control & LOCK != 0, self.is_half_open) {
            (false, _) => {}
            (true, false) if value == KEYS[0] => self.is_half_open = true,
            (true, true) if value == KEYS[1] => {
                (self.control, self.is_half_open) = (self.control & !LOCK, false);
            }
            _ => {
                return Err(Refused::NotModelled(
                    "a wrong key, which locks the flash until the next reset",
                ));
            }
        }
        Ok(())
    }

    /// Writes `FLASH_OPTKEYR`, which opens the option bytes once the control register is open.
    fn write_option_key(&mut self, value: u32) -> Result<(), Refused> {
        match (self.control & LOCK, self.are_options_half_open) {
            (0, false) if value == OPTION_KEYS[0] => self.are_options_half_open = true,
            (0, true) if value == OPTION_KEYS[1] => {
                self.control &= !LOCK_OPTIONS;
                self.are_options_half_open = false;
            }
            _ => {
                return Err(Refused::NotModelled(
                    "a wrong key, which locks the option bytes until the next reset",
                ));
            }
        }
        Ok(())
    }

    /// Writes `FLASH_CR`.
    fn write_control(&mut self, value: u32, now: Time) -> Result<(), Refused> {
        if value & UNUSUAL != 0 {
            return Err(Refused::NotModelled("fast programming or interrupts of protected areas"));
        }
        let are_options_open = self.control & LOCK_OPTIONS == 0;
        if value & START_OPTIONS != 0 && are_options_open {
            self.programmed_options = self.options;
            self.options_busy = now + OPTIONS_TAKE;
        }
        self.launches = value & LAUNCH != 0 && are_options_open;
        self.control = value & !(START | START_OPTIONS | LAUNCH)
            | if are_options_open { 0 } else { LOCK_OPTIONS };
        if value & START != 0 {
            self.erase(now)?;
        }
        Ok(())
    }

    /// Refuses an operation in a bank that the core executes its program from.
    ///
    /// # Errors
    /// It is that bank.
    pub fn leave_program(&self, bank: Bank) -> Result<(), Refused> {
        let is_program = self.program == Some(bank);
        let reason =
            "an erasure or a row in the bank of the program, which the core would wait for";
        Refused::where_asked(is_program.then_some(reason))
    }

    /// Erases what the control register says.
    fn erase(&mut self, now: Time) -> Result<(), Refused> {
        let page = (self.control >> 3 & 0xFF) as u8;
        let (bank, page) = match self.control & (ERASE_PAGE | ERASE_LOWER | ERASE_UPPER | PROGRAM) {
            ERASE_PAGE if self.control & IN_UPPER != 0 => (Bank::Upper, Some(page)),
            ERASE_PAGE => (Bank::Lower, Some(page)),
            ERASE_LOWER => (Bank::Lower, None),
            ERASE_UPPER => (Bank::Upper, None),
            _ => {
                self.status |= SEQUENCE;
                return Ok(());
            }
        };
        self.leave_program(bank)?;
        let time = since_start(now);
        let begun = match page {
            Some(page) => self.array.erase_page(bank, page, time),
            None => self.array.erase_bank(bank, time),
        };
        match begun {
            Ok(()) => {
                let start = bank.start() + u32::from(page.unwrap_or(0)) * PAGE as u32;
                let is_of_log = page.is_some() && LOG.contains(&start);
                *(if is_of_log { &mut self.log_operations } else { &mut self.used.pages }) += 1;
                self.run(now);
            }
            Err(_) => self.status |= SEQUENCE,
        }
        Ok(())
    }

    /// A store into the flash: the second word of a row programs it. Meanwhile the core waits where the store
    /// falls into an operation that is under way; then it says until when.
    pub fn store(&mut self, offset: u32, value: u32, size: u32, now: Time) -> Option<Time> {
        if let Some(busy) = self.array.busy(since_start(now)) {
            return Some(Time::nanoseconds(busy.until.as_nanos() as u64));
        }
        self.is_busy(now);
        if self.control & (PROGRAM | LOCK) != PROGRAM || self.status & ERRORS != 0 {
            self.status |= SEQUENCE;
            return None;
        }
        if size < 4 {
            self.status |= SIZE_ERROR;
            return None;
        }
        match self.half.take() {
            None if offset.is_multiple_of(ROW as u32) => self.half = Some((offset, value)),
            Some((start, first)) if offset == start + 4 => {
                let data = (u64::from(value) << 32 | u64::from(first)).to_le_bytes();
                match self.array.program(start, data, since_start(now)) {
                    Ok(()) => {
                        let is_of_log = LOG.contains(&start);
                        *(if is_of_log {
                            &mut self.log_operations
                        } else {
                            &mut self.used.rows
                        }) += 1;
                        self.used.rows_with_cache_on += u64::from(self.access & CACHES_DATA != 0);
                        self.run(now);
                    }
                    Err(NotProgrammed::Programmed) => self.status |= PROGRAMMED,
                    Err(_) => self.status |= SEQUENCE,
                }
            }
            _ => self.status |= UNALIGNED,
        }
        None
    }

    /// A load from the flash by the core, of up to eight bytes that do not leave a row, or until when it waits.
    pub fn load(&mut self, offset: u32, size: u32, now: Time) -> Result<u32, Time> {
        let read = self
            .array
            .load(offset, since_start(now))
            .map_err(|busy| Time::nanoseconds(busy.until.as_nanos() as u64))?;
        match read.ecc {
            Ecc::Sound => {}
            Ecc::Corrected => self.report(offset, CORRECTED),
            Ecc::Uncorrectable => {
                self.report(offset, BROKEN);
                self.is_broken = true;
            }
        }
        let place = offset as usize % ROW;
        let bytes = &read.bytes[place..(place + size as usize).min(ROW)];
        Ok(bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)))
    }

    /// Notes what the check of a row found; the address of the first finding stays.
    fn report(&mut self, offset: u32, flag: u32) {
        if self.ecc & (CORRECTED | BROKEN) == 0 {
            let bank = if offset as usize >= SIZE / 2 { 1 << 19 } else { 0 };
            let row = (offset % (SIZE as u32 / 2)) & !(ROW as u32 - 1);
            self.ecc = (self.ecc & TELLS_FINDING) | bank | row;
        }
        self.ecc |= flag;
    }
}

/// The pages of the store: the last two.
pub const STORE: std::ops::Range<u32> = (SIZE - 2 * PAGE) as u32..SIZE as u32;
/// The pages in which a board keeps lines of its log: the sixteen before them.
pub const LOG: std::ops::Range<u32> = STORE.start - 16 * PAGE as u32..STORE.start;
