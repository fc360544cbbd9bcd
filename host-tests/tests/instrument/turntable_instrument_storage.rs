//! Axis misalignments are kept over a loss of supply: whenever it comes, the old one or the new one is there. The
//! whole instrument uses what it kept, and tells it.

use drivers::fault::Fault;
use firmware::date::Day;
use firmware::event::Event;
use firmware::ports::Store;
use firmware::storage::{FlashStore, Today, keep, recall};
use host::instrument::{Trial, TurntableRun};
use host::output::{azimuth_error, degrees};
use host::virtual_time::run;
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::misalignment::{AxisMisalignment, BYTES};
use orientation::units::{RadiansPerSecond, Seconds};
use proptest::prelude::*;
use simulated::flash::Flash;
use simulated::hold::Hold;
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;

fn save(store: &mut FlashStore<Flash>, bytes: &[u8; BYTES]) -> Result<(), Fault> {
    run(store.save(0, bytes)).expect("it ends")
}

fn load(store: &mut FlashStore<Flash>) -> Option<[u8; BYTES]> {
    run(store.load(0)).expect("it ends").expect("the flash is sound")
}

fn misalignment(sine: f64, date: u64) -> AxisMisalignment {
    AxisMisalignment {
        sine,
        quadrature: Seconds(1e-6),
        sine_sigma: 1e-6,
        quadrature_sigma: Seconds(1e-6),
        frequency: RadiansPerSecond(0.9),
        date,
        temperature: 21.5,
    }
}

fn stored(number: u8) -> [u8; BYTES] {
    misalignment(f64::from(number) * 1e-4, 1_700_000_000).to_bytes()
}

/// A store with so many misalignments written one after the other, the last of number 1.
fn used(times: usize) -> FlashStore<Flash> {
    let mut store = Flash::default().store();
    for _ in 0..times {
        save(&mut store, &stored(0)).expect("there is room");
    }
    save(&mut store, &stored(1)).expect("there is room");
    store
}

/// Words until a save is over.
fn effort(times: usize) -> usize {
    let mut flash = used(times).into_flash();
    flash.left = Some(usize::MAX);
    let mut store = flash.store();
    save(&mut store, &stored(2)).expect("there is room");
    usize::MAX - store.into_flash().left.expect("it was set")
}

#[test]
fn what_is_saved_last_is_loaded_from_then_on() {
    let mut store = Flash::default().store();
    assert_eq!(load(&mut store), None);
    for number in 0..200 {
        save(&mut store, &stored(number)).expect("there is room");
        store = store.into_flash().store();
        assert_eq!(load(&mut store), Some(stored(number)));
    }
}

/// At every word of a save, on an empty page, in the middle of one, and where pages are changed and
/// erased.
#[test]
fn a_loss_of_supply_at_any_moment_leaves_the_old_misalignment_or_the_new_one() {
    let mut cuts = 0;
    for times in [0, 5, 20, 21, 22, 23, 24, 25, 26, 27, 28] {
        for cut in 0..effort(times) {
            let mut flash = used(times).into_flash();
            flash.left = Some(cut);
            let mut store = flash.store();
            assert!(save(&mut store, &stored(2)).is_err(), "the supply was lost");
            let mut flash = store.into_flash();
            flash.left = None;
            let mut store = flash.store();
            let found = load(&mut store).expect("nothing is lost");
            cuts += 1;
            assert!(found == stored(1) || found == stored(2), "after {times}, cut at {cut}");
            save(&mut store, &stored(3)).expect("it goes on");
            assert_eq!(load(&mut store), Some(stored(3)));
        }
    }
    // Eleven saves of ten words or more each, with 256 words of an erased page in some of them.
    assert!(cuts > 300, "only {cuts} moments");
}

#[test]
fn every_speed_has_its_own_misalignment_and_all_are_needed() {
    let mut store = Flash::default().store();
    let today = Today { date: Some(1_700_000_100), longest: Some(3600) };
    let recalled = |store: &mut FlashStore<Flash>, speeds: &[f64]| {
        let speeds: Vec<_> = speeds.iter().copied().map(RadiansPerSecond).collect();
        run(recall(store, &speeds, today)).expect("it ends").expect("the flash is sound")
    };
    assert_eq!(recalled(&mut store, &[0.9]), None);
    let found = [misalignment(0.01, 1_700_000_000), misalignment(0.02, 1_700_000_050)];
    run(keep(&mut store, found.into_iter().take(1))).expect("it ends").expect("there is room");
    assert_eq!(recalled(&mut store, &[0.9]), Some([Some(found[0]), None]));
    assert_eq!(recalled(&mut store, &[0.9, 0.9]), None);
    run(keep(&mut store, found.into_iter())).expect("it ends").expect("there is room");
    assert_eq!(recalled(&mut store, &[0.9, 0.9]), Some(found.map(Some)));
}

#[test]
fn what_is_no_misalignment_is_not_recalled() {
    let mut store = Flash::default().store();
    let mut bytes = stored(1);
    bytes[12] ^= 1;
    save(&mut store, &bytes).expect("there is room");
    let today = Today { date: None, longest: None };
    assert_eq!(run(recall(&mut store, &[RadiansPerSecond(0.9)], today)), Ok(Ok(None)));
}

/// 2026-03-14, 09:26:53.
const THEN: u64 = 1_773_480_413;
/// 2026-03-20.
const NOW: u64 = 1_773_964_800;

/// The store of a board that keeps misalignments, and the day.
struct Keeping {
    store: FlashStore<Flash>,
    today: Today,
}

fn keeping(flash: Flash, date: u64) -> Keeping {
    Keeping { store: flash.store(), today: Today { date: Some(date), longest: None } }
}

/// A short alignment with so many rate-modulated turns.
fn scenario(seed: u64, modulated_turns: u32) -> TurntableScenario {
    let base = Scenario { sample_rate_hz: 100.0, ..Scenario::usual(seed) };
    TurntableScenario { base, modulated_turns, turns: 4, ..TurntableScenario::brief(seed) }
}

/// A sensor that is not flat, which must know its misalignment.
fn molecular(modulated_turns: u32) -> TurntableScenario {
    let molecular = TurntableScenario::molecular(1);
    let base = Scenario { sample_rate_hz: 100.0, ..molecular.base };
    TurntableScenario { base, modulated_turns, turns: 2, ..molecular }
}

fn aligned(scenario: &TurntableScenario, keeping: &mut Keeping) -> TurntableRun {
    let scenario = TurntableScenario { today: Some(keeping.today), ..*scenario };
    Trial::of(&scenario).store(&mut keeping.store).run().expect("it is possible")
}

fn verdict(run: &TurntableRun) -> Result<Azimuth, Refusal> {
    run.replay.conclusion().expect("every run concludes").verdict
}

fn reported(run: &TurntableRun, part: &str) -> Option<String> {
    let mut reported = run.events.iter().map(|(_, event)| event.to_string());
    reported.find(|line| line.contains(part))
}

#[test]
fn what_a_modulated_turn_found_gives_the_same_north_the_next_time() {
    let mut before = keeping(Flash::default(), THEN);
    let first = aligned(&scenario(5, 6), &mut before);
    let kept = reported(&first, "axis misalignment saved").expect("it is kept");
    assert!(kept.contains("found on 2026-03-14 at 2") && kept.contains("°C"), "{kept}");
    let mut after = keeping(before.store.into_flash(), NOW);
    let second = aligned(&scenario(5, 0), &mut after);
    let recalled = reported(&second, "misalignment recalled").expect("it is used");
    assert_eq!(recalled.replace("recalled", "saved"), kept);
    assert_eq!(reported(&second, "rate-modulated"), None);
    assert_eq!(reported(&second, "axis misalignment saved"), None, "nothing new was found");
    let [first, second] = [&first, &second].map(|run| verdict(run).expect("north"));
    let apart = azimuth_error(first.angle.degrees(), second.angle.degrees()).abs();
    // Both have noise of their own.
    assert!(apart < 3.0 * degrees(first.sigma.0.hypot(second.sigma.0)), "{apart}° apart");
}

#[test]
fn a_misalignment_is_saved_as_its_alignment_ends_while_the_azimuth_is_held_on() {
    let usual = scenario(5, 6);
    let base = Scenario { hold: Hold::of(30.0), has_base_imu: true, ..usual.base };
    let run = aligned(&TurntableScenario { base, ..usual }, &mut keeping(Flash::default(), THEN));
    let at = |part: &str| {
        let found = run.events.iter().find(|(_, event)| event.to_string().contains(part));
        found.unwrap_or_else(|| panic!("nothing of {part}")).0.as_micros() as f64 * 1e-6
    };
    let saved = at("axis misalignment saved");
    assert!(saved <= at("handed over") && saved + 29.0 < run.seconds, "{saved} s");
}

#[test]
fn a_sensor_that_must_know_its_misalignment_is_refused_before_anything_turns() {
    let mut keeping = keeping(Flash::default(), NOW);
    let run = aligned(&molecular(0), &mut keeping);
    assert_eq!(verdict(&run), Err(Refusal::MisalignmentUnknown));
    assert!(reported(&run, "no stored axis misalignment").is_some());
    assert_eq!(reported(&run, "stage: turns"), None);
}

#[test]
fn misalignments_of_both_speeds_of_a_molecular_electronic_sensor_are_used_again() {
    let mut before = keeping(Flash::default(), THEN);
    verdict(&aligned(&molecular(12), &mut before)).expect("north");
    let mut after = keeping(before.store.into_flash(), NOW);
    let run = aligned(&molecular(0), &mut after);
    let azimuth = verdict(&run).expect("north");
    let error = azimuth_error(azimuth.angle.degrees(), molecular(0).base.azimuth_deg);
    assert!(error.abs() < 4.0 * azimuth.sigma.degrees(), "off by {error}°");
    let is_recalled = |event: &Event| matches!(event, Event::Recalled(_));
    assert_eq!(run.events.iter().filter(|(_, event)| is_recalled(event)).count(), 2);
}

/// A misalignment that a refused session found is not saved: the next session would be refused for it, too.
#[test]
fn a_refused_session_keeps_nothing() {
    let mut keeping = keeping(Flash::default(), THEN);
    let tilted = TurntableScenario { elevation_deg: -2.5, ..scenario(1, 6) };
    verdict(&aligned(&tilted, &mut keeping)).expect_err("it is misaligned");
    assert_eq!(load(&mut keeping.store), None);
}

#[test]
fn a_misalignment_of_another_speed_or_of_tomorrow_is_not_used() {
    let mut store = Flash::default().store();
    let found = misalignment(0.01, THEN);
    run(keep(&mut store, core::iter::once(found))).expect("it ends").expect("there is room");
    let mut recalled = |speed: f64, date| {
        let today = Today { date: Some(date), longest: None };
        run(recall(&mut store, &[RadiansPerSecond(speed)], today))
            .expect("it ends")
            .expect("the flash is sound")
    };
    assert!(recalled(0.9, NOW).is_some() && recalled(0.93, NOW).is_some());
    assert_eq!(
        (recalled(1.3, NOW), recalled(0.5, NOW), recalled(0.9, THEN - 1)),
        (None, None, None)
    );
}

#[test]
fn a_store_that_fails_is_reported_and_north_is_found_all_the_same() {
    let mut flash = Flash::default();
    flash.left = Some(2);
    let mut keeping = keeping(flash, THEN);
    let run = aligned(&scenario(5, 6), &mut keeping);
    verdict(&run).expect("north");
    assert!(reported(&run, "axis misalignment not saved: bus error").is_some());
}

/// Seconds by `date -u -d … +%s`.
#[test]
fn days_are_those_of_the_calendar() {
    for (text, (year, month, day), seconds) in [
        ("1970-01-02", (1970, 1, 2), 86_400),
        ("2000-02-29", (2000, 2, 29), 951_782_400),
        ("2026-03-14", (2026, 3, 14), 1_773_446_400),
        ("2100-03-01", (2100, 3, 1), 4_107_542_400),
        ("9999-12-31", (9999, 12, 31), 253_402_214_400),
    ] {
        assert_eq!(Day::begin(year, month, day), Some(seconds), "{text}");
        assert_eq!(Day::of(seconds).to_string(), text);
        assert_eq!(Day::of(seconds + 86_399).to_string(), text);
    }
    assert_eq!(Day::of(0).to_string(), "an unknown day");
    assert_eq!(Day::of(u64::MAX).to_string(), "9999-12-31");
    for (year, month, day) in
        [(2026, 2, 29), (2100, 2, 29), (2026, 13, 1), (2026, 0, 1), (2026, 1, 0)]
    {
        assert_eq!(Day::begin(year, month, day), None, "{year}-{month}-{day}");
    }
}

proptest! {
    #[test]
    fn a_misalignment_is_fresh_between_its_date_and_the_longest_age(
        found in 1_u64..4_000_000_000, age in 0_u64..4_000_000_000, longest in 0_u64..4_000_000_000,
    ) {
        let fresh = |date, longest| Today { date, longest }.is_fresh(&misalignment(0.01, found));
        prop_assert_eq!(fresh(Some(found + age), Some(longest)), age <= longest);
        prop_assert!(fresh(Some(found + age), None));
        prop_assert!(!fresh(Some(found - 1), Some(longest)), "it is from the future");
        prop_assert!(!fresh(Some(found - 1), None), "it is from the future");
        prop_assert!(!fresh(None, Some(longest)), "its age is unknown");
        prop_assert!(fresh(None, None), "its age does not matter");
    }

    #[test]
    fn a_misalignment_without_a_date_is_fresh_where_its_age_does_not_matter(
        date in prop::option::of(1_u64..4_000_000_000), longest in 0_u64..4_000_000_000,
    ) {
        let undated = misalignment(0.01, 0);
        let of_an_age = Today { date, longest: Some(longest) };
        prop_assert!(!of_an_age.is_fresh(&undated));
        let any_age = Today { date, longest: None };
        prop_assert!(any_age.is_fresh(&undated));
    }
}
