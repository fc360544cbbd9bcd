//! Holds the north finder on a platform that turns all the time to closed forms, to plain arithmetic
//! written here, and to the truth of a simulated platform.

mod integrity;
mod met;
mod misalignment;
mod molecular;
mod outcome;
mod phasor;
mod platform_faults;
mod rig;
mod sensor_faults;
mod stretch;
mod table;
