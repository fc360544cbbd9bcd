//! The record beside what else a store holds, in two pages of the board's flash.

use drivers::fault::Fault;
use firmware::ports::Store;
use firmware::storage::{FlashStore, HEADING};
use host::virtual_time::run;
use orientation::attitude::restart::Remembered;
use simulated::flash::Flash;

use super::first::{aligning, migrated, of_a_vehicle};
use super::{
    BYTES, SERIAL, SLOT, Settings, SettingsError, StageSchedule, TurntableSchedule,
    VehicleSchedule, load, record, sealed, settings, stage, turntable, vehicle,
};

/// A store in the board's flash.
type InFlash = FlashStore<Flash>;

fn put<const N: usize>(store: &mut InFlash, slot: u8, item: [u8; N]) {
    run(store.save(slot, &item)).expect("it ends").expect("there is room");
}

fn got<const N: usize>(store: &mut InFlash, slot: u8) -> Option<[u8; N]> {
    run(store.load(slot)).expect("it ends").expect("the flash is sound")
}

fn keep(store: &mut InFlash, settings: &Settings<TurntableSchedule>) {
    run(super::save(store, settings, &SERIAL)).expect("it ends").expect("there is room");
}

fn kept(store: &mut InFlash) -> Result<Option<Settings<TurntableSchedule>>, SettingsError> {
    run(load(store, &SERIAL)).expect("it ends")
}

/// Settings that differ by a number.
fn numbered(number: u32) -> Settings<TurntableSchedule> {
    settings(TurntableSchedule { turns: 2 + number, ..turntable() })
}

#[test]
fn a_store_without_a_record_has_no_settings() {
    let mut store = Flash::default().store();
    assert_eq!(kept(&mut store), Ok(None));
    put(&mut store, 0, [1; 64]);
    put(&mut store, HEADING, [2; Remembered::BYTES]);
    assert_eq!(kept(&mut store), Ok(None));
}

#[test]
fn settings_that_are_saved_last_are_loaded_from_then_on() {
    let mut store = Flash::default().store();
    for number in 0..100 {
        keep(&mut store, &numbered(number));
        store = store.into_flash().store();
        assert_eq!(kept(&mut store), Ok(Some(numbered(number))));
    }
}

/// Over many changes of page, in either of which the other items must be carried along.
#[test]
fn settings_misalignments_and_heading_leave_each_other_alone() {
    let mut store = Flash::default().store();
    keep(&mut store, &numbered(0));
    put(&mut store, 0, [10; 64]);
    put(&mut store, 1, [11; 64]);
    for number in 0..200 {
        put(&mut store, HEADING, [number; Remembered::BYTES]);
        assert_eq!(kept(&mut store), Ok(Some(numbered(0))));
    }
    for number in 1..100 {
        keep(&mut store, &numbered(number));
        assert_eq!(got(&mut store, 0), Some([10; 64]));
        assert_eq!(got(&mut store, 1), Some([11; 64]));
        assert_eq!(got(&mut store, HEADING), Some([199; Remembered::BYTES]));
    }
}

#[test]
fn a_loss_of_supply_at_any_moment_leaves_the_old_settings_or_the_new_ones() {
    let mut cuts = 0;
    for saved in 0..12 {
        let begun = || {
            let mut store = Flash::default().store();
            (0..=saved).for_each(|number| keep(&mut store, &numbered(number)));
            store.into_flash()
        };
        for cut in 0.. {
            let mut flash = begun();
            flash.left = Some(cut);
            let mut store = flash.store();
            let result = run(super::save(&mut store, &numbered(500), &SERIAL)).expect("it ends");
            let mut flash = store.into_flash();
            flash.left = None;
            let mut store = flash.store();
            let found = kept(&mut store).expect("it is sound").expect("nothing is lost");
            assert!(found == numbered(saved) || found == numbered(500), "{saved}, cut at {cut}");
            if result.is_ok() {
                break;
            }
            assert_eq!(result, Err(SettingsError::NotSaved(Fault::Bus)));
            cuts += 1;
        }
    }
    assert!(cuts > 300, "only {cuts} moments");
}

#[test]
fn settings_out_of_range_are_not_saved_and_the_old_ones_stay() {
    let mut store = Flash::default().store();
    keep(&mut store, &numbered(0));
    let result = run(super::save(&mut store, &numbered(1000), &SERIAL)).expect("it ends");
    assert!(matches!(result, Err(SettingsError::OutOfRange(_))), "{result:?}");
    assert_eq!(kept(&mut store), Ok(Some(numbered(0))));
}

#[test]
fn a_record_that_must_not_be_used_is_refused_and_not_passed_over() {
    let mut store = Flash::default().store();
    put(&mut store, SLOT, record(&settings(stage())));
    let refused = run(load::<VehicleSchedule>(&mut store, &SERIAL)).expect("it ends");
    assert!(matches!(refused, Err(SettingsError::OtherCarrier { .. })), "{refused:?}");
    let mut newer = record(&settings(stage()));
    newer[0] = 3;
    put(&mut store, SLOT, sealed(newer));
    let refused = run(load::<StageSchedule>(&mut store, &SERIAL)).expect("it ends");
    assert_eq!(refused, Err(SettingsError::UnknownVersion(3)));
    put(&mut store, SLOT, [0; BYTES]);
    let refused = run(load::<StageSchedule>(&mut store, &SERIAL)).expect("it ends");
    assert_eq!(refused, Err(SettingsError::Damaged));
    put(&mut store, SLOT, [0; 16]);
    let refused = run(load::<StageSchedule>(&mut store, &SERIAL)).expect("it ends");
    assert_eq!(refused, Err(SettingsError::Damaged));
    put(&mut store, SLOT, [0; 255]);
    let refused = run(load::<StageSchedule>(&mut store, &SERIAL)).expect("it ends");
    assert_eq!(refused, Err(SettingsError::Unreadable(Fault::Bus)));
    let right = settings(vehicle());
    run(super::save(&mut store, &right, &SERIAL)).expect("it ends").expect("there is room");
    assert_eq!(run(load(&mut store, &SERIAL)).expect("it ends"), Ok(Some(right)));
}

#[test]
fn pages_of_another_program_are_no_lack_of_a_record() {
    let mut store = Flash::holding([0x5A; simulated::flash::BYTES]).store();
    assert_eq!(kept(&mut store), Err(SettingsError::Unreadable(Fault::Bus)));
}

/// The first save by an image of today takes its place.
#[test]
fn a_record_of_version_1_in_a_store_is_loaded_and_written_over_by_one_of_today() {
    let mut store = Flash::default().store();
    put(&mut store, SLOT, of_a_vehicle());
    let found: Option<Settings<VehicleSchedule>> =
        run(load(&mut store, &SERIAL)).expect("it ends").expect("it is sound");
    assert_eq!(found, Some(migrated(aligning())));
    let right = settings(vehicle());
    run(super::save(&mut store, &right, &SERIAL)).expect("it ends").expect("there is room");
    assert_eq!(got(&mut store, SLOT), Some(record(&right)));
    assert_eq!(run(load(&mut store, &SERIAL)).expect("it ends"), Ok(Some(right)));
}
