//! Holds pitch, roll and the kept azimuth (equations.md §3, §7) to closed forms and to what may go wrong.

mod attitude;
mod faults;
mod forces;
mod gaps;
mod honesty;
mod rest;
mod slope;
mod unseen;
mod wheels;
mod world;

use crate::support::assert_near;
