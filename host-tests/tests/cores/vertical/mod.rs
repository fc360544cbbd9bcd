//! Holds pitch, roll and the kept azimuth to closed forms and to what may go wrong.

mod attitude;
mod faults;
mod forces;
mod gaps;
mod honesty;
mod rest;
mod slope;
mod swaying;
mod unseen;
mod wheels;
mod world;

use crate::support::assert_near;
