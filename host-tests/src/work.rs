//! Many pieces of work side by side, until all are done or no further one is wanted.

use rayon::prelude::*;

/// An observer of pieces of work, called from any thread, that may stop further ones.
pub trait Follower: Sync {
    /// A piece is done.
    fn done(&self);

    /// Whether further pieces are wanted.
    fn wants_more(&self) -> bool {
        true
    }
}

impl<F: Fn() + Sync> Follower for F {
    fn done(&self) {
        self();
    }
}

/// What came of the pieces, in their order: of all, or of the first ones where no further one was wanted. Pieces are
/// handed out in their order, and what is handed out is done.
pub fn side_by_side<P: Send, T: Send>(
    pieces: impl Iterator<Item = P> + Send,
    follower: &dyn Follower,
    of: impl Fn(P) -> T + Sync + Send,
) -> Vec<T> {
    let wanted = pieces.enumerate().take_while(|_| follower.wants_more());
    let results = wanted.par_bridge().map(|(place, piece)| (place, of(piece)));
    let mut results: Vec<_> = results.inspect(|_| follower.done()).collect();
    results.sort_unstable_by_key(|(place, _)| *place);
    results.into_iter().map(|(_, result)| result).collect()
}

/// What came of the pieces one after the other, each of which is work for itself: of all, or of those that were begun.
pub fn one_by_one<P, T>(
    pieces: impl IntoIterator<Item = P>,
    follower: &dyn Follower,
    of: impl FnMut(P) -> T,
) -> Vec<T> {
    pieces.into_iter().take_while(|_| follower.wants_more()).map(of).collect()
}
