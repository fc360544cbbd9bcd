//! A board that is executed step by step, with its log, its link and its faults.
#![allow(dead_code, reason = "each program of tests uses a part of it")]

use emulated_board::controller::Controller;
use emulated_board::run::{Execution, Order};
use emulated_board::world::World;
use firmware::platform::Platform;

use super::images::image;

/// A board that is executed.
pub struct Board {
    /// The execution.
    pub execution: Execution,
    /// Lines of the log with the time at which the probe took them, s after the supply came up first.
    pub log: Vec<(f64, String)>,
    /// Its lines as the probe prints them: the time that the board states, to a tenth of a second, level and words.
    pub printed: Vec<String>,
    /// Status lines of the link with the time at which each was complete, s.
    pub link: Vec<(f64, String)>,
    /// The beginning of a line.
    begun: Vec<u8>,
}

impl Board {
    /// The board of a carrier in its usual world.
    pub fn new(carrier: Platform) -> Self {
        Self::within(carrier, World::new(carrier, 1).expect("its settings are possible"))
    }

    /// The board of a carrier in this world.
    pub fn within(carrier: Platform, world: World) -> Self {
        Self::ordered(&Order::usual(carrier, 1), world)
    }

    /// The board of an order in this world.
    pub fn ordered(order: &Order, world: World) -> Self {
        let execution = Execution::new(&image(order.carrier), order, world);
        let execution = execution.expect("the image has a log");
        Self {
            execution,
            log: Vec::new(),
            printed: Vec::new(),
            link: Vec::new(),
            begun: Vec::new(),
        }
    }

    /// Time since the supply came up first, s.
    pub fn seconds(&self) -> f64 {
        self.execution.processor.now().as_seconds()
    }

    /// What is done with the microcontroller, as by someone who injects faults.
    pub fn controller<T>(&self, task: impl FnOnce(&mut Controller) -> T) -> T {
        self.execution.processor.with_controller(task)
    }

    /// Goes on for a millisecond.
    fn step(&mut self) {
        let lines = self.execution.step().unwrap_or_else(|error| panic!("{error}\n{self}"));
        let now = self.seconds();
        self.printed.extend(lines.iter().map(|line| {
            let seconds = line.time.parse::<f64>().unwrap_or(f64::NAN);
            format!("{seconds:6.1} {} {}", line.level.unwrap_or("-"), line.words)
        }));
        self.log.extend(lines.into_iter().map(|line| (now, line.words)));
        for byte in self.execution.take_sent() {
            if byte == b'\n' {
                let line =
                    String::from_utf8_lossy(&std::mem::take(&mut self.begun)).trim().to_owned();
                self.link.push((now, line));
            } else {
                self.begun.push(byte);
            }
        }
    }

    /// Goes on for some seconds.
    pub fn run(&mut self, seconds: f64) {
        let end = self.seconds() + seconds;
        while self.seconds() < end {
            self.step();
        }
    }

    /// Goes on until a line of the log that contains these words, from now on; the time at which it came, s.
    ///
    /// # Panics
    /// Where none comes within so many seconds.
    #[track_caller]
    pub fn until(&mut self, words: &str, longest: f64) -> f64 {
        let came = self.awaited(words, longest);
        came.unwrap_or_else(|| panic!("no {words:?} within {longest} s:\n{self}"))
    }

    /// As [`Self::until`]; none where no such line comes.
    pub fn awaited(&mut self, words: &str, longest: f64) -> Option<f64> {
        let (end, mut seen) = (self.seconds() + longest, self.log.len());
        while self.seconds() < end {
            self.step();
            if let Some((at, _)) = self.log[seen..].iter().find(|(_, line)| line.contains(words)) {
                return Some(*at);
            }
            seen = self.log.len();
        }
        None
    }

    /// How long it takes from now to a line of the log that contains these words, s; so many seconds where none comes.
    pub fn takes(&mut self, words: &str, longest: f64) -> f64 {
        let now = self.seconds();
        self.awaited(words, longest).map_or(longest, |came| came - now)
    }

    /// Lines of the log from a moment on, s, until another.
    pub fn lines(&self, from: f64, until: f64) -> Vec<&str> {
        let within = self.log.iter().filter(|(at, _)| (from..until).contains(at));
        within.map(|(_, line)| line.as_str()).collect()
    }

    /// Status lines of the link from a moment on, s, until another.
    pub fn sent(&self, from: f64, until: f64) -> Vec<&str> {
        let within = self.link.iter().filter(|(at, _)| (from..until).contains(at));
        within.map(|(_, line)| line.as_str()).collect()
    }
}

impl std::fmt::Display for Board {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.log.iter().try_for_each(|(at, line)| writeln!(f, "{at:11.6} {line}"))?;
        self.link.iter().try_for_each(|(at, line)| writeln!(f, "{at:11.6} link: {line}"))
    }
}
