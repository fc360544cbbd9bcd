//! Holds azimuth from stops to closed forms, to scipy, and to simulated vehicles.

mod criteria;
mod drives;
mod gaps;
mod inclination;
mod increments;
mod minimum;
mod place;
mod refusals;
mod rotations;
mod strapdown;
mod swaying;
mod turns;
mod weak;
mod world;

use crate::support::assert_near;
