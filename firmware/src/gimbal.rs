//! Control of a two-frame mount: homes both frames, turns them at the same time to the orientation
//! that the session requests, and sets the gyro's sensitive axis vertical to hold the azimuth.
//!
//! Each frame is a [`Stage`] of its own, so motor and encoder of each must agree after every
//! movement. A failure is reported with the name of the frame.

use core::convert::Infallible;

use embassy_futures::join::join;
use embassy_futures::select::{Either, select};
use orientation::align::mount::Station;
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::units::DEGREES_PER_RADIAN as DEGREES;

use crate::configuration::FramesConfiguration;
use crate::event::Event;
use crate::motor::Axis;
use crate::ports::{Actuator, Frames, Observer};
use crate::shared::{LatestAngle, Shared};
use crate::stage::Stage;

/// Names of the outer frame's drive and encoder in the log.
const OUTER: Axis = Axis { drive: Device::OuterFrame, encoder: Device::OuterEncoder };
/// Names of the inner frame's drive and encoder in the log.
const INNER: Axis = Axis { drive: Device::InnerFrame, encoder: Device::InnerEncoder };

/// The two frames of a mount and their control.
pub struct Gimbal<'a, M, O> {
    /// Drive of the outer frame.
    outer: Stage<'a, M, O>,
    /// Drive of the inner frame.
    inner: Stage<'a, M, O>,
    /// Geometry and tolerances.
    configuration: &'a FramesConfiguration,
    /// Latest encoder angles, written by acquisition.
    latest: &'a Frames<LatestAngle>,
    /// Signals and counters that all parts share.
    shared: &'a Shared<'a, O>,
}

impl<'a, M: Actuator, O: Observer> Gimbal<'a, M, O> {
    /// Takes both motors; nothing moves yet.
    pub fn new(
        actuators: &'a mut Frames<M>,
        configuration: &'a FramesConfiguration,
        latest: &'a Frames<LatestAngle>,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let Frames { outer, inner } = actuators;
        let drives = &configuration.drives;
        Self {
            outer: Stage::of(OUTER, outer, &drives.outer, &latest.outer, shared),
            inner: Stage::of(INNER, inner, &drives.inner, &latest.inner, shared),
            configuration,
            latest,
            shared,
        }
    }

    /// Homes both frames, then serves the session's requests until a frame is given up; returns the
    /// reason.
    pub async fn run(&mut self) -> Refusal {
        match self.serve().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    /// Sets the gyro's sensitive axis vertical and reports the angles of both frames.
    ///
    /// # Errors
    /// A frame that was given up during the movement; the log has its name and the reason.
    pub async fn store(&mut self) -> Result<(), Refusal> {
        self.go_to(Station::Storage).await?;
        let shown = |latest: &LatestAngle| latest.get().0.signed_rad() * DEGREES;
        self.shared.tell(Event::Stored(shown(&self.latest.outer), shown(&self.latest.inner)));
        Ok(())
    }

    /// Starts the drives, waits for the first valid angles, homes, and then follows requests for a
    /// heading or for the vertical.
    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        both(self.outer.start(), self.inner.start()).await?;
        self.shared.sensing.wait().await;
        both(self.outer.home(), self.inner.home()).await?;
        self.go_to(Station::Forward).await?;
        self.shared.homed.signal(());
        loop {
            let Either::First(heading) =
                select(self.shared.wanted.wait(), self.shared.keep.store.wait()).await
            else {
                self.store().await?;
                continue;
            };
            // A heading that is not a multiple of 90° lies beyond the travel of this mount.
            let station = Station::at_heading(heading).map_err(|_| {
                self.shared.give_up(Device::Stage, Trouble::BeyondTravel(heading * DEGREES))
            })?;
            self.go_to(station).await?;
        }
    }

    /// Turns both frames to an orientation at the same time.
    async fn go_to(&mut self, station: Station) -> Result<(), Refusal> {
        let angles = self.configuration.angles(station);
        both(self.outer.turn_to(angles.outer), self.inner.turn_to(angles.inner)).await
    }
}

/// Runs two movements at the same time; the error is that of the outer frame if both fail.
async fn both(
    outer: impl Future<Output = Result<(), Refusal>>,
    inner: impl Future<Output = Result<(), Refusal>>,
) -> Result<(), Refusal> {
    let (outer, inner) = join(outer, inner).await;
    outer.and(inner)
}
