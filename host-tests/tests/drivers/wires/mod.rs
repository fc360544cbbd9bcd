//! The wires of the buses: the chips answer byte by byte as by transaction, every rule of the wires is held, and
//! each driver starts over them as over its port.

mod bench;
mod bring_up;
mod i2c;
mod interrupted;
mod rules;
mod same;
