//! Stub.
#![allow(missing_docs)]
#![allow(clippy::pedantic)]
use heapless::Vec;

pub use crate::align::stops::{Conclusion, Setting};
use crate::align::conclusion::Azimuth;
use crate::error::Refusal;
use crate::session::procedure::ProcedureError;
use crate::signal::InertialSample;
use crate::units::Instant;

#[derive(Clone, Debug, PartialEq)]
pub enum Stops {
    Found(usize),
    Whole,
}
#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    pub stops: Stops,
    pub sample_seconds: f64,
    pub average_seconds: f64,
    pub delay_seconds: f64,
    pub stop_seconds: f64,
}
impl Procedure {
    #[must_use]
    pub fn new(stops: Stops, sample_seconds: f64) -> Self {
        Self { stops, sample_seconds, average_seconds: 10.0, delay_seconds: 5.0, stop_seconds: 60.0 }
    }
}
pub enum Event<'a> {
    Sample(&'a InertialSample),
    Displaced([f64; 2]),
    End,
    Failed(Refusal),
}
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command { Wait, Drive, Finished }
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase { Level, Driving, Stopped(usize), Done }
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop { pub from: f64, pub to: f64, pub pitch: f64, pub roll: f64, pub displacement: Option<[f64; 2]> }
#[derive(Clone, Debug)]
pub struct Session {
    setting: Setting,
    procedure: Procedure,
    phase: Phase,
    stops: Vec<Stop, 10>,
    conclusion: Option<Conclusion>,
    last: Instant,
    turned: [f64; 3],
    samples: u32,
    clipped: u32,
    still: u32,
    moving: u32,
    sum: u64,
}
impl Session {
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, ProcedureError> {
        Ok(Self { setting, procedure, phase: Phase::Level, stops: Vec::new(), conclusion: None, last: Instant(0), turned: [0.0; 3], samples: 0, clipped: 0, still: 0, moving: 0, sum: 0 })
    }
    pub fn setting(&self) -> &Setting { &self.setting }
    pub fn procedure(&self) -> &Procedure { &self.procedure }
    pub fn phase(&self) -> Phase { self.phase }
    pub fn stops(&self) -> &[Stop] { &self.stops }
    pub fn conclusion(&self) -> Option<&Conclusion> { self.conclusion.as_ref() }
    fn end(&mut self, verdict: Result<Azimuth, Refusal>) -> Command {
        if self.conclusion.is_none() {
            self.phase = Phase::Done;
            self.conclusion = Some(Conclusion { verdict, start: None, limit: 0.0, biases: None, level: [0.0; 2] });
        }
        Command::Finished
    }
    pub fn handle(&mut self, event: Event) -> Command {
        if self.phase == Phase::Done { return Command::Finished; }
        match event {
            Event::Failed(reason) => self.end(Err(reason)),
            Event::End => self.end(Err(Refusal::TimeExhausted)),
            Event::Displaced(place) => { if let Some(stop) = self.stops.last_mut() { stop.displacement = Some(place); } Command::Wait }
            Event::Sample(sample) => self.sample(sample),
        }
    }
    fn sample(&mut self, sample: &InertialSample) -> Command {
        let period = self.procedure.sample_seconds;
        let gap = (sample.time.0 - self.last.0) as f64 * 1e-6;
        if self.last.0 > 0 && gap > 1.5 * period { return self.end(Err(Refusal::NoSchedule { seconds: gap })); }
        self.last = sample.time;
        if sample.is_clipped { self.clipped += 1; }
        if self.clipped > 10 { return self.end(Err(Refusal::TimeExhausted)); }
        for (sum, turned) in self.turned.iter_mut().zip(sample.turned) { *sum += turned.rad(); self.sum = self.sum.wrapping_mul(31).wrapping_add(turned.0 as u64); }
        self.samples += 1;
        let second = (1.0 / period) as u32;
        if self.samples % second != 0 { return Command::Wait; }
        let turned = core::mem::take(&mut self.turned);
        let is_still = turned.iter().all(|t| t.abs() < 1.5e-4);
        if is_still { self.still += 1; self.moving = 0; } else { self.moving += 1; if self.moving > 2 { self.still = 0; } }
        let now = sample.time.0 as f64 * 1e-6;
        match self.phase {
            Phase::Level | Phase::Stopped(_) => {
                if self.moving > 5 { self.phase = Phase::Driving; return Command::Wait; }
                let number = match self.phase { Phase::Stopped(index) => index, _ => 0 };
                if self.still == 15 && self.stops.len() == number {
                    let _ = self.stops.push(Stop { from: now - 15.0, to: now, pitch: 0.01, roll: 0.02, displacement: None });
                    if Stops::Found(self.stops.len()) == self.procedure.stops { return self.end(Ok(Azimuth { angle: self.sum as f64 * 1e-19, sigma: 3.0 })); }
                    return Command::Drive;
                }
                Command::Wait
            }
            _ => { if self.still > 10 { self.phase = Phase::Stopped(self.stops.len()); } Command::Wait }
        }
    }
}
