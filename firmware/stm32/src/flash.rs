//! Flash of the controller, for data that must outlast a loss of supply: its driver, the store in it and the ring of lines
//! of the log, for an STM32L4 with two banks (RM0351, chapter 3). The program lies in the lower bank, these in the upper one.
//!
//! Reading and programming are embassy's. Other tasks run after each row that is programmed, 82 µs, and after some that are
//! read, since a store is searched for the end of what it holds. What embassy-stm32 0.6.0 lacks is here:
//! - the data cache, which a write of one bank may corrupt while the other is read (an erratum: Zephyr's pull request 13732),
//!   is off while a row is programmed or a page erased, and emptied before it is on again, since an erasure leaves in it
//!   what the page held. The release after 0.6.0 does so (embassy's pull request 6384); `WithoutCache` goes then;
//! - an erasure, 22 ms, is waited for by the timer. The interrupt of the release's asynchronous driver clears errors before
//!   they are read; once it does not, it can take the place of `erase_page`;
//! - a row with two wrong bits, as of a loss of supply amid its programming, raises the non-maskable interrupt. Its handler
//!   asks [`note_unreadable_row`], and the read ends with an error.
//!
//! An erasure that does not end is an error; a row that does not is polled until the watchdog resets.

use core::cell::RefCell;
use core::ops::Range;
use core::sync::atomic::{AtomicU32, Ordering, fence};

use drivers::fault::Fault;
use embassy_futures::yield_now;
use embassy_stm32::Peri;
use embassy_stm32::flash::{Blocking, FLASH_SIZE, Flash, MAX_ERASE_SIZE, WRITE_SIZE};
use embassy_stm32::pac;
use embassy_stm32::peripherals::FLASH;
use embassy_time::{Duration, Instant, Timer};
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use firmware::storage;
use firmware::storage::{FlashStore, LogRecord, Pages, Row, record_after};
use static_cell::StaticCell;

/// Store in flash.
pub type Store = FlashStore<UpperBank>;
/// Ring of lines of the log in flash.
pub type Ring = storage::Ring<UpperBank>;

/// Range of what is kept: the last pages, which no image reaches (`memory.x`).
const KEPT: Range<u32> = LINES.start..FLASH_SIZE as u32;
/// First byte of the store: the last two pages.
const STORE: u32 = (FLASH_SIZE - 2 * MAX_ERASE_SIZE) as u32;
/// Range of the ring: the sixteen pages before them.
const LINES: Range<u32> = STORE - 16 * MAX_ERASE_SIZE as u32..STORE;
/// Bytes of a bank.
const BANK: u32 = FLASH_SIZE as u32 / 2;
/// Bytes of a page.
const PAGE: u32 = MAX_ERASE_SIZE as u32;
/// The keys that unlock the control register, in their order (RM0351, 3.3.5).
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
/// Milliseconds after which an erasure counts as failed: twice what the slowest known one took (30 ms, Zephyr's issue
/// 16934; 24.47 ms by the data sheet).
const LONGEST_MILLISECONDS: u32 = 60;
/// Rows that are read before other tasks run, about 3 µs each.
const ROWS_AT_ONCE: u32 = 16;
/// No offset.
const NONE: u32 = u32::MAX;

/// Offset of the row of what is kept that could not be read last.
static UNREADABLE: AtomicU32 = AtomicU32::new(NONE);

/// Takes the flash, once.
pub fn take(flash: Peri<'static, FLASH>) -> UpperBank {
    static DRIVER: StaticCell<RefCell<Flash<'static, Blocking>>> = StaticCell::new();
    UpperBank { driver: DRIVER.init(RefCell::new(Flash::new_blocking(flash))), rows_read: 0 }
}

/// Notes the row of what is kept that has raised the non-maskable interrupt, for the read that came upon it. `false` if
/// something else has raised it, which is a fault.
#[must_use]
pub fn note_unreadable_row() -> bool {
    let found = pac::FLASH.eccr().read();
    let bank = if found.bk_ecc() { BANK } else { 0 };
    let offset = bank + found.addr_ecc();
    let is_noted = found.eccd() && !found.sysf_ecc() && KEPT.contains(&offset);
    if is_noted {
        UNREADABLE.store(offset, Ordering::Relaxed);
        clear_findings();
    }
    is_noted
}

/// Clears what was found by the error-correcting code. Both flags are cleared by ones.
fn clear_findings() {
    pac::FLASH.eccr().modify(|_| {});
}

/// Why an access to the flash fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A row has more wrong bits than its code corrects.
    Unreadable,
    /// The flash does not do it: a row was programmed before, an area is protected, or the access is not in whole rows or
    /// pages.
    Refused,
    /// An erasure does not end.
    Busy,
}

impl NorFlashError for Trouble {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

/// The flash, of which the program's own bank is neither programmed nor erased. Store and ring have it each: where one
/// erases a page, the other waits.
#[derive(Clone, Copy)]
pub struct UpperBank {
    /// The driver for what it does right. It is borrowed for a row at a time.
    driver: &'static RefCell<Flash<'static, Blocking>>,
    /// Rows read, which wrap.
    rows_read: u32,
}

/// The store, and beside it the records of the ring.
pub struct Archive {
    store: Store,
    bank: UpperBank,
}

impl firmware::ports::Store for Archive {
    async fn read(&mut self, slot: u8, item: &mut [u8]) -> Result<Option<usize>, Fault> {
        self.store.read(slot, item).await
    }

    async fn save<const N: usize>(&mut self, slot: u8, item: &[u8; N]) -> Result<(), Fault> {
        self.store.save(slot, item).await
    }

    async fn forget(&mut self, slot: u8) -> Result<(), Fault> {
        self.store.forget(slot).await
    }

    async fn record_after(&mut self, number: u32) -> Option<LogRecord> {
        record_after(&self.bank, LINES, number).await
    }
}

/// The data cache is off, and emptied before it is on again.
struct WithoutCache;

impl WithoutCache {
    /// Switches the cache off.
    fn new() -> Self {
        switch_cache_off();
        Self
    }
}

impl Drop for WithoutCache {
    fn drop(&mut self) {
        switch_cache_on();
    }
}

/// Switches the data cache off.
fn switch_cache_off() {
    pac::FLASH.acr().modify(|access| access.set_dcen(false));
}

/// Empties the data cache, and switches it on.
fn switch_cache_on() {
    pac::FLASH.acr().modify(|access| access.set_dcrst(true));
    pac::FLASH.acr().modify(|access| access.set_dcrst(false));
    pac::FLASH.acr().modify(|access| access.set_dcen(true));
}

/// Whether an operation is under way.
fn is_busy() -> bool {
    pac::FLASH.sr().read().bsy()
}

impl UpperBank {
    /// The store in it.
    #[must_use]
    pub const fn store(self) -> Store {
        FlashStore::new(self, STORE)
    }

    /// The store in it, and beside it the records of the ring.
    #[must_use]
    pub const fn archive(self) -> Archive {
        Archive { store: self.store(), bank: self }
    }

    /// The ring in it. No erasure may be under way: the core would wait for it.
    #[must_use]
    pub fn ring(self) -> Ring {
        Ring::open(self, LINES)
    }

    /// Reads a row, or a part of it.
    #[inline(never)]
    fn read_row(&self, offset: u32, row: &mut [u8]) -> Result<(), Trouble> {
        // The address of an earlier finding would stay.
        clear_findings();
        UNREADABLE.store(NONE, Ordering::Relaxed);
        fence(Ordering::SeqCst);
        self.driver.borrow_mut().blocking_read(offset, row).map_err(|_| Trouble::Refused)?;
        fence(Ordering::SeqCst);
        let is_pending = pac::FLASH.eccr().read().eccd();
        if is_pending || UNREADABLE.load(Ordering::Relaxed) != NONE {
            // The cache holds the row now, and would not tell it again.
            drop(WithoutCache::new());
            return Err(Trouble::Unreadable);
        }
        Ok(())
    }

    /// Programs a row.
    #[inline(never)]
    fn program_row(&self, offset: u32, row: &[u8]) -> Result<(), Trouble> {
        let _without_cache = WithoutCache::new();
        self.driver.borrow_mut().blocking_write(offset, row).map_err(|_| Trouble::Refused)
    }
}

/// Whether nothing is under way, nor an erasure whose end has not been seen by its part: the cache is off until then.
fn is_free() -> bool {
    !is_busy() && pac::FLASH.acr().read().dcen()
}

/// Waits until something is so, as that nothing is under way, not even an erasure whose future was dropped.
async fn until(is_so: fn() -> bool) -> Result<(), Trouble> {
    for _ in 0..LONGEST_MILLISECONDS {
        if is_so() {
            return Ok(());
        }
        Timer::after_millis(1).await;
    }
    Err(Trouble::Busy)
}

/// Unlocks the control register, where it is locked.
pub(crate) fn unlock() {
    if pac::FLASH.cr().read().lock() {
        for key in KEYS {
            pac::FLASH.keyr().write_value(key);
        }
    }
}

/// Erases the page at this offset.
async fn erase_page(offset: u32) -> Result<(), Trouble> {
    until(is_free).await?;
    let erasure = Erasure { _without_cache: WithoutCache::new() };
    begin_erasure(offset);
    let ended = until(|| !is_busy()).await;
    drop(erasure);
    is_accepted().and(ended)
}

/// An erasure that is under way. Who no longer waits for it drops it: it is then waited for here, and only after it is
/// the cache on again.
struct Erasure {
    _without_cache: WithoutCache,
}

impl Drop for Erasure {
    fn drop(&mut self) {
        let deadline = Instant::now() + Duration::from_millis(LONGEST_MILLISECONDS.into());
        while is_busy() && Instant::now() < deadline {}
        end_erasure();
    }
}

/// Begins to erase the page at this offset.
#[inline(never)]
fn begin_erasure(offset: u32) {
    unlock();
    // Errors of before are cleared by ones; with one of them nothing would begin.
    pac::FLASH.sr().modify(|_| {});
    pac::FLASH.cr().modify(|control| {
        control.set_per(true);
        control.set_bker(offset >= BANK);
        control.set_pnb((offset % BANK / PAGE) as u8);
        control.set_start(true);
    });
}

/// Leaves an erasure that is over, or counts as failed.
#[inline(never)]
fn end_erasure() {
    pac::FLASH.cr().modify(|control| control.set_per(false));
    pac::FLASH.cr().modify(|control| control.set_lock(true));
}

/// Whether an erasure that has ended was one.
fn is_accepted() -> Result<(), Trouble> {
    let status = pac::FLASH.sr().read();
    let is_refused = status.operr() || status.wrperr() || status.pgserr();
    if is_refused { Err(Trouble::Refused) } else { Ok(()) }
}

impl Pages for UpperBank {
    fn row(&self, offset: u32) -> Option<Row> {
        let mut row = [0; WRITE_SIZE];
        self.read_row(offset, &mut row).ok()?;
        Some(row)
    }

    fn is_idle(&self) -> bool {
        is_free()
    }

    fn program(&mut self, offset: u32, row: Row) -> bool {
        self.program_row(offset, &row).is_ok()
    }

    fn begin_erasure(&mut self, offset: u32) {
        switch_cache_off();
        begin_erasure(offset);
    }

    fn end_erasure(&mut self) -> bool {
        let is_over = !is_busy();
        if is_over {
            // A refusal shows in the rows.
            end_erasure();
            switch_cache_on();
        }
        is_over
    }
}

impl ErrorType for UpperBank {
    type Error = Trouble;
}

impl ReadNorFlash for UpperBank {
    const READ_SIZE: usize = WRITE_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Trouble> {
        for (offset, row) in (offset..).step_by(WRITE_SIZE).zip(bytes.chunks_mut(WRITE_SIZE)) {
            if self.rows_read.is_multiple_of(ROWS_AT_ONCE) {
                yield_now().await;
            }
            // The core would wait for the row while its bank is erased.
            until(is_free).await?;
            self.rows_read = self.rows_read.wrapping_add(1);
            self.read_row(offset, row)?;
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        FLASH_SIZE
    }
}

impl NorFlash for UpperBank {
    const WRITE_SIZE: usize = WRITE_SIZE;
    const ERASE_SIZE: usize = MAX_ERASE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Trouble> {
        let are_pages = from.is_multiple_of(PAGE) && to.is_multiple_of(PAGE);
        if !(are_pages && BANK <= from && from <= to && to <= 2 * BANK) {
            return Err(Trouble::Refused);
        }
        for page in (from..to).step_by(MAX_ERASE_SIZE) {
            erase_page(page).await?;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Trouble> {
        if offset < BANK {
            return Err(Trouble::Refused);
        }
        for (offset, row) in (offset..).step_by(WRITE_SIZE).zip(bytes.chunks(WRITE_SIZE)) {
            until(is_free).await?;
            self.program_row(offset, row)?;
            yield_now().await;
        }
        Ok(())
    }
}
