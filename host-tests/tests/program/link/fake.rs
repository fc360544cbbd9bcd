//! An instrument at the other end of a wire. It takes sentences apart and puts them together by itself, and shares no code
//! with the program.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// How often it says something by itself.
const IDLE: Duration = Duration::from_millis(10);

/// What it says.
#[derive(Clone, Debug)]
pub enum Say {
    /// A sentence of this content, among the chatter.
    Sentence(String),
    /// Bytes as they are.
    Bytes(Vec<u8>),
    /// It goes away.
    HangUp,
}

/// Bytes as hexadecimal digits.
pub fn digits(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02X}"))
}

/// A sentence of this content.
pub fn say(content: impl Into<String>) -> Say {
    Say::Sentence(content.into())
}

/// The bytes of a sentence.
pub fn sentence(content: &str) -> Vec<u8> {
    let sum = content.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${content}*{sum:02X}\r\n").into_bytes()
}

/// What an instrument answers to the words of a command.
pub type Answering = Box<dyn FnMut(&[&str]) -> Vec<Say> + Send>;

/// A wire, whose reads end after a while without anything.
pub trait Wire: Send {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize>;
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<()>;
}

impl Wire for TcpStream {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        Read::read(self, into)
    }

    fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.write_all(bytes)
    }
}

#[cfg(unix)]
impl Wire for serial2::SerialPort {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        serial2::SerialPort::read(self, into)
    }

    fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.write_all(bytes)
    }
}

/// A sentence of a heading, one of another talker, the word of status, a frame of MAVLink that the component of an inertial
/// measurement unit sends, the beginning of a frame without an end, and bytes of nothing.
pub fn chatter() -> Vec<u8> {
    let mut bytes = b"\x00\x80noise\xFD\x09".to_vec();
    bytes.extend(sentence("HEHDT,213.702,T"));
    bytes.extend(frame(200));
    bytes.extend(sentence("PMRDS,degraded,0.039,0.012,0.012,2,61,5,24"));
    bytes.extend(b"$GPGGA,cut off\xFF");
    bytes.extend(sentence("GPHDT,12.3,T"));
    bytes
}

/// A heartbeat of a component.
pub fn frame(component: u8) -> Vec<u8> {
    use mavlink::dialects::common::HEARTBEAT_DATA;
    let header = mavlink::MavHeader { system_id: 1, component_id: component, sequence: 7 };
    let mut frame = mavlink::MAVLinkV2MessageRaw::new();
    frame.serialize_message_data(header, &HEARTBEAT_DATA::default());
    frame.raw_bytes().to_vec()
}

/// Speaks over a wire until the other side is gone, or it hangs up.
fn speak(wire: &mut dyn Wire, idle: &[u8], answering: &mut Answering) {
    let (mut waiting, mut chunk) = (Vec::new(), [0; 256]);
    loop {
        match wire.read(&mut chunk) {
            Ok(0) => return,
            Ok(count) => waiting.extend_from_slice(&chunk[..count]),
            Err(error) if [ErrorKind::WouldBlock, ErrorKind::TimedOut].contains(&error.kind()) => {
                // A wire that nobody reads is full at some time.
                if wire.write(idle).is_err_and(|error| error.kind() != ErrorKind::TimedOut) {
                    return;
                }
            }
            Err(_) => return,
        }
        while let Some(end) = waiting.windows(2).position(|pair| pair == b"\r\n") {
            let line: Vec<u8> = waiting.drain(..end + 2).collect();
            let line = String::from_utf8(line).expect("a command is text");
            for said in answering(&taken_apart(line.trim_end())) {
                let said = match said {
                    Say::Sentence(content) => [idle, &sentence(&content), idle].concat(),
                    Say::Bytes(bytes) => bytes,
                    Say::HangUp => return,
                };
                if wire.write(&said).is_err() {
                    return;
                }
            }
        }
    }
}

/// The words of a command, whose form must be right to the last character.
fn taken_apart(line: &str) -> Vec<&str> {
    assert!(line.len() + 2 <= 82, "{line}");
    let (content, sum) = line
        .strip_prefix('$')
        .and_then(|line| line.rsplit_once('*'))
        .unwrap_or_else(|| panic!("{line} is no sentence"));
    assert_eq!(format!("${content}*{sum}\r\n").into_bytes(), sentence(content));
    content.strip_prefix("PMRDC,").unwrap_or_else(|| panic!("{line}")).split(',').collect()
}

/// Serves an instrument to one client after the other, over TCP; its address.
pub fn over_tcp(idle: Vec<u8>, mut answering: Answering) -> String {
    let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port is free");
    let port = listener.local_addr().expect("it has one").port();
    thread::spawn(move || {
        for client in listener.incoming() {
            let mut client = client.expect("it connects");
            client.set_read_timeout(Some(IDLE)).expect("it is a time");
            speak(&mut client, &idle, &mut answering);
        }
    });
    format!("tcp:{port}")
}

/// Serves an instrument at a pseudo-terminal; the name of that. It is gone when the instrument hangs up.
#[cfg(target_os = "linux")]
pub fn at_terminal(idle: Vec<u8>, mut answering: Answering) -> String {
    use std::os::fd::AsRawFd as _;
    let (mut ours, theirs) = serial2::SerialPort::pair().expect("there are pseudo-terminals");
    ours.set_read_timeout(IDLE).expect("it is a time");
    ours.set_write_timeout(Duration::from_millis(500)).expect("it is a time");
    let name = std::fs::read_link(format!("/proc/self/fd/{}", theirs.as_raw_fd()));
    thread::spawn(move || {
        // It stays open, so that it is there before the program opens it, too.
        let _theirs = theirs;
        speak(&mut ours, &idle, &mut answering);
    });
    name.expect("it has a name").display().to_string()
}

/// An instrument with settings, as the contract has it.
#[derive(Clone, Debug, Default)]
pub struct Instrument {
    /// What it is.
    pub identity: Vec<[&'static str; 2]>,
    /// Settings in memory.
    pub memory: BTreeMap<String, String>,
    /// Settings in flash.
    pub flash: Option<BTreeMap<String, String>>,
    /// Settings, or commands, that it refuses, with the reason.
    pub refuses: BTreeMap<String, &'static str>,
    /// Values of two settings that are not possible together.
    pub excludes: Option<[[&'static str; 2]; 2]>,
    /// The commands that it has got.
    pub got: Vec<String>,
}

/// An instrument that a test looks into.
pub type Shared = Arc<Mutex<Instrument>>;

impl Instrument {
    /// On a stage, with some settings.
    pub fn new() -> Self {
        let settings = [
            ("latitude", "47.58"),
            ("dwell", "10"),
            ("link", "nmea"),
            ("gyro_scale", "-0.0125"),
            ("g_bias_x", "0.50"),
            ("holds", "true"),
        ];
        let memory = settings.map(|(name, value)| (name.to_owned(), value.to_owned()));
        Self {
            identity: vec![
                ["carrier", "stage"],
                ["serial", "0123456789ABCDEF01234567"],
                ["firmware", "0.1.0"],
            ],
            memory: BTreeMap::from(memory),
            ..Self::default()
        }
    }

    /// It, for a test that looks into it afterwards.
    pub fn shared(self) -> Shared {
        Arc::new(Mutex::new(self))
    }

    /// Names and values of all.
    fn all(&self) -> Vec<[String; 2]> {
        let identity = self.identity.iter().map(|pair| pair.map(str::to_owned));
        let settings = self.memory.iter().map(|(name, value)| [name.clone(), value.clone()]);
        identity.chain(settings).collect()
    }

    /// Whether a setting cannot have this value because of that of another.
    fn is_excluded(&self, name: &str, new: &str) -> bool {
        let has = |[other, value]: [&str; 2]| self.memory.get(other).is_some_and(|it| it == value);
        let Some([one, other]) = self.excludes else { return false };
        (one == [name, new] && has(other)) || (other == [name, new] && has(one))
    }

    /// What it answers.
    pub fn answer(&mut self, words: &[&str]) -> Vec<Say> {
        self.got.push(words.join(" "));
        let command = words[0];
        let refused = |why: &str| vec![say(format!("PMRDR,{command},refused,{why}"))];
        let value = |name: &str, value: &str| vec![say(format!("PMRDR,{command},{name},{value}"))];
        let done = || say(format!("PMRDR,{command},ok"));
        if let Some(why) = self.refuses.get(command) {
            return refused(why);
        }
        match words {
            ["get"] => {
                let all = self.all().into_iter();
                let all = all.map(|[name, value]| say(format!("PMRDR,get,{name},{value}")));
                all.chain([done()]).collect()
            }
            ["get", name] => match self.all().iter().find(|[other, _]| other == name) {
                Some([_, found]) => value(name, found),
                None => refused("no such setting"),
            },
            ["set", name, new] if self.is_excluded(name, new) => refused("not together"),
            ["set", name, new] => match (self.refuses.get(*name), self.memory.get_mut(*name)) {
                (Some(why), _) => refused(why),
                (_, None) => refused("no such setting"),
                (_, Some(there)) => {
                    (*new).clone_into(there);
                    value(name, new)
                }
            },
            ["save"] => {
                self.flash = Some(self.memory.clone());
                vec![done()]
            }
            ["log"] => {
                let parts = (0..3).map(|part| {
                    let bytes: Vec<u8> = (part * 20..(part + 1) * 20).collect();
                    say(format!("PMRDR,log,412,{part},{}", digits(&bytes)))
                });
                parts.chain([done()]).collect()
            }
            _ => vec![done()],
        }
    }
}

/// What a shared instrument answers.
pub fn answering(instrument: &Shared) -> Answering {
    let instrument = Arc::clone(instrument);
    Box::new(move |words| instrument.lock().expect("no test has panicked").answer(words))
}

/// Serves a shared instrument over TCP, among chatter; its address.
pub fn served(instrument: &Shared) -> String {
    over_tcp(chatter(), answering(instrument))
}
