//! An alignment that may be begun anew: what it found before is kept until it finds something again.

use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::alignment::{Input, Listener, Method, Request, Verdict};
use orientation::units::Radians;

use crate::methods::{Course, is_answered};
use crate::report::Stretch;

/// A session, and what it was when it found an azimuth before it was begun anew.
pub(super) struct Latest<M> {
    session: M,
    before: Option<Box<M>>,
    /// What alignments did before that one.
    earlier: Vec<Stretch>,
}

impl<M> Latest<M> {
    /// A session that has found nothing yet.
    pub(super) fn of(session: M) -> Self {
        Self { session, before: None, earlier: Vec::new() }
    }

    /// The session where it is over; else what it was when it found an azimuth, where it had. Of a run that breaks off
    /// before, it is concluded with what it has been given; the second tells whether it was.
    pub(super) fn into_session<S>(mut self, breaks_off: bool) -> (M, bool)
    where
        M: Method<S>,
    {
        let is_over = self.session.verdict().is_some();
        match self.before {
            Some(before) if !is_over => (*before, false),
            None if !is_over && breaks_off => {
                let mut request = self.session.take(Input::End, &mut |_| ());
                while request == Request::Compute {
                    request = self.session.compute(&mut |_| ());
                }
                (self.session, true)
            }
            _ => (self.session, false),
        }
    }
}

impl<M: Course> Latest<M> {
    /// What alignments did that found an azimuth before the one that stands at the end.
    pub(super) fn earlier<S>(&self) -> Vec<Stretch>
    where
        M: Method<S>,
    {
        let is_over = self.session.verdict().is_some();
        let before = self.before.iter().filter(|_| is_over);
        self.earlier.iter().cloned().chain(before.flat_map(|before| before.stretches())).collect()
    }
}

impl<S, M: Method<S> + Course + Clone> Method<S> for Latest<M> {
    fn begin(&mut self, listener: Listener) -> Request {
        if is_answered(&self.session) {
            let before = self.before.replace(Box::new(self.session.clone()));
            self.earlier.extend(before.iter().flat_map(|before| before.stretches()));
        }
        self.session.begin(listener)
    }

    fn take(&mut self, input: Input<'_, S>, listener: Listener) -> Request {
        self.session.take(input, listener)
    }

    fn compute(&mut self, listener: Listener) -> Request {
        self.session.compute(listener)
    }

    fn verdict(&self) -> Option<Verdict> {
        self.session.verdict()
    }

    fn required_sigma(&self) -> Option<Radians> {
        self.session.required_sigma()
    }

    fn misalignment(&self, speed: usize) -> Option<AxisMisalignment> {
        self.session.misalignment(speed)
    }
}
