//! Stub.
#![allow(missing_docs)]
use crate::align::conclusion::Azimuth;
use crate::align::setting;
use crate::error::Refusal;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub common: setting::Setting,
    pub bias_sigma: Option<f64>,
    pub force_noise: Option<f64>,
    pub displacement_sigma: f64,
    pub speed_sigma: f64,
}
impl Setting {
    #[must_use]
    pub fn new(common: setting::Setting) -> Self {
        Self { common, bias_sigma: None, force_noise: None, displacement_sigma: 1.0, speed_sigma: 20.0 }
    }
}
#[derive(Clone, Debug)]
pub struct Conclusion {
    pub verdict: Result<Azimuth, Refusal>,
    pub start: Option<Azimuth>,
    pub limit: f64,
    pub biases: Option<([f64; 3], [f64; 3])>,
    pub level: [f64; 2],
}
