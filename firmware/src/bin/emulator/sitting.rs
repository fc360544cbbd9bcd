//! The session of a run: one place in memory for either kind.

use embedded_io_async::Write;
use firmware::configuration::{Configuration, TurntableConfiguration};
use firmware::ports::{Actuator, Observer, Ports, Recorder};
use firmware::run::{run, run_rotating};
use firmware::shared::Seams;
use orientation::align::rotating::Setting;
use orientation::align::rotating::turn::Stretch;
use orientation::session::{Prepared, Session, rotating};
use static_cell::StaticCell;

use crate::results;

/// The greatest piece of memory.
static PLACE: StaticCell<Sitting> = StaticCell::new();

/// A session of either kind.
#[expect(clippy::large_enum_variant, reason = "there is one, and it stays where it is")]
pub enum Sitting {
    /// In positions.
    Stepwise(Session),
    /// On a platform that turns all the time.
    Turning(rotating::Session),
}

impl Sitting {
    /// A session in positions. Not inlined: what it is made of on the stack is not to stay there.
    #[inline(never)]
    pub fn stepwise(prepared: Prepared) -> &'static mut Self {
        PLACE.init_with(|| Self::Stepwise(Session::from(prepared)))
    }

    /// A session on a turning platform, whose procedure was checked.
    #[inline(never)]
    pub fn turning(setting: &Setting, procedure: rotating::Procedure) -> &'static mut Self {
        PLACE.init_with(|| Self::Turning(rotating::Session::of(*setting, procedure)))
    }

    /// Runs the instrument to the session's conclusion.
    pub async fn run<M, L, R, O>(
        &mut self,
        outputs: &mut Ports<M, L, R>,
        configuration: &Configuration,
        seams: &Seams<'_, O>,
    ) where
        M: Actuator,
        L: Write,
        R: Recorder,
        O: Observer,
    {
        match self {
            Self::Stepwise(session) => run(outputs, configuration, session, seams).await,
            Self::Turning(session) => {
                run_rotating(outputs, &TurntableConfiguration::default(), session, seams).await
            }
        };
    }

    /// Logs what was found; `None` where nothing was.
    pub fn log(&self, seed: u64) -> Option<()> {
        match self {
            Self::Stepwise(session) => {
                session.dwells().iter().zip(1..).for_each(|(dwell, number)| {
                    results::dwell(number, dwell);
                });
                results::outcome(seed, &session.conclusion()?.verdict);
            }
            Self::Turning(session) => {
                let stretches = session.follower().stretches().iter();
                stretches.flat_map(Stretch::turns).zip(1..).for_each(|(turn, number)| {
                    results::turn(number, turn);
                });
                results::outcome(seed, &session.conclusion()?.verdict);
            }
        }
        Some(())
    }
}
