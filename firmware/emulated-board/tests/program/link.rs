//! Clients of the link that are slow, that are too slow, that go, and that come after others.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::thread::{sleep, spawn};
use std::time::Duration;

use emulated_board::link::{Client, WAITING};
use firmware::platform::Platform;

use crate::images::path;
use crate::started::{Waiting, output, text};

/// Bytes that are sent at once.
const CHUNK: usize = 1024;
/// More of them than the buffers of the system take.
const CHUNKS: usize = 1 << 16;

/// A client, and its own end of the connection.
fn connected() -> (Client, TcpStream) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("there is a free port");
    let own = TcpStream::connect(listener.local_addr().expect("it has one")).expect("it listens");
    let (stream, _) = listener.accept().expect("it has connected");
    (Client::new(stream).expect("a connection"), own)
}

/// Bytes of which none is like that before or after it, and no chunk like the one before.
fn chunk(number: usize) -> Vec<u8> {
    (0..CHUNK).map(|place| ((number * CHUNK + place) % 251) as u8).collect()
}

/// Sends chunks until the connection takes no more of them; how many.
fn fill(client: &mut Client) -> usize {
    let full = (0..CHUNKS).find(|number| {
        client.exchange(&chunk(*number)).expect("the client is there");
        client.waits() > 0
    });
    full.expect("the buffers of the system end") + 1
}

#[test]
fn a_slow_client_gets_every_byte_in_order() {
    let (mut client, mut own) = connected();
    let filled = fill(&mut client);
    let more = filled + WAITING / CHUNK / 2;
    for number in filled..more {
        client.exchange(&chunk(number)).expect("so many may wait");
    }
    assert!(client.waits() > WAITING / 3, "{} bytes wait", client.waits());
    let reader = spawn(move || {
        let (mut all, mut some) = (Vec::new(), vec![0; 1 << 18]);
        while let Ok(count @ 1..) = own.read(&mut some) {
            all.extend_from_slice(&some[..count]);
            sleep(Duration::from_millis(2));
        }
        all
    });
    // Some of what waits goes with the next bytes, the rest at the end.
    client.exchange(&chunk(more)).expect("the client is there");
    client.finish().expect("it takes all");
    let expected: Vec<u8> = (0..=more).flat_map(chunk).collect();
    let taken = reader.join().expect("it reads to the end");
    assert_eq!(taken.len(), expected.len());
    assert!(taken == expected, "the bytes are others");
}

#[test]
fn a_client_that_takes_nothing_is_given_up_where_more_waits_than_may() {
    let (mut client, _own) = connected();
    // The buffers of the system may grow meanwhile.
    let mut errors =
        (fill(&mut client)..CHUNKS).filter_map(|number| client.exchange(&chunk(number)).err());
    let error = errors.next().expect("it is too slow");
    assert!(error.starts_with("the client is too slow: 6"), "{error}");
}

#[test]
fn a_client_that_has_gone_is_noticed() {
    let (mut client, own) = connected();
    drop(own);
    let noticed = (0..100).find_map(|_| {
        sleep(Duration::from_millis(1));
        client.exchange(b"measuring\n").err()
    });
    let error = noticed.expect("it has gone");
    assert!(error.starts_with("the client is gone: "), "{error}");
}

#[test]
fn what_a_client_sends_is_received_and_one_that_sends_no_more_still_hears() {
    let (mut client, mut own) = connected();
    own.write_all(b"command").expect("it is connected");
    own.shutdown(Shutdown::Write).expect("it is connected");
    let mut received = Vec::new();
    while received.len() < 7 {
        received.extend(client.exchange(b"").expect("the client is there"));
    }
    assert_eq!(received, b"command");
    for _ in 0..10 {
        assert_eq!(client.exchange(b"status\n"), Ok(Vec::new()));
    }
    client.finish().expect("it takes all");
    let mut heard = String::new();
    own.read_to_string(&mut heard).expect("text");
    assert_eq!(heard, "status\n".repeat(10));
}

#[test]
fn an_execution_goes_on_without_its_client_and_says_so_once() {
    let mut waiting = Waiting::new(Platform::Spin, &[]);
    drop(TcpStream::connect(&waiting.address).expect("it listens"));
    let (mut log, mut report) = (String::new(), String::new());
    waiting.log.read_to_string(&mut log).expect("text");
    let output = waiting.child.stdout.take();
    output.expect("it is piped").read_to_string(&mut report).expect("text");
    assert!(waiting.child.wait().expect("it ends").success(), "{log}");
    assert_eq!(log.matches("link: the client is gone: ").count(), 1, "{log}");
    assert_eq!(report.lines().count(), 1, "{report}");
}

/// Asks a board that waits for its latitude to do something, as a client of its own; the fields of the answer, and what the
/// board says of its state after it.
fn asked(waiting: &Waiting, line: &str) -> [String; 2] {
    let mut client = waiting.connect();
    // It has begun to hear.
    client.heard("$PMRDS,waiting,");
    client.send(line);
    [client.heard("$PMRDR,"), client.heard("$PMRDS,")]
}

#[test]
fn a_board_as_it_is_shipped_waits_and_is_set_up_by_one_client_after_the_other() {
    let waiting = Waiting::new(Platform::Stage, &["--as-shipped"]);
    let [answer, state] = asked(&waiting, "get latitude");
    assert!(answer.starts_with("$PMRDR,get,latitude,none*"), "{answer}");
    assert!(state.starts_with("$PMRDS,waiting,"), "{state}");
    for (asks, answers) in
        [("set latitude 47.58", "set,latitude,47.58"), ("save", "save,ok"), ("start", "start,ok")]
    {
        let [answer, state] = asked(&waiting, asks);
        assert!(answer.starts_with(&format!("$PMRDR,{answers}*")), "{answer}");
        let expected = if asks == "start" { "$PMRDS,aligning," } else { "$PMRDS,waiting," };
        assert!(state.starts_with(expected), "{asks}: {state}");
    }
}

#[test]
fn a_board_as_it_is_shipped_is_executed_with_a_link_alone() {
    let image = path(Platform::Stage).to_str().expect("a name in UTF-8");
    let said = text(&output(image, Platform::Stage, &["--as-shipped"]).stderr);
    assert!(said.contains("--link <tcp:PORT>"), "{said}");
}
