//! Stands in for what the pure crate does not have yet.
#![allow(missing_docs, clippy::all, clippy::pedantic, reason = "a stand-in")]

use orientation::align::budget::Budget;
use orientation::align::conclusion::Azimuth;
use orientation::align::setting::Setting as Common;
use orientation::error::Refusal;
use orientation::session::procedure::ProcedureError;
use orientation::signal::InertialSample;

pub const STOPS: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub common: Common,
    pub bias_sigma: Option<f64>,
    pub force_noise: Option<f64>,
    pub displacement_sigma: f64,
    pub speed_sigma: f64,
}

impl Setting {
    pub fn new(common: Common) -> Self {
        Self {
            common,
            bias_sigma: None,
            force_noise: None,
            displacement_sigma: 0.0,
            speed_sigma: 0.0,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Stops {
    Found(usize),
    Stated(heapless::Vec<[f64; 2], STOPS>),
    Whole,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    pub stops: Stops,
    pub sample_seconds: f64,
}

impl Procedure {
    pub fn new(stops: Stops, sample_seconds: f64) -> Self {
        Self { stops, sample_seconds }
    }
}

#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    Sample(&'a InertialSample),
    Displaced([f64; 2]),
    End,
    Failed(Refusal),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    Wait,
    Drive,
    Finished,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    Level,
    Driving,
    Stopped(usize),
    Done,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    pub rate: f64,
    pub force: f64,
    pub rate_limit: f64,
    pub force_limit: f64,
    pub is_at_rest: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    pub from: f64,
    pub to: f64,
    pub pitch: f64,
    pub roll: f64,
    pub displacement: Option<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inclination;

impl Inclination {
    pub fn angle(&self, _azimuth: f64) -> f64 {
        0.0
    }
    pub fn euler(&self, _azimuth: f64) -> f64 {
        0.0
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    pub at: f64,
    pub value: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plain {
    pub inclination: Inclination,
    pub azimuth: f64,
    pub sigma: f64,
    pub angle: Minimum,
    pub euler: Minimum,
    pub ratio: f64,
    pub ratio_sigma: f64,
}

#[derive(Clone, Debug)]
pub struct Conclusion {
    pub verdict: Result<Azimuth, Refusal>,
    pub start: Option<Azimuth>,
    pub limit: f64,
    pub budget: Budget,
    pub plain: Option<Plain>,
    pub biases: Option<([f64; 3], [f64; 3])>,
    pub level: [f64; 2],
    pub ratio: f64,
    pub ratio_sigma: f64,
}

#[derive(Clone, Debug)]
pub struct Session {
    setting: Setting,
    conclusion: Option<Conclusion>,
}

impl Session {
    pub fn new(setting: Setting, _: Procedure) -> Result<Self, ProcedureError> {
        Ok(Self { setting, conclusion: None })
    }
    pub fn handle(&mut self, event: Event<'_>) -> Command {
        if let Event::End = event {
            self.conclusion = Some(Conclusion {
                verdict: Err(Refusal::TimeExhausted),
                start: None,
                limit: 0.0,
                budget: Budget::default(),
                plain: None,
                biases: None,
                level: [0.0; 2],
                ratio: 1.0,
                ratio_sigma: 0.0,
            });
            return Command::Finished;
        }
        Command::Wait
    }
    pub fn setting(&self) -> &Setting {
        &self.setting
    }
    pub fn phase(&self) -> Phase {
        Phase::Level
    }
    pub fn criteria(&self) -> Option<Criteria> {
        None
    }
    pub fn stops(&self) -> &[Stop] {
        &[]
    }
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.conclusion.as_ref()
    }
}
