//! What makes a molecular-electronic sensor of rotation another thing than a gyro: a liquid that
//! feels linear acceleration too, and that passes neither steady nor quick rotation.
//!
//! ```text
//!  felt u ──▶ (+) ──▶ s/(s + ω) ──▶ 1/(1 + τs) ──▶ shown
//!  force f ─▶ κ/s ─▲   high-pass      lag
//! ```
//!
//! In steady turning at w in direction d = ±1, a phasor U of what is felt and the tilt phasor F show
//! as H·(U + κF/(jdw)), H = jdw/(jdw + ω)/(1 + jdwτ), exactly. The integral and the high-pass are one
//! state x with x′ = −ωx + (ωu − κf), shown u − x: so the integral never grows beyond κ·f/ω, and
//! without a high-pass it is a plain integral from the first sample.
//!
//! Between two samples the input of each filter is taken to be linear, and its response is exact. Of a
//! sine at w this makes, at a sample period h, at most (w² + wω)h²/12 relative in a rate and w²h²/6 in
//! a force: 2·10⁻⁵ at 1 rad/s and 100 Hz. White noise is felt, sample by sample, as the nodes of such
//! lines; noise of the electronics behind, bias included, passes no filter.

/// Dynamics of a molecular-electronic sensor; the default adds nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MolecularConfiguration {
    /// The sensor's g-sensitivity (`κ_M1`, `κ_M2`), rad/s² per g: by how much the shown rate grows in a second of
    /// specific force along the sensitive axis and 90° clockwise of it.
    pub force_rad_s2_g: [f64; 2],
    /// Corner of the high-pass, Hz, ≥ 0; zero for none.
    pub high_pass_hz: f64,
    /// Time constant τ of the low-pass, s, ≥ 0; zero for none.
    pub lag_s: f64,
}

/// The sensor at work.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Molecular {
    /// g-sensitivity along the sensitive axis and 90° clockwise of it, rad/s² per g.
    force_rad_s2_g: [f64; 2],
    /// The high-pass, as the lag that is taken away, with the integral of the force.
    slow: Lag,
    /// The low-pass.
    lag: Option<Lag>,
    /// Inputs of both lags at the latest sample; none before the first.
    before: Option<[f64; 2]>,
}

impl Molecular {
    /// A sensor read `rate_hz` times a second, > 0.
    pub(crate) fn new(configuration: &MolecularConfiguration, rate_hz: f64) -> Self {
        let c = configuration;
        let slow = Lag::new(core::f64::consts::TAU * c.high_pass_hz, 1.0 / rate_hz);
        let lag = (c.lag_s > 0.0).then(|| Lag::new(1.0 / c.lag_s, 1.0 / rate_hz));
        Self { force_rad_s2_g: c.force_rad_s2_g, slow, lag, before: None }
    }

    /// What the sensor shows next, rad/s, of a felt rate and its noise in rad/s and a specific force along
    /// and across its axis in g. The first sample finds it settled to what it feels, noise apart.
    pub(crate) fn sample(&mut self, felt_rad_s: f64, noise_rad_s: f64, force_g: [f64; 2]) -> f64 {
        let [along, across] = self.force_rad_s2_g;
        let growth = along * force_g[0] + across * force_g[1];
        if self.before.is_none() {
            self.settle(felt_rad_s, growth);
        }
        let before = self.before.unwrap_or_default();
        let input_rad_s = felt_rad_s + noise_rad_s;
        let slow_input = self.slow.corner_rad_s * input_rad_s - growth;
        let passed = input_rad_s - self.slow.pass(before[0], slow_input);
        let lag_input = self.lag.as_ref().map_or(0.0, |lag| lag.corner_rad_s * passed);
        self.before = Some([slow_input, lag_input]);
        self.lag.as_mut().map_or(passed, |lag| lag.pass(before[1], lag_input))
    }

    /// Comes to rest with a steady input.
    fn settle(&mut self, felt_rad_s: f64, growth_rad_s2: f64) {
        let slow_input = self.slow.corner_rad_s * felt_rad_s - growth_rad_s2;
        let passed = felt_rad_s - self.slow.settle(slow_input);
        let lag_input = self.lag.as_mut().map_or(0.0, |lag| {
            let input = lag.corner_rad_s * passed;
            lag.settle(input);
            input
        });
        self.before = Some([slow_input, lag_input]);
    }
}

/// x′ = −ωx + p with p linear between samples: x(h) = e^(−ωh)·x + (I₀ − I₁)·p(0) + I₁·p(h), where
/// I₀ = (1 − e^(−ωh))/ω and I₁ = (1 − I₀/h)/ω. Without a corner, an integral by trapezoids.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lag {
    /// ω, rad/s.
    corner_rad_s: f64,
    /// e^(−ωh), 1.
    keep: f64,
    /// I₀ − I₁, s.
    from: f64,
    /// I₁, s.
    to: f64,
    /// x, rad/s.
    state: f64,
}

/// Below this ωh a series is nearer to I₁ than its formula, which cancels: both are good to 10⁻¹¹.
const SMALL: f64 = 1e-5;

impl Lag {
    /// A lag at zero with a corner in rad/s, ≥ 0, for samples `period_s` seconds apart.
    fn new(corner_rad_s: f64, period_s: f64) -> Self {
        let turn = corner_rad_s * period_s;
        let (whole, to) = if turn < SMALL {
            (period_s * (1.0 - 0.5 * turn), period_s * (0.5 - turn / 6.0))
        } else {
            let whole = -libm::expm1(-turn) / corner_rad_s;
            (whole, (1.0 - whole / period_s) / corner_rad_s)
        };
        Self { corner_rad_s, keep: libm::exp(-turn), from: whole - to, to, state: 0.0 }
    }

    /// State of the sensor after a period in which the input went from one value to another.
    fn pass(&mut self, from: f64, to: f64) -> f64 {
        self.state = self.keep * self.state + self.from * from + self.to * to;
        self.state
    }

    /// State of the sensor under an input that has stood for ever; an integral begins at zero.
    fn settle(&mut self, input: f64) -> f64 {
        self.state = if self.corner_rad_s > 0.0 { input / self.corner_rad_s } else { 0.0 };
        self.state
    }
}
