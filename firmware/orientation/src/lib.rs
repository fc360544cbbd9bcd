//! True north, heading, pitch and roll from inertial sensors, as pure cores.
//!
//! ```text
//!  gyro ─counts─▶ filter ─rate─▶ dwell average ─dwell─▶ matcher ─fit─▶ azimuth ± σ
//!                                    ▲ one per stage position   ▲
//!  stage ◀─command─ session ◀─plan─ planner ◀─ Allan variance    etalon table (flash)
//!  accelerometers ─▶ level ───────────────────────▶ (tilt enters the fit)
//! ```
//!
//! On a platform that turns all the time the path is another, with the same ends:
//!
//! ```text
//!  gyro, encoder ─▶ block ─▶ sums of a turn ─▶ Q₊, Q₋ ─both senses, one or two speeds─▶ azimuth ± σ
//!                              └─uneven turn─▶ coupling ──▲    accelerometer ─▶ tilt ──▲
//! ```
//!
//! In a vehicle nothing turns the gyros: three carry the attitude from stop to stop.
//!
//! ```text
//!  3 gyros ─▶ strapdown ─▶ frozen start frame ─▶ up at each stop ─▶ filter ─▶ azimuth ± σ
//!  3 accelerometers ─▶ stop criteria ─▶ rest rates ────────────────▶ ▲ Earth rotation, displacement
//! ```
//!
//! What was found is kept, and pitch and roll with it; the roll of a spinning body is followed apart.
//!
//! ```text
//!  gyros, accelerometers ─▶ attitude ─▶ level ± σ ─────▶ azimuth ± σ(t)
//!                             ▲ biases ◀─ rest?  alignment ─▲
//!  spinning: gyro ─▶ angle ──▲── phase, scale ◀─ sums of turns ◀─ accelerometers
//! ```
//!
//! Time and numbers go in, results come out: there is no bus, clock, allocator or async here, so
//! the whole procedure can be replayed from a recording.
#![no_std]
#![forbid(unsafe_code)]

mod checksum;
pub mod units;
pub mod words;

pub mod device;
pub mod earth;
pub mod error;
pub mod math;

pub mod signal;

pub mod noise;

pub mod align;

pub mod planner;

pub mod keep;

pub mod session;
