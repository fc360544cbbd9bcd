//! The driver on a simulated chip that is sick, or on a bus that is.

use drivers::ads1262::Ads1262 as Driver;
use drivers::ads1262::configuration::Configuration;
use drivers::data_ready::{DataReady, Edge};
use drivers::fault::Fault;
use embassy_time::{Delay, Duration, Instant, with_timeout};
use embedded_hal_async::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use hal_mock::ads1262::{Ads1262, ChipFault};
use hal_mock::chip::{Rig as _, Select};
use hal_mock::fault::{BusFault, FaultPlan, FaultySpi, When};

use super::rig::{Device, Input, Rig, device, port, rig, run, violations};

/// A chip that is sick before it is started.
fn started(inject: impl FnOnce(&mut Ads1262)) -> Result<(), Fault> {
    let rig = rig(Input::default());
    inject(&mut rig.borrow_mut().chip);
    run(async { device(&rig, Configuration::default()).start().await })
}

/// A device that runs.
async fn running(rig: &Rig) -> Device<'_> {
    let mut device = device(rig, Configuration::default());
    device.start().await.expect("it is healthy");
    device.ready().await.expect("there is a line");
    device.read().await.expect("it is healthy");
    device
}

#[test]
fn another_chip_is_not_believed() {
    let fault = started(|chip| chip.set_identity(0x21));
    assert_eq!(fault, Err(Fault::Identity { found: 0x0021_1105 }), "an ADS1263");
    assert_eq!(started(|chip| chip.set_identity(0x1F)), Ok(()), "the revision may change");
}

#[test]
fn a_wrong_checksum_costs_one_conversion() {
    let rig = rig(Input::steady(0.5));
    run(async {
        let mut device = running(&rig).await;
        rig.borrow_mut().chip.chip_fault.corrupts_next = true;
        device.ready().await.expect("there is a line");
        assert_eq!(device.read().await, Err(Fault::Checksum));
        assert!(!device.read().await.expect("the second time it is right").is_new);
        device.ready().await.expect("there is a line");
        let conversion = device.read().await.expect("it is healthy");
        assert!(conversion.is_new);
        assert_eq!(conversion.code, 429_496_730);
    });
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_chip_that_lost_its_supply_is_noticed_and_started_again() {
    let rig = rig(Input::steady(0.5));
    run(async {
        let mut device = running(&rig).await;
        rig.borrow_mut().power_cycle(Select::Gyro, Instant::now());
        let wait = with_timeout(Duration::from_millis(10), device.ready()).await;
        assert!(wait.is_err(), "a reset stops conversions");
        assert_eq!(device.read().await, Err(Fault::Reset));
        device.start().await.expect("it is healthy");
        device.ready().await.expect("there is a line");
        assert_eq!(device.read().await.expect("it is healthy").code, 429_496_730);
    });
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_chip_whose_supply_has_just_failed_is_started_without_delay() {
    let rig = rig(Input::default());
    run(async {
        let mut device = running(&rig).await;
        rig.borrow_mut().power_cycle(Select::Gyro, Instant::now());
        device.start().await.expect("it is healthy");
    });
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_dead_stuck_or_false_converter_does_not_start() {
    assert_eq!(started(|chip| chip.chip_fault.is_dead = true), Err(Fault::NotReady));
    assert_eq!(started(Ads1262::stick), Err(Fault::SelfTest));
    for code in [858_993_459, -858_993_459, i32::MAX, i32::MIN, -1] {
        assert_eq!(
            started(|chip| chip.chip_fault.stuck_at = Some(code)),
            Err(Fault::SelfTest),
            "{code}"
        );
    }
    assert_eq!(started(|chip| chip.voltages.reference = 2.2), Err(Fault::SelfTest));
    assert_eq!(started(|chip| chip.voltages.reference = 0.3), Err(Fault::Alarm { status: 0x52 }));
    assert_eq!(started(|chip| chip.voltages.supply = 4.0), Err(Fault::SelfTest));
}

#[test]
fn a_register_that_does_not_take_its_value_is_named() {
    for register in [0x01, 0x04, 0x06, 0x10, 0x11] {
        let fault = started(|chip| chip.chip_fault.broken_register = Some(register));
        assert_eq!(fault, Err(Fault::NotAsWritten { register }));
    }
}

/// It would convert at another rate than the one that was configured.
#[test]
fn a_clock_at_the_pins_is_an_alarm() {
    assert_eq!(started(|chip| chip.has_external_clock = true), Err(Fault::Alarm { status: 0x60 }));
}

/// Section 7.3: 4.75 V to 5.25 V.
#[test]
fn a_supply_within_its_range_is_no_fault() {
    assert_eq!(started(|chip| chip.voltages.supply = 4.75), Ok(()));
    assert_eq!(started(|chip| chip.voltages.supply = 5.25), Ok(()));
}

/// The driver cannot tell a stuck code from a quiet gyro; the next start can.
#[test]
fn a_converter_that_sticks_is_found_by_the_next_start() {
    let rig = rig(Input { volts: 0.0, volts_per_s: 1.0, asked: 0 });
    run(async {
        let mut device = running(&rig).await;
        rig.borrow_mut().chip.stick();
        let mut codes = Vec::new();
        for _ in 0..5 {
            device.ready().await.expect("it goes on signalling");
            let conversion = device.read().await.expect("nothing shows");
            assert!(conversion.is_new);
            codes.push(conversion.code);
        }
        codes.dedup();
        assert_eq!(codes.len(), 1);
        assert_eq!(device.start().await, Err(Fault::SelfTest));
        rig.borrow_mut().chip.chip_fault = ChipFault::default();
        device.start().await.expect("it is healthy");
    });
    assert_eq!(violations(&rig), 0);
}

#[test]
fn a_clipped_input_is_marked() {
    for (volts, is_clipped) in
        [(2.4, false), (2.5, true), (3.0, true), (-2.4, false), (-2.5, true), (-9.0, true)]
    {
        let rig = rig(Input::steady(volts));
        let found = run(async {
            let mut device = device(&rig, Configuration::default());
            device.start().await.expect("it is healthy");
            device.ready().await.expect("there is a line");
            device.read().await.expect("it is healthy").is_clipped
        });
        assert_eq!(found, is_clipped, "{volts}");
    }
}

#[test]
fn a_failing_reference_is_an_alarm() {
    let rig = rig(Input::default());
    run(async {
        let mut device = running(&rig).await;
        rig.borrow_mut().chip.voltages.reference = 0.2;
        device.ready().await.expect("there is a line");
        assert_eq!(device.read().await, Err(Fault::Alarm { status: 0x50 }));
    });
}

/// A bus whose answers are all the same, or which does not answer.
struct Sick(Option<u8>);

impl ErrorType for Sick {
    type Error = ErrorKind;
}

impl SpiDevice for Sick {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let byte = self.0.ok_or(ErrorKind::Overrun)?;
        for operation in operations {
            match operation {
                Operation::Read(bytes)
                | Operation::TransferInPlace(bytes)
                | Operation::Transfer(bytes, _) => bytes.fill(byte),
                Operation::Write(_) | Operation::DelayNs(_) => {}
            }
        }
        Ok(())
    }
}

/// A line that cannot be observed.
struct Cut;

impl DataReady for Cut {
    async fn edge(&mut self) -> Result<Edge, Fault> {
        Err(Fault::Bus)
    }
}

#[test]
fn a_sick_bus_is_reported() {
    for (answer, at_start, at_read) in [
        (None, Fault::Bus, Fault::Bus),
        (Some(0x00), Fault::Identity { found: 0 }, Fault::Checksum),
        (Some(0xFF), Fault::Identity { found: 0x00FF_FFFF }, Fault::Checksum),
    ] {
        run(async {
            let mut device = Driver::new(Sick(answer), Cut, Delay, Configuration::default());
            assert_eq!(device.start().await, Err(at_start));
            assert_eq!(device.read().await, Err(at_read));
            assert_eq!(device.ready().await, Err(Fault::Bus));
        });
    }
}

#[test]
fn a_transfer_that_its_bus_gave_up_is_told_from_one_that_failed() {
    run(async {
        let rig = rig(Input::default());
        let hangs = FaultPlan { fault: BusFault::Hang, when: When::always(Instant::MIN) };
        let bus = FaultySpi::new(port(&rig, 5_000_000), Some(hangs));
        let mut device = Driver::new(bus, Cut, Delay, Configuration::default());
        assert_eq!(device.start().await, Err(Fault::Hung));
        assert_eq!(device.read().await, Err(Fault::Hung));
    });
}
