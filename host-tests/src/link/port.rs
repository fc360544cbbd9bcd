//! A port that an instrument is at: bytes out, bytes in, and why there are none.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::Duration;

use serial2::SerialPort;

use super::address::Address;
use crate::refused;

/// How long it waits for bytes before it returns without any, so that who waits can look at the time: at 115 200 baud the
/// longest frame takes 24 ms, and what pauses for longer is at an end.
const SLICE: Duration = Duration::from_millis(50);
/// How long a connection may take.
const CONNECTING: Duration = Duration::from_secs(5);
/// How long a command may take to go out: 82 characters take 7 ms at 115 200 baud, and 0.7 s at 1 200.
const SENDING: Duration = Duration::from_secs(2);

/// An open port.
pub struct Port {
    address: Address,
    /// Baud rate of a serial port, bits/s.
    baud: u32,
    stream: Stream,
}

/// What carries the bytes.
enum Stream {
    Serial(SerialPort),
    Tcp(TcpStream),
}

impl Port {
    /// Opens the port at an address, a serial one with this baud rate, eight bits, no parity.
    ///
    /// # Errors
    /// Why it cannot be opened, and what mends that.
    pub fn open(address: &Address, baud: u32) -> Result<Self, String> {
        let stream = match address {
            Address::Serial(path) => serial(path, baud),
            Address::Tcp(host, port) => connected(host, *port),
        };
        let stream = stream.map_err(|why| format!("{address}: {why}"))?;
        Ok(Self { address: address.clone(), baud, stream })
    }

    /// Where it is.
    #[must_use]
    pub fn address(&self) -> &Address {
        &self.address
    }

    /// Baud rate, bits/s; none of a byte stream, which has none.
    #[must_use]
    pub fn baud(&self) -> Option<u32> {
        matches!(self.stream, Stream::Serial(_)).then_some(self.baud)
    }

    /// Sends all of these bytes.
    ///
    /// # Errors
    /// The other side is gone, or takes nothing.
    pub fn send(&mut self, bytes: &[u8]) -> Result<(), String> {
        let sent = match &mut self.stream {
            Stream::Serial(port) => port.write_all(bytes),
            Stream::Tcp(stream) => stream.write_all(bytes),
        };
        sent.map_err(|error| match error.kind() {
            ErrorKind::TimedOut | ErrorKind::WouldBlock => {
                "it takes no bytes: another program may hold it, or its line may be blocked"
                    .to_owned()
            }
            _ => gone(&error),
        })
    }

    /// Receives some bytes; none where none have come for a while.
    ///
    /// # Errors
    /// The other side is gone.
    pub fn receive(&mut self, into: &mut [u8]) -> Result<usize, String> {
        let received = match &mut self.stream {
            Stream::Serial(port) => port.read(into),
            Stream::Tcp(stream) => stream.read(into),
        };
        match received {
            Ok(0) => Err("the other side has closed it".to_owned()),
            Ok(count) => Ok(count),
            Err(error) if is_pause(error.kind()) => Ok(0),
            Err(error) => Err(gone(&error)),
        }
    }
}

/// Whether an error says that nothing has come yet.
fn is_pause(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

/// Why a port gives and takes nothing any more.
fn gone(error: &io::Error) -> String {
    format!("the other side is gone: {}", refused::cause(error))
}

/// Opens a serial port. What has come before is none of ours.
fn serial(path: &Path, baud: u32) -> Result<Stream, String> {
    let opened = SerialPort::open(path, baud).and_then(|mut port| {
        port.set_read_timeout(SLICE)?;
        port.set_write_timeout(SENDING)?;
        port.discard_input_buffer()?;
        Ok(port)
    });
    opened.map(Stream::Serial).map_err(|error| unopened(path, baud, &error))
}

/// Why a serial port cannot be opened, and what mends that.
fn unopened(path: &Path, baud: u32, error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => format!("there is no such port; {}", others()),
        ErrorKind::PermissionDenied if cfg!(windows) => "another program has it in use".to_owned(),
        ErrorKind::PermissionDenied => {
            let path = path.display();
            format!(
                "the permission is missing: `sudo usermod -aG \"$(stat -c %G {path})\" \"$USER\"`, then log in anew"
            )
        }
        ErrorKind::ResourceBusy => "another program has it in use; close that".to_owned(),
        _ if path.is_file() => "it is a file and no serial port".to_owned(),
        _ => format!("it cannot be opened with {baud} baud: {}", refused::cause(error)),
    }
}

/// The ports that there are, in words.
fn others() -> String {
    let ports = SerialPort::available_ports().unwrap_or_default();
    let names: Vec<_> = ports.iter().map(|port| port.display().to_string()).collect();
    match names.as_slice() {
        [] => "this computer has none: is the board connected?".to_owned(),
        names => format!("this computer has {}", names.join(", ")),
    }
}

/// Connects to a byte stream.
fn connected(host: &str, port: u16) -> Result<Stream, String> {
    let addresses = (host, port).to_socket_addrs();
    let addresses = addresses.map_err(|_| format!("there is no computer {host}"))?;
    let mut last = None;
    for address in addresses {
        match TcpStream::connect_timeout(&address, CONNECTING).and_then(settled) {
            Ok(stream) => return Ok(Stream::Tcp(stream)),
            Err(error) => last = Some(error),
        }
    }
    Err(last
        .map_or_else(|| format!("there is no computer {host}"), |error| unconnected(port, &error)))
}

/// A stream that sends at once and waits for bytes no longer than a port does.
fn settled(stream: TcpStream) -> io::Result<TcpStream> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(SLICE))?;
    stream.set_write_timeout(Some(SENDING))?;
    Ok(stream)
}

/// Why there is no connection, and what mends that.
fn unconnected(port: u16, error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::ConnectionRefused => format!(
            "nothing is served there; `meridian emulate --board stage --link tcp:{port}` serves an emulated board"
        ),
        ErrorKind::TimedOut => "the computer does not answer".to_owned(),
        _ => refused::cause(error),
    }
}
