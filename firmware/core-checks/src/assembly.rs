//! What no language but the core's own can say: entries of handlers, and functions that break at a known place.

use core::arch::global_asm;

global_asm!(
    ".section .HardFault.user, \"ax\"",
    ".syntax unified",
    ".thumb",
    ".fpu fpv4-sp-d16",
    ".global HardFault, DefaultHandler",
    ".type HardFault, %function",
    ".type DefaultHandler, %function",
    ".thumb_func",
    "HardFault:",
    ".thumb_func",
    "DefaultHandler:",
    "mov r0, lr",
    "tst lr, #4",
    "ite eq",
    "mrseq r1, msp",
    "mrsne r1, psp",
    "push {{r4, lr}}",
    // It says how the handler returns.
    "bl handle",
    "pop {{r4, lr}}",
    "bx r0",
    ".section .text.checks, \"ax\"",
    // Each of these breaks at its first instruction.
    ".macro breaks name, instruction:vararg",
    ".global \\name",
    ".type \\name, %function",
    ".thumb_func",
    "\\name:",
    "\\instruction",
    "bx lr",
    ".endm",
    "breaks undefined, udf #0",
    "breaks load, ldr r0, [r0]",
    "breaks store, str r1, [r0]",
    "breaks store_byte, strb r1, [r0]",
    "breaks load_pair, ldrd r0, r1, [r0]",
    "breaks load_many, ldm r0, {{r0, r1}}",
    "breaks store_pair, strd r1, r1, [r0, #8]",
    "breaks store_many, stm r0, {{r1, r2}}",
    "breaks load_exclusive, ldrex r0, [r0, #4]",
    "breaks load_float, vldr s0, [r0, #4]",
    "breaks load_floats, vldm r0, {{s0, s1}}",
    "breaks load_and_move, ldr r1, [r0], #4",
    "breaks jump, bx r0",
    "breaks divide, sdiv r0, r0, r1",
    "breaks call, svc #0x5a",
    // A fault after other instructions.
    ".global load_pair_late",
    ".type load_pair_late, %function",
    ".thumb_func",
    "load_pair_late:",
    "adds r1, #1",
    "add.w r2, r1, r0",
    "ldrd r2, r3, [r0, #-4]",
    "mov r0, r2",
    "bx lr",
    // A fault within conditional instructions: the second of three.
    ".global load_if",
    ".type load_if, %function",
    ".thumb_func",
    "load_if:",
    "movs r1, #0",
    "cmp r1, #0",
    "ittt eq",
    "addeq r1, #1",
    "ldreq r0, [r0]",
    "addeq r1, #16",
    "bx lr",
    // Loads within conditional instructions, after which the condition no longer holds in the next block: 7.
    ".global loads_if",
    ".type loads_if, %function",
    ".thumb_func",
    "loads_if:",
    "mov r3, r0",
    "mov r0, #0",
    "cmp r3, r3",
    "itt eq",
    "ldreq r1, [r3]",
    "ldreq r2, [r3]",
    "movs r1, #1",
    "b loaded_if",
    "loaded_if:",
    "mov r0, #7",
    "bx lr",
    // A call within conditional instructions: what comes after it is done by its own condition.
    ".global call_if",
    ".type call_if, %function",
    ".thumb_func",
    "call_if:",
    "cmp r0, #0",
    "mov r0, #0",
    "itete eq",
    "addeq r0, #1",
    "addne r0, #2",
    "svceq #1",
    "addne r0, #4",
    "it eq",
    "addeq r0, #8",
    "bx lr",
    // An interrupt is pended (r0 its bit, r1 the register) within conditional instructions.
    ".global pend_if",
    ".type pend_if, %function",
    ".thumb_func",
    "pend_if:",
    "mov r2, #0",
    "tst r0, r0",
    "itete ne",
    "strne r0, [r1]",
    "addeq r2, #1",
    "addne r2, #2",
    "addeq r2, #4",
    "dsb",
    "isb",
    "mov r0, r2",
    "bx lr",
    // Calls with the stack moved by r0 bytes; returns by how much the stack has moved in the end.
    ".global call_on",
    ".type call_on, %function",
    ".thumb_func",
    "call_on:",
    "mov r2, sp",
    "subs r1, r2, r0",
    "mov sp, r1",
    "svc #2",
    "mov r0, sp",
    "mov sp, r2",
    "subs r0, r2, r0",
    "bx lr",
    // Pushes with the process stack at r0.
    ".global push_at",
    ".type push_at, %function",
    ".thumb_func",
    "push_at:",
    "push {{r4, lr}}",
    "msr psp, r0",
    "mov r2, #2",
    "msr control, r2",
    "isb",
    "push {{r0-r3}}",
    ".global pushed",
    ".type pushed, %function",
    ".thumb_func",
    "pushed:",
    "mov r2, #0",
    "msr control, r2",
    "isb",
    "pop {{r4, pc}}",
    // Threads on the process stack at r0: calls, and pends an interrupt (r1 its bit, r2 the register).
    ".global on_process_stack",
    ".type on_process_stack, %function",
    ".thumb_func",
    "on_process_stack:",
    "msr psp, r0",
    "mov r3, #2",
    "msr control, r3",
    "isb",
    "svc #3",
    "str r1, [r2]",
    "dsb",
    "isb",
    "mov r0, sp",
    "mov r3, #0",
    "msr control, r3",
    "isb",
    "bx lr",
    // Reads r0 without privilege, and becomes privileged by a call.
    ".global read_unprivileged",
    ".type read_unprivileged, %function",
    ".thumb_func",
    "read_unprivileged:",
    "push {{r4, lr}}",
    "mov r2, #1",
    "msr control, r2",
    "isb",
    "msr primask, r2",
    "bl load",
    "mov r4, r0",
    "svc #4",
    "mov r0, r4",
    "pop {{r4, pc}}",
    // Fills the floating-point registers from r0 (32 words, then the status), pends an interrupt (r1 its bit, r2 the
    // register), and stores them to r3.
    ".global floats_across",
    ".type floats_across, %function",
    ".thumb_func",
    "floats_across:",
    "vpush {{d8-d15}}",
    "vldm r0!, {{s0-s31}}",
    "ldr r0, [r0]",
    "vmsr fpscr, r0",
    "str r1, [r2]",
    "dsb",
    "isb",
    "vstm r3!, {{s0-s31}}",
    "vmrs r0, fpscr",
    "str r0, [r3]",
    "mov r0, #0",
    "vmsr fpscr, r0",
    "vpop {{d8-d15}}",
    "bx lr",
    // Overwrites the registers that a function may: returns the status that it found.
    ".global spoil_floats",
    ".type spoil_floats, %function",
    ".thumb_func",
    "spoil_floats:",
    "vmrs r0, fpscr",
    "mvn r1, #0",
    "vmov d0, r1, r1",
    "vmov d1, r1, r1",
    "vmov d2, r1, r1",
    "vmov d3, r1, r1",
    "vmov d4, r1, r1",
    "vmov d5, r1, r1",
    "vmov d6, r1, r1",
    "vmov d7, r1, r1",
    "mov r1, #0x80000000",
    "vmsr fpscr, r1",
    "bx lr",
);

unsafe extern "C" {
    pub safe fn undefined() -> u32;
    pub safe fn load(address: u32) -> u32;
    pub safe fn store(address: u32, value: u32) -> u32;
    pub safe fn store_byte(address: u32, value: u32) -> u32;
    pub safe fn load_pair(address: u32) -> u32;
    pub safe fn load_many(address: u32) -> u32;
    pub safe fn store_pair(address: u32) -> u32;
    pub safe fn store_many(address: u32) -> u32;
    pub safe fn load_exclusive(address: u32) -> u32;
    pub safe fn load_float(address: u32) -> u32;
    pub safe fn load_floats(address: u32) -> u32;
    pub safe fn load_pair_late(address: u32, addend: u32) -> u32;
    pub safe fn load_and_move(address: u32) -> u32;
    pub safe fn jump(address: u32) -> u32;
    pub safe fn divide(dividend: u32, divisor: u32) -> u32;
    pub safe fn call() -> u32;
    pub safe fn load_if(address: u32) -> u32;
    pub safe fn loads_if(address: u32) -> u32;
    pub safe fn call_if(condition: u32) -> u32;
    pub safe fn pend_if(bit: u32, register: u32) -> u32;
    pub safe fn call_on(moved: u32) -> u32;
    pub safe fn push_at(stack: *mut u32) -> u32;
    pub safe fn pushed();
    pub safe fn on_process_stack(stack: *mut u32, bit: u32, register: u32) -> u32;
    pub safe fn read_unprivileged(address: u32) -> u32;
    pub safe fn floats_across(from: *const u32, bit: u32, register: u32, to: *mut u32);
    pub safe fn spoil_floats() -> u32;
}
