//! Executes an image of a board and prints what it showed as a line of JSON; the log goes to standard error.
//!
//! `meridian emulate --board CARRIER` builds and starts this program: it links Unicorn, whose licence is the GPL-2.0,
//! and nothing links it.

use std::path::PathBuf;
use std::process::{self, ExitCode};
use std::rc::Rc;
use std::time::Duration;
use std::{io, thread};

use clap::Parser;
use emulated_board::controller::rcc::Oscillators;
use emulated_board::image::Image;
use emulated_board::link::Clients;
use emulated_board::pace::Pace;
use emulated_board::probe::Line;
use emulated_board::run::{LOOK, Order, execute};
use emulated_board::world::World;
use execution::options::{afterwards, carrier, cycles, port};
use execution::report::Report;
use firmware::platform::Platform;

/// Executes an image of a board behind a model of its microcontroller, with simulated chips on its pins.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// The ELF file of the image.
    image: PathBuf,
    /// The carrier that the image was built for: stage, two-frame, turntable, vehicle or spin.
    #[arg(long, value_parser = carrier)]
    carrier: Platform,
    /// Seed of the simulated world.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Cycles of the core for an instruction, wait states of the flash included.
    #[arg(long, default_value_t = 1.4, allow_hyphen_values = true, value_parser = cycles)]
    cycles: f64,
    /// How long it goes on after its result, s.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = afterwards)]
    afterwards: Option<f64>,
    /// The link as a byte stream for one client after the other; the first is waited for.
    #[arg(long, value_name = "tcp:PORT", value_parser = port)]
    link: Option<u16>,
    /// The flash has nothing but the image: the board is set up over its link. It waits for no client, and its time goes no
    /// faster than theirs; it ends after an hour without a result, and an hour after its first one unless that is stated.
    #[arg(long, requires = "link")]
    as_shipped: bool,
    /// The board's crystal does not oscillate.
    #[arg(long)]
    dead_crystal: bool,
    /// Ends when standard input ends, as with a program that keeps it open for as long as it lives.
    #[arg(long)]
    while_stdin: bool,
}

/// Time that a start with a dead crystal waits for it longer than one with a sound crystal, s.
const DEAD_CRYSTAL: f64 = 0.5;

/// Time that a board has until its result which is to be set up first, and after it, s.
const SETTING_UP: f64 = 3600.0;

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
    if arguments.while_stdin {
        end_with_stdin();
    }
    let file = arguments.image.display();
    let named = |error: String| format!("{file}: {error}");
    let image = Rc::new(Image::read(&arguments.image)?);
    execution::carrier::require(&image.elf, arguments.carrier).map_err(named)?;
    let order = order(arguments);
    let clients = arguments.link.map(|port| Clients::at(port, !arguments.as_shipped));
    let mut clients = clients.transpose()?;
    let on_line = |line: &Line| {
        eprintln!("{:>12} {:<5} {}", line.time, line.level.unwrap_or("-"), line.words);
    };
    let mut pace = arguments.as_shipped.then(Pace::begin);
    let on_link = |sent: &[u8]| {
        if let Some(pace) = &mut pace {
            pace.keep(Duration::from_nanos(LOOK.as_nanoseconds()));
        }
        clients.as_mut().map_or_else(Vec::new, |clients| clients.exchange(sent))
    };
    let world = World::new(order.carrier, order.seed)?;
    let world = if arguments.as_shipped { world.with_store(Vec::new()) } else { world };
    let report = execute(&image, &order, world, on_line, on_link).map_err(named)?;
    if let Some(clients) = clients {
        clients.finish();
    }
    match report.outcome.as_str() {
        "" => Err(named("its log says nothing: is it the image of a board?".to_owned())),
        refused if refused.starts_with("no settings") => Err(named(refused.to_owned())),
        _ => Ok(report),
    }
}

/// What is executed.
fn order(arguments: &Arguments) -> Order {
    let usual = Order::usual(arguments.carrier, arguments.seed);
    let (longest, afterwards) = if arguments.as_shipped {
        (SETTING_UP, SETTING_UP)
    } else {
        (usual.longest, usual.afterwards)
    };
    Order {
        cycles: arguments.cycles,
        afterwards: arguments.afterwards.unwrap_or(afterwards),
        longest: longest + if arguments.dead_crystal { DEAD_CRYSTAL } else { 0.0 },
        oscillators: Oscillators { has_crystal: !arguments.dead_crystal, ..usual.oscillators },
        ..usual
    }
}

/// Ends this program when standard input ends, whatever it does meanwhile.
fn end_with_stdin() {
    thread::spawn(|| {
        // What is read there has no meaning, and an error is an end.
        let _ = io::copy(&mut io::stdin(), &mut io::sink());
        process::exit(1);
    });
}
