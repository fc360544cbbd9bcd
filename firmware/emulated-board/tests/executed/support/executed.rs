//! Executions of images, each made once.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use emulated_board::image::Image;
use emulated_board::probe::Line;
use emulated_board::run::{Order, execute};
use emulated_board::world::World;
use execution::report::Report;
use firmware::platform::Platform;

use super::images::{found, image, read};

/// A line of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Time as the image states it, s from the start of its clock.
    pub seconds: f64,
    /// Words.
    pub words: String,
}

impl Entry {
    /// A line as the probe decodes it.
    pub fn of(line: &Line) -> Self {
        Self {
            seconds: line.time.parse().expect("a line begins with its time"),
            words: line.words.clone(),
        }
    }
}

/// What an execution showed.
#[derive(Clone, Debug)]
pub struct Executed {
    /// What it measured.
    pub report: Report,
    /// Lines of the log.
    pub log: Vec<Entry>,
    /// Lines of the link.
    pub link: Vec<String>,
    /// All bytes of the link.
    pub bytes: Vec<u8>,
}

impl Executed {
    /// Lines of the log that contain these words.
    pub fn lines(&self, words: &str) -> impl Iterator<Item = &Entry> {
        self.log.iter().filter(move |entry| entry.words.contains(words))
    }

    /// The first line of the log that contains these words.
    #[track_caller]
    pub fn line(&self, words: &str) -> &Entry {
        self.lines(words)
            .next()
            .unwrap_or_else(|| panic!("no line of the log contains {words:?}:\n{}", self.text()))
    }

    /// The log as text.
    pub fn text(&self) -> String {
        let lines =
            self.log.iter().map(|Entry { seconds, words }| format!("{seconds:10.3} {words}"));
        lines.collect::<Vec<_>>().join("\n")
    }
}

/// The order's image in a world.
pub fn execute_in(order: &Order, world: World) -> Executed {
    execute_spoken_to(order, world, &[])
}

/// The order's image in a world whose other side of the link sends these bytes every millisecond.
pub fn execute_spoken_to(order: &Order, world: World, bytes: &[u8]) -> Executed {
    execute_told(order, world, || bytes.to_vec())
}

/// The order's image in a world whose other side of the link sends what it is given every millisecond.
pub fn execute_told(order: &Order, world: World, told: impl FnMut() -> Vec<u8>) -> Executed {
    execute_image(&image(order.carrier), order, world, told)
}

/// An image in a world whose other side of the link sends what it is given every millisecond.
pub fn execute_image(
    image: &Rc<Image>,
    order: &Order,
    world: World,
    mut told: impl FnMut() -> Vec<u8>,
) -> Executed {
    let (mut log, mut bytes) = (Vec::new(), Vec::new());
    let on_link = |sent: &[u8]| {
        bytes.extend_from_slice(sent);
        told()
    };
    let report = execute(image, order, world, |line| log.push(Entry::of(line)), on_link);
    let report = report.unwrap_or_else(|error| panic!("the image of {}: {error}", order.carrier));
    // Messages are no text.
    let text = String::from_utf8_lossy(&bytes);
    // The end may come amid a line.
    let whole = text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
    let link = whole.map(|line| line.trim_end().to_owned()).collect();
    Executed { report, log, link, bytes }
}

/// The order's image in its usual world, without looking whether it was executed before.
pub fn execute_anew(order: &Order) -> Executed {
    execute_in(order, World::new(order.carrier, order.seed).expect("the usual world can be made"))
}

/// An execution that is made at most once.
type Slot = Arc<OnceLock<Arc<Executed>>>;

/// An execution by its name; one that was made before is not made again.
pub fn once(name: String, make: impl FnOnce() -> Executed) -> Arc<Executed> {
    static ALL: Mutex<Option<HashMap<String, Slot>>> = Mutex::new(None);
    let slot = {
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(all.get_or_insert_default().entry(name).or_default())
    };
    Arc::clone(slot.get_or_init(|| Arc::new(make())))
}

/// The order's image in its usual world.
pub fn executed_by(order: &Order) -> Arc<Executed> {
    once(format!("{order:?}"), || execute_anew(order))
}

/// The usual execution of a carrier by the seed of its world.
pub fn executed(carrier: Platform, seed: u64) -> Arc<Executed> {
    executed_by(&Order::usual(carrier, seed))
}

/// The feature of an image with 2 400 samples a second.
const FAST: &str = "sps2400";

/// A carrier's image with 2 400 samples a second.
pub fn fast_image(carrier: Platform) -> Rc<Image> {
    read(&found(carrier, Some(FAST)), carrier)
}

/// The usual execution of a carrier's image with 2 400 samples a second.
pub fn sampled_fast(carrier: Platform) -> Arc<Executed> {
    once(format!("{carrier} {FAST}"), || {
        let image = fast_image(carrier);
        let world = World::new(carrier, 1).expect("the usual world can be made");
        execute_image(&image, &Order::usual(carrier, 1), world, Vec::new)
    })
}
