//! Control of a two-frame mount: homes both frames, turns them at the same time to the orientation
//! that the session requests, and sets the gyro's sensitive axis vertical to hold the azimuth.
//!
//! Each frame is a [`Stage`] of its own, so motor and encoder of each must agree after every
//! movement. A failure is reported with the name of the frame.

use core::convert::Infallible;

use embassy_futures::join::join;
use embassy_futures::select::select;
use orientation::alignment::Request;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::mount::Station;
use orientation::device::{Device, Trouble};
use orientation::units::{DEGREES_PER_RADIAN as DEGREES, Radians};

use crate::configuration::FramesConfiguration;
use crate::event::Event;
use crate::mechanism::Mechanism;
use crate::motor::Axis;
use crate::ports::{Actuator, Frames};
use crate::shared::Shared;
use crate::stage::Stage;
use crate::status::Status;

/// Names of the outer frame's drive and encoder in the log.
const OUTER: Axis = Axis { drive: Device::OuterFrame, encoder: Device::OuterEncoder };
/// Names of the inner frame's drive and encoder in the log.
const INNER: Axis = Axis { drive: Device::InnerFrame, encoder: Device::InnerEncoder };

/// The two frames of a mount and their control.
pub struct Gimbal<'a, M> {
    /// Drive of the outer frame.
    outer: Stage<'a, M>,
    /// Drive of the inner frame.
    inner: Stage<'a, M>,
    /// Geometry and tolerances.
    configuration: &'a FramesConfiguration,
    /// Signals and counters that all parts share.
    shared: &'a Shared<'a>,
}

impl<'a, M: Actuator> Gimbal<'a, M> {
    /// Takes both motors; nothing moves yet.
    pub fn new(
        actuators: &'a mut Frames<M>,
        configuration: &'a FramesConfiguration,
        shared: &'a Shared<'a>,
    ) -> Self {
        let Frames { outer, inner } = actuators;
        let (drives, latest) = (&configuration.drives, &shared.angles);
        Self {
            outer: Stage::of(OUTER, outer, &drives.outer, &latest.outer, shared),
            inner: Stage::of(INNER, inner, &drives.inner, &latest.inner, shared),
            configuration,
            shared,
        }
    }

    /// Sets the gyro's sensitive axis vertical and reports the angles of both frames.
    ///
    /// # Errors
    /// A frame that was given up during the movement; the log has its name and the reason.
    async fn store(&mut self) -> Result<(), Refusal> {
        self.go_to(Station::Storage).await?;
        let shown = |frame: &Stage<'_, M>| frame.motor.shown().signed_rad() * DEGREES;
        self.shared.report(Event::Stored(shown(&self.outer), shown(&self.inner)));
        Ok(())
    }

    /// Points the sensitive axis to a heading; one that is not a multiple of 90° lies beyond
    /// the travel of this mount.
    async fn point(&mut self, heading: Radians) -> Result<(), Refusal> {
        let station = Station::at_heading(heading).map_err(|_| {
            self.shared.give_up(Device::Stage, Trouble::BeyondTravel(heading.into()))
        })?;
        self.go_to(station).await
    }

    /// Turns both frames to an orientation at the same time.
    async fn go_to(&mut self, station: Station) -> Result<(), Refusal> {
        let angles = self.configuration.angles(station);
        both(join(self.outer.turn_to(angles.outer.0), self.inner.turn_to(angles.inner.0)).await)
    }
}

impl<M: Actuator> Mechanism for Gimbal<'_, M> {
    /// Has both motors rest before they get their current, starts the drives, waits for the first valid angles, homes,
    /// and then follows requests for a heading or for the vertical.
    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        let (outer, inner) = join(self.outer.motor.rest(), self.inner.motor.rest()).await;
        self.shared.current.signal(outer && inner);
        let [outer, inner] =
            [&mut self.outer, &mut self.inner].map(|frame| &mut frame.motor.actuator);
        both(join(outer.start(self.shared), inner.start(self.shared)).await)?;
        self.shared.sensing.wait().await;
        both(join(self.outer.home(), self.inner.home()).await)?;
        self.go_to(Station::Forward).await?;
        self.shared.homed.signal(());
        loop {
            match self.shared.wanted.wait().await {
                Request::Point(heading) => self.point(heading).await?,
                Request::Vertical => self.store().await?,
                _ => {}
            }
        }
    }

    async fn halt(&mut self) {
        join(self.outer.motor.halt(), self.inner.motor.halt()).await;
    }

    /// After an azimuth was found, sets the gyro's sensitive axis vertical, where it can hold the
    /// azimuth; a keeper has requested that already.
    async fn park(&mut self, meanwhile: impl Future<Output = ()>) {
        let is_found = matches!(self.shared.status.get(), Status::Concluded(..));
        let is_to_store = is_found && !self.shared.is_kept.get();
        let parking = async {
            // If this fails, the log has the reason; the azimuth is valid nevertheless.
            if !is_to_store || self.store().await.is_err() {
                self.halt().await;
            }
        };
        select(parking, meanwhile).await;
    }
}

/// Result of two movements at the same time; the error is that of the outer frame if both failed.
fn both((outer, inner): (Result<(), Refusal>, Result<(), Refusal>)) -> Result<(), Refusal> {
    outer.and(inner)
}
