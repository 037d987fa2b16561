//! How deep the stack is in a function: followed from instruction to instruction, along every branch.

use super::assembly::{Function, Instruction};
use std::collections::BTreeMap;

/// The stack of a function, below the address that its caller has pushed.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Bytes at its deepest.
    pub bytes: u64,
    /// Its calls, and the bytes that are taken then, the pushed address with them.
    pub calls: BTreeMap<&'a str, u64>,
}

/// The known state at a place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct State<'a> {
    /// Bytes below the address that the caller has pushed.
    bytes: u64,
    /// Those where the frame pointer points to.
    base: u64,
    /// Those of a frame of many pages, while it is touched page after page.
    probed: Option<u64>,
    /// Registers that point to functions of the C library.
    pointers: BTreeMap<char, &'a str>,
}

/// The frame of a function.
///
/// # Errors
/// Code that is not understood: a pointer that is called, a stack pointer that is computed, two depths in one place.
pub fn of<'a>(function: &Function<'a>) -> Result<Frame<'a>, String> {
    let states = vec![None; function.instructions.len()];
    let mut walk = Walk { function, states, open: vec![(0, State::default())], tables: None };
    let mut frame = Frame::default();
    while let Some((index, state)) = walk.next() {
        walk.visit(index, state, &mut frame)?;
    }
    Ok(frame)
}

struct Walk<'f, 'a> {
    function: &'f Function<'a>,
    states: Vec<Option<State<'a>>>,
    open: Vec<(usize, State<'a>)>,
    /// The state at a jump by a table: that of its targets, which nothing else leads to.
    tables: Option<State<'a>>,
}

/// The padding of the linker.
const PADDING: [&str; 7] = ["nop", "nopw", "nopl", "int3", "xchg", "ud2", "hlt"];

impl<'a> Walk<'_, 'a> {
    fn next(&mut self) -> Option<(usize, State<'a>)> {
        self.open.pop().or_else(|| {
            let state = self.tables.clone()?;
            let mut places = self.states.iter().zip(&self.function.instructions);
            let index = places.position(|(state, code)| state.is_none() && !PADDING.contains(&code.mnemonic))?;
            Some((index, state))
        })
    }

    /// Notes a state in a place, or its common part with the one that was there; `None` where nothing is new.
    fn met(&mut self, index: usize, state: State<'a>) -> Result<Option<State<'a>>, &'static str> {
        let Some(place) = self.states.get_mut(index) else { return Ok(None) };
        let common = match place {
            None => state,
            Some(known) if known.bytes != state.bytes => return Err("two depths"),
            Some(known) => {
                let mut common = known.clone();
                common.pointers.retain(|register, name| state.pointers.get(register) == Some(name));
                common
            }
        };
        if place.as_ref() == Some(&common) {
            return Ok(None);
        }
        Ok(Some(place.insert(common).clone()))
    }

    fn visit(&mut self, index: usize, state: State<'a>, frame: &mut Frame<'a>) -> Result<(), String> {
        let code = self.function.instructions.get(index).copied();
        self.step(index, code, state, frame).map_err(|what| {
            let code = code.map(|code| format!("{:x}: {} {}", code.address, code.mnemonic, code.operands));
            format!("stack: {what} in {} at {}", self.function.name, code.unwrap_or_default())
        })
    }

    fn step(
        &mut self,
        index: usize,
        code: Option<Instruction<'a>>,
        state: State<'a>,
        frame: &mut Frame<'a>,
    ) -> Result<(), &'static str> {
        let (Some(code), Some(before)) = (code, self.met(index, state)?) else { return Ok(()) };
        let after = moved(&code, &before).ok_or("a stack pointer that is not understood")?;
        frame.bytes = frame.bytes.max(after.bytes).max(before.bytes + beyond(code.operands));
        let jumps = code.mnemonic.starts_with('j');
        let inside = code.target().and_then(|target| self.place(target));
        // of a call, of a jump to another function, or of one through the table of the linker
        let callee = match code.target() {
            Some(_) => code.symbol,
            None => code
                .symbol
                .filter(|name| name.contains("@GLIBC"))
                .or_else(|| before.pointers.get(&pointer(code.operands)?).copied()),
        };
        match (code.mnemonic, callee) {
            ("call", Some(name)) => called(frame, name, after.bytes + 8),
            ("call", None) => return Err("a call of a pointer"),
            ("jmp", None) if self.is_table(index) => self.tables = Some(after.clone()),
            ("jmp", None) if inside.is_none() => return Err("a jump to a pointer"),
            (_, Some(name)) if jumps && inside.is_none() => called(frame, name, after.bytes),
            _ => {}
        }
        // the loop that touches page after page of a large frame ends where it was computed to end
        if let Some(place) = inside.filter(|place| jumps && (before.probed.is_none() || *place > index)) {
            self.open.push((place, after.clone()));
        }
        if !matches!(code.mnemonic, "ret" | "jmp" | "ud2" | "hlt") {
            let probed = after.probed.filter(|_| !jumps);
            self.open.push((index + 1, State { probed, ..after }));
        }
        Ok(())
    }

    /// Whether a jump is one by a table: of addresses, `jmp *table(,%r,8)`, or of offsets, `movslq (table,%i,4),%r; add table,%r; jmp *%r`.
    fn is_table(&self, index: usize) -> bool {
        let (before, rest) = self.function.instructions.split_at(index);
        let of_addresses =
            rest.first().is_some_and(|code| code.operands.starts_with("*0x") && code.operands.contains("(,%"));
        let of_offsets =
            before.iter().rev().take(4).any(|code| code.mnemonic == "movslq" && code.operands.contains(",4),"));
        of_addresses || of_offsets
    }

    fn place(&self, address: u64) -> Option<usize> {
        self.function.instructions.binary_search_by_key(&address, |instruction| instruction.address).ok()
    }
}

fn called<'a>(frame: &mut Frame<'a>, name: &'a str, bytes: u64) {
    let most = frame.calls.entry(name).or_default();
    *most = bytes.max(*most);
}

/// The state after an instruction; `None` where it does something else to the stack pointer.
fn moved<'a>(code: &Instruction<'a>, before: &State<'a>) -> Option<State<'a>> {
    let Instruction { mnemonic, operands, .. } = *code;
    let State { bytes, base, probed, .. } = *before;
    let by = |bytes: u64| State { bytes, base, probed, pointers: pointers_after(code, before) };
    Some(match (mnemonic, operands) {
        ("push", _) => by(bytes + 8),
        ("pop", "%rsp") => return None,
        ("pop", _) => by(bytes.checked_sub(8)?),
        ("leave", _) => by(base.checked_sub(8)?),
        ("mov", "%rsp,%rbp") => State { base: bytes, ..by(bytes) },
        ("mov", "%rbp,%rsp") => by(base),
        // a frame of many pages is touched page after page, down to here
        ("lea", _) if operands.ends_with("(%rsp),%r11") => State { probed: Some(down(bytes, operands)?), ..by(bytes) },
        ("mov", "%rsp,%r11") => State { probed: Some(bytes), ..by(bytes) },
        ("sub", _) if operands.ends_with(",%r11") && probed.is_some() => {
            State { probed: Some(probed?.checked_add_signed(number(operands)?)?), ..by(bytes) }
        }
        ("cmp", "%r11,%rsp") if probed.is_some() => by(probed?),
        ("lea", _) if operands.ends_with("(%rsp),%rsp") => by(down(bytes, operands)?),
        ("lea", _) if operands.ends_with("(%rbp),%rsp") => by(down(base, operands)?),
        ("sub", _) if operands.ends_with(",%rsp") => by(bytes.checked_add_signed(number(operands)?)?),
        ("add", _) if operands.ends_with(",%rsp") => by(bytes.checked_add_signed(-number(operands)?)?),
        // rounded down to a multiple of a power of two: at most so much, as the stack is aligned to 8 already
        ("and", _) if operands.ends_with(",%rsp") => by(bytes + number(operands)?.unsigned_abs().checked_sub(8)?),
        ("cmp" | "test" | "call" | "jmp", _) => by(bytes),
        _ if operands.ends_with(",%rsp") => return None,
        _ => by(bytes),
    })
}

/// The registers that point to functions of the C library, after an instruction that may write others.
fn pointers_after<'a>(code: &Instruction<'a>, before: &State<'a>) -> BTreeMap<char, &'a str> {
    let mut pointers = before.pointers.clone();
    let registers = code.operands.split(',').map(register);
    match code.mnemonic {
        "cmp" | "test" | "push" => {}
        // a call preserves the registers that the callee has to preserve
        "call" => pointers.retain(|register, _| "bp".contains(*register) || ('C'..='F').contains(register)),
        // registers that these write without naming them
        "mul" | "imul" | "div" | "idiv" if !code.operands.contains(',') => {
            pointers.retain(|register, _| !"ad".contains(*register))
        }
        "cqto" | "cltd" => pointers.retain(|register, _| *register != 'd'),
        "movs" | "movsb" | "movsq" | "stos" | "stosb" | "stosq" => {
            pointers.retain(|register, _| !"acst".contains(*register))
        }
        "xchg" | "xadd" | "cmpxchg" => {
            registers.flatten().chain(['a']).for_each(|written| {
                pointers.remove(&written);
            });
        }
        _ => {
            if let Some(written) = registers.last().flatten() {
                let copied = code
                    .operands
                    .split(',')
                    .next()
                    .and_then(register)
                    .and_then(|read| before.pointers.get(&read).copied());
                let pointed = copied.or(code.symbol.filter(|name| name.contains("@GLIBC")));
                match pointed.filter(|_| code.mnemonic == "mov") {
                    Some(name) => pointers.insert(written, name),
                    None => pointers.remove(&written),
                };
            }
        }
    }
    pointers
}

/// The register of `*%r13`.
fn pointer(operands: &str) -> Option<char> {
    register(operands.strip_prefix('*')?)
}

/// One letter for each register, whatever part of it is meant. They are a, b, c, d, s, t, p for those with names, and
/// `8` to `F`.
fn register(operand: &str) -> Option<char> {
    let name = operand.split_whitespace().next()?.strip_prefix('%')?;
    let digits = name.strip_prefix('r').map(|rest| rest.trim_end_matches(['d', 'w', 'b']));
    if let Some(number) = digits.and_then(|digits| digits.parse::<u32>().ok()) {
        return char::from_digit(number, 16).map(|digit| digit.to_ascii_uppercase());
    }
    match name.trim_start_matches(['r', 'e']) {
        "ax" | "al" | "ah" => Some('a'),
        "bx" | "bl" | "bh" => Some('b'),
        "cx" | "cl" | "ch" => Some('c'),
        "dx" | "dl" | "dh" => Some('d'),
        "si" | "sil" => Some('s'),
        "di" | "dil" => Some('t'),
        "bp" | "bpl" => Some('p'),
        _ => None,
    }
}

/// How far below the stack pointer an operand lies: a function that calls none may use 128 bytes there.
fn beyond(operands: &str) -> u64 {
    let place = operands.split_once("(%rsp").and_then(|(before, _)| before.rsplit(['$', ',', ' ', '*']).next());
    place.and_then(hexadecimal).filter(|offset| *offset < 0).map_or(0, i64::unsigned_abs)
}

/// The depth at `-0x40(%register)`, of a register that points to a depth.
fn down(bytes: u64, operands: &str) -> Option<u64> {
    let (offset, _) = operands.split_once('(')?;
    bytes.checked_add_signed(-hexadecimal(offset)?)
}

/// `$0x40` in front.
fn number(operands: &str) -> Option<i64> {
    hexadecimal(operands.strip_prefix('$')?.split(',').next()?)
}

/// A number with its sign, or as 64 bits.
fn hexadecimal(text: &str) -> Option<i64> {
    match text.strip_prefix("-0x") {
        Some(digits) => i64::from_str_radix(digits, 16).ok().map(|value| -value),
        None => u64::from_str_radix(text.strip_prefix("0x")?, 16).ok().map(u64::cast_signed),
    }
}

#[cfg(test)]
mod tests {
    use super::{Frame, of};
    use crate::assembly::functions;
    use std::collections::BTreeMap;

    /// The frame of a function of these instructions, one every 16 bytes from 0x1000.
    fn frame(instructions: &[&'static str]) -> Result<(u64, BTreeMap<String, u64>), String> {
        let lines = instructions.iter().enumerate().map(|(i, line)| format!("    {:x}:\t{line}\n", 0x1000 + 16 * i));
        let text = format!("0000000000001000 <f>:\n{}", lines.collect::<String>());
        let Frame { bytes, calls } = of(&functions(&text)[0])?;
        Ok((bytes, calls.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect()))
    }

    fn calls(calls: &[(&str, u64)]) -> BTreeMap<String, u64> {
        calls.iter().map(|(name, bytes)| ((*name).to_owned(), *bytes)).collect()
    }

    #[test]
    fn pushes_and_locals_are_added_and_calls_push_an_address() {
        let code = ["push %rbx", "sub $0x40,%rsp", "call 2000 <g>", "add $0x40,%rsp", "pop %rbx", "ret"];
        assert_eq!(frame(&code), Ok((0x48, calls(&[("g", 0x50)]))));
    }

    #[test]
    fn what_lies_below_the_stack_pointer_counts() {
        assert_eq!(
            frame(&["push %rbx", "movsd %xmm0,-0x40(%rsp)", "mov -0x10(%rsp),%rax", "ret"]),
            Ok((0x48, calls(&[])))
        );
        assert_eq!(frame(&["mov 0x40(%rsp),%rax", "ret"]), Ok((0, calls(&[]))));
    }

    #[test]
    fn a_tail_call_starts_where_the_function_did() {
        let code = ["sub $0x40,%rsp", "add $0x40,%rsp", "jmp 2000 <g>"];
        assert_eq!(frame(&code), Ok((0x40, calls(&[("g", 0)]))));
    }

    #[test]
    fn code_behind_a_return_has_the_depth_of_the_jump_to_it() {
        let code = ["push %rbx", "jne 1040 <f+0x40>", "pop %rbx", "ret", "call 2000 <g>", "jmp 1020 <f+0x20>"];
        assert_eq!(frame(&code), Ok((8, calls(&[("g", 16)]))));
    }

    #[test]
    fn pages_are_counted_once_where_a_loop_touches_them() {
        let by_address = ["lea -0x3000(%rsp),%r11", "nop"];
        let by_difference = ["mov %rsp,%r11", "sub $0x3000,%r11"];
        for [first, second] in [by_address, by_difference] {
            let touched =
                ["sub $0x1000,%rsp", "movq $0x0,(%rsp)", "cmp %r11,%rsp", "jne 1030 <f+0x30>", "sub $0x18,%rsp"];
            let rest = ["call 2000 <g>", "add $0x3018,%rsp", "pop %rbx", "ret"];
            let code = [&["push %rbx", first, second], &touched[..], &rest].concat();
            assert_eq!(frame(&code), Ok((0x3020, calls(&[("g", 0x3028)]))));
        }
    }

    #[test]
    fn an_aligned_frame_counts_what_alignment_may_take() {
        let code = [
            "push %rbp",
            "mov %rsp,%rbp",
            "and $0xffffffffffffffe0,%rsp",
            "sub $0x60,%rsp",
            "call 2000 <g>",
            "mov %rbp,%rsp",
            "pop %rbp",
            "ret",
        ];
        // 8 of the push, 24 of the alignment
        assert_eq!(frame(&code), Ok((8 + 24 + 0x60, calls(&[("g", 8 + 24 + 0x60 + 8)]))));
    }

    #[test]
    fn the_targets_of_a_table_have_the_depth_of_the_jump() {
        let code = [
            "push %rbx",
            "movslq (%rcx,%rax,4),%rax",
            "add %rcx,%rax",
            "jmp *%rax",
            "call 2000 <g>",
            "pop %rbx",
            "ret",
        ];
        assert_eq!(frame(&code), Ok((8, calls(&[("g", 16)]))));
    }

    #[test]
    fn so_have_those_of_a_table_of_addresses() {
        let code = ["push %rbx", "jmp *0xe04760(,%rax,8)", "call 2000 <g>", "pop %rbx", "ret"];
        assert_eq!(frame(&code), Ok((8, calls(&[("g", 16)]))));
    }

    #[test]
    fn functions_of_the_c_library_are_called_through_registers_while_they_keep_them() {
        let load = "mov 0x10(%rip),%r13        # 3000 <memcpy@GLIBC_2.14>";
        let code = [load, "mov %rax,%rdi", "call *%r13", "mov %r13,%rax", "call *%rax", "jne 1000 <f>", "ret"];
        assert_eq!(frame(&code), Ok((0, calls(&[("memcpy@GLIBC_2.14", 8)]))));
        for write in ["mov %eax,%r13d", "pop %r13", "xchg %rax,%r13"] {
            assert!(
                frame(&["push %r13", load, write, "call *%r13", "ret"])
                    .is_err_and(|error| error.contains("a call of a pointer"))
            );
        }
        // saved on one branch only
        let code = ["je 1020 <f+0x20>", load, "call *%r13", "ret"];
        assert!(frame(&code).is_err_and(|error| error.contains("a call of a pointer")));
    }

    #[test]
    fn what_is_not_understood_is_an_error() {
        let is_error = |code: &[&'static str], what: &str| frame(code).is_err_and(|error| error.contains(what));
        assert!(is_error(&["call *%rax", "ret"], "a call of a pointer"));
        assert!(is_error(&["jmp *0x18(%rax)"], "a jump to a pointer"));
        assert!(is_error(&["jmp *%rax"], "a jump to a pointer"));
        assert!(is_error(&["sub %rax,%rsp", "ret"], "not understood"));
        assert!(is_error(&["jne 1020 <f+0x20>", "push %rbx", "ret"], "two depths"));
    }
}
