//! What came over a link beside answers, and what that says where none came.

use crate::output::counted;

/// Component of an instrument in a MAVLink network, that of the first inertial measurement unit.
const INSTRUMENT: u8 = 200;
/// How the sentences of an instrument begin.
const OWN: [&str; 4] = ["PMRD", "HE", "PHTRO", "PHINF"];
/// Characters of an example that are shown.
const SHOWN: usize = 60;

/// What came over a link, counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Heard {
    /// All bytes.
    pub bytes: usize,
    /// Bytes that are part of no sentence, frame or line of text.
    pub noise: usize,
    /// Sentences and frames of an instrument.
    own: usize,
    /// The first sentence, frame or line of something else.
    other: Option<Other>,
}

/// What something else sends.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Other {
    /// A sentence.
    Sentence(String),
    /// A frame of this component.
    Frame(u8),
    /// A line of text.
    Text(String),
}

impl Other {
    /// What was heard of it, and what to do.
    fn in_words(&self) -> String {
        match self {
            Self::Sentence(line) => {
                format!("another device was heard, as `{line}`; name the port of the instrument")
            }
            Self::Frame(component) => format!(
                "another device was heard, the component {component} of a MAVLink network; name the port of the instrument"
            ),
            Self::Text(line) => format!(
                "text was heard, as `{line}`, and no sentence: it is another device, or firmware that takes no commands; name \
                 the port of the instrument, or flash it anew with `cargo board`"
            ),
        }
    }
}

/// That nothing was heard at a serial port of this rate, or at a stream without one, and what to do.
fn nothing(rate: &str) -> String {
    if rate.is_empty() {
        return "nothing was heard: what serves it is no instrument, or stands still".to_owned();
    }
    format!(
        "nothing was heard: it is another port, another baud rate than {rate} (--baud), or the board is off; `meridian doctor` \
         lists the ports"
    )
}

impl Heard {
    /// Counts a sentence.
    pub(super) fn sentence(&mut self, line: &str) {
        if OWN.iter().any(|begin| line[1..].starts_with(begin)) {
            self.own += 1;
        } else {
            self.other.get_or_insert_with(|| Other::Sentence(shown(line)));
        }
    }

    /// Counts a frame of a component.
    pub(super) fn frame(&mut self, component: u8) {
        if component == INSTRUMENT {
            self.own += 1;
        } else {
            self.other.get_or_insert(Other::Frame(component));
        }
    }

    /// Counts a line of text.
    pub(super) fn text(&mut self, line: &str) {
        self.other.get_or_insert_with(|| Other::Text(shown(line)));
    }

    /// What was heard instead of an answer, and what to do, at a serial port of this baud rate or a stream without one.
    #[must_use]
    pub fn instead(&self, baud: Option<u32>) -> String {
        let rate = baud.map(|baud| format!("{baud} baud")).unwrap_or_default();
        if self.bytes == 0 {
            return nothing(&rate);
        }
        if self.own > 0 {
            return format!(
                "the instrument was heard ({}) but does not answer: it was starting, the line to it is not connected, or its \
                 firmware takes no commands; try once more, check the wire, or flash it anew with `cargo board`",
                counted(self.own, "sentence")
            );
        }
        match &self.other {
            Some(other) if 2 * self.noise <= self.bytes => other.in_words(),
            _ => self.of_noise(&rate),
        }
    }

    /// What noise says.
    fn of_noise(&self, rate: &str) -> String {
        let bytes = counted(self.bytes, "byte");
        if rate.is_empty() {
            return format!("{bytes} of noise were heard: what serves it is no instrument");
        }
        format!(
            "{bytes} of noise were heard: the instrument has another baud rate than {rate} (--baud), or it is another device"
        )
    }
}

/// The beginning of a line.
fn shown(line: &str) -> String {
    line.chars().take(SHOWN).collect()
}
