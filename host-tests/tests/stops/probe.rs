#![allow(warnings)]
use crate::world::*;
use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::*;
use rayon::prelude::*;

pub fn hunt(
    name: &str,
    n: u64,
    make: impl Fn(u64) -> Day + Sync,
    change: impl Fn(u64, &mut VehicleSample) -> bool + Sync,
) {
    let all: Vec<_> =
        (0..n).into_par_iter().map(|seed| make(seed).run_through(|s| change(seed, s))).collect();
    let mut told = vec![];
    let mut wrong = 0;
    for o in &all {
        match &o.conclusion.verdict {
            Ok(_) => {
                let [a, b] = o.ratios();
                if a.abs().max(b.abs()) > 5.0 {
                    wrong += 1;
                }
                let f = o.found();
                told.push(format!("OK {a:.1}/{b:.1}σ err {:.2}° σ {:.2}° lo {:?} t{} u{} chi {:.1} ratio {:.3}±{:.3} n{}", o.errors()[1].to_degrees(), f.azimuth.sigma.to_degrees(), f.left_out, f.turning, f.unsteady, f.chi_square[0]/f.chi_square[1], f.plain.ratio, f.plain.ratio_sigma, o.stops.len()))
            }
            Err(r) => told.push(format!("{r:?}")),
        }
    }
    println!("## {name}: WRONG {wrong} of {n}");
    for t in told {
        println!("     {t}");
    }
}

fn two(seed: u64) -> Day {
    Day::new(Scenario::stops(seed, 2, 60.0, 600.0), seed)
}
fn three(seed: u64) -> Day {
    Day::new(Scenario::stops(seed, 3, 60.0, 300.0), seed)
}
/// quiet gyro, so wrong shows
fn quiet(mut d: Day) -> Day {
    for g in &mut d.scenario.vehicle.gyros {
        g.bias_sigma_deg_h = 0.01;
        g.n_deg_sqrt_h = 0.002;
    }
    let s = known(d.scenario.vehicle.latitude_deg, 0.002, Some(0.01));
    d.setting = s;
    d
}

#[test]
fn probe() {
    let f = std::env::var("HUNT").unwrap_or_default();
    let n = 4;
    for (kind, base) in [
        ("fog two", Box::new(two) as Box<dyn Fn(u64) -> Day + Sync>),
        ("quiet two", Box::new(|s| quiet(two(s)))),
        ("fog three", Box::new(three)),
        ("quiet three", Box::new(|s| quiet(three(s)))),
    ] {
        hunt(&format!("{kind} healthy"), n, &base, |_, _| true);
        for axis in 0..3 {
            hunt(&format!("{kind} sign of gyro {axis}"), n, &base, |_, s| {
                s.turned_rad[axis] *= -1.0;
                true
            });
            hunt(&format!("{kind} zero gyro {axis}"), n, &base, |_, s| {
                s.turned_rad[axis] = 0.0;
                true
            });
            hunt(&format!("{kind} swap gyros {axis} {}", (axis + 1) % 3), n, &base, |_, s| {
                s.turned_rad.swap(axis, (axis + 1) % 3);
                true
            });
            hunt(
                &format!("{kind} swap accelerometers {axis} {}", (axis + 1) % 3),
                n,
                &base,
                |_, s| {
                    s.force_m_s2.swap(axis, (axis + 1) % 3);
                    true
                },
            );
            hunt(&format!("{kind} sign of accelerometer {axis}"), n, &base, |_, s| {
                s.force_m_s2[axis] *= -1.0;
                true
            });
            hunt(&format!("{kind} scale 1% of gyro {axis}"), n, &base, |_, s| {
                s.turned_rad[axis] *= 1.01;
                true
            });
            hunt(&format!("{kind} accel bias 0.05 {axis}"), n, &base, |_, s| {
                s.force_m_s2[axis] += 0.05;
                true
            });
        }
        hunt(&format!("{kind} zero gyros"), n, &base, |_, s| {
            s.turned_rad = [0.0; 3];
            true
        });
        hunt(&format!("{kind} signs of y and z (axes z up)"), n, &base, |_, s| {
            for i in [1, 2] {
                s.turned_rad[i] *= -1.0;
            }
            true
        });
        hunt(&format!("{kind} signs of all gyros"), n, &base, |_, s| {
            for i in 0..3 {
                s.turned_rad[i] *= -1.0;
            }
            true
        });
        for wrong in [10.0, -10.0, 2.0, -104.0] {
            hunt(
                &format!("{kind} latitude off by {wrong}"),
                n,
                |s| {
                    let mut d = base(s);
                    let l = d.scenario.vehicle.latitude_deg + wrong;
                    let k = known(l, 0.0, None);
                    d.setting.common.latitude = k.common.latitude;
                    d
                },
                |_, _| true,
            );
        }
        hunt(
            &format!("{kind} wrong displacement 5 km"),
            n,
            |s| Day { told: Told::Wrong([3000.0, -4000.0]), ..base(s) },
            |_, _| true,
        );
        hunt(
            &format!("{kind} level change at stop 2 by boarding"),
            n,
            |s| {
                let mut d = base(s);
                let at = d.scenario.configuration().stops().nth(1).unwrap()[0] + 30.0;
                d.scenario.events.push(Event::Boarding {
                    at_s: at,
                    seconds: 2.0,
                    pitch_deg: 0.5,
                    roll_deg: 1.0,
                });
                d
            },
            |_, _| true,
        );
        hunt(
            &format!("{kind} small level change at stop 2"),
            n,
            |s| {
                let mut d = base(s);
                let at = d.scenario.configuration().stops().nth(1).unwrap()[0] + 30.0;
                d.scenario.events.push(Event::Boarding {
                    at_s: at,
                    seconds: 2.0,
                    pitch_deg: 0.02,
                    roll_deg: 0.05,
                });
                d
            },
            |_, _| true,
        );
        hunt(
            &format!("{kind} gyro 2 stuck in drive 10 s"),
            n,
            |s| Day {
                faults: vec![SensorFault::Stuck { channel: 2, from_s: 200.0, until_s: 210.0 }],
                ..base(s)
            },
            |_, _| true,
        );
        hunt(
            &format!("{kind} gyro 2 stuck in drive 0.2 s"),
            n,
            |s| Day {
                faults: vec![SensorFault::Stuck { channel: 2, from_s: 200.0, until_s: 200.2 }],
                ..base(s)
            },
            |_, _| true,
        );
        hunt(
            &format!("{kind} gyro 0 stuck from 200 s on"),
            n,
            |s| Day {
                faults: vec![SensorFault::Stuck { channel: 0, from_s: 200.0, until_s: 1e9 }],
                ..base(s)
            },
            |_, _| true,
        );
        hunt(
            &format!("{kind} accelerometer 0 stuck from 200"),
            n,
            |s| Day {
                faults: vec![SensorFault::Stuck { channel: 3, from_s: 200.0, until_s: 1e9 }],
                ..base(s)
            },
            |_, _| true,
        );
        hunt(
            &format!("{kind} one sample lost"),
            n,
            |s| Day {
                faults: vec![SensorFault::Gap { from_s: 200.0, until_s: 200.03 }],
                ..base(s)
            },
            |_, _| true,
        );
        // turned on a turntable at the end of the stop slowly: 5 deg over 10 s in the middle of stop 2 about down
        hunt(&format!("{kind} clocks 1% slow"), n, &base, |_, s| {
            s.time_s *= 1.01;
            true
        });
    }
}
