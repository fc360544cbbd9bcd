//! What the link sends, and how often.

use orientation::alignment::setup::{SetupError, check_ranges};
use serde::{Deserialize, Serialize};

use super::names::{List, Named};

/// Greatest rate of anything that is sent, Hz: that of the navigator's attitudes.
pub const FASTEST: u8 = 10;
/// Rates of what is sent, Hz: a whole number of looks lies between two.
const RATES: [u8; 5] = [0, 1, 2, 5, FASTEST];
/// Bits of a byte on the link: with its start and its stop.
const BITS: u32 = 10;
/// Slowest and fastest link, baud: that of NMEA 0183, and that of an autopilot's fastest port.
const BAUD: [u32; 2] = [4800, 921_600];
/// Share of the link that periodic output may take, percent; the rest is for words and answers.
const SHARE: u32 = 80;

/// A format of what is sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    /// Sentences of NMEA 0183.
    #[default]
    Nmea,
    /// Messages of MAVLink 2.
    Mavlink,
}

/// A sentence or a message that is sent periodically, at a rate that is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// Sentence `$HEHDT`: heading.
    Hdt,
    /// Sentence `$HETHS`: heading and its mode.
    Ths,
    /// Sentence `$HEROT`: rate of turn.
    Rot,
    /// Sentence `$PHTRO`: pitch and roll.
    Phtro,
    /// Sentence `$PHINF`: word of status.
    Phinf,
    /// Sentence `$PMRDS`: state and standard deviations.
    Pmrds,
    /// Sentence `$PMRDL`: roll of a spinning body.
    Pmrdl,
    /// Message `ATTITUDE_QUATERNION`.
    Attitude,
    /// Message `VISION_POSITION_ESTIMATE`: azimuth for an autopilot to fuse.
    Vision,
    /// Message `SYS_STATUS`.
    SysStatus,
}

/// How many of them there are.
pub const ITEMS: usize = 10;

impl Item {
    /// All of them, in the order in which they are sent.
    pub const ALL: [Self; ITEMS] = [
        Self::Hdt,
        Self::Ths,
        Self::Rot,
        Self::Phtro,
        Self::Phinf,
        Self::Pmrds,
        Self::Pmrdl,
        Self::Attitude,
        Self::Vision,
        Self::SysStatus,
    ];

    /// What is fixed of it: the name of the setting of its rate, most bytes that it has on the link, and the number of its
    /// message, where it is one.
    const fn fixed(self) -> (&'static str, u32, Option<u32>) {
        match self {
            Self::Hdt => ("hdt_rate", 21, None),
            Self::Ths => ("ths_rate", 21, None),
            Self::Rot => ("rot_rate", 24, None),
            Self::Phtro => ("phtro_rate", 31, None),
            Self::Phinf => ("phinf_rate", 20, None),
            Self::Pmrds => ("pmrds_rate", 82, None),
            Self::Pmrdl => ("pmrdl_rate", 82, None),
            Self::Attitude => ("attitude_rate", FRAME + 48, Some(31)),
            Self::Vision => ("vision_rate", FRAME + 117, Some(102)),
            Self::SysStatus => ("sysstatus_rate", FRAME + 43, Some(1)),
        }
    }

    /// The format that it is of.
    #[must_use]
    pub const fn format(self) -> Format {
        if self.fixed().2.is_some() { Format::Mavlink } else { Format::Nmea }
    }

    /// The name of the setting of its rate.
    #[must_use]
    pub const fn rate_name(self) -> &'static str {
        self.fixed().0
    }

    /// Most bytes that it has on the link.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        self.fixed().1
    }

    /// The item that is the message of this number of MAVLink.
    #[must_use]
    pub fn of_message(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|item| item.fixed().2 == Some(number))
    }

    /// How often it is sent unless that is set, Hz.
    #[must_use]
    pub const fn usual_rate(self) -> u8 {
        match self {
            Self::Attitude => FASTEST,
            // Some vehicles of PX4 fuse its position, which is none, unless they are told not to.
            Self::Vision => 0,
            _ => 1,
        }
    }
}

/// Bytes of a message beside its payload.
const FRAME: u32 = 12;
/// Most bytes of a heartbeat, which goes once a second.
const HEARTBEAT: u32 = FRAME + 9;

/// What the link sends, and how often.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Output {
    /// The format.
    pub format: Format,
    /// Rate of the link, baud.
    pub baud: u32,
    /// Number of the MAVLink system that the instrument belongs to, 1 to 254.
    pub system: u8,
    /// Rates of [`Item::ALL`], Hz: 0 for never, or a divisor of ten.
    pub rates: [u8; ITEMS],
}

impl Default for Output {
    /// Every sentence once a second at 115 200 baud; with messages the attitude ten times a second.
    fn default() -> Self {
        let rates = Item::ALL.map(Item::usual_rate);
        Self { format: Format::Nmea, baud: 115_200, system: 1, rates }
    }
}

impl Output {
    /// The rate of an item, Hz; zero where it is of the other format.
    #[must_use]
    pub fn rate(&self, item: Item) -> u8 {
        if item.format() == self.format { self.rates[item as usize] } else { 0 }
    }

    /// Bytes a second that it sends at most, but for words and answers.
    #[must_use]
    pub fn bytes_per_second(&self) -> u32 {
        let periodic = Item::ALL.map(|item| u32::from(self.rate(item)) * item.bytes());
        periodic.iter().sum::<u32>() + if self.format == Format::Mavlink { HEARTBEAT } else { 0 }
    }

    /// Bytes of answers that the link takes in the time from one look to the next: what periodic output leaves.
    #[must_use]
    pub const fn room_at_a_look(&self) -> usize {
        (self.baud / BITS * (100 - SHARE) / 100 / FASTEST as u32) as usize
    }

    /// Checks that every number is possible, and that the link can carry what is to be sent.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`] and [`SetupError::NotAmong`], which name the first field that is not.
    pub fn check(&self) -> Result<(), SetupError> {
        let [slowest, fastest] = BAUD.map(f64::from);
        check_ranges(&[
            ("baud", self.baud.into(), [slowest, fastest]),
            ("system", self.system.into(), [1.0, 254.0]),
        ])?;
        for (item, rate) in Item::ALL.into_iter().zip(self.rates) {
            let (is_possible, choices) = match item {
                // PX4 begins with an azimuth only where two follow one another within 200 ms.
                Item::Vision => ([0, FASTEST].contains(&rate), "0 or 10 Hz"),
                _ => (RATES.contains(&rate), "0, 1, 2, 5 or 10 Hz"),
            };
            if !is_possible {
                return Err(SetupError::NotAmong {
                    name: item.rate_name(),
                    value: rate.into(),
                    choices,
                });
            }
        }
        let room = self.baud / BITS * SHARE / 100;
        let load = self.bytes_per_second();
        check_ranges(&[("bytes a second on the link", load.into(), [0.0, room.into()])])
    }
}

impl Named for Output {
    fn list(&mut self, list: &mut List<'_>) {
        const FORMATS: [Format; 2] = [Format::Nmea, Format::Mavlink];
        let format = &mut self.format;
        let index = *format as usize;
        list.choice("output", &["nmea", "mavlink"], index, &mut |index| *format = FORMATS[index]);
        list.count("baud", &mut self.baud);
        list.few("mav_system", &mut self.system);
        for (item, rate) in Item::ALL.into_iter().zip(&mut self.rates) {
            list.few(item.rate_name(), rate);
        }
    }
}
