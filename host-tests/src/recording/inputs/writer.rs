//! Writes inputs as they come.

use std::cell::{Cell, RefCell};
use std::io::{self, Write};

use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::{Observer, Recorder};
use hal_mock::earth::Attitude;
use orientation::navigation::{Input, aligner};
use serde::Serialize;

use super::{End, Given, Header, Line, VERSION};
use crate::instrument::kept::{Kept, Point};
use crate::recording::Truth;
use crate::recording::checksum::Checksum;

/// Writes the inputs of a run as they come: the recorder of its samples, and an observer of the others. After the first
/// failure it writes nothing more, and the run goes on.
#[derive(Debug)]
pub struct Writer<W> {
    to: RefCell<io::Result<W>>,
    /// Checksum of the lines so far.
    sum: RefCell<Checksum>,
    /// Whether no alignment ran at the latest input that said so.
    was_idle: Cell<Option<bool>>,
    /// Whether an azimuth, or the computation of one, waits for the inertial sample of its time.
    is_found: Cell<bool>,
}

impl<W: Write> Writer<W> {
    /// Writes the header of a run of this seed.
    ///
    /// # Errors
    /// The file cannot be written, or the header holds a number that JSON does not have.
    pub fn new(to: W, seed: u64, given: Given) -> io::Result<Self> {
        let program = concat!("meridian ", env!("CARGO_PKG_VERSION")).to_owned();
        let header = Header { inputs: VERSION, program, seed, given };
        serde_json::from_slice::<Header>(&serde_json::to_vec(&header)?)?;
        let (sum, was_idle, is_found) = Default::default();
        let this = Self { to: RefCell::new(Ok(to)), sum, was_idle, is_found };
        this.write(&header);
        Ok(this)
    }

    /// Writes a line.
    fn write(&self, line: &impl Serialize) {
        let mut to = self.to.borrow_mut();
        let Ok(file) = to.as_mut() else { return };
        let written = serde_json::to_string(line).map_err(io::Error::from).and_then(|mut text| {
            self.sum.borrow_mut().add(&text);
            text.push('\n');
            file.write_all(text.as_bytes())
        });
        if let Err(error) = written {
            *to = Err(error);
        }
    }

    /// Leaves out the end, for a run that was stopped; gives back what was written to.
    ///
    /// # Errors
    /// A line could not be written.
    pub fn stop(self) -> io::Result<W> {
        self.to.into_inner()
    }

    /// Writes what was true of what was kept, and the end; gives back what was written to.
    ///
    /// # Errors
    /// A line could not be written, one of these or an earlier one.
    pub fn finish(self, kept: &Kept, truth: &Truth) -> io::Result<W> {
        for Point { truth: Attitude { azimuth_rad, pitch_rad, roll_rad }, .. } in &kept.points {
            self.write(&Line::<()>::TruthAttitude([*azimuth_rad, *pitch_rad, *roll_rad]));
        }
        let checksum = self.sum.borrow().digits();
        self.write(&Line::<()>::End(End {
            checksum,
            truth_azimuth_deg: truth.azimuth_deg,
            truth_start_azimuth_deg: truth.start_azimuth_deg,
        }));
        self.to.into_inner()
    }
}

impl<W: Write> Observer for Writer<W> {
    fn event(&self, _: Instant, _: &Event) {}

    fn aligns(&self, input: &aligner::Input) {
        self.write(&Line::<()>::Aligner(*input));
    }

    fn navigates(&self, input: &Input) {
        let changes = match input {
            Input::Idle(is_idle) => self.was_idle.replace(Some(*is_idle)) != Some(*is_idle),
            Input::Concluding(_) | Input::Found(..) => {
                self.is_found.set(true);
                true
            }
            Input::Settled => self.is_found.replace(false),
            _ => true,
        };
        if changes {
            self.write(&Line::<()>::Navigator(*input));
        }
    }
}

impl<S: Serialize, W: Write> Recorder<S> for &Writer<W> {
    async fn record(&mut self, sample: &S) {
        self.write(&Line::Sample(sample));
    }
}
