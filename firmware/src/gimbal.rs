//! The two-frame mount under control: homes both frames, turns both at once to where the session wants
//! the gyro's axis, and takes it to the vertical for the storage of azimuth.
//!
//! Each frame is a [`Stage`] of its own: motor and encoder must agree after every movement, and what
//! goes wrong is told with the frame's name.

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

/// The names of the two frames' devices.
const OUTER: Axis = Axis { drive: Device::OuterFrame, encoder: Device::OuterEncoder };
const INNER: Axis = Axis { drive: Device::InnerFrame, encoder: Device::InnerEncoder };

/// Both frames.
pub struct Gimbal<'a, M, O> {
    outer: Stage<'a, M, O>,
    inner: Stage<'a, M, O>,
    configuration: &'a FramesConfiguration,
    latest: &'a Frames<LatestAngle>,
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

    /// Homes, then goes where it is sent until a frame must be given up; gives the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.serve().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    /// Takes the gyro's axis to the vertical.
    ///
    /// # Errors
    /// A frame that had to be given up on the way, which is told.
    pub async fn store(&mut self) -> Result<(), Refusal> {
        self.go_to(Station::Storage).await?;
        let shown = |latest: &LatestAngle| latest.get().0.signed_rad() * DEGREES;
        self.shared.tell(Event::Stored(shown(&self.latest.outer), shown(&self.latest.inner)));
        Ok(())
    }

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
            let station = Station::at_heading(heading).map_err(|_| {
                self.shared.give_up(Device::Stage, Trouble::BeyondTravel(heading * DEGREES))
            })?;
            self.go_to(station).await?;
        }
    }

    async fn go_to(&mut self, station: Station) -> Result<(), Refusal> {
        let angles = self.configuration.angles(station);
        both(self.outer.turn_to(angles.outer), self.inner.turn_to(angles.inner)).await
    }
}

/// Both at once; the first reason why not.
async fn both(
    outer: impl Future<Output = Result<(), Refusal>>,
    inner: impl Future<Output = Result<(), Refusal>>,
) -> Result<(), Refusal> {
    let (outer, inner) = join(outer, inner).await;
    outer.and(inner)
}
