//! An alignment that may be begun anew: what it found before is kept until it finds something again.

use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::alignment::{Input, Listener, Method, Request, Verdict};

use crate::methods::is_answered;

/// A session, and what it was when it found an azimuth before it was begun anew.
pub(super) struct Latest<M> {
    session: M,
    before: Option<Box<M>>,
}

impl<M> Latest<M> {
    /// A session that has found nothing yet.
    pub(super) fn of(session: M) -> Self {
        Self { session, before: None }
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

impl<S, M: Method<S> + Clone> Method<S> for Latest<M> {
    fn begin(&mut self, listener: Listener) -> Request {
        if is_answered(&self.session) {
            self.before = Some(Box::new(self.session.clone()));
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

    fn misalignment(&self, speed: usize) -> Option<AxisMisalignment> {
        self.session.misalignment(speed)
    }
}
