//! A campaign that ends early: its tables rest on the runs that were done, and show nothing else.

use std::sync::atomic::{AtomicUsize, Ordering};

use host::campaign::{Asked, CAMPAIGNS};
use host::report::{Look, Verbosity};
use host::work::{Follower, side_by_side};
use simulated::fault::Platform;

/// Wants no further run after some.
struct Few {
    done: AtomicUsize,
    most: usize,
}

impl Few {
    fn of(most: usize) -> Self {
        Self { done: AtomicUsize::new(0), most }
    }
}

impl Follower for Few {
    fn done(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn wants_more(&self) -> bool {
        self.done.load(Ordering::Relaxed) < self.most
    }
}

#[test]
fn whatever_campaign_ends_early_shows_no_row_without_a_run_and_no_number_that_is_none() {
    for campaign in &CAMPAIGNS {
        let platform = (campaign.name == "faults").then_some(Platform::Spin);
        let asked = Asked { runs: 40, platform, class: None };
        for most in [0, 1, 3] {
            let few = Few::of(most);
            let done = (campaign.run)(&asked, &few).expect("it runs");
            let text = done.report.text(Look::plain(Verbosity::Verbose));
            for none in ["NaN", "inf", "-0.0 ", "-0.00 "] {
                assert!(!text.contains(none), "{} after {most}: {none} in {text}", campaign.name);
            }
            // What other threads had begun is done, too.
            let rows = few.done.load(Ordering::Relaxed);
            assert!(rows <= most + rayon::current_num_threads(), "{}", campaign.name);
        }
    }
}

#[test]
fn what_is_done_side_by_side_comes_in_the_order_of_its_pieces_and_without_a_gap() {
    for most in [0, 1, 7, 100, 1000] {
        let few = Few::of(most);
        let found = side_by_side(0..500, &few, |piece: usize| piece * piece);
        assert!(found.len() >= most.min(500), "{most}");
        assert!(found.iter().enumerate().all(|(place, square)| *square == place * place));
    }
}
