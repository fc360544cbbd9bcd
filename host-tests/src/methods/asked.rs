//! What a user asks of a replay, whatever the method.

use orientation::alignment::site::Site;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::setting::Half;
use orientation::earth::Latitude;
use orientation::units::{DEGREE, Radians};

use super::error::ReplayError;
use crate::recording::{Body, Header};
use crate::setting::describe;

/// Greatest 1σ that is accepted where none is asked for, rad: 10°, as [`orientation::alignment::site::Site`] has it.
pub const REQUIRED_SIGMA: f64 = 10.0 * DEGREE;

/// What a user asks of a replay, whatever the method; what is not asked for is as the recording has it.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Name of the method; `None` for the one that the recording shows.
    pub method: Option<&'static str>,
    /// Latitude instead of the header's.
    pub latitude: Option<Latitude>,
    /// How the azimuth is found; of a stage that stops.
    pub criterion: Option<Criterion>,
    /// The half of the circle in which the azimuth lies, where that is known; of a stage that stops.
    pub half: Option<Half>,
    /// Displacements of the stops, north and east, m, instead of the header's; of a vehicle.
    pub displacements_m: Option<Vec<[f64; 2]>>,
    /// Greatest accepted 1σ, rad.
    pub required_sigma: Option<f64>,
}

impl Asked {
    /// Displacements of the stops: the user's, or the header's.
    pub(crate) fn displacements_m<'a>(&'a self, header: &'a Header) -> Option<&'a [[f64; 2]]> {
        self.displacements_m.as_deref().or(header.displacements_m.as_deref())
    }

    /// The user's latitude, or the header's.
    ///
    /// # Errors
    /// Neither gives one.
    pub(crate) fn latitude(&self, header: &Header, body: &Body) -> Result<Latitude, ReplayError> {
        let stated = header.latitude_deg.and_then(Latitude::from_degrees);
        self.latitude.or(stated).ok_or(ReplayError::NoLatitude(body.kind()))
    }

    /// Site and instrument as header and user state them.
    ///
    /// # Errors
    /// There is no latitude.
    pub(crate) fn describe(
        &self,
        header: &Header,
        body: &Body,
        assumed: &mut Vec<String>,
    ) -> Result<Site, ReplayError> {
        let mut site = describe(header, body, self.latitude(header, body)?, assumed);
        self.change(&mut site);
        Ok(site)
    }

    /// Greatest accepted 1σ of a method whose recordings hold none, rad.
    pub(crate) fn required_sigma(&self) -> f64 {
        self.required_sigma.unwrap_or(REQUIRED_SIGMA)
    }

    /// Puts what the user states in the place of what a session was given.
    pub(crate) fn change(&self, site: &mut Site) {
        site.latitude = self.latitude.unwrap_or(site.latitude);
        site.required_sigma = self.required_sigma.map_or(site.required_sigma, Radians);
    }
}
