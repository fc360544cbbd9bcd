//! A colour for each quantity, the same in all figures of all pages.

use crate::report::Figure;

/// The quantities that pages share, by the colour of the page's style that each has. In one figure no two of them have
/// the same one.
const QUANTITIES: [&[&str]; 8] = [
    // What is found: azimuth and heading, a measured curve, a model.
    &[
        "kept",
        "what is known by then",
        "heading",
        "the whole model",
        "overlapping Allan deviation",
        "optimum",
        "forward",
        "angle between the verticals",
        "inclination",
        "way by the forces, fitted to the stops",
        "W = 2 Ω_h |sin(δ/2)|",
        "Earth's rate less that measured, size",
        "gravity less the force measured, size",
        "phase-locked",
        "encoder",
        "sensor, after that is taken off",
    ],
    // What it is held to.
    &["truth", "true pitch", "threshold", "wanted", "best", "left out", "fit"],
    &["limit (Cramér–Rao)", "the final one ± the limit", "N"],
    // Its standard deviation.
    &["σ", "±1σ", "within 1σ", "σ(t)", "σ of the phase lock", "1σ of pitch and of roll", "B"],
    // Pairs: pitch and roll, north and east, what comes first and what comes second.
    &[
        "pitch",
        "right",
        "north",
        "about north of the level frame",
        "p′ = Ω_h (1 − cos δ)",
        "extrema",
        "sensor, before",
        "K",
    ],
    &[
        "roll",
        "down",
        "east",
        "about east of the level frame",
        "q′ = Ω_h sin δ",
        "interpolated",
        "platform's rate as the axis misalignment shows it",
        "stops",
        "R",
    ],
    // What it is off, and what a model leaves.
    &[
        "error",
        "size of the error",
        "scale error",
        "rate error",
        "one run each",
        "one drive each",
        "dwells",
        "measured less the whole model",
        "the plan",
        "true roll",
    ],
    &["Q"],
];

/// The quantities that have a colour, and those of this page alone, in the order in which they came.
#[derive(Default)]
pub(super) struct Palette {
    others: Vec<String>,
}

impl Palette {
    /// The colour of each series of a figure, by its class in the page's style. Two quantities of one figure have the same
    /// one only where it has more of them than there are colours.
    pub fn classes(&mut self, figure: &Figure) -> Vec<String> {
        let names = || figure.series.iter().map(|series| quantity(&series.name));
        let mut taken: Vec<(&str, usize)> =
            names().filter_map(|name| Some((name, shared(name)?))).collect();
        for name in names() {
            if taken.iter().all(|(other, _)| *other != name) {
                let is_free = |colour: &usize| taken.iter().all(|(_, other)| other != colour);
                let own = self.colour(name);
                let all = [own].into_iter().chain(0..QUANTITIES.len());
                taken.push((name, all.into_iter().find(is_free).unwrap_or(own)));
            }
        }
        let colour = |name| taken.iter().find(|(other, _)| *other == name).map_or(0, |(_, at)| *at);
        names().map(|name| format!("s{}", colour(name))).collect()
    }

    /// The colour of a quantity of this page alone, from now on where it has none yet.
    fn colour(&mut self, name: &str) -> usize {
        let known = self.others.iter().position(|other| other == name);
        let place = known.unwrap_or_else(|| {
            self.others.push(name.to_owned());
            self.others.len() - 1
        });
        place % QUANTITIES.len()
    }
}

/// The colour of a quantity that pages share.
fn shared(quantity: &str) -> Option<usize> {
    QUANTITIES.iter().position(|names| names.contains(&quantity))
}

/// What a series is of: a quantity, the bands of its σ, its points that are hardly known, and what the solution makes of it
/// have one colour, and so have all stops. A coefficient of the noise is named by its letter.
fn quantity(name: &str) -> &str {
    let name = match name {
        "limits of 68.3 %" | "fewer than 8 degrees of freedom" => "overlapping Allan deviation",
        _ if name.starts_with("stop ") => "stops",
        _ => name.strip_prefix("the solution, ").unwrap_or(name),
    };
    if name.contains(", slope ") {
        return &name[..name.chars().next().map_or(0, char::len_utf8)];
    }
    let ends = [" ±1σ", " ±3σ", ", each with its 1σ", ", with 1σ"];
    ends.into_iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name)
}
