//! A colour for each name, the same in all figures of a page.

use crate::report::Figure;

/// How many colours the page's style has for series.
const COLOURS: usize = 8;

/// The names that have a colour, in the order in which they came.
#[derive(Default)]
pub(super) struct Palette {
    names: Vec<String>,
}

impl Palette {
    /// The colour of each series of a figure, by its class in the page's style. Two names of one figure have the same one
    /// only where it has more names than there are colours.
    pub fn classes(&mut self, figure: &Figure) -> Vec<String> {
        let mut taken: Vec<(&str, usize)> = Vec::new();
        for series in &figure.series {
            let name = quantity(&series.name);
            if taken.iter().all(|(other, _)| *other != name) {
                let is_free = |colour: &usize| taken.iter().all(|(_, other)| other != colour);
                let own = self.colour(name);
                let colour = [own].into_iter().chain(0..COLOURS).find(is_free).unwrap_or(own);
                taken.push((name, colour));
            }
        }
        let colour = |name| taken.iter().find(|(other, _)| *other == name).map_or(0, |(_, at)| *at);
        figure.series.iter().map(|series| format!("s{}", colour(quantity(&series.name)))).collect()
    }

    /// The colour of a name, from now on where it has none yet.
    fn colour(&mut self, name: &str) -> usize {
        let known = self.names.iter().position(|other| other == name);
        let place = known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        });
        place % COLOURS
    }
}

/// What a series is of: a quantity and the bands of its σ have one colour.
fn quantity(name: &str) -> &str {
    [" ±1σ", " ±3σ"].into_iter().find_map(|band| name.strip_suffix(band)).unwrap_or(name)
}
