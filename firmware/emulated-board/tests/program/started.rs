//! The program, started.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStderr, Command, Output, Stdio};

use std::time::Duration;

use firmware::platform::Platform;

use crate::images::path;

/// The program with an image of a carrier, and further arguments.
pub fn program(image: &str, carrier: Platform, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_emulated-board"));
    command.arg(image).args(["--carrier", carrier.name()]).args(arguments);
    command
}

/// What the program does with an image of a carrier, and further arguments.
pub fn output(image: &str, carrier: Platform, arguments: &[&str]) -> Output {
    program(image, carrier, arguments).output().expect("it starts")
}

/// Text that a program has printed.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("it prints UTF-8")
}

/// The program, which waits for a client of a board's link; its port is free.
pub struct Waiting {
    /// The process.
    pub child: Child,
    /// Where it waits, as "127.0.0.1:5000".
    pub address: String,
    /// What it says from then on.
    pub log: BufReader<ChildStderr>,
}

impl Waiting {
    /// Starts it with the image of a carrier, and further arguments.
    pub fn new(carrier: Platform, arguments: &[&str]) -> Self {
        let image = path(carrier).to_str().expect("a name in UTF-8");
        let mut command = program(image, carrier, &["--link", "tcp:0"]);
        let piped = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = piped.stderr(Stdio::piped()).spawn().expect("it starts");
        let mut log = BufReader::new(child.stderr.take().expect("it is piped"));
        let mut line = String::new();
        log.read_line(&mut line).expect("it says where it waits");
        let address = line.trim().rsplit(' ').next().expect("the line has words").to_owned();
        Self { child, address, log }
    }

    /// A client of the board's link.
    pub fn connect(&self) -> Connected {
        let stream = TcpStream::connect(&self.address).expect("it listens");
        stream.set_read_timeout(Some(Duration::from_mins(1))).expect("a connection");
        Connected(BufReader::new(stream))
    }
}

/// A client of the link, which is served from when the one before it has gone.
pub struct Connected(BufReader<TcpStream>);

impl Connected {
    /// Listens until a line begins like this; the whole line.
    pub fn heard(&mut self, start: &str) -> String {
        let mut lines = (&mut self.0).lines().map(|line| line.expect("it goes on"));
        lines.find(|line| line.starts_with(start)).expect("it says so")
    }

    /// Sends a line.
    pub fn send(&mut self, line: &str) {
        write!(self.0.get_mut(), "{line}\r\n").expect("it is connected");
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        // Both fail only where it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
