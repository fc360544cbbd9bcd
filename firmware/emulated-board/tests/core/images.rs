//! The image of the checks, executed by QEMU and by the model of the board.

use std::path::PathBuf;
use std::process::Command;
use std::rc::Rc;

use emulated_board::controller::Controller;
use emulated_board::controller::rcc::Oscillators;
use emulated_board::image::Image;
use emulated_board::probe::Probe;
use emulated_board::processor::Processor;
use emulated_board::time::Time;
use emulated_board::wiring::board::Served;
use emulated_board::wiring::{I2cBus, Pin, Wiring};
use execution::built::{executable, of_firmware};
use hal_mock::wires::Clock;

/// Less time than fills the buffer of the lines.
pub const LOOK: Time = Time::microseconds(500);

/// Builds both images; the path of one of them.
fn image(name: &str) -> Result<PathBuf, String> {
    executable(&of_firmware(&["--package", "core-checks"])?, name)
}

/// Executes the checks in QEMU: what it prints. The machine has flash and RAM where the board has them.
pub fn in_qemu() -> Result<String, String> {
    let arguments = "-machine netduinoplus2 -nographic -monitor none -serial none \
        -semihosting-config enable=on,target=native -icount shift=5,align=off,sleep=off -kernel";
    let mut qemu = Command::new("qemu-system-arm");
    qemu.args(arguments.split_whitespace()).arg(image("core-checks-semihosting")?);
    let output = qemu.output().map_err(|error| format!("qemu-system-arm: {error}"))?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr))
}

/// The model of the board with the checks in its flash.
pub struct Board {
    /// The core.
    pub processor: Processor,
    probe: Probe,
}

impl Board {
    /// A board whose supply comes up.
    pub fn new() -> Result<Self, String> {
        let image = Rc::new(Image::read(&image("core-checks-probe")?)?);
        let probe = Probe::new(&image.elf, image.log)?;
        let oscillators = Oscillators { has_crystal: true, msi_error: 0.0 };
        let controller = Controller::new(oscillators, 1, Box::new(Nothing));
        let processor = Processor::new(image, controller, 1.0)
            .map_err(|error| format!("Unicorn: {error:?}"))?;
        Ok(Self { processor, probe })
    }

    /// The lines until this one, or until the core has done nothing for a second; last what the model does not know.
    pub fn lines_until(&mut self, end: &str) -> Vec<String> {
        let mut lines = Vec::new();
        while lines.last().is_none_or(|line| line != end)
            && self.processor.now() < Time::seconds(1.0)
        {
            match self.go_on(LOOK) {
                Ok(more) => lines.extend(more),
                Err(unknown) => {
                    lines.push(unknown);
                    break;
                }
            }
        }
        lines
    }

    /// Goes on for some time; the lines of it.
    pub fn go_on(&mut self, span: Time) -> Result<Vec<String>, String> {
        let until = self.processor.now() + span;
        let ran = self.processor.run(until);
        let mut lines = Vec::new();
        self.probe.poll(&mut self.processor, |line| lines.push(line.words));
        ran.map(|()| lines).map_err(|unknown| unknown.to_string())
    }
}

/// Nothing is connected.
struct Nothing;

impl I2cBus for Nothing {
    fn start(&mut self, _: u8, _: bool, _: u32, _: Time) -> bool {
        false
    }

    fn write(&mut self, _: u8, _: Time) -> bool {
        false
    }

    fn read(&mut self, _: bool, _: Time) -> u8 {
        0xFF
    }

    fn stop(&mut self, _: Time) {}

    fn stop_clock(&mut self, _: u32, _: Time) {}
}

impl Wiring for Nothing {
    fn drive(&mut self, _: Pin, _: Option<bool>, _: Time) {}

    fn served(&mut self, _: Time) -> Served {
        Served::default()
    }

    fn level(&mut self, _: Pin, _: Time) -> bool {
        false
    }

    fn begin(&mut self, _: usize, _: u8, _: Clock, _: Time) {}

    fn finish(&mut self, _: usize) -> u8 {
        0xFF
    }

    fn baud(&self) -> u32 {
        115_200
    }

    fn frame(&mut self, _: u32) {}

    fn faults(&self) -> Vec<String> {
        Vec::new()
    }

    fn due(&self) -> Time {
        Time::NEVER
    }

    fn edges(&mut self, _: Time) -> Vec<(Pin, bool)> {
        Vec::new()
    }
}
