//! The simulated world that feeds the orientation board: Earth, stage, sensors, one seed.
//!
//! On a schedule, as a recording:
//!
//! ```text
//!  stops ─▶ stage ─angle─▶ site (Earth rate, gravity) ─▶ gyro, accelerometer ─▶ sample
//!             └─▶ encoder ────────────────────────────────────────────────────▶
//!                            disturbance, temperature ─▶
//! ```
//!
//! On a platform that turns all the time ([`turntable`]), as a recording too:
//!
//! ```text
//!  segments ─▶ motor ─▶ uneven gear ─angle, rate─▶ site ─▶ gyro or molecular sensor ─▶ sample
//!                             └─▶ encoder ─▶ slip ─▶         accelerometer, lever ───▶
//! ```
//!
//! Or a vehicle that stands and drives ([`vehicle`]), with three gyros and accelerometers fixed to it:
//!
//! ```text
//!  legs, events ─▶ route ─▶ motion on the rotating ellipsoid ─∫ω, ∫f─▶ gyros, accelerometers ─▶ sample
//! ```
//!
//! Or a body that flies and turns fast about its long axis ([`spin`]), with three gyros and two
//! accelerometers fixed to it:
//!
//! ```text
//!  lift, spin ─▶ flight ─▶ ω, q in the body's axes, ρω² ─▶ gyros, accelerometers ─▶ sample
//! ```
//!
//! Or around a firmware that turns the stage itself, in virtual time, at the level of registers:
//!
//! ```text
//!  driver ⇄ fault ⇄ spi ⇄ board ┬ ads1262 ◀─volts── plant: instruments as above,
//!                               ├ adxl355 ◀─force──        on the stage's mechanics,
//!                               ├ mt6835 ◀──angle──        on a base that may sway;
//!                               └ tmc5160 ─microsteps─▶    the stage may turn without end
//!  driver ⇄ i2c ⇄ lsm6dsl ◀─rates, forces── base that sways
//! ```
//!
//! A two-frame mount ([`gimbal`]) has six chips around a plant of its own, a vehicle
//! ([`vehicle::plant`]) three converters and an accelerometer, a spinning body ([`spin::plant`]) five
//! converters. The latter two are one type of board ([`converters`]); what all boards have in common,
//! order of events, losses of supply, the bus and the record of forbidden accesses, is an
//! [`assembly::Board`].
//!
//! What the microcontroller itself brings with it is the flash in which a board keeps data ([`flash`]).
//! A model of one reaches the chips over wires, byte by byte and pin by pin ([`wires`]); ports in front of
//! drivers ([`spi`], [`i2c`]) do so transaction by transaction.
//!
//! A chip behaves as its data sheet says, and where that promises nothing, it does the worst that is
//! still allowed. What a driver does that the data sheet forbids is recorded ([`violation`]), so that a
//! test can demand that there was nothing.
//!
//! This crate is an oracle. It carries its own reading of the physics, by full rotation matrices, and
//! never depends on the `orientation` crate, so that it can catch that crate's mistakes.
//!
//! Conventions: navigation frame north, east, down; body frame forward, right, down; the *platform*
//! frame is the body frame turned by the stage angle about body z, clockwise from above, so that
//! platform x carries the gyro's sensitive axis. SI units inside; configurations take the units of
//! data sheets, named in each field.
//!
//! One seed gives one run, bit for bit, on every target: all arithmetic is `f64` and libm, every
//! noise source owns a stream of its own (switching one off does not move the others).
#![no_std]
#![forbid(unsafe_code)]

pub mod accelerometer;
pub mod ads1262;
pub mod adxl355;
pub mod assembly;
pub mod board;
mod checksum;
pub mod chip;
pub mod clock;
pub mod converters;
pub mod disturbance;
pub mod earth;
pub mod environment;
pub mod fault;
pub mod flash;
pub mod flicker;
pub mod gimbal;
pub mod gyro;
pub mod i2c;
pub mod instruments;
pub mod lsm6dsl;
pub mod molecular;
pub mod mt6835;
pub mod noise;
pub mod plant;
mod registers;
pub mod sensor_fault;
pub mod spi;
pub mod spin;
pub mod stage;
mod strapdown;
pub mod temperature;
pub mod tmc5160;
pub mod turntable;
pub mod vehicle;
pub mod violation;
pub mod wires;
pub mod world;
