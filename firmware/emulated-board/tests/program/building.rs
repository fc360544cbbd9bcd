//! Images are built one after the other, and each is that of its carrier.

use std::fs;
use std::thread;

use execution::{built, carrier};
use firmware::platform::Platform;

#[test]
fn images_that_are_built_at_the_same_time_are_those_of_their_carriers() {
    let carriers = [Platform::Stage, Platform::Spin].repeat(3);
    let builders = carriers.into_iter().map(|of| {
        thread::spawn(move || {
            let image = built::image(of).expect("it builds");
            (of, carrier::stated(&fs::read(image).expect("it is there")))
        })
    });
    let builders: Vec<_> = builders.collect();
    for builder in builders {
        let (of, stated) = builder.join().expect("it has built");
        assert_eq!(stated, Ok(Some(of)));
    }
}
