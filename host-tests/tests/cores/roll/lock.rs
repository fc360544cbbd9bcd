//! What the lock reaches, and whether its σ tells it: against the Cramér–Rao bound.

use super::world::{Body, assert_followed, follow, worst};

#[test]
fn without_noise_the_roll_is_good_to_a_five_hundredth_of_a_degree() {
    let known = follow(&Body { noise: 0.0, seconds: 3.0, ..Body::default() }, |_, _| true);
    let after = known.iter().filter(|known| known.time >= 0.2);
    let worst = after.map(|known| known.error.abs()).fold(0.0, f64::max);
    assert!(worst < 0.002_f64.to_radians(), "{}°", worst.to_degrees());
    assert!(known[10_000..].iter().all(|known| known.scale[0].abs() < 1e-7));
}

#[test]
fn fast_and_slow_spins_are_followed() {
    let fast = Body { turns: |time| 250.0 * time, rate: |_| 250.0, ..Body::default() };
    let slow = Body { turns: |time| 12.0 * time, rate: |_| 12.0, seconds: 3.0, ..Body::default() };
    for body in [fast, slow] {
        assert_followed(&follow(&body, |_, _| true));
    }
}

#[test]
fn its_sigma_is_that_of_its_errors_and_near_the_bound() {
    // Two forces, each of 1σ s, tell a phase to s/(q√n) and, with a rate that is not known, to twice that at the end:
    // the bound of a line's end over n samples.
    let (noise, lift) = (2.0, 20.0);
    for (time, most) in [(0.1, 1.8), (0.3, 1.5), (1.0, 1.3)] {
        let (mut squares, mut stated) = (0.0, 0.0);
        let runs = 200;
        for seed in 0..runs {
            let body = Body { noise, seconds: time, seed, ..Body::default() };
            let known = follow(&body, |_, _| true);
            let last = known.last().expect("samples");
            squares += last.in_sigmas() * last.in_sigmas() / runs as f64;
            stated += last.sigma.expect("a sigma") / runs as f64;
        }
        let coverage = squares.sqrt();
        let bound = 2.0 * noise / (lift * (time / 1e-4).sqrt());
        assert!((0.8..1.2).contains(&coverage), "{time} s: errors of {coverage} σ");
        assert!((0.9..most).contains(&(stated / bound)), "{time} s: {} bounds", stated / bound);
    }
}

#[test]
fn noise_leaves_it_within_four_sigma() {
    for seed in 0..20 {
        let known = follow(&Body { noise: 2.0, seed, ..Body::default() }, |_, _| true);
        assert!(worst(&known, 0.1) < 4.5, "{} σ", worst(&known, 0.1));
    }
}
