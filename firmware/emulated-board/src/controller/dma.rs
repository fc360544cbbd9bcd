//! Direct memory access (RM0351, chapter 11): seven channels of each of two controllers.

use super::Refused;

/// Channels of a controller.
pub const CHANNELS: usize = 7;

/// A channel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Channel {
    /// `DMA_CCRx`.
    pub control: u32,
    /// `DMA_CNDTRx`: items that are left.
    pub left: u32,
    /// `DMA_CPARx`.
    peripheral: u32,
    /// `DMA_CMARx`.
    memory: u32,
    /// Items at the beginning: the number that was written last, to which a circular channel returns (11.4.5).
    items: u32,
    /// Whether an item was transferred since their number was written.
    is_used: bool,
}

/// A transfer of one item that a channel is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item {
    /// Address in the peripheral.
    pub peripheral: u32,
    /// Address in memory.
    pub memory: u32,
    /// Size in the peripheral, bytes.
    pub peripheral_size: u32,
    /// Size in memory, bytes.
    pub memory_size: u32,
    /// Whether it goes from memory to the peripheral.
    pub is_to_peripheral: bool,
}

impl Channel {
    /// Whether it is enabled and has items left.
    pub fn is_armed(&self) -> bool {
        self.control & 1 != 0 && self.left > 0
    }

    /// Whether it has transferred items, and has some left, since their number was written.
    const fn is_amid(&self) -> bool {
        self.left > 0 && self.is_used
    }

    /// The item that is next.
    fn item(&self) -> Item {
        let done = self.items - self.left;
        let [peripheral_size, memory_size] = [8, 10].map(|bit| 1 << (self.control >> bit & 3));
        let steps = |bit: u32, size: u32| if self.control & bit != 0 { done * size } else { 0 };
        Item {
            peripheral: self.peripheral + steps(1 << 6, peripheral_size),
            memory: self.memory + steps(1 << 7, memory_size),
            peripheral_size,
            memory_size,
            is_to_peripheral: self.control & 0x10 != 0,
        }
    }
}

/// A controller of seven channels.
#[derive(Clone, Debug, Default)]
pub struct Dma {
    /// `DMA_ISR`, without the global flags.
    flags: u32,
    /// The channels.
    pub channels: [Channel; CHANNELS],
    /// `DMA_CSELR`: the request of each channel, four bits.
    selections: u32,
    /// Items that were transferred.
    pub transfers: u64,
}

impl Dma {
    /// The request that a channel listens to.
    pub fn selection(&self, channel: usize) -> u32 {
        self.selections >> (4 * channel) & 0xF
    }

    /// The priority of a channel, 0 to 3.
    pub const fn priority(&self, channel: usize) -> u32 {
        self.channels[channel].control >> 12 & 3
    }

    /// The next item of a channel whose request is active; it counts as done.
    pub fn take(&mut self, channel: usize) -> Option<Item> {
        let armed = self.channels.get_mut(channel).filter(|channel| channel.is_armed())?;
        let item = armed.item();
        (armed.left, armed.is_used) = (armed.left - 1, true);
        self.transfers += 1;
        let flag = |bit: u32| 1 << (4 * channel as u32 + bit);
        if 2 * armed.left == armed.items {
            self.flags |= flag(2);
        }
        if armed.left == 0 {
            self.flags |= flag(1);
            if armed.control & 0x20 != 0 {
                armed.left = armed.items;
            }
        }
        Some(item)
    }

    /// A transfer of a channel that met no memory: the channel is switched off.
    pub fn fail(&mut self, channel: usize) {
        self.flags = self.flags & !(0xF << (4 * channel)) | 8 << (4 * channel);
        self.channels[channel].control &= !1;
    }

    /// Whether a channel interrupts.
    pub fn interrupts(&self, channel: usize) -> bool {
        self.flags >> (4 * channel) & self.channels[channel].control & 0xE != 0
    }

    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refused> {
        match offset {
            0x00 => Ok(self.status()),
            0x04 => Ok(0),
            0xA8 => Ok(self.selections),
            _ => {
                let (channel, register) = place(offset)?;
                let channel = &self.channels[channel];
                Ok([channel.control, channel.left, channel.peripheral, channel.memory][register])
            }
        }
    }

    /// The status, with the global flag of each channel that has another one.
    fn status(&self) -> u32 {
        let global = (0..CHANNELS)
            .map(|channel| u32::from(self.flags >> (4 * channel) & 0xE != 0) << (4 * channel));
        self.flags | global.sum::<u32>()
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        match offset {
            0x04 => {
                // The global flag of a channel clears all of it.
                let all = (0..CHANNELS)
                    .filter(|channel| value >> (4 * channel) & 1 != 0)
                    .map(|channel| 0xF << (4 * channel));
                self.flags &= !(value | all.sum::<u32>());
            }
            0xA8 => self.selections = value,
            _ => {
                let (channel, register) = place(offset)?;
                let channel = &mut self.channels[channel];
                match register {
                    0 if value & 0x4000 != 0 => {
                        return Err(Refused::NotModelled("transfers from memory to memory"));
                    }
                    // What is left would not be transferred for certain (11.4.5).
                    0 if value & !channel.control & 1 != 0 && channel.is_amid() => {
                        return Err(Refused::NotModelled(
                            "a channel that goes on amid its items without their number being written again",
                        ));
                    }
                    0 => channel.control = value,
                    // A channel that is enabled keeps its settings (11.6.4 to 11.6.6).
                    _ if channel.control & 1 != 0 => {
                        return Err(Refused::NotModelled(
                            "a channel that is changed while it is enabled",
                        ));
                    }
                    1 => {
                        let items = value & 0xFFFF;
                        (channel.items, channel.left, channel.is_used) = (items, items, false);
                    }
                    2 => channel.peripheral = value,
                    _ => channel.memory = value,
                }
            }
        }
        Ok(())
    }
}

/// The channel and the register of it that an offset means.
fn place(offset: u32) -> Result<(usize, usize), Refused> {
    let distance = offset.checked_sub(8).ok_or(Refused::Unknown)?;
    let (channel, register) = ((distance / 20) as usize, (distance % 20 / 4) as usize);
    if channel < CHANNELS && register < 4 { Ok((channel, register)) } else { Err(Refused::Unknown) }
}
