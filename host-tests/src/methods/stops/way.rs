//! How far the forces on the way say that a vehicle drove from stop to stop, and whether that is what was stated.
//!
//! Between two stops the gyros' rates, less those that they showed at rest, and the forces are integrated from the
//! level and the azimuth found. What the velocity and the level at the next stop are off then is an even and a
//! linearly growing acceleration, and is taken off. What is left is good to a tenth of the way: not enough for the
//! azimuth, but enough to distinguish metres from kilometres and north from east.

use orientation::alignment::site::Site;
use orientation::alignment::stops::stop::Stop;
use orientation::math::rotation::{
    Matrix, Vector, about_down, by, cross, difference, length, levelled, product, scaled, sum,
    transposed, turned, unit,
};

use thiserror::Error;

use crate::recording::ImuRow;

/// Mean radius of the Earth, m.
const RADIUS: f64 = 6.371e6;
/// What of a stop's end and beginning is not quite at rest, s.
const MARGIN_S: f64 = 1.0;
/// Part of a way by which scale errors let it be off.
const SCALE: f64 = 0.1;
/// Part of what was taken off that may be left.
const LEFT: f64 = 0.2;
/// What 1σ of an accelerometer's bias leaves of the way, over that bias and the square of the time: it turns with the
/// vehicle, so that neither an even acceleration nor a growing one is all of it.
const TURNED: f64 = 1.0 / 16.0;
/// What a displacement may be off in any case, m.
const LEAST_M: f64 = 100.0;

/// A drive from one stop to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// How far the vehicle came by its forces, north and east, m.
    pub driven_m: [f64; 2],
    /// How much that may be off beside a tenth of the way, m.
    pub off_m: f64,
    /// How far it came as stated, m.
    pub stated_m: [f64; 2],
}

/// What a displacement is likely to be where it is not north and east in metres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Slip {
    /// Kilometres.
    #[error("they are in kilometres, as it seems: state them in metres")]
    Kilometres,
    /// East and north.
    #[error("north and east are exchanged, as it seems: state north first")]
    Exchanged,
    /// South and west.
    #[error("their signs are reversed, as it seems: state how far each stop lies from the first")]
    Reversed,
    /// None of these.
    #[error("correct them, or leave them out")]
    Unknown,
}

impl Slip {
    /// What a stated displacement would be then.
    fn mended(self, [north, east]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Kilometres => [1e3 * north, 1e3 * east],
            Self::Exchanged => [east, north],
            Self::Reversed => [-north, -east],
            Self::Unknown => [north, east],
        }
    }

    /// What all legs together are likely to be: what fits best of all that fit.
    pub(crate) fn of(legs: &[Leg]) -> Self {
        let all = [Self::Kilometres, Self::Exchanged, Self::Reversed];
        let fits = |slip: &Self| legs.iter().all(|leg| leg.fits(slip.mended(leg.stated_m)));
        let off =
            |slip: Self| legs.iter().map(|leg| leg.off(slip.mended(leg.stated_m))).sum::<f64>();
        let best = all.into_iter().filter(fits).min_by(|a, b| off(*a).total_cmp(&off(*b)));
        best.unwrap_or(Self::Unknown)
    }
}

impl Leg {
    /// How far from where the forces say that it came such a displacement is, m.
    fn off(&self, [north, east]: [f64; 2]) -> f64 {
        let [driven_north, driven_east] = self.driven_m;
        (north - driven_north).hypot(east - driven_east)
    }

    /// Whether the vehicle may have come so far.
    fn fits(&self, stated_m: [f64; 2]) -> bool {
        let way = [stated_m, self.driven_m].map(|[north, east]| north.hypot(east));
        self.off(stated_m) <= self.off_m + SCALE * way[0].max(way[1])
    }

    /// Whether it may have come as far as stated.
    pub(crate) fn is_as_stated(&self) -> bool {
        self.fits(self.stated_m)
    }

    /// Whether what was driven cannot be distinguished from nothing.
    pub(crate) fn tells_nothing(&self) -> bool {
        self.fits([0.0; 2])
    }
}

/// A drive and the way that it took, as the forces have it.
pub(crate) struct Driven {
    /// How far it came.
    pub leg: Leg,
    /// Places from its beginning on, north and east, m, fitted to where it ended as stated.
    pub path_m: Vec<[f64; 2]>,
}

/// The drives between stops whose displacements are stated, from the azimuth at the first one, rad. Times of
/// stops count from `zero_s` on the recording's clock.
pub(crate) fn drives(
    rows: &[ImuRow],
    zero_s: f64,
    period_s: f64,
    stops: &[Stop],
    site: &Site,
    azimuth: f64,
) -> Vec<Driven> {
    let mut azimuth = azimuth;
    let mut drives = Vec::new();
    for pair in stops.windows(2) {
        let [begin, end] = [&pair[0], &pair[1]];
        let [Some(from), Some(to)] = [begin.displacement, end.displacement] else { break };
        let between = |from_s: f64, to_s: f64| {
            let [from, to] = [from_s, to_s]
                .map(|time_s| rows.partition_point(|row| row.time_s <= zero_s + time_s));
            &rows[from..to.max(from)]
        };
        let way = between(begin.to.0 - MARGIN_S, end.from.0 + MARGIN_S);
        let rest = between(end.from.0 + MARGIN_S, end.to.0 - MARGIN_S);
        let mut drive = Drive::from(begin, site, azimuth, period_s);
        let stated_m = [to[0].0 - from[0].0, to[1].0 - from[1].0];
        let mut path_m = Vec::with_capacity(way.len());
        for row in way {
            drive.push(row);
            path_m.push([drive.way[0], drive.way[1]]);
        }
        fit(&mut path_m, stated_m);
        let (driven_m, off_m) = drive.ended(rest);
        azimuth = drive.azimuth();
        drives.push(Driven { leg: Leg { driven_m, off_m, stated_m }, path_m });
    }
    drives
}

/// Takes off a path what its end is beside the stated one, as an even acceleration lets it grow.
fn fit(path_m: &mut [[f64; 2]], stated_m: [f64; 2]) {
    let Some(end) = path_m.last().copied() else { return };
    let count = path_m.len() as f64;
    for (index, place) in path_m.iter_mut().enumerate() {
        let part = (index + 1) as f64 / count;
        for axis in 0..2 {
            place[axis] += (stated_m[axis] - end[axis]) * part * part;
        }
    }
}

/// A drive in progress: north, east, down.
struct Drive {
    /// Body to north, east, down.
    attitude: Matrix,
    bias: Vector,
    earth: Vector,
    gravity: f64,
    force_bias: f64,
    tangent: f64,
    period_s: f64,
    velocity: Vector,
    way: Vector,
    seconds: f64,
}

impl Drive {
    /// From a stop, with an azimuth, rad.
    fn from(stop: &Stop, site: &Site, azimuth: f64, period_s: f64) -> Self {
        let force = stop.force.mean();
        let attitude = product(&about_down(azimuth), &levelled(&unit(&force)));
        let earth = [site.latitude.horizontal_rate().0, 0.0, -site.latitude.vertical_rate().0];
        let felt = turned(&transposed(&attitude), &earth);
        Self {
            attitude,
            bias: difference(&stop.turned.mean(), &felt),
            earth,
            gravity: length(&force),
            force_bias: site.accelerometer_bias_sigma.0,
            tangent: site.latitude.rad().tan(),
            period_s,
            velocity: [0.0; 3],
            way: [0.0; 3],
            seconds: 0.0,
        }
    }

    /// Takes a sample; the force on north, east, down, less what the frame adds.
    fn push(&mut self, row: &ImuRow) -> Vector {
        let [north, east, _] = self.velocity;
        let over = [east / RADIUS, -north / RADIUS, -east * self.tangent / RADIUS];
        let rates = difference(&row.sample.rates_rad_s, &self.bias);
        let frame = by(&scaled(&sum(&self.earth, &over), -self.period_s));
        let body = by(&scaled(&rates, self.period_s));
        self.attitude = product(&product(&frame, &self.attitude), &body);
        let force = turned(&self.attitude, &row.sample.force_m_s2);
        let turning = cross(&sum(&scaled(&self.earth, 2.0), &over), &self.velocity);
        let felt = difference(&sum(&force, &[0.0, 0.0, self.gravity]), &turning);
        self.velocity = sum(&self.velocity, &scaled(&felt, self.period_s));
        self.way = sum(&self.way, &scaled(&self.velocity, self.period_s));
        self.seconds += self.period_s;
        felt
    }

    /// The way, north and east, m, and how much it may be off, m, once the vehicle stands again.
    fn ended(&mut self, rest: &[ImuRow]) -> ([f64; 2], f64) {
        let (way, velocity, seconds) = (self.way, self.velocity, self.seconds);
        self.velocity = [0.0; 3];
        let mut felt = [0.0; 3];
        for row in rest {
            felt = sum(&felt, &self.push(row));
            self.velocity = [0.0; 3];
        }
        let felt = scaled(&felt, 1.0 / rest.len().max(1) as f64);
        let even = [0, 1].map(|axis| velocity[axis] * 0.5 * seconds);
        let growing = [0, 1].map(|axis| felt[axis] * seconds * seconds / 12.0);
        let driven = [0, 1].map(|axis: usize| way[axis] - even[axis] + growing[axis]);
        let taken_off = even[0].hypot(even[1]) + growing[0].hypot(growing[1]);
        let turned = TURNED * self.force_bias * seconds * seconds;
        (driven, LEAST_M + LEFT * taken_off + turned)
    }

    /// Azimuth of body x, rad.
    fn azimuth(&self) -> f64 {
        self.attitude[1][0].atan2(self.attitude[0][0])
    }
}
