//! `meridian doctor`: every check on computers that are made here, and the program on this one.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use host::doctor::environment::{Chip, Environment, Probe};
use host::doctor::system::System;
use host::doctor::{Finding, Need, State, board, findings, serial, tools};
use serde_json::json;

use crate::support::program::{code, command, meridian, object, text};

/// A computer with nothing on it but what a test puts there.
#[derive(Clone, Default)]
struct Computer {
    system: Option<System>,
    /// What command lines print.
    programs: BTreeMap<String, String>,
    files: BTreeMap<PathBuf, String>,
    /// Devices that can be opened, or why not.
    devices: BTreeMap<PathBuf, Result<(), ErrorKind>>,
    ports: Vec<PathBuf>,
    probes: Option<Vec<Probe>>,
}

impl Computer {
    fn on(system: System) -> Self {
        Self { system: Some(system), ..Self::default() }
    }

    fn with_program(mut self, line: &str, prints: &str) -> Self {
        self.programs.insert(line.to_owned(), prints.to_owned());
        self
    }

    fn with_file(mut self, path: &str, text: &str) -> Self {
        self.files.insert(PathBuf::from(path), text.to_owned());
        self
    }

    fn with_device(mut self, path: &str, opens: Result<(), ErrorKind>) -> Self {
        self.devices.insert(PathBuf::from(path), opens);
        self
    }

    fn with_port(mut self, path: &str) -> Self {
        self.ports.push(PathBuf::from(path));
        self
    }

    /// With a board at USB, as Linux shows it.
    fn with_board(self) -> Self {
        let folder = "/sys/bus/usb/devices/1-4/";
        [("idVendor", "0483\n"), ("idProduct", "374b\n"), ("busnum", "1\n"), ("devnum", "7\n")]
            .into_iter()
            .fold(self, |computer, (name, text)| {
                computer.with_file(&format!("{folder}{name}"), text)
            })
            .with_file("/sys/bus/usb/devices/1-1/idVendor", "1d6b\n")
            .with_file("/sys/class/tty/ttyACM0/device/../idVendor", "0483\n")
            .with_port("/dev/ttyS0")
            .with_port("/dev/ttyACM0")
    }
}

impl Environment for Computer {
    fn system(&self) -> System {
        self.system.unwrap_or_else(|| System::of_linux(self))
    }

    fn run(&self, program: &str, arguments: &[&str]) -> Option<String> {
        self.programs.get(&format!("{program} {}", arguments.join(" "))).cloned()
    }

    fn read(&self, path: &Path) -> Option<String> {
        self.files.get(path).cloned()
    }

    fn list(&self, folder: &Path) -> Vec<PathBuf> {
        let below = self.files.keys().filter_map(|path| path.strip_prefix(folder).ok());
        let mut names: Vec<_> =
            below.filter_map(|path| Some(folder.join(path.components().next()?))).collect();
        names.dedup();
        names
    }

    fn open(&self, path: &Path) -> Result<(), ErrorKind> {
        self.devices.get(path).copied().unwrap_or(Err(ErrorKind::NotFound))
    }

    fn ports(&self) -> Vec<PathBuf> {
        self.ports.clone()
    }

    fn probes(&self) -> Option<Vec<Probe>> {
        self.probes.clone()
    }
}

/// That something is there, and what.
#[track_caller]
fn assert_found(finding: &Finding, words: &str) {
    assert!(matches!(&finding.state, State::Found(found) if found.contains(words)), "{finding:?}");
}

/// That something is not there, what, and what mends it.
#[track_caller]
fn assert_missing(finding: &Finding, words: &str, remedy: &str) {
    let is_so = |found: &str, mends: &str| found.contains(words) && mends.contains(remedy);
    let is_missing = matches!(&finding.state, State::Missing(found, mends) if is_so(found, mends));
    assert!(is_missing, "{finding:?}");
}

/// All systems.
const SYSTEMS: [System; 7] = [
    System::Debian,
    System::Fedora,
    System::Arch,
    System::Linux,
    System::MacOs,
    System::Windows,
    System::Other,
];

#[test]
fn on_an_empty_computer_of_any_system_everything_is_missing_and_has_a_remedy() {
    for system in SYSTEMS {
        let found = findings(&Computer::on(system));
        assert_eq!(found.len(), 7);
        for finding in &found {
            let needs_none = finding.what == "access to it" && !system.is_linux();
            assert_eq!(finding.remedy().is_none(), needs_none, "{system:?}: {finding:?}");
            assert!(finding.remedy().is_none_or(|remedy| !remedy.contains('\n')), "{finding:?}");
        }
        assert!(found.iter().any(Finding::stops_the_board), "{system:?}");
    }
}

#[test]
fn on_a_computer_with_everything_nothing_is_missing() {
    let mut computer = Computer::on(System::Debian)
        .with_program("rustup target list --installed", "thumbv7em-none-eabihf\nx86_64\n")
        .with_program("probe-rs --version", "probe-rs 0.32.0\n")
        .with_program("qemu-system-arm --version", "QEMU emulator version 7.2.9\nCopyright\n")
        .with_board()
        .with_device("/dev/bus/usb/001/007", Ok(()))
        .with_device("/dev/ttyACM0", Ok(()));
    let unique = [0x0033_0021, 0x5036_4B50, 0x2031_3537];
    let chip = Ok(Chip { device: 0x1007_6415, unique });
    computer.probes = Some(vec![Probe { name: "STLink V2-1".to_owned(), chip }]);
    let found = findings(&computer);
    for (finding, words) in found.iter().zip([
        "thumbv7em-none-eabihf",
        "probe-rs 0.32.0",
        "ST-LINK/V2-1",
        "/dev/bus/usb/001/007",
        "revision 1007, identity 0033002150364B5020313537",
        "/dev/ttyACM0, of an ST-LINK",
        "QEMU emulator version 7.2.9",
    ]) {
        assert_found(finding, words);
    }
    assert!(!found.iter().any(Finding::stops_the_board));
}

#[test]
fn a_linux_is_known_by_its_release() {
    for (release, system, installs) in [
        ("ID=debian\n", System::Debian, "sudo apt install qemu-system-arm"),
        ("NAME=\"Mint\"\nID=linuxmint\nID_LIKE=\"ubuntu debian\"\n", System::Debian, "sudo apt"),
        ("ID=fedora\n", System::Fedora, "sudo dnf install qemu-system-arm"),
        ("ID=endeavouros\nID_LIKE='arch'\n", System::Arch, "sudo pacman -S qemu-system-arm"),
        ("ID=nixos\n", System::Linux, "the package of your system"),
        ("", System::Linux, "the package of your system"),
    ] {
        let computer = Computer::default().with_file("/etc/os-release", release);
        assert_eq!(computer.system(), system, "{release}");
        assert_missing(&tools::emulator(&computer), "qemu-system-arm is not installed", installs);
    }
    for (system, installs) in
        [(System::MacOs, "brew install qemu"), (System::Windows, "winget install")]
    {
        assert_missing(&tools::emulator(&Computer::on(system)), "not installed", installs);
    }
}

#[test]
fn the_target_is_missing_where_rustup_does_not_list_it_and_there_without_rustup() {
    let computer = Computer::on(System::Debian);
    let listed = computer.clone().with_program("rustup target list --installed", "x86_64\n");
    let add = "rustup target add thumbv7em-none-eabihf";
    assert_missing(&tools::target(&listed), "rustup has no thumbv7em", add);
    assert_missing(&tools::target(&computer), "rustup is not installed", "https://sh.rustup.rs");
    let windows = Computer::on(System::Windows);
    assert_missing(&tools::target(&windows), "rustup is not", "winget install Rustlang.Rustup");
    let library = "/usr/lib/rustlib/thumbv7em-none-eabihf/lib/libcore.rlib";
    let packaged = computer.with_program("rustc --print sysroot", "/usr\n");
    assert_missing(&tools::target(&packaged), "rustup is not installed", add);
    assert_found(&tools::target(&packaged.with_file(library, "")), "without rustup");
}

#[test]
fn a_board_is_known_by_the_numbers_of_its_probe_on_every_system_that_says_them() {
    assert_found(&board::board(&Computer::on(System::Arch).with_board()), "ST-LINK/V2-1");
    let mac = "\"idProduct\" = 14155\n  \"idVendor\" = 1155\n";
    let mac = Computer::on(System::MacOs).with_program("ioreg -p IOUSB -l -w 0", mac);
    assert_found(&board::board(&mac), "ST-LINK/V2-1");
    let windows = "Instance ID: USB\\VID_0483&PID_374B\\0669FF\n";
    let windows =
        Computer::on(System::Windows).with_program("pnputil /enum-devices /connected", windows);
    assert_found(&board::board(&windows), "ST-LINK/V2-1");
    let other = Computer::on(System::Debian).with_file("/sys/bus/usb/devices/1-1/idVendor", "1d6b");
    assert_missing(&board::board(&other), "no ST-LINK at any USB port", "CN7");
    assert!(matches!(board::board(&Computer::on(System::Other)).state, State::Unseen(..)));
}

#[test]
fn a_probe_that_is_protected_needs_rules() {
    let computer = Computer::on(System::Debian);
    let board = computer.clone().with_board();
    let protected =
        board.clone().with_device("/dev/bus/usb/001/007", Err(ErrorKind::PermissionDenied));
    let words = "/dev/bus/usb/001/007 is protected";
    assert_missing(&board::access(&protected), words, "/etc/udev/rules.d/69-probe-rs.rules");
    assert_missing(&board::access(&board), "no such file", "put it in again");
    // Without a board only the rules can be looked at.
    assert_missing(
        &board::access(&computer),
        "no rules for an ST-LINK",
        "udevadm control --reload",
    );
    let rules = "/usr/lib/udev/rules.d/69-probe-rs.rules";
    let with_rules =
        computer.with_file(rules, "ATTRS{idVendor}==\"0483\", ATTRS{idProduct}==\"374b\"");
    assert_found(&board::access(&with_rules), rules);
    assert_found(&board::access(&Computer::on(System::MacOs)), "asks for none");
}

#[test]
fn without_its_feature_the_chip_is_not_looked_for_and_nothing_is_missing_for_that() {
    let finding = board::probe(&Computer::on(System::Debian));
    let State::Unseen(_, remedy) = &finding.state else { panic!("{finding:?}") };
    assert_eq!(remedy, "cargo run --release --features probe -- doctor");
    assert!(!finding.stops_the_board());
}

#[test]
fn a_probe_without_the_right_chip_says_what_is_behind_it() {
    let with =
        |probes: Vec<Probe>| Computer { probes: Some(probes), ..Computer::on(System::Debian) };
    let probe = |chip| Probe { name: "STLink V2-1".to_owned(), chip };
    assert_missing(&board::probe(&with(Vec::new())), "no debug probe", "CN7");
    let other = with(vec![probe(Ok(Chip { device: 0x2000_0413, unique: [0; 3] }))]);
    assert_missing(&board::probe(&other), "a chip of the kind 413", "B-L475E-IOT01A");
    let none = with(vec![probe(Err("the target does not answer".to_owned()))]);
    assert_missing(&board::probe(&none), "STLink V2-1: the target does not answer", "end other");
}

#[test]
fn a_serial_port_is_that_of_the_board_and_may_be_protected_or_in_use() {
    let board =
        |system, opens| Computer::on(system).with_board().with_device("/dev/ttyACM0", opens);
    let denied = Err(ErrorKind::PermissionDenied);
    let port = |system, opens| serial::port(&board(system, opens));
    assert_found(&port(System::Debian, Ok(())), "/dev/ttyACM0, of an ST-LINK");
    assert_missing(
        &port(System::Debian, denied),
        "/dev/ttyACM0 is protected",
        "-aG dialout \"$USER\"",
    );
    assert_missing(&port(System::Arch, denied), "is protected", "-aG uucp");
    assert_found(&port(System::Fedora, Err(ErrorKind::ResourceBusy)), "another program has it");
    let other = Computer::on(System::Debian).with_port("/dev/ttyS0");
    assert_missing(&serial::port(&other), "none is an ST-LINK's; there are /dev/ttyS0", "CN7");
    assert_found(&serial::port(&Computer::on(System::Windows).with_port("COM3")), "COM3");
    let finding = serial::port(&Computer::on(System::Windows));
    assert_eq!((finding.need, finding.stops_the_board()), (Need::Link, false));
    assert_missing(&finding, "no serial port", "CN7");
}

#[test]
fn the_program_says_the_same_as_text_and_as_an_object_and_its_exit_code_is_that_of_the_board() {
    let output = meridian(&["doctor", "--json"]);
    let object = object(&output);
    let findings = object["findings"].as_array().expect("there are findings");
    let lacks = |finding: &serde_json::Value| {
        finding["needed_for"] == "cargo board" && finding["state"] == "missing"
    };
    let is_whole = !findings.iter().any(lacks);
    assert_eq!(code(&output), i32::from(!is_whole));
    assert_eq!(object["status"], json!(if is_whole { "ok" } else { "failed" }));
    let shown = text(&meridian(&["doctor"]).stdout);
    for finding in findings {
        for key in ["what", "state", "found"] {
            let words = finding[key].as_str().expect("words");
            assert!(shown.contains(words), "{words} in {shown}");
        }
    }
}

#[test]
fn without_any_program_it_says_what_is_missing_and_does_not_fail() {
    let mut command = command();
    let output = command.arg("doctor").env("PATH", "").output().expect("it starts");
    assert_eq!(code(&output), 1);
    let said = text(&output.stderr);
    assert!(said.starts_with("meridian: `cargo board` lacks what it needs: "), "{said}");
    for what in ["Rust for the board", "flashing tool"] {
        assert!(said.contains(what), "{said}");
    }
}
