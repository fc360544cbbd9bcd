//! Where an instrument is: at a serial port, or at a byte stream over TCP, as the emulated board offers one.

use std::fmt;
use std::path::{Path, PathBuf};

/// How the address of a byte stream begins.
const TCP: &str = "tcp:";
/// The computer of a byte stream whose address names none.
const HERE: &str = "127.0.0.1";

/// Where an instrument is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// A serial port, by the name that the system has for it.
    Serial(PathBuf),
    /// A byte stream: the name of a computer, and a port there.
    Tcp(String, u16),
}

impl Address {
    /// An address as it is written: `/dev/ttyACM0`, `COM3`, `tcp:5000`, `tcp:bench.local:5000`, `tcp:[::1]:5000`.
    ///
    /// # Errors
    /// What is meant.
    pub fn parse(text: &str) -> Result<Self, String> {
        let Some(rest) = text.strip_prefix(TCP) else {
            let is_one = !text.trim().is_empty();
            let serial = || Self::Serial(PathBuf::from(text));
            return is_one.then(serial).ok_or_else(|| "the name of the port is empty".to_owned());
        };
        let (host, port) = rest.rsplit_once(':').unwrap_or((HERE, rest));
        let host = host.trim_start_matches('[').trim_end_matches(']');
        let port = port.parse().ok().filter(|port| *port != 0 && !host.is_empty());
        port.map(|port| Self::Tcp(host.to_owned(), port)).ok_or_else(|| {
            "tcp: and a port, or a computer and a port, are meant, as in tcp:5000 or tcp:bench:5000"
                .to_owned()
        })
    }

    /// The port of which this is the address; none where the name is that of a file.
    #[must_use]
    pub fn of_port(name: &str) -> Option<Self> {
        let is_stream = name.starts_with(TCP);
        (is_stream || is_serial(Path::new(name))).then(|| Self::parse(name).ok()).flatten()
    }
}

/// Whether a name is that which a system gives to a serial port; links, as those of `/dev/serial/by-id`, are followed.
fn is_serial(name: &Path) -> bool {
    let number = |name: &str| {
        let number = name.to_ascii_uppercase().strip_prefix("COM").map(str::to_owned);
        number.is_some_and(|it| !it.is_empty() && it.bytes().all(|digit| digit.is_ascii_digit()))
    };
    if name.to_str().is_some_and(|name| number(name.trim_start_matches(r"\\.\"))) {
        return true;
    }
    let file = name.canonicalize().unwrap_or_else(|_| name.to_path_buf());
    let last = file.file_name().map(|last| last.to_string_lossy().into_owned()).unwrap_or_default();
    let is_terminal = ["tty", "cu.", "rfcomm"].iter().any(|begin| last.starts_with(begin));
    file.starts_with("/dev/pts") || (file.starts_with("/dev") && is_terminal)
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial(path) => write!(f, "{}", path.display()),
            Self::Tcp(host, port) if host.contains(':') => write!(f, "{TCP}[{host}]:{port}"),
            Self::Tcp(host, port) if host == HERE => write!(f, "{TCP}{port}"),
            Self::Tcp(host, port) => write!(f, "{TCP}{host}:{port}"),
        }
    }
}
