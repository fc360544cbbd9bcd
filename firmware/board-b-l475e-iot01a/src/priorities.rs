//! Priorities of the interrupts, 0 being the highest (the controller has sixteen).
//!
//! | priority | interrupts | why |
//! |--:|---|---|
//! | 0 | edges of the data-ready lines | a stamp is as late as its interrupt: nothing but a critical section may come first |
//! | 2 | alarms of the time driver, the bus of the base, direct memory access | they move data and wake tasks, which may take some microseconds |
//! | thread | the executor and all its tasks | |

use embassy_stm32::interrupt::{Interrupt, InterruptExt, Priority};

/// The edges of the data-ready lines.
const EDGES: [Interrupt; 5] =
    [Interrupt::EXTI0, Interrupt::EXTI1, Interrupt::EXTI3, Interrupt::EXTI4, Interrupt::EXTI15_10];

/// Time driver, bus of the base, direct memory access of that bus and of the link.
const OTHERS: [Interrupt; 6] = [
    Interrupt::TIM1_BRK_TIM15,
    Interrupt::I2C2_EV,
    Interrupt::I2C2_ER,
    Interrupt::DMA1_CHANNEL4,
    Interrupt::DMA1_CHANNEL5,
    Interrupt::DMA2_CHANNEL6,
];

/// Sets the priorities.
pub fn set() {
    EDGES.into_iter().for_each(|interrupt| interrupt.set_priority(Priority::P0));
    OTHERS.into_iter().for_each(|interrupt| interrupt.set_priority(Priority::P2));
}
