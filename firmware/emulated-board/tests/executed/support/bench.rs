//! A board on a bench: stepped, watched, and its supply switched.

use emulated_board::run::{Execution, Order};
use emulated_board::time::Time;
use emulated_board::world::World;

use super::executed::Entry;
use super::images::image;

/// A board that is stepped.
pub struct Bench {
    /// The board.
    pub execution: Execution,
    /// Lines of its log, in the image's own time, which begins anew with every start.
    pub log: Vec<Entry>,
    /// What came over the link.
    pub link: String,
}

impl Bench {
    /// The order's image in a world, as its supply comes up.
    pub fn new(order: &Order, world: World) -> Self {
        let execution =
            Execution::new(&image(order.carrier), order, world).expect("the image can be executed");
        Self { execution, log: Vec::new(), link: String::new() }
    }

    /// Seconds since the supply came up for the first time.
    pub fn now(&self) -> f64 {
        self.execution.processor.now().as_seconds()
    }

    /// Goes on for a millisecond, or until the core sleeps.
    pub fn step(&mut self) {
        let lines = self.execution.step().expect("the model knows what the image does");
        self.log.extend(lines.iter().map(Entry::of));
        let sent = self
            .execution
            .processor
            .with_controller(|controller| std::mem::take(&mut controller.usart.sent));
        self.link += &String::from_utf8_lossy(&sent);
    }

    /// Goes on for so many seconds.
    pub fn run(&mut self, seconds: f64) {
        let end = self.now() + seconds;
        while self.now() < end {
            self.step();
        }
    }

    /// Goes on until a line of the log contains these words, and returns it.
    ///
    /// # Panics
    /// If none does within so many seconds.
    #[track_caller]
    pub fn run_until(&mut self, words: &str, seconds: f64) -> Entry {
        let (end, mut seen) = (self.now() + seconds, self.log.len());
        while self.now() < end {
            self.step();
            if let Some(found) = self.log[seen..].iter().find(|entry| entry.words.contains(words)) {
                return found.clone();
            }
            seen = self.log.len();
        }
        panic!("no line of the log contains {words:?} within {seconds} s: {:#?}", self.log);
    }

    /// How long conversions waited at most to be read since this was asked for the last time, s.
    pub fn longest_wait(&self) -> f64 {
        let now = self.execution.processor.now();
        let served =
            self.execution.processor.with_controller(|controller| controller.wiring.served(now));
        Time::as_seconds(served.longest.0)
    }

    /// How often the watchdog was fed since the latest start.
    pub fn feedings(&self) -> u64 {
        self.execution.processor.with_controller(|controller| controller.watchdog.feedings)
    }
}
