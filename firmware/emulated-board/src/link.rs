//! The link as a byte stream for clients, of which one at a time may come, be slow, and go.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::Duration;

/// Bytes that wait for a slow client at most: some minutes of sentences.
pub const WAITING: usize = 1 << 16;
/// How long the client may take for some of the bytes that wait at the end.
const PATIENCE: Duration = Duration::from_secs(5);

/// The link at a port of this computer, for one client after the other.
pub struct Clients {
    listener: TcpListener,
    /// The one that is there.
    client: Option<Client>,
}

impl Clients {
    /// Those who come to a port of this computer, of whom the first may be waited for; 0 is any port that is free. Standard
    /// error says which.
    ///
    /// # Errors
    /// What the system says, as where the port is taken.
    pub fn at(port: u16, waits: bool) -> Result<Self, String> {
        let failed = |error: io::Error| format!("--link tcp:{port}: {error}");
        let listener = TcpListener::bind(("127.0.0.1", port)).map_err(failed)?;
        let does = if waits { "waiting for a client" } else { "listening to clients" };
        eprintln!("{does} at {}", listener.local_addr().map_err(failed)?);
        let client = waits.then(|| Client::next(&listener)).transpose().map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        Ok(Self { listener, client })
    }

    /// Hands over bytes of the link, and takes what the client sends, without waiting for it. Without a client, the bytes
    /// are lost. Standard error says why a client was given up.
    pub fn exchange(&mut self, sent: &[u8]) -> Vec<u8> {
        if self.client.is_none() {
            self.client = Client::next(&self.listener).ok();
        }
        let exchanged = self.client.as_mut().map_or(Ok(Vec::new()), |client| client.exchange(sent));
        exchanged.unwrap_or_else(|error| {
            eprintln!("link: {error}");
            self.client = None;
            Vec::new()
        })
    }

    /// Waits until the client that is there has what is left for it; standard error says where it does not take that.
    pub fn finish(self) {
        if let Some(Err(error)) = self.client.map(Client::finish) {
            eprintln!("link: {error}");
        }
    }
}

/// The client of a link.
pub struct Client {
    stream: TcpStream,
    /// Bytes that it has not taken yet.
    waiting: VecDeque<u8>,
}

impl Client {
    /// The next client that has connected, waited for where the listener waits.
    fn next(listener: &TcpListener) -> io::Result<Self> {
        let (stream, _) = listener.accept()?;
        Self::new(stream)
    }

    /// A client at the other end of a connection.
    ///
    /// # Errors
    /// What the system says.
    pub fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        // An answer of the board goes at once, as on a wire.
        stream.set_nodelay(true)?;
        Ok(Self { stream, waiting: VecDeque::new() })
    }

    /// Hands over bytes of the link, and takes what the client sends, without waiting for it.
    ///
    /// # Errors
    /// Why the client hears nothing any more: it has gone, or more than [`WAITING`] bytes wait for it.
    pub fn exchange(&mut self, sent: &[u8]) -> Result<Vec<u8>, String> {
        self.waiting.extend(sent);
        self.hand_over().map_err(gone)?;
        if self.waiting.len() > WAITING {
            return Err(format!(
                "the client is too slow: {} bytes wait for it",
                self.waiting.len()
            ));
        }
        let mut received = [0; 256];
        let count = no_wait(self.stream.read(&mut received)).map_err(gone)?;
        Ok(received[..count.unwrap_or(0)].to_vec())
    }

    /// How many bytes the client has not taken yet.
    pub fn waits(&self) -> usize {
        self.waiting.len()
    }

    /// Hands over as many of the bytes that wait as the connection takes.
    fn hand_over(&mut self) -> io::Result<()> {
        while !self.waiting.is_empty()
            && let Some(count) = no_wait(self.stream.write(self.waiting.make_contiguous()))?
        {
            self.waiting.drain(..count);
        }
        Ok(())
    }

    /// Waits until the client has what is left for it.
    ///
    /// # Errors
    /// It has gone, or takes nothing for five seconds.
    pub fn finish(mut self) -> Result<(), String> {
        let settle = |stream: &TcpStream| {
            stream.set_nonblocking(false)?;
            stream.set_write_timeout(Some(PATIENCE))
        };
        let handed = settle(&self.stream)
            .and_then(|()| self.stream.write_all(self.waiting.make_contiguous()));
        handed.map_err(gone)
    }
}

/// What came of something that does not wait; none where it would have to.
fn no_wait(result: io::Result<usize>) -> io::Result<Option<usize>> {
    match result {
        Ok(count) => Ok(Some(count)),
        Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(None),
        Err(error) => Err(error),
    }
}

/// Why a client hears nothing any more.
#[expect(clippy::needless_pass_by_value, reason = "as what errors are mapped by")]
fn gone(error: io::Error) -> String {
    format!("the client is gone: {error}")
}
