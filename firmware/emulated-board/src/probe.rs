//! The debug probe: it takes the log out of the buffer in RAM while the core runs, and decodes it.

use defmt_decoder::{DecodeError, StreamDecoder, Table};

use crate::processor::Processor;

/// Distance of the first buffer to the host from the control block: after its mark and the numbers of buffers.
const BUFFER: u32 = 24;

/// One line of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Time since the start, as the image states it.
    pub time: String,
    /// Level; none for a line that is printed at every level.
    pub level: Option<&'static str>,
    /// Words of the line.
    pub words: String,
}

/// A probe that is connected.
pub struct Probe {
    /// Address of the control block.
    control: u32,
    decoder: Box<dyn StreamDecoder>,
}

impl Probe {
    /// A probe for an image whose control block is at this address. The strings live as long as the program.
    ///
    /// # Errors
    /// Where the file is no image with a log.
    pub fn new(elf: &[u8], control: u32) -> Result<Self, String> {
        let table = match Table::parse(elf) {
            Ok(Some(table)) => table,
            Ok(None) => return Err("the image has no strings of a log".to_owned()),
            Err(error) => return Err(format!("the image's strings cannot be read: {error:#}")),
        };
        let decoder = Box::leak(Box::new(table)).new_stream_decoder();
        Ok(Self { control, decoder })
    }

    /// Takes what the buffer holds, and hands over the lines that it completes.
    pub fn poll(&mut self, processor: &mut Processor, on_line: impl FnMut(Line)) {
        let bytes = self.take(processor);
        if !bytes.is_empty() {
            self.decoder.received(&bytes);
            self.decode(on_line);
        }
    }

    /// Takes the bytes out of the buffer; none before the image has made it.
    fn take(&self, processor: &mut Processor) -> Vec<u8> {
        let word = |place: u32| {
            let mut bytes = [0; 4];
            processor.peek(self.control + BUFFER + 4 * place, &mut bytes);
            u32::from_le_bytes(bytes)
        };
        let mut mark = [0; 10];
        processor.peek(self.control, &mut mark);
        let [start, size, written, read] = [1, 2, 3, 4].map(word);
        if &mark != b"SEGGER RTT" || size == 0 || written >= size || read >= size {
            return Vec::new();
        }
        let byte = |place| {
            let mut byte = [0];
            processor.peek(start + (read + place) % size, &mut byte);
            byte[0]
        };
        let bytes: Vec<u8> = (0..(written + size - read) % size).map(byte).collect();
        if !bytes.is_empty() {
            processor.poke(self.control + BUFFER + 16, &written.to_le_bytes());
        }
        bytes
    }

    /// Decodes what was taken.
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method's type has no name here"
    )]
    fn decode(&mut self, mut on_line: impl FnMut(Line)) {
        loop {
            match self.decoder.decode() {
                Ok(frame) => on_line(Line {
                    time: frame
                        .display_timestamp()
                        .map(|time| time.to_string())
                        .unwrap_or_default(),
                    level: frame.level().map(|level| level.as_str()),
                    words: frame.display_message().to_string(),
                }),
                Err(DecodeError::UnexpectedEof) => return,
                // A frame that a reset has cut; the next one begins after its mark.
                Err(DecodeError::Malformed) => {}
            }
        }
    }
}
