//! The memory protection unit (ARMv7-M Architecture Reference Manual, B3.5).

/// How many regions there are (Cortex-M4 TRM, 5.1).
const REGIONS: usize = 8;
/// Registers of the core, which no region covers (B3.1).
const PRIVATE: std::ops::Range<u32> = 0xE000_0000..0xE010_0000;

/// How memory is accessed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Data are read.
    Read,
    /// Data are written.
    Write,
    /// An instruction is fetched.
    Fetch,
}

/// Who accesses memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Level {
    /// A thread without privilege.
    pub is_unprivileged: bool,
    /// A handler of hard faults or of what nothing masks, or code that masks faults.
    pub is_above_faults: bool,
}

/// A region.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Region {
    /// `MPU_RBAR`.
    base: u32,
    /// `MPU_RASR`.
    attributes: u32,
}

impl Region {
    /// Its first and last address; none where it is disabled.
    fn ends(self) -> Option<(u32, u32)> {
        let rest = u32::MAX >> (31 - (self.attributes >> 1 & 0x1F));
        (self.attributes & 1 != 0).then_some((self.base & !rest, self.base | rest))
    }

    /// Whether it covers an address (B3.5.3, `ValidateAddress`).
    const fn covers(self, address: u32) -> bool {
        let power = (self.attributes >> 1 & 0x1F) + 1;
        let is_near = power == 32 || (address ^ self.base) >> power == 0;
        let eighth = if power < 8 { 0 } else { address >> (power - 3) & 7 };
        let is_left_out = power >= 8 && self.attributes >> (8 + eighth) & 1 != 0;
        self.attributes & 1 != 0 && is_near && !is_left_out
    }

    /// Whether it allows an access (table B3-15).
    const fn allows(self, access: Access, is_unprivileged: bool) -> bool {
        let (reads, writes) = match (self.attributes >> 24 & 7, is_unprivileged) {
            (1 | 2, false) | (3, _) => (true, true),
            (2, true) | (5, false) | (6 | 7, _) => (true, false),
            _ => (false, false),
        };
        match access {
            Access::Read => reads,
            Access::Write => writes,
            Access::Fetch => reads && self.attributes >> 28 & 1 == 0,
        }
    }
}

/// The registers of the unit.
#[derive(Clone, Debug, Default)]
pub struct Protection {
    /// `MPU_CTRL`.
    control: u32,
    /// `MPU_RNR`.
    number: u32,
    regions: [Region; REGIONS],
}

impl Protection {
    /// Whether it is enabled.
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.control & 1 != 0
    }

    /// The first and the last address between which an access of data may not be allowed; none where all are. Code
    /// without privilege may be refused anywhere.
    #[must_use]
    pub fn watched(&self, is_unprivileged: bool) -> Option<(u32, u32)> {
        let has_default_map = self.control & 4 != 0;
        match self.is_on() {
            false => None,
            true if is_unprivileged || !has_default_map => Some((0, u32::MAX)),
            true => {
                let ends = self.regions.iter().filter_map(|region| region.ends());
                ends.reduce(|all, ends| (all.0.min(ends.0), all.1.max(ends.1)))
            }
        }
    }

    /// Reads a register by its distance from `MPU_TYPE`; none where there is none.
    #[must_use]
    pub fn read(&self, offset: u32) -> Option<u32> {
        let region = self.regions[self.number as usize];
        Some(match offset {
            0x0 => (REGIONS as u32) << 8,
            0x4 => self.control,
            0x8 => self.number,
            0xC => region.base | self.number,
            0x10 => region.attributes,
            _ => return None,
        })
    }

    /// Writes a register by its distance from `MPU_TYPE`; whether there is one.
    pub fn write(&mut self, offset: u32, value: u32) -> bool {
        match offset {
            0x4 => self.control = value & 7,
            0x8 => self.number = value & (REGIONS as u32 - 1),
            0xC => {
                if value & 0x10 != 0 {
                    self.number = value & (REGIONS as u32 - 1);
                }
                self.regions[self.number as usize].base = value & !0x1F;
            }
            0x10 => self.regions[self.number as usize].attributes = value,
            _ => return false,
        }
        true
    }

    /// Whether an access of so many bytes is allowed.
    #[must_use]
    pub fn allows(&self, address: u32, size: u32, access: Access, level: Level) -> bool {
        self.refuses(address, size, access, level).is_none()
    }

    /// The first of both ends of an access of so many bytes that is not allowed.
    #[must_use]
    pub fn refuses(&self, address: u32, size: u32, access: Access, level: Level) -> Option<u32> {
        let is_in_force = self.is_on() && (!level.is_above_faults || self.control & 2 != 0);
        if !is_in_force {
            return None;
        }
        let ends = [address, address.wrapping_add(size - 1)];
        ends.into_iter().find(|address| !self.allows_byte(*address, access, level.is_unprivileged))
    }

    /// Whether an access to a byte is allowed, while the unit is in force.
    fn allows_byte(&self, address: u32, access: Access, is_unprivileged: bool) -> bool {
        if PRIVATE.contains(&address) {
            return true;
        }
        match self.regions.iter().rfind(|region| region.covers(address)) {
            Some(region) => region.allows(access, is_unprivileged),
            None => self.control & 4 != 0 && !is_unprivileged,
        }
    }
}
