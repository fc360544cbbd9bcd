//! The mechanism that carries the sensors, as the session commands it.

use core::convert::Infallible;
use core::future::pending;

use embassy_futures::select::select;
use orientation::alignment::refusal::Refusal;

use crate::shared::Shared;

/// A mechanism that executes the requests of a session: a stage, a two-frame mount, a turntable, or
/// none.
pub trait Mechanism {
    /// Brings the mechanism to its reference, then executes requests without end.
    ///
    /// # Errors
    /// The reason for which the mechanism or its encoder is given up.
    async fn serve(&mut self) -> Result<Infallible, Refusal>;

    /// Brings the mechanism to rest, within 10 s, once it was given up or the run is over. Where a motor does not
    /// obey, its current is taken away ([`Shared::current`]).
    async fn halt(&mut self) {}

    /// Brings the mechanism to where it is to stand after the run, while `meanwhile`, which never
    /// ends, takes the samples. If that fails, the log has the reason.
    async fn park(&mut self, meanwhile: impl Future<Output = ()>) {
        select(self.halt(), meanwhile).await;
    }
}

/// Sensors fixed to the body (strapdown): there is nothing to turn.
#[derive(Debug)]
pub struct Strapdown;

impl Strapdown {
    /// Reports at once that the angles are valid, since there is no index to find.
    pub fn new(shared: &Shared<'_>) -> Self {
        shared.homed.signal(());
        shared.is_strapdown.set(true);
        Self
    }
}

impl Mechanism for Strapdown {
    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        pending().await
    }
}
