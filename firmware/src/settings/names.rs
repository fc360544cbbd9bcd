//! Settings by their names, in their users' units: as they are typed on a terminal, written in a file, and sent as the
//! parameters of MAVLink.
//!
//! A part of the settings lists its fields once, by [`Named::list`]: name, unit, decimal places, and the field itself. All
//! that reads, shows and changes settings by their names goes through these lists, whatever the carrier.
//!
//! A name is of lower-case letters, digits and underscores, at most [`LONGEST`] of them, and one of a kind on its carrier.
//! Those that begin with one of [`CALIBRATIONS`] are what was measured of the instrument; the others are choices. A value
//! is a number, shown with so many decimal places at most, or a choice among words; [`NONE`] is what is absent.

use core::fmt;

use orientation::alignment::setup::{Quantity, SetupError};
use orientation::earth::Latitude;
use orientation::units::{DEGREE, Seconds};
use orientation::words::{Decimal, Shortened};
use protocol::command;

use super::output::Output;
use super::record::{BYTES, Serial, SettingsError};

/// Most characters of a name: as many as a parameter of MAVLink has.
pub const LONGEST: usize = 16;
/// How the names of calibrations begin, and no others.
pub const CALIBRATIONS: [&str; 7] =
    ["gyro_", "g_", "force_", "encoder_", "frame_", "index_", "spin_"];
/// The word for what is absent.
pub const NONE: &str = "none";
/// The words of what is so or not.
const FLAG: &[&str] = &["no", "yes"];

/// The unit in which a user states a quantity, and the decimal places in which it is shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    /// Decimal places.
    pub places: u8,
    /// The unit, in SI units.
    pub si: f64,
}

/// Seconds, as times are stated: to a millisecond.
pub(super) const SECONDS: Unit = Unit { places: 3, si: 1.0 };
/// Degrees, as directions are stated: to a third of a second of arc.
pub(super) const DEGREES: Unit = Unit { places: 4, si: DEGREE };
/// Parts of the whole, as σ of a scale factor is stated: to a tenth of a millionth.
pub(super) const PARTS: Unit = Unit { places: 7, si: 1.0 };

/// A setting as it stands. Shown, it is its value: a word, or a decimal number without zeros at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// Its name.
    pub name: &'static str,
    /// Its value in the user's unit, not a number where it is absent; of a choice the index of its word.
    pub value: f64,
    /// Decimal places of a number.
    pub places: u8,
    /// The words of a choice by their index; empty for a number.
    pub words: &'static [&'static str],
}

impl fmt::Display for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value: number, places, words, .. } = *self;
        match words.get(number as usize) {
            Some(word) => f.write_str(word),
            None if number.is_nan() => f.write_str(NONE),
            None => Decimal { number, places }.fmt(f),
        }
    }
}

/// Part of its last decimal place by which a number that was shown may differ from what is read of it.
const SAME: f64 = 0.01;

impl Stated {
    /// Whether a value is the number that this one is shown as.
    fn shows(&self, value: f64) -> bool {
        let unit = (0..self.places).fold(1.0, |unit, _| unit * 10.0);
        let apart = libm::fabs(libm::round(self.value * unit) - value * unit);
        apart < SAME || (self.value.is_nan() && value.is_nan())
    }

    /// The value that a text states for this setting.
    ///
    /// # Errors
    /// [`EditError::NotANumber`] and [`EditError::NoSuchWord`].
    pub fn parse(&self, text: &str) -> Result<f64, EditError> {
        if !self.words.is_empty() {
            let index = self.words.iter().position(|word| *word == text);
            return index.map(|index| index as f64).ok_or(EditError::NoSuchWord(self.words));
        }
        if text == NONE {
            return Ok(f64::NAN);
        }
        command::number(text).map_err(|_| EditError::NotANumber)
    }
}

/// A field of the settings, as its part lists it.
pub struct Entry<'e> {
    /// The setting.
    pub stated: Stated,
    /// The user's unit, in SI units; one for what has none.
    pub si: f64,
    /// Its number in the list, from zero.
    pub number: usize,
    /// Gives the field a value in the user's unit; whether its type can hold that. Ranges are checked elsewhere.
    pub set: &'e mut dyn FnMut(f64) -> bool,
}

/// A part of the settings.
pub trait Named {
    /// Lists its fields, always the same in the same order.
    fn list(&mut self, list: &mut List<'_>);
}

/// Which field of settings is looked for.
#[derive(Clone, Copy)]
enum Wanted<'w> {
    /// That of this name.
    Name(&'w str),
    /// That of this number in the list, from zero.
    Number(usize),
}

/// What passes the fields of settings, one after the other, for the one that is wanted: the values of others are not even
/// computed. What passes a field is not inlined, since there are sixty of them.
pub struct List<'v> {
    wanted: Wanted<'v>,
    visitor: &'v mut dyn FnMut(Entry<'_>),
    /// How many it has passed.
    passed: usize,
}

impl<'v> List<'v> {
    /// A list whose wanted entry goes to this visitor.
    fn new(wanted: Wanted<'v>, visitor: &'v mut dyn FnMut(Entry<'_>)) -> Self {
        Self { wanted, visitor, passed: 0 }
    }

    /// Passes a field; whether it is the one that is wanted.
    fn wants(&mut self, name: &str) -> bool {
        let number = self.passed;
        self.passed += 1;
        match self.wanted {
            Wanted::Name(wanted) => wanted == name,
            Wanted::Number(wanted) => wanted == number,
        }
    }

    /// Lists a number, SI units.
    #[inline(never)]
    pub(super) fn number(&mut self, name: &'static str, unit: Unit, field: &mut f64) {
        if self.wants(name) {
            self.show_number(name, unit, field);
        }
    }

    /// Shows a number, SI units, which is wanted.
    fn show_number(&mut self, name: &'static str, unit: Unit, field: &mut f64) {
        let value = *field / unit.si;
        let stated = Stated { name, value, places: unit.places, words: &[] };
        self.show(stated, unit.si, &mut |stated| {
            if stated.is_finite() {
                *field = stated * unit.si;
            }
            stated.is_finite()
        });
    }

    /// Lists a number of single precision, SI units.
    #[inline(never)]
    pub(super) fn single(&mut self, name: &'static str, unit: Unit, field: &mut f32) {
        if self.wants(name) {
            let mut number = f64::from(*field);
            self.show_number(name, unit, &mut number);
            *field = number as f32;
        }
    }

    /// Lists a time that may be absent.
    pub(super) fn time(&mut self, name: &'static str, field: &mut Option<Seconds>) {
        let value = field.map_or(f64::NAN, |time| time.0);
        self.optional(name, SECONDS, value, &mut |stated| {
            *field = stated.map(Seconds);
            true
        });
    }

    /// Lists a number in the user's unit that may be absent, which is not a number then. `set` is given none for that, and
    /// tells whether the field can hold what it is given.
    #[inline(never)]
    pub(super) fn optional(
        &mut self,
        name: &'static str,
        unit: Unit,
        value: f64,
        set: &mut dyn FnMut(Option<f64>) -> bool,
    ) {
        if !self.wants(name) {
            return;
        }
        let stated = Stated { name, value, places: unit.places, words: &[] };
        self.show(stated, unit.si, &mut |stated| {
            !stated.is_infinite() && set(Some(stated).filter(|stated| !stated.is_nan()))
        });
    }

    /// Lists a number of things up to 255.
    pub(super) fn few(&mut self, name: &'static str, field: &mut u8) {
        let mut count = u32::from(*field);
        self.up_to(name, u8::MAX.into(), &mut count);
        *field = count as u8;
    }

    /// Lists a number of things.
    pub(super) fn count(&mut self, name: &'static str, field: &mut u32) {
        self.up_to(name, u32::MAX, field);
    }

    /// Lists a number of things of which the field can hold so many.
    #[inline(never)]
    fn up_to(&mut self, name: &'static str, most: u32, field: &mut u32) {
        if !self.wants(name) {
            return;
        }
        let value = f64::from(*field);
        self.show(Stated { name, value, places: 0, words: &[] }, 1.0, &mut |stated| {
            let is_held =
                stated >= 0.0 && stated <= f64::from(most) && libm::trunc(stated) == stated;
            if is_held {
                *field = stated as u32;
            }
            is_held
        });
    }

    /// Lists what is so or not.
    pub(super) fn flag(&mut self, name: &'static str, field: &mut bool) {
        self.choice(name, FLAG, usize::from(*field), &mut |index| *field = index == 1);
    }

    /// Lists a choice among words by the index of the one that is chosen.
    #[inline(never)]
    pub(super) fn choice(
        &mut self,
        name: &'static str,
        words: &'static [&'static str],
        index: usize,
        set: &mut dyn FnMut(usize),
    ) {
        if !self.wants(name) {
            return;
        }
        let value = index as f64;
        self.show(Stated { name, value, places: 0, words }, 1.0, &mut |stated| {
            let found = (0..words.len()).find(|index| *index as f64 == stated);
            found.map(&mut *set).is_some()
        });
    }

    /// Shows the field that is wanted, which was passed last.
    fn show(&mut self, stated: Stated, si: f64, set: &mut dyn FnMut(f64) -> bool) {
        (self.visitor)(Entry { stated, si, number: self.passed - 1, set });
    }
}

/// Settings that are read and changed by their names, whatever the carrier.
pub trait Editable: Named + Send {
    /// Gives the setting of this name a value in its user's unit. Unless all settings are then possible together, they stay
    /// as they were.
    ///
    /// # Errors
    /// Why not.
    fn set(&mut self, name: &str, value: f64) -> Result<(), EditError>;

    /// Checksum of what counts from the next start on: of all but what the link sends.
    fn checksum(&self) -> u32;

    /// Record of the settings for the board whose controller has this serial number.
    ///
    /// # Errors
    /// As [`Settings::to_record`](super::Settings::to_record).
    fn to_record(&self, serial: &Serial) -> Result<[u8; BYTES], SettingsError>;

    /// Takes the factory settings.
    fn restore(&mut self);

    /// Name of the carrier that they are for.
    fn carrier(&self) -> &'static str;

    /// What the link sends.
    fn output(&self) -> Output;

    /// What an alignment begins with.
    fn start(&self) -> Start;
}

/// What an alignment begins with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The latitude, where it is stated.
    pub stated: Option<Latitude>,
    /// Whether nothing begins without one.
    pub needs_latitude: bool,
    /// Whether it begins at power-on without an order.
    pub is_at_power_on: bool,
}

impl Start {
    /// The latitude that it has: as it is stated, or else that of a satellite receiver, where there is one.
    #[must_use]
    pub fn latitude(&self, received: Option<Latitude>) -> Option<Latitude> {
        self.stated.or(received).filter(|_| self.needs_latitude)
    }

    /// Whether it needs a latitude that it does not have.
    #[must_use]
    pub fn lacks_latitude(&self, received: Option<Latitude>) -> bool {
        self.needs_latitude && self.latitude(received).is_none()
    }
}

impl dyn Editable + '_ {
    /// How many settings there are.
    pub fn count(&mut self) -> usize {
        let visitor = &mut |_: Entry<'_>| ();
        let mut list = List::new(Wanted::Number(usize::MAX), visitor);
        self.list(&mut list);
        list.passed
    }

    /// The setting of this number from zero.
    pub fn nth(&mut self, number: usize) -> Option<Stated> {
        self.find(Wanted::Number(number)).map(|(_, stated)| stated)
    }

    /// All settings, in the order of their numbers.
    pub fn all(&mut self) -> impl Iterator<Item = Stated> {
        (0..self.count()).map_while(|number| self.nth(number))
    }

    /// The setting of this name, and its number from zero.
    pub fn numbered(&mut self, name: &str) -> Option<(usize, Stated)> {
        self.find(Wanted::Name(name))
    }

    /// The setting of this name.
    pub fn get(&mut self, name: &str) -> Option<Stated> {
        self.numbered(name).map(|(_, stated)| stated)
    }

    /// The setting that is wanted, and its number.
    fn find(&mut self, wanted: Wanted<'_>) -> Option<(usize, Stated)> {
        let mut found = None;
        self.list(&mut List::new(wanted, &mut |entry| found = Some((entry.number, entry.stated))));
        found
    }

    /// The value that a text states for the setting of this name, in its user's unit.
    ///
    /// # Errors
    /// [`EditError::Unknown`], [`EditError::NotANumber`] and [`EditError::NoSuchWord`].
    pub fn parse(&mut self, name: &str, text: &str) -> Result<f64, EditError> {
        self.get(name).ok_or(EditError::Unknown)?.parse(text)
    }
}

/// Gives the field of this name a value, unchecked; the user's unit, in SI units.
///
/// # Errors
/// [`EditError::Unknown`] and [`EditError::NotHeld`].
pub(super) fn put(part: &mut dyn Named, name: &str, value: f64) -> Result<f64, EditError> {
    let mut done = Err(EditError::Unknown);
    part.list(&mut List::new(Wanted::Name(name), &mut |entry| {
        // What is shown already stays as it is: its unit would round it once more.
        let is_held = entry.stated.shows(value) || (entry.set)(value);
        done = is_held.then_some(entry.si).ok_or(EditError::NotHeld);
    }));
    done
}

/// Why a setting does not get a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EditError {
    /// There is no setting of this name.
    Unknown,
    /// The text is no decimal number.
    NotANumber,
    /// The text is none of these words of a choice.
    NoSuchWord(&'static [&'static str]),
    /// The setting is never such a value: a part of a thing, too many, or nothing where it cannot be absent.
    NotHeld,
    /// The value is not from the least to the greatest one that the setting can have, in the user's unit.
    Beyond([f64; 2]),
    /// The setting is never such a number, but one of these.
    NotAmong(&'static str),
    /// Another quantity would be out of its range, or the settings are not possible together.
    OutOfRange(SetupError),
}

/// Part by which a quantity may differ from the value that it was given, as it may be of single precision.
const ROUNDED: f64 = 1e-6;

impl EditError {
    /// The reason why a setting does not get this value, in SI units, whose user's unit is `si`.
    pub(super) fn of(error: SetupError, value: f64, si: f64) -> Self {
        match error {
            SetupError::OutOfRange(Quantity { value: found, range, .. })
                if (found.abs() - value.abs()).abs() <= ROUNDED * found.abs() =>
            {
                Self::Beyond(range.map(|end| end / si))
            }
            SetupError::NotAmong { choices, .. } => Self::NotAmong(choices),
            error => Self::OutOfRange(error),
        }
    }
}

impl core::error::Error for EditError {}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "no such setting",
            Self::NotANumber => "not a number",
            Self::NoSuchWord(words) => {
                f.write_str("not one of")?;
                return words.iter().try_for_each(|word| write!(f, " {word}"));
            }
            Self::NotHeld => "not a value of this setting",
            Self::Beyond([least, greatest]) => {
                return write!(f, "not from {} to {}", Shortened(*least), Shortened(*greatest));
            }
            Self::NotAmong(choices) => return write!(f, "not {choices}"),
            Self::OutOfRange(error) => return error.fmt(f),
        })
    }
}
