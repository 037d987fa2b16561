//! Faults that the check looks for in a program of their own: a fault that it does not find here it would not find
//! anywhere.

/// One vector: with it the library does not build. The systems are crates that are built already.
#[cfg(feature = "heap")]
#[unsafe(export_name = "planted.heap")]
extern "C" fn heap(length: usize) -> usize {
    core::hint::black_box(alloc::vec![0_u8; length]).len()
}

/// An index that may be out of range.
#[unsafe(export_name = "planted.panic")]
extern "C" fn panic(values: &[f64; 3], index: usize) -> f64 {
    values[index]
}

/// 64 KiB on the stack, in two frames.
#[unsafe(export_name = "planted.stack")]
extern "C" fn stack(seed: u8) -> u8 {
    frame(&core::hint::black_box([seed; 40 * 1024]))
}

#[inline(never)]
fn frame(values: &[u8; 40 * 1024]) -> u8 {
    let own = core::hint::black_box([values[0]; 24 * 1024]);
    own[own.len() - 1]
}

/// A depth that depends on a number.
#[unsafe(export_name = "planted.recursion")]
extern "C" fn recursion(depth: u64) -> u64 {
    if depth == 0 { 0 } else { core::hint::black_box(recursion(depth - 1)) + depth }
}

/// A call of an unknown function.
#[unsafe(export_name = "planted.pointer")]
extern "C" fn pointer(called: extern "C" fn(u64) -> u64) -> u64 {
    called(1) + 1
}
