//! Data-ready lines, which tell when a conversion ended.

use orientation::units::Instant;

use crate::fault::Fault;

/// A falling edge of a data-ready line: the end of a conversion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// When the line fell.
    pub at: Instant,
    /// Number of edges until then, this one included; it wraps.
    pub count: u32,
}

/// A data-ready line whose edges are noticed as they come, whatever is done meanwhile.
pub trait DataReady {
    /// Waits until the line is low by an edge that has not been returned before, and returns the latest one. The
    /// future may be dropped at any time without loss.
    ///
    /// # Errors
    /// [`Fault::Bus`] if the line cannot be observed.
    fn edge(&mut self) -> impl Future<Output = Result<Edge, Fault>>;
}
