//! What goes wrong with the gyros and accelerometers fixed to a body, by channel and time.

/// Something that goes wrong with the sensors, for [from, until) in s from the start. Channels 0 to 2 are
/// the gyros forward, right, down, 3 to 5 the accelerometers; of a spinning body 0
/// to 2 are the gyros about x, y and z, 3 and 4 the accelerometers along y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorFault {
    /// Failure of the sensor.
    pub failure: SensorFailure,
    /// Beginning of the fault, s from the start.
    pub from_s: f64,
    /// End of the fault, s from the start.
    pub until_s: f64,
}

/// What a sensor, by its channel, or all of them do that are faulty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorFailure {
    /// Samples that end in this time are missing.
    Gap,
    /// The channel shows its full scale, as under an overload.
    Saturated(usize),
    /// What the channel shows is not a number.
    NotANumber(usize),
    /// The channel repeats its last value.
    Stuck(usize),
}

impl SensorFault {
    /// Whether one of some faults has the sample missing that ends at a time in s.
    pub(crate) fn lost(faults: &[Self], time_s: f64) -> bool {
        faults.iter().any(|fault| fault.failure == SensorFailure::Gap && fault.is_on(time_s))
    }

    /// What a channel shows at a time in s of a value, after the last one, both in its unit. Faults act in
    /// their order, each on what the one before left; then the channel clips at ±`full`.
    pub(crate) fn spoilt(
        faults: &[Self],
        channel: usize,
        time_s: f64,
        [value, last]: [f64; 2],
        full: f64,
    ) -> f64 {
        let mut shown = value;
        for fault in faults.iter().filter(|fault| fault.is_on(time_s)) {
            match fault.failure {
                SensorFailure::Saturated(at) if at == channel => shown = full,
                SensorFailure::NotANumber(at) if at == channel => shown = f64::NAN,
                SensorFailure::Stuck(at) if at == channel => shown = last,
                _ => {}
            }
        }
        // Full scale leaves what is not a number as it is.
        if shown.abs() > full { libm::copysign(full, shown) } else { shown }
    }

    /// Whether the failure acts at a time in s from the start.
    fn is_on(&self, time_s: f64) -> bool {
        (self.from_s..self.until_s).contains(&time_s)
    }
}
