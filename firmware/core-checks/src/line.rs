//! The line of the step that is done: thread and handlers write to it.

use core::fmt::{self, Write};
use core::ptr::addr_of_mut;

/// The line.
pub struct Line {
    text: [u8; 400],
    length: usize,
}

/// The line of this step.
static mut LINE: Line = Line { text: [0; 400], length: 0 };

/// The line. One step writes at a time, and what interrupts it writes between two words.
pub fn line() -> &'static mut Line {
    // SAFETY: one core; a handler that writes is entered where the thread does not.
    unsafe { &mut *addr_of_mut!(LINE) }
}

impl Write for Line {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let room = self.text.get_mut(self.length..self.length + text.len()).ok_or(fmt::Error)?;
        room.copy_from_slice(text.as_bytes());
        self.length += text.len();
        Ok(())
    }
}

/// Begins a line.
pub fn begin(name: &str) {
    line().length = 0;
    let _ = line().write_str(name);
    let _ = line().write_str(":");
}

/// What is on the line.
pub fn text() -> &'static str {
    let line = line();
    core::str::from_utf8(&line.text[..line.length]).unwrap_or("no text")
}

/// Writes to the line.
macro_rules! say {
    ($($words:tt)*) => {{
        let _ = core::fmt::Write::write_fmt(crate::line::line(), format_args!($($words)*));
    }};
}
pub(crate) use say;
