//! The classes of coarse sensors on a simulated base.

/// A class of coarse sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoarseClass {
    /// Noise density of the gyros, m°/s/√Hz.
    pub rate_mdps_sqrt_hz: f64,
    /// Noise density of the accelerometers, µg/√Hz.
    pub force_ug_sqrt_hz: f64,
}

impl CoarseClass {
    /// LSM6DSL (data sheet, Mechanical characteristics): 4 m°/s/√Hz, 90 µg/√Hz.
    pub const LSM6DSL: Self = Self { rate_mdps_sqrt_hz: 4.0, force_ug_sqrt_hz: 90.0 };
    /// The best micromechanical sensors on a base: 0.3 m°/s/√Hz, 25 µg/√Hz.
    pub const FINE: Self = Self { rate_mdps_sqrt_hz: 0.3, force_ug_sqrt_hz: 25.0 };
}
