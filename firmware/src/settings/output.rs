//! What the link sends, and how often.

use orientation::alignment::setup::{SetupError, check_ranges};
use serde::{Deserialize, Serialize};

/// Greatest rate of anything that is sent, Hz: that of the navigator's attitudes.
pub const FASTEST: u8 = 10;
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

    /// The format that it is of.
    #[must_use]
    pub const fn format(self) -> Format {
        match self {
            Self::Attitude | Self::Vision | Self::SysStatus => Format::Mavlink,
            _ => Format::Nmea,
        }
    }

    /// Most bytes that it has on the link.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Self::Hdt | Self::Ths => 21,
            Self::Rot => 24,
            Self::Phtro => 31,
            Self::Phinf => 20,
            Self::Pmrds | Self::Pmrdl => 82,
            Self::Attitude => FRAME + 48,
            Self::Vision => FRAME + 117,
            Self::SysStatus => FRAME + 43,
        }
    }

    /// How often it is sent unless that is set, Hz.
    const fn usual_rate(self) -> u8 {
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

    /// Checks that every number is possible, and that the link can carry what is to be sent.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`], which names the first field that is not.
    pub fn check(&self) -> Result<(), SetupError> {
        let [slowest, fastest] = BAUD.map(f64::from);
        check_ranges(&[
            ("baud", self.baud.into(), [slowest, fastest]),
            ("system", self.system.into(), [1.0, 254.0]),
        ])?;
        for rate in self.rates {
            let is_divisor = rate == 0 || (rate <= FASTEST && FASTEST.is_multiple_of(rate));
            let nearest = if is_divisor { f64::from(rate) } else { 0.0 };
            check_ranges(&[("rate, 0, 1, 2, 5 or 10 Hz", rate.into(), [nearest; 2])])?;
        }
        // PX4 begins with an azimuth only where two follow one another within 200 ms.
        let vision = self.rates[Item::Vision as usize];
        let nearest = if vision > 0 { FASTEST } else { 0 };
        check_ranges(&[("vision_rate, 0 or 10 Hz", vision.into(), [nearest.into(); 2])])?;
        let room = self.baud / BITS * SHARE / 100;
        let load = self.bytes_per_second();
        check_ranges(&[("bytes a second on the link", load.into(), [0.0, room.into()])])
    }
}
