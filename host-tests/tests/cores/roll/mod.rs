//! Holds the roll of a spinning body to closed forms and to what may go wrong.

mod faults;
mod lock;
mod world;
