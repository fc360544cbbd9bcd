//! The pages of the store hold what another program left in them.

use super::{Board, FIRST, SLOTS, erased, store};
use drivers::fault::Fault;
use hal_mock::flash::PAGE;
use hal_mock::noise::Generator;
use host::virtual_time::run;

/// A flash in whose store's pages another program left these bytes, after the board's first start.
fn left(seed: u64, bytes: &[u8; 2 * PAGE]) -> Board {
    let mut flash = erased(seed);
    flash.flash.burn(FIRST, bytes);
    assert_eq!(SLOTS[0].load(&mut flash), Err(Fault::Bus), "no lack of an item");
    assert_eq!(run(store(&mut flash).take_over()), Ok(Ok(true)), "which is told");
    flash
}

/// Whether each of a hundred saves, after a restart each, is there to be loaded afterwards.
fn saved(flash: &mut Board) -> [bool; 100] {
    core::array::from_fn(|number| {
        flash.restart();
        let number = number as u64;
        let is_saved = SLOTS[0].save(flash, number).is_ok();
        is_saved && SLOTS[0].load(flash) == Ok(Some(number))
    })
}

#[test]
fn a_store_in_pages_of_zeros_is_taken_over() {
    let mut flash = left(1, &[0; 2 * PAGE]);
    let found = SLOTS[0].load(&mut flash);
    let count = saved(&mut flash).into_iter().filter(|is_saved| *is_saved).count();
    assert!(found == Ok(None) && count == 100, "{count} of 100 saves: {found:?}");
}

#[test]
fn a_store_in_pages_of_random_bytes_is_taken_over() {
    let (mut never, mut partly) = (0, 0);
    for seed in 0..100 {
        let mut noise = Generator::new(seed);
        let bytes = core::array::from_fn(|_| noise.next_u64() as u8);
        let saved = saved(&mut left(seed, &bytes));
        never += u32::from(saved == [false; 100]);
        partly += u32::from(saved.contains(&true) && saved.contains(&false));
    }
    assert!(
        never + partly == 0,
        "in {never} of 100 stores nothing is ever saved, in {partly} not everything"
    );
}
