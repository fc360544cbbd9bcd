//! Commands and settings over the link: what each does, what it is answered, and that nothing else does anything.

mod flood;
mod frames;
mod lines;
mod running;

use std::cell::RefCell;
use std::collections::VecDeque;

use conversation::{Conversation, Listening};
use drivers::fault::Fault;
use embassy_futures::select::select3;
use embassy_sync::mutex::Mutex;
use embassy_time::{Duration, Instant, Timer};
use embedded_io_async::{ErrorKind, ErrorType, Read, Write};
use firmware::ports::Store;
use firmware::run::store;
use firmware::settings::{BoardSettings, Serial, Settings, StageSchedule};
use firmware::shared::Shared;
use firmware::storage::{CONTENT, LogRecord};
use host::instrument::Traffic;
use host::virtual_time;
use orientation::earth::Latitude;

use crate::support::link::sentences;

/// Serial number of the controller here.
const SERIAL: Serial = Serial([7; 12]);

/// Settings on a stage, with a latitude.
fn settings() -> Settings<StageSchedule> {
    Settings { latitude: Latitude::from_degrees(48.0), ..Settings::default() }
}

/// A terminal: it sends what it is told at its times, ms, and keeps what it is sent.
struct Terminal {
    typed: VecDeque<(u64, Vec<u8>)>,
    shown: Vec<u8>,
}

impl ErrorType for Terminal {
    type Error = ErrorKind;
}

impl Read for Terminal {
    async fn read(&mut self, bytes: &mut [u8]) -> Result<usize, ErrorKind> {
        let Some((at, typed)) = self.typed.front_mut() else {
            return core::future::pending().await;
        };
        Timer::at(Instant::from_millis(*at)).await;
        let count = typed.len().min(bytes.len());
        bytes[..count].copy_from_slice(&typed[..count]);
        typed.drain(..count);
        if typed.is_empty() {
            self.typed.pop_front();
        }
        Ok(count)
    }
}

impl Write for Terminal {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, ErrorKind> {
        self.shown.extend(bytes);
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}

/// A store of one item with a log beside it, which refuses to be written where it is full.
#[derive(Default)]
struct Memory {
    item: Option<(u8, Vec<u8>)>,
    log: Vec<LogRecord>,
    is_full: bool,
}

/// A handle to a memory.
struct Handle<'m>(&'m RefCell<Memory>);

impl Store for Handle<'_> {
    async fn read(&mut self, slot: u8, item: &mut [u8]) -> Result<Option<usize>, Fault> {
        let memory = self.0.borrow();
        let kept = memory.item.as_ref().filter(|(kept, _)| *kept == slot).map(|(_, bytes)| bytes);
        Ok(kept.map(|bytes| {
            item[..bytes.len()].copy_from_slice(bytes);
            bytes.len()
        }))
    }

    async fn save<const N: usize>(&mut self, slot: u8, item: &[u8; N]) -> Result<(), Fault> {
        if self.0.borrow().is_full {
            return Err(Fault::Bus);
        }
        // A row takes its time.
        Timer::after_millis(300).await;
        self.0.borrow_mut().item = Some((slot, item.to_vec()));
        Ok(())
    }

    async fn forget(&mut self, _: u8) -> Result<(), Fault> {
        Ok(())
    }

    async fn record_after(&mut self, number: u32) -> Option<LogRecord> {
        self.0.borrow().log.iter().find(|(found, _)| *found > number).copied()
    }
}

/// What an instrument says that is sent this, at times, ms, within so many milliseconds.
fn conversed(
    (shared, stated): (&Shared<'_>, Settings<StageSchedule>),
    typed: &[(u64, &[u8])],
    milliseconds: u64,
    memory: &RefCell<Memory>,
) -> Vec<u8> {
    let typed = typed.iter().map(|(at, bytes)| (*at, bytes.to_vec())).collect();
    let mut terminal = Terminal { typed, shown: Vec::new() };
    shared.output.set(stated.output);
    let settings = Mutex::new(stated);
    let kept = BoardSettings { settings: &settings, serial: SERIAL };
    let listener = Listening::new(kept, || REBOOTS.with_borrow_mut(|all| all.push(Instant::now())));
    let mut conversation = Conversation::new(&mut terminal, listener, shared);
    let passing = Timer::after(Duration::from_millis(milliseconds));
    let serving = store(Handle(memory), Some(kept), shared);
    virtual_time::run(select3(conversation.without_end(), serving, passing)).expect("time goes on");
    terminal.shown
}

std::thread_local! {
    /// When the instrument was started anew.
    static REBOOTS: RefCell<Vec<Instant>> = const { RefCell::new(Vec::new()) };
}

/// Bytes that come over the link at times.
struct Typed(RefCell<VecDeque<(Instant, Vec<u8>)>>);

impl Typed {
    /// These bytes at these times, s.
    fn bytes(bytes: impl IntoIterator<Item = (u64, Vec<u8>)>) -> Self {
        let at = |(at, bytes)| (Instant::from_secs(at), bytes);
        Self(RefCell::new(bytes.into_iter().map(at).collect()))
    }

    /// These lines at these times, s.
    fn lines(lines: &[(u64, &str)]) -> Self {
        Self::bytes(lines.iter().map(|(at, line)| (*at, format!("{line}\r\n").into_bytes())))
    }
}

impl Traffic for Typed {
    fn next(&self) -> Option<(Instant, Vec<u8>)> {
        self.0.borrow_mut().pop_front()
    }
}

/// The answers among lines of the link, each with the commas between its fields.
fn answers_in(lines: &str) -> Vec<String> {
    sentences(lines, "PMRDR").into_iter().map(|fields| fields.join(",")).collect()
}

/// A record of the log.
fn record(number: u32, byte: u8) -> LogRecord {
    (number, [byte; CONTENT])
}
