//! The board at a USB port of this computer: its ST-LINK, who may use that, and the chip behind it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::environment::{Chip, Environment, Probe};
use super::system::System;
use super::{Finding, Need, State};

/// Number at USB of the maker of the board and its probe.
pub(super) const MAKER: u16 = 0x0483;
/// Numbers of the maker's probes, with their names; a B-L475E-IOT01A has an ST-LINK/V2-1.
const PROBES: [(u16, &str); 7] = [
    (0x3748, "ST-LINK/V2"),
    (0x374B, "ST-LINK/V2-1"),
    (0x3752, "ST-LINK/V2-1 without a disk"),
    (0x374E, "STLINK-V3"),
    (0x374F, "STLINK-V3"),
    (0x3753, "STLINK-V3"),
    (0x3754, "STLINK-V3 without a disk"),
];
/// Where Linux shows the devices at USB.
const DEVICES: &str = "/sys/bus/usb/devices";
/// Where Linux keeps the rules that say who may use a device.
const RULES: [&str; 3] = ["/etc/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d"];
/// The kinds of a chip by its identity (RM0351 section 48.6.1): the STM32L475 and its relatives.
const KIND: u32 = 0x415;

/// An ST-LINK at USB.
struct Link {
    name: &'static str,
    /// The device that is opened to use it, where the system has one.
    device: Option<PathBuf>,
}

/// The board.
#[must_use]
pub fn board(of: &dyn Environment) -> Finding {
    let links = links(of);
    let state = match (links.as_slice(), of.system()) {
        ([link], _) => State::Found(link.name.to_owned()),
        ([first, ..], _) => State::Found(format!("{} ST-LINK, as {}", links.len(), first.name)),
        ([], System::Other) => State::Unseen(
            "this system does not say what is at its USB ports".to_owned(),
            "probe-rs list".to_owned(),
        ),
        ([], _) => State::Missing(
            "no ST-LINK at any USB port".to_owned(),
            "connect the board's connector CN7 with a USB cable that carries data".to_owned(),
        ),
    };
    Finding { what: "board", need: Need::Board, state }
}

/// The ST-LINK probes at USB.
fn links(of: &dyn Environment) -> Vec<Link> {
    let by_number = |numbers: Vec<u16>| {
        let named = numbers.into_iter().filter_map(named);
        named.map(|name| Link { name, device: None }).collect()
    };
    match of.system() {
        System::MacOs => {
            let text = of.run("ioreg", &["-p", "IOUSB", "-l", "-w", "0"]).unwrap_or_default();
            by_number(numbers(&text, "\"idProduct\" = ", 10))
        }
        System::Windows => {
            let text = of.run("pnputil", &["/enum-devices", "/connected"]).unwrap_or_default();
            by_number(numbers(&text, "USB\\VID_0483&PID_", 16))
        }
        System::Other => Vec::new(),
        _ => of.list(Path::new(DEVICES)).iter().filter_map(|folder| of_linux(of, folder)).collect(),
    }
}

/// The name of the probe with a number.
fn named(number: u16) -> Option<&'static str> {
    PROBES.iter().find(|(of, _)| *of == number).map(|(_, name)| *name)
}

/// The numbers that stand behind a mark in a text.
fn numbers(text: &str, mark: &str, radix: u32) -> Vec<u16> {
    let behind = text.split(mark).skip(1);
    let digits = behind.map(|rest| rest.split(|c: char| !c.is_digit(radix)).next());
    digits.filter_map(|digits| u16::from_str_radix(digits?, radix).ok()).collect()
}

/// The ST-LINK that Linux shows in a folder.
fn of_linux(of: &dyn Environment, folder: &Path) -> Option<Link> {
    let text = |name: &str| of.read(&folder.join(name)).map(|text| text.trim().to_owned());
    let number = |name: &str| u16::from_str_radix(&text(name)?, 16).ok();
    let name = named(number("idProduct")?).filter(|_| number("idVendor") == Some(MAKER))?;
    let place = |name: &str| text(name)?.parse::<u16>().ok();
    let device = place("busnum").zip(place("devnum"));
    let device = device.map(|(bus, at)| PathBuf::from(format!("/dev/bus/usb/{bus:03}/{at:03}")));
    Some(Link { name, device })
}

/// Whether the user may use the probe.
#[must_use]
pub fn access(of: &dyn Environment) -> Finding {
    let finding = |state| Finding { what: "access to it", need: Need::Board, state };
    if !of.system().is_linux() {
        return finding(State::Found("this system asks for none".to_owned()));
    }
    let device = links(of).into_iter().find_map(|link| link.device);
    let opened = device.map(|device| (of.open(&device), device));
    finding(match opened {
        Some((Ok(()), device)) => State::Found(device.display().to_string()),
        Some((Err(ErrorKind::PermissionDenied), device)) => {
            State::Missing(format!("{} is protected", device.display()), RULE.to_owned())
        }
        Some((Err(kind), device)) => State::Missing(
            format!("{}: {}", device.display(), crate::refused::words(kind, &kind.to_string())),
            "take the board's cable out and put it in again".to_owned(),
        ),
        None => match rule(of) {
            Some(file) => State::Found(format!("rules in {}", file.display())),
            None => State::Missing("no rules for an ST-LINK".to_owned(), RULE.to_owned()),
        },
    })
}

/// The command that lets users have debug probes, as the documentation of probe-rs has it.
const RULE: &str = "sudo curl -fsSL https://probe.rs/files/69-probe-rs.rules -o /etc/udev/rules.d/69-probe-rs.rules \
                    && sudo udevadm control --reload && sudo udevadm trigger";

/// The file of rules for probes of this maker.
fn rule(of: &dyn Environment) -> Option<PathBuf> {
    let maker = format!("{MAKER:04x}");
    let names_it = |path: &PathBuf| {
        of.read(path).is_some_and(|text| text.contains(&maker) && text.contains("374"))
    };
    RULES.iter().flat_map(|folder| of.list(Path::new(folder))).find(names_it)
}

/// The chip behind a debug probe.
#[must_use]
pub fn probe(of: &dyn Environment) -> Finding {
    let state = match of.probes() {
        None => State::Unseen(
            "this program was built without it".to_owned(),
            "cargo run --release --features probe -- doctor".to_owned(),
        ),
        Some(probes) => match probes.as_slice() {
            [] => State::Missing(
                "no debug probe that can be used".to_owned(),
                "connect the board's connector CN7, and see what is said of access to it"
                    .to_owned(),
            ),
            [probe, ..] => behind(probe),
        },
    };
    Finding { what: "chip behind a probe", need: Need::Board, state }
}

/// The chip behind a probe.
fn behind(Probe { name, chip }: &Probe) -> State {
    match chip {
        Ok(Chip { device, unique: [a, b, c] }) if device & 0xFFF == KIND => State::Found(format!(
            "{name}: STM32L475 or a relative, revision {:04X}, identity {a:08X}{b:08X}{c:08X}",
            device >> 16
        )),
        Ok(Chip { device, .. }) => State::Missing(
            format!("{name}: a chip of the kind {:03X}, and not an STM32L475", device & 0xFFF),
            "connect a B-L475E-IOT01A".to_owned(),
        ),
        Err(why) => State::Missing(
            format!("{name}: {why}"),
            "end other programs that use the probe, and take the board's cable out and put it in again"
                .to_owned(),
        ),
    }
}
