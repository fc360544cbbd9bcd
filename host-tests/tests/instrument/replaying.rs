//! What a board did follows again from what came in, keeping included: the two pure halves, driven by one list
//! of inputs in their order, do it once more without a board.

use std::cell::RefCell;

use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::{Observer, Recorder};
use host::instrument::{Carrier, Run, Trial};
use orientation::alignment::{Method, Request, Verdict, rotating, stepwise, stops};
use orientation::attitude::{self, Keeper, Report};
use orientation::navigation::{self, Aligner, Navigator, Order, Output, Policy, aligner};
use orientation::signal::Timed;
use simulated::hold::Hold;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;

/// Something that came to the halves of an instrument.
enum Input<S> {
    Sample(S),
    Aligner(aligner::Input),
    Navigator(navigation::Input),
}

/// All that came, in its order.
struct Journal<S>(RefCell<Vec<Input<S>>>);

impl<S> Observer for Journal<S> {
    fn event(&self, _: Instant, _: &Event) {}

    fn aligns(&self, input: &aligner::Input) {
        self.0.borrow_mut().push(Input::Aligner(*input));
    }

    fn navigates(&self, input: &navigation::Input) {
        self.0.borrow_mut().push(Input::Navigator(*input));
    }
}

impl<S: Copy> Recorder<S> for &Journal<S> {
    async fn record(&mut self, sample: &S) {
        self.0.borrow_mut().push(Input::Sample(*sample));
    }
}

/// What a board did, or what followed from its inputs.
#[derive(Debug, PartialEq)]
struct Done {
    verdict: Option<Verdict>,
    reports: Vec<Report>,
    /// How often an alignment was begun anew, or skipped.
    orders: usize,
}

/// Drives both halves by a list of inputs.
fn replayed<S: Timed>(
    method: &mut dyn Method<S>,
    (setting, policy): (&attitude::Setting, &Policy),
    inputs: &[Input<S>],
) -> Done {
    let (mut keeper, mut reports, mut given) = (Keeper::new(setting), Vec::new(), Vec::new());
    let mut navigator = Navigator::new(&mut keeper, policy);
    let mut aligner = Aligner::new(method);
    let mut request = aligner.begin(&mut |_| ());
    let mut orders = 0;
    for input in inputs {
        while request == Request::Compute {
            request = aligner.compute(&mut |_| ());
        }
        match input {
            Input::Sample(sample) => request = aligner.sample(sample, &mut |_| ()),
            Input::Aligner(input) => {
                if let aligner::Input::Ordered(order @ (Order::Restart | Order::Skip)) = input {
                    assert!(given.contains(order), "{order:?} is none of the navigator");
                    orders += 1;
                }
                request = aligner.take(input, &mut |_| ());
            }
            Input::Navigator(input) => {
                if let navigation::Input::Found(at, azimuth) = input {
                    assert_eq!(aligner.hand_over(), Some((*at, *azimuth)));
                }
                navigator.take(input, &mut |output| match output {
                    Output::Report(report, _) => reports.push(report),
                    Output::Order(order) => given.push(order),
                    _ => {}
                });
            }
        }
    }
    Done { verdict: aligner.method().verdict(), reports, orders }
}

/// Runs a board and drives its halves again by what came in; with what the board did.
fn both<C: Carrier<Run = Run<R, T>>, R, T, M: Method<C::Sample>>(
    carrier: &C,
    mut method: M,
    (setting, policy): (attitude::Setting, Policy),
    verdict: impl Fn(&R) -> Option<Verdict>,
) -> [Done; 2]
where
    C::Sample: Timed + Copy,
{
    let journal = Journal(RefCell::new(Vec::new()));
    let run = Trial::of(carrier).record(&journal).watch(&journal).run();
    let run = run.expect("the scenario is possible");
    let inputs = journal.0.into_inner();
    let is_order = |input: &&Input<C::Sample>| {
        matches!(input, Input::Aligner(aligner::Input::Ordered(Order::Restart | Order::Skip)))
    };
    let orders = inputs.iter().filter(is_order).count();
    let done = Done { verdict: verdict(&run.replay), reports: run.reports, orders };
    [done, replayed(&mut method, (&setting, &policy), &inputs)]
}

/// How the runs go on: aligning anew, and with an azimuth from outside.
fn holds(seconds: f64) -> [Hold; 2] {
    let usual = Hold { realigns: true, drive_s: 100.0, ..Hold::of(seconds) };
    [usual, Hold { handover: Some(([213.6, 0.1], 20.0)), ..usual }]
}

fn base(hold: Hold) -> Scenario {
    let usual = Scenario::usual(2);
    Scenario { hold, has_base_imu: true, sample_rate_hz: 100.0, positions: 8, ..usual }
}

fn assert_alike([done, again]: [Done; 2]) {
    assert!(done.reports.len() > 300 && done.orders > 0, "{} orders", done.orders);
    assert!(done.reports.iter().any(|report| report.azimuth.is_some()));
    assert_eq!(done, again);
}

#[test]
fn a_stage_and_two_frames_do_again_what_came_of_their_inputs() {
    for hold in holds(500.0) {
        let scenario = base(hold);
        let setting = scenario.setting().expect("a latitude");
        let method = stepwise::Session::new(setting, scenario.procedure()).expect("a procedure");
        let keeping = (scenario.keeper().expect("a latitude"), scenario.policy());
        assert_alike(both(&scenario, method, keeping, |it| it.session.verdict()));
        let frames = FramesScenario { base: scenario, passes: 2, ..FramesScenario::default() };
        let setting = frames.setting().expect("a latitude");
        let method = stepwise::Session::new(setting, frames.procedure()).expect("a procedure");
        let keeping = (frames.keeper().expect("a latitude"), keeping.1);
        assert_alike(both(&frames, method, keeping, |it| it.session.verdict()));
    }
}

#[test]
fn a_turntable_does_again_what_came_of_its_inputs() {
    for hold in holds(500.0) {
        let usual = TurntableScenario::brief(2);
        let scenario = TurntableScenario { base: base(hold), turns: 4, ..usual };
        let setting = scenario.setting().expect("a latitude");
        let method = rotating::Session::new(setting, scenario.procedure()).expect("a procedure");
        let base = scenario.base;
        let keeping = (base.keeper().expect("a latitude"), base.policy());
        assert_alike(both(&scenario, method, keeping, Method::verdict));
    }
}

#[test]
fn a_vehicle_does_again_what_came_of_its_inputs() {
    for hold in holds(900.0) {
        let usual = VehicleScenario::usual(2);
        let scenario = VehicleScenario { base: Scenario { hold, ..usual.base }, ..usual };
        let setting = scenario.setting().expect("a latitude");
        let method = stops::Session::new(setting, scenario.procedure()).expect("a procedure");
        let keeping = (scenario.keeper().expect("a latitude"), scenario.policy());
        assert_alike(both(&scenario, method, keeping, Method::verdict));
    }
}
