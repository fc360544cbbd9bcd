//! Executes an image of a board and prints what it showed as a line of JSON; the log goes to standard error.
//!
//! `meridian emulate --board CARRIER` builds and starts this program: it links Unicorn, whose licence is the GPL-2.0,
//! and nothing links it.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::ExitCode;
use std::rc::Rc;

use clap::Parser;
use emulated_board::image::Image;
use emulated_board::probe::Line;
use emulated_board::report::Report;
use emulated_board::run::{Order, execute};
use emulated_board::world::World;
use firmware::platform::Platform;

/// Executes an image of a board behind a model of its microcontroller, with simulated chips on its pins.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// The ELF file of the image.
    image: PathBuf,
    /// The carrier that the image was built for: stage, two-frame, turntable, vehicle or spin.
    #[arg(long, value_parser = platform)]
    carrier: Platform,
    /// Seed of the simulated world.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Cycles of the core for an instruction, wait states of the flash included.
    #[arg(long, default_value_t = 1.4)]
    cycles: f64,
    /// How long it goes on after its result, s.
    #[arg(long)]
    afterwards: Option<f64>,
    /// The link as a byte stream for a client, which is waited for.
    #[arg(long, value_name = "tcp:PORT")]
    link: Option<String>,
    /// The board's crystal does not oscillate.
    #[arg(long)]
    dead_crystal: bool,
}

/// A carrier by its name.
fn platform(name: &str) -> Result<Platform, String> {
    let found = Platform::ALL.iter().find(|platform| platform.name() == name);
    found.copied().ok_or_else(|| format!("no carrier {name:?}"))
}

fn main() -> ExitCode {
    match run(&Arguments::parse())
        .and_then(|report| serde_json::to_string(&report).map_err(|e| e.to_string()))
    {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Executes what the arguments say.
fn run(arguments: &Arguments) -> Result<Report, String> {
    if !(0.5..=20.0).contains(&arguments.cycles) {
        return Err(format!("--cycles {}: 0.5 to 20 cycles for an instruction", arguments.cycles));
    }
    let image = Rc::new(Image::read(&arguments.image)?);
    let usual = Order::usual(arguments.carrier, arguments.seed);
    let order = Order {
        cycles: arguments.cycles,
        afterwards: arguments.afterwards.unwrap_or(usual.afterwards),
        has_crystal: !arguments.dead_crystal,
        ..usual
    };
    let mut client = arguments.link.as_deref().map(client).transpose()?;
    let on_line = |line: &Line| {
        eprintln!("{:>12} {:<5} {}", line.time, line.level.unwrap_or("-"), line.words);
    };
    let world = World::new(order.carrier, order.seed)?;
    let report = execute(&image, &order, world, on_line, |sent| exchange(client.as_mut(), sent))?;
    let file = arguments.image.display();
    match report.outcome.as_str() {
        "" => Err(format!(
            "{file}: its log says nothing: is it the image of a board, for this carrier?"
        )),
        refused if refused.starts_with("board: no settings") => Err(format!("{file}: {refused}")),
        _ => Ok(report),
    }
}

/// The client of the link, who is waited for.
fn client(address: &str) -> Result<TcpStream, String> {
    let port = address.strip_prefix("tcp:").and_then(|port| port.parse().ok());
    let port: u16 =
        port.ok_or_else(|| format!("--link {address}: tcp: and a port are meant, as in tcp:5000"))?;
    let failed = |error: std::io::Error| format!("--link {address}: {error}");
    let listener = TcpListener::bind(("127.0.0.1", port)).map_err(failed)?;
    eprintln!("waiting for a client at {}", listener.local_addr().map_err(failed)?);
    let (stream, _) = listener.accept().map_err(failed)?;
    stream.set_nonblocking(true).map_err(failed)?;
    Ok(stream)
}

/// Hands bytes of the link to the client, and takes what it sends. A client that is gone hears nothing.
fn exchange(client: Option<&mut TcpStream>, sent: &[u8]) -> Vec<u8> {
    let Some(client) = client else { return Vec::new() };
    let _ = client.write_all(sent);
    let mut received = [0; 256];
    let count = client.read(&mut received).unwrap_or(0);
    received[..count].to_vec()
}
