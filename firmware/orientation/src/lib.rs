//! True north, heading, pitch and roll from inertial sensors, as pure cores.
//!
//! # An alignment
//! A method takes samples and says what it wants done: here it has a stage pointed at eight positions
//! around the circle, and at the first again. The body stands at an azimuth of 30°; the gyro on the
//! stage feels the Earth's rotation, and the accelerometer shows that it stands level.
//!
//! ```
//! use orientation::alignment::stepwise::session::procedure::Procedure;
//! use orientation::alignment::stepwise::session::schedule::Schedule;
//! use orientation::alignment::stepwise::{Session, setting::Setting};
//! use orientation::alignment::{Azimuth, Input, Method, Request};
//! use orientation::earth::Latitude;
//! use orientation::signal::Sample;
//! use orientation::units::{Angle, AngularRate, Instant, Radians, Seconds, SpecificForce};
//!
//! let latitude = Latitude::from_degrees(48.0).expect("a latitude");
//! let azimuth = Radians::from_degrees(30.0);
//! let procedure = Procedure::new(Schedule::closed_circle(8, Seconds(2.0)), Seconds(0.01));
//! let mut session = Session::new(Setting::at(latitude), procedure)?;
//!
//! let (mut microseconds, mut stage) = (0_u32, Radians(0.0));
//! let mut request = session.begin(&mut |progress| println!("{progress}"));
//! while request != Request::Done {
//!     if let Request::Point(angle) = request {
//!         stage = angle;
//!     }
//!     microseconds += 10_000;
//!     // A gyro that shows no noise is refused as stuck.
//!     let noise = 1e-7 * f64::from(microseconds).sin();
//!     let rate = latitude.horizontal_rate().0 * (azimuth.0 + stage.0).cos() + noise;
//!     let sample = Sample {
//!         time: Instant(microseconds.into()),
//!         stage: Angle::from_rad(stage.0),
//!         rate: AngularRate::from_rad_per_s(rate),
//!         force: Some([0.0, 0.0, -latitude.gravity().0].map(SpecificForce::from_m_per_s2)),
//!         ..Sample::default()
//!     };
//!     request = session.feed(Input::Sample(&sample));
//! }
//! let Azimuth { angle, sigma } = session.verdict().expect("it is over")?.azimuth;
//! assert!((angle.0 - azimuth.0).abs() < 5.0 * sigma.0);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! [`navigation::Aligner`] runs any method so, and again where it is ordered; beside it
//! [`navigation::Navigator`] keeps what was found.
//!
//! | you have | use | and read |
//! |---|---|---|
//! | one precise gyro on a stage or two frames that stand at positions | [`alignment::stepwise::Session`] | [`alignment::stepwise`] |
//! | one precise gyro on a platform that rotates all the time | [`alignment::rotating::Session`] | [`alignment::rotating`] |
//! | three gyros and accelerometers in a vehicle that stops | [`alignment::stops::Session`] | [`alignment::stops`] |
//! | three gyros and two accelerometers on a spinning body | [`roll::Flight`] | [`roll`] |
//! | an azimuth, and gyros and accelerometers of any class, to keep it with pitch and roll | [`attitude::Keeper`] | [`attitude`], [`navigation`] |
//! | a record of a gyro at rest, and the question how good it is | [`noise::allan`] | [`noise`] |
//! | a gyro's noise, and the question how long to stand where | [`planner`] | [`planner`] |
//!
//! # The ways of the data
//!
//! ```text
//!  gyro ─counts─▶ filter ─rate─▶ dwell average ─dwell─▶ matcher ─fit─▶ azimuth ± σ
//!                                    ▲ one per stage position   ▲
//!  stage ◀─command─ session ◀─plan─ planner ◀─ Allan variance    etalon table (flash)
//!  accelerometers ─▶ level ───────────────────────▶ (tilt enters the fit)
//! ```
//!
//! On a platform that rotates continuously the path is another, with the same ends:
//!
//! ```text
//!  gyro, encoder ─▶ block ─▶ sums of a turn ─▶ Q₊, Q₋ ─both senses, one or two speeds─▶ azimuth ± σ
//!                              └─modulated─▶ misalignment ▲    accelerometer ─▶ tilt ──▲
//! ```
//!
//! In a vehicle nothing rotates the gyros: three of them carry the attitude from stop to stop.
//!
//! ```text
//!  3 gyros ─▶ strapdown ─▶ frozen start frame ─▶ up at each stop ─▶ filter ─▶ azimuth ± σ
//!  3 accelerometers ─▶ stop criteria ─▶ rest rates ────────────────▶ ▲ Earth rotation, displacement
//! ```
//!
//! After the alignment pitch, roll and azimuth are propagated; the roll of a spinning body is
//! estimated separately.
//!
//! ```text
//!  gyros, accelerometers ─▶ attitude ─▶ level ± σ ─────▶ azimuth ± σ(t)
//!                             ▲ biases ◀─ rest?  alignment ─▲
//!  spinning: gyro ─▶ angle ──▲── phase, scale ◀─ sums of turns ◀─ accelerometers
//! ```
//!
//! Time and numbers go in, results come out: there is no bus, clock, allocator or async here, so
//! the whole procedure can be replayed from a recording.
//!
//! # Conventions
//! The navigation frame is north, east, down; the body frame is forward, right, down. An azimuth is
//! that of body x from true north, clockwise from above. Angles are in rad and rates in rad/s
//! unless a name or a doc line says otherwise; `1σ` is one standard deviation.
//!
//! Quantities that are stated and read have types that are named after their unit, such as
//! [`units::Radians`] and [`units::Seconds`]; `.0` is their number. Samples are integers, such as
//! [`units::AngularRate`]. Ratios, variances and densities, and what the kernels of [`math`],
//! [`filter`] and the fits compute with, are plain `f64` in SI units. The steps of
//! these integers are stated in [`units`].
//!
//! # Glossary
//! The methods, and the terms of this crate, under their names in inertial navigation:
//!
//! | term | meaning here | module |
//! |---|---|---|
//! | multi-position static alignment, gyrocompassing | a gyro is turned to several positions and measures the horizontal Earth rate at each (Sokolov 2019, Burov) | [`alignment::stepwise`] |
//! | dwell | one standstill at a position; its averaged rate is one measurement | [`signal::dwell`] |
//! | reference table (etalon) | Sokolov's table of expected rate differences for every azimuth on a 10″ grid, and the search for the best one | [`alignment::stepwise::etalon`] |
//! | continuous rotation, carouselling | the gyro rotates all the time and its rate is demodulated at the turn (MET 2018) | [`alignment::rotating`] |
//! | rate-modulated turns | turns with a deliberate modulation of the platform's rate, which show the axis misalignment and the lag of the gyro | [`alignment::rotating::misalignment`] |
//! | axis misalignment | angle between the sensitive axis and the plane of rotation | [`alignment::rotating::misalignment::AxisMisalignment`] |
//! | inertial-frame alignment | gravity, seen from a frame frozen in inertial space, rotates with the Earth and shows north (Szymanowski 2003) | [`alignment::stops`] |
//! | strapdown | attitude by integrating the rates of gyros that are fixed to the body | [`signal::strapdown`], [`math::quaternion`] |
//! | coning | rotation that the order of small rotations adds, and its compensation | [`signal::strapdown`] |
//! | zero-velocity update | the knowledge that a body at rest has zero velocity and turns with the Earth alone, used as a measurement | [`signal::rest`], [`alignment::stops`], [`attitude`] |
//! | AHRS, gyrovertical | attitude and heading reference: pitch and roll from gyros and accelerometers, with the azimuth held | [`attitude`] |
//! | heading hold, storage of azimuth | propagation of a known azimuth by the gyros, with its growing σ (Burov) | [`attitude`] |
//! | roll of a spinning body | phase of the lift in the transverse forces, as a correction of the gyro (Nekrasova 2017) | [`roll`] |
//! | g-sensitivity | response of a gyro to specific force, κ in rad/s per g; with a tilt it acts as an Earth rate | [`alignment::stepwise::setting`], [`alignment::budget`] |
//! | angle random walk | white noise N of a gyro, °/√h; with bias instability B, rate random walk K, rate ramp R and quantisation Q the noise model | [`noise::model`], [`noise::allan`] |
//! | Cramér–Rao bound | least standard deviation that any estimator reaches with the same data and unknowns; the `limit` of every result | [`alignment::stepwise`], [`alignment::rotating::solution`] |
//! | normalised innovation squared | squared difference between measurement and prediction over its variance, by which outliers are rejected | [`alignment::stops`], [`noise::whitener`] |
//! | sway compensation | subtraction of the base's motion, measured by coarse sensors, from the precise gyro's rate (Burov) | [`signal::sway`] |
//! | error budget | contributions to the standard deviation of an azimuth; their root sum of squares is σ | [`alignment::budget`] |
//! | autocompensation | cancelling a gyro's drift by turning it between positions, and the best schedule for that (Burov) | [`planner`], [`planner::burov`] |
//!
//! # Sources
//! Papers are cited by author and year; what each gave is said where it is used.
//!
//! | cited as | source |
//! |---|---|
//! | Sokolov 2019 | S. Sokolov, A. Novikov, V. Ivetić, *Determining the Initial Orientation for Navigation and Measurement Systems of Mobile Apparatus in Reforestation*, 2019 |
//! | Burov | D. A. Burov, E. I. Verzunov, *Creation of Orientation Systems for Mobile Robots*; its text states no year |
//! | MET 2018 | a study of azimuth errors in the dynamic scheme of north finding by a molecular-electronic (MET) angular motion sensor; the text that was at hand states neither authors nor title, and its formulas were lost: they are derived anew |
//! | Szymanowski 2003 | J. Szymanowski, J. Grzelak, S. Popowski, *Static Initial Azimuth Update Method in Land Navigation Systems*, Annual of Navigation 6/2003 |
//! | Nekrasova 2017 | M. Nekrasova, V. Uspenskiy, *Improving the Accuracy of Determining Orientation of a Rapidly Rotating Object* |
//! | IEEE Std 952-1997 | the gyro's noise model and its Allan variance |
#![no_std]
#![forbid(unsafe_code)]

pub mod checksum;
pub mod units;
pub mod words;

pub mod device;
pub mod earth;
pub mod math;
pub mod timebase;

pub mod signal;

pub mod noise;

pub mod planner;

pub mod filter;

pub mod alignment;

pub mod attitude;
pub mod roll;

pub mod navigation;
