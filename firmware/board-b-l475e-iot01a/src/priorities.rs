//! Priorities of the interrupts, 0 being the highest (the controller has sixteen).
//!
//! | priority | interrupts | why |
//! |--:|---|---|
//! | 0 | edges of the data-ready lines; on a spinning body the transfers that they begin | a stamp is as late as its interrupt: nothing may come first, no critical section either |
//! | 1 | the notifier of these | it wakes their tasks, as what a critical section holds back may |
//! | 2 | alarms of the time driver, the bus of the base, the link and its direct memory access | they move data and wake tasks, which may take some microseconds |
//! | 6 | the executor of acquisition | what is read belongs to the moment of its conversion |
//! | 8 | the executor of control: motors and keeper | they must not wait for a conclusion, but may work for a millisecond |
//! | 10 | the executor of the link | it goes on while the thread computes |
//! | thread | the executor of the thread: aligner, conclusions, store | |

use embassy_stm32::interrupt::{Interrupt, InterruptExt, Priority};
use stm32::edges::NOTIFIER;

/// The edges of the data-ready lines, and the ends of the transfers that they begin.
const EDGES: [Interrupt; 6] = [
    Interrupt::EXTI0,
    Interrupt::EXTI1,
    Interrupt::EXTI3,
    Interrupt::EXTI4,
    Interrupt::EXTI15_10,
    Interrupt::DMA1_CHANNEL2,
];

/// Time driver, bus of the base, the link with its direct memory access both ways.
const OTHERS: [Interrupt; 6] = [
    Interrupt::TIM1_BRK_TIM15,
    Interrupt::I2C2_EV,
    Interrupt::I2C2_ER,
    Interrupt::USART1,
    Interrupt::DMA2_CHANNEL6,
    Interrupt::DMA2_CHANNEL7,
];

/// The executors of acquisition, of control and of the link. The peripherals of these interrupts are not used: a master of a
/// single-wire protocol, a controller of touch keys, and a generator of random numbers.
pub const EXECUTORS: [Interrupt; 3] = [Interrupt::SWPMI1, Interrupt::TSC, Interrupt::RNG];

/// Sets the priorities.
pub fn set() {
    let [acquisition, control, link] = EXECUTORS;
    let groups: [(&[Interrupt], Priority); 6] = [
        (&EDGES, Priority::P0),
        (&[NOTIFIER], Priority::P1),
        (&OTHERS, Priority::P2),
        (&[acquisition], Priority::P6),
        (&[control], Priority::P8),
        (&[link], Priority::P10),
    ];
    for (interrupts, priority) in groups {
        for interrupt in interrupts {
            interrupt.set_priority(priority);
        }
    }
}
