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

/// Difference of latitudes that is told, °: what one states more exactly than another differs by less.
const OTHER_LATITUDE_DEG: f64 = 0.1;

/// A recording and what a user asks of it: what a replay is made from.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// What the recording's header states.
    pub header: &'a Header,
    /// Its rows.
    pub body: &'a Body,
    /// What the user asks.
    pub asked: &'a Asked,
}

impl Question<'_> {
    /// Displacements of the stops: the user's, or the header's.
    pub(crate) fn displacements_m(&self) -> Option<&[[f64; 2]]> {
        self.asked.displacements_m.as_deref().or(self.header.displacements_m.as_deref())
    }

    /// That the user's latitude is another one than the header's, where it is.
    #[must_use]
    pub fn other_latitude(&self) -> Option<String> {
        let [asked, stated] = [self.asked.latitude?.rad().to_degrees(), self.header.latitude_deg?];
        let is_other = (asked - stated).abs() > OTHER_LATITUDE_DEG;
        is_other.then(|| {
            format!("the latitude is taken to be {asked:.4}°; the recording states {stated:.4}°")
        })
    }

    /// The user's latitude, or the header's.
    ///
    /// # Errors
    /// Neither gives one.
    pub(crate) fn latitude(&self) -> Result<Latitude, ReplayError> {
        let stated = self.header.latitude_deg.and_then(Latitude::from_degrees);
        self.asked.latitude.or(stated).ok_or(ReplayError::NoLatitude(self.body.kind()))
    }

    /// Site and instrument as header and user state them.
    ///
    /// # Errors
    /// There is no latitude.
    pub(crate) fn site(&self, assumed: &mut Vec<String>) -> Result<Site, ReplayError> {
        let mut site = describe(self, self.latitude()?, assumed);
        self.asked.change(&mut site);
        Ok(site)
    }
}
