//! Programs: what compiles for the board, what flashes it, and what emulates it.

use std::path::Path;

use super::environment::Environment;
use super::system::System;
use super::{Finding, Need, State};
use crate::emulate::qemu;

/// What the firmware is compiled for.
const TARGET: &str = "thumbv7em-none-eabihf";
/// The program that flashes a board, as the runner of `cargo board` names it.
const FLASHER: &str = "probe-rs";

/// The first line of what a program says of its version.
fn version(of: &dyn Environment, program: &str) -> Option<String> {
    let said = of.run(program, &["--version"])?;
    said.lines().next().map(|line| line.trim().to_owned()).filter(|line| !line.is_empty())
}

/// The standard library for the board's controller.
#[must_use]
pub fn target(of: &dyn Environment) -> Finding {
    let listed = of.run("rustup", &["target", "list", "--installed"]);
    let has_it = |listed: &String| listed.lines().any(|line| line.trim() == TARGET);
    let state = match listed {
        Some(listed) if has_it(&listed) => State::Found(TARGET.to_owned()),
        Some(_) => {
            State::Missing(format!("rustup has no {TARGET}"), format!("rustup target add {TARGET}"))
        }
        None if is_in_compiler(of) => State::Found(format!("{TARGET}, without rustup")),
        None => State::Missing("rustup is not installed".to_owned(), rustup(of.system())),
    };
    Finding { what: "Rust for the board", need: Need::Board, state }
}

/// Whether the compiler has the target's library without rustup.
fn is_in_compiler(of: &dyn Environment) -> bool {
    let root = of.run("rustc", &["--print", "sysroot"]).unwrap_or_default();
    let folder = Path::new(root.trim()).join("lib/rustlib").join(TARGET).join("lib");
    !root.trim().is_empty() && !of.list(&folder).is_empty()
}

/// The command that installs rustup.
fn rustup(system: System) -> String {
    let command = match system {
        System::Windows => "winget install Rustlang.Rustup",
        System::Arch => "sudo pacman -S rustup && rustup default stable",
        System::MacOs | System::Debian | System::Fedora | System::Linux | System::Other => {
            "curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh"
        }
    };
    format!("{command} && rustup target add {TARGET}")
}

/// The program that flashes a board.
#[must_use]
pub fn flasher(of: &dyn Environment) -> Finding {
    let state = version(of, FLASHER).map_or_else(
        || State::Missing(format!("{FLASHER} is not installed"), install_flasher(of.system())),
        State::Found,
    );
    Finding { what: "flashing tool", need: Need::Board, state }
}

/// The command that installs it, with the libraries that it is linked with.
fn install_flasher(system: System) -> String {
    let before = match system {
        System::Debian => "sudo apt install pkg-config libudev-dev cmake && ",
        System::Fedora => "sudo dnf install pkgconf-pkg-config systemd-devel cmake && ",
        System::Arch => "sudo pacman -S --needed pkgconf systemd-libs cmake && ",
        System::Linux | System::MacOs | System::Windows | System::Other => "",
    };
    format!("{before}cargo install probe-rs-tools --locked")
}

/// The emulator.
#[must_use]
pub fn emulator(of: &dyn Environment) -> Finding {
    let program = qemu::PROGRAM;
    let state = version(of, program).map_or_else(
        || State::Missing(format!("{program} is not installed"), install_emulator(of.system())),
        State::Found,
    );
    Finding { what: "emulator", need: Need::Emulator, state }
}

/// The command that installs it.
fn install_emulator(system: System) -> String {
    let command = match system {
        System::Debian => "sudo apt install qemu-system-arm",
        System::Fedora => "sudo dnf install qemu-system-arm",
        System::Arch => "sudo pacman -S qemu-system-arm",
        System::MacOs => "brew install qemu",
        System::Windows => "winget install SoftwareFreedomConservancy.QEMU",
        System::Linux | System::Other => "install the package of your system with qemu-system-arm",
    };
    command.to_owned()
}
