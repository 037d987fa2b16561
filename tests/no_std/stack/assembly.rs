//! The output of objdump for a program for x86-64, in the syntax of AT&T.

/// A function: its name as it stands in the file, and its instructions in their order.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Function<'a> {
    pub name: &'a str,
    pub instructions: Vec<Instruction<'a>>,
}

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction<'a> {
    pub address: u64,
    pub mnemonic: &'a str,
    pub operands: &'a str,
    /// The symbol that objdump writes behind, without an offset in it.
    pub symbol: Option<&'a str>,
}

impl Instruction<'_> {
    /// Where a jump goes, or a call, if that is written.
    pub fn target(&self) -> Option<u64> {
        u64::from_str_radix(self.operands.split_whitespace().next()?, 16).ok()
    }
}

/// The functions of a disassembly.
pub fn functions(text: &str) -> Vec<Function<'_>> {
    let mut functions = Vec::new();
    for line in text.lines() {
        if let Some(name) = header(line) {
            functions.push(Function { name, instructions: Vec::new() });
        } else if let (Some(function), Some(instruction)) = (functions.last_mut(), instruction(line)) {
            function.instructions.push(instruction);
        }
    }
    functions
}

/// The functions that other tools name, with their addresses: functions with the same code are one, under several names.
pub fn names(text: &str) -> Vec<(&str, u64)> {
    let name = |line: &'_ str| -> Option<(usize, u64)> {
        let mut words = line.split_whitespace();
        let address = u64::from_str_radix(words.next()?, 16).ok()?;
        let is_function = matches!(words.next()?, "T" | "t");
        let start = line.rfind(' ')? + 1;
        (is_function && words.next().is_some()).then_some((start, address))
    };
    text.lines().filter_map(|line| name(line).map(|(start, address)| (&line[start..], address))).collect()
}

/// `0000000000001000 <name>:`
fn header(line: &str) -> Option<&str> {
    let (address, name) = line.split_once(" <")?;
    u64::from_str_radix(address, 16).ok()?;
    name.strip_suffix(">:")
}

/// `    1000:\tcall   2000 <name>`, with prefixes such as `addr32`.
fn instruction(line: &str) -> Option<Instruction<'_>> {
    let (address, rest) = line.split_once(":\t")?;
    let address = u64::from_str_radix(address.trim(), 16).ok()?;
    let (mut mnemonic, mut operands) = word(rest);
    while matches!(mnemonic, "addr32" | "bnd" | "notrack" | "data16" | "cs" | "rep" | "repz" | "lock") {
        (mnemonic, operands) = word(operands);
    }
    let symbol = operands.split_once('<').and_then(|(_, symbol)| symbol.trim_end().strip_suffix('>'));
    Some(Instruction {
        address,
        mnemonic,
        operands,
        symbol: symbol.map(|symbol| symbol.split('+').next().unwrap_or(symbol)),
    })
}

fn word(text: &str) -> (&str, &str) {
    let text = text.trim();
    text.split_once(char::is_whitespace).map_or((text, ""), |(word, rest)| (word, rest.trim()))
}

#[cfg(test)]
mod tests {
    use super::{Instruction, functions, names};

    #[test]
    fn names_of_nm_are_read_and_instructions_are_not() {
        let text = "0000000000001000 T clebsch.step.heavy_top.f64\n                 U memcpy@GLIBC_2.14\n    1000:\tpush   %rbx\n";
        assert_eq!(names(text), [("clebsch.step.heavy_top.f64", 0x1000)]);
    }

    #[test]
    fn names_targets_and_symbols_are_read() {
        let text = "\
0000000000001000 <clebsch.step.heavy_top.f64>:
    1000:\tpush   %rbx
    1001:\taddr32 call 2000 <inner+0x10>
    1007:\tcall   *0x2fe2(%rip)        # 3ff0 <memcpy@GLIBC_2.14>
    100d:\tret
";
        let functions = functions(text);
        let [function] = functions.as_slice() else { panic!("one function") };
        assert_eq!(function.name, "clebsch.step.heavy_top.f64");
        let [push, call, pointer, ret] = function.instructions.as_slice() else { panic!("four instructions") };
        assert_eq!(*push, Instruction { address: 0x1000, mnemonic: "push", operands: "%rbx", symbol: None });
        assert_eq!((call.mnemonic, call.target(), call.symbol), ("call", Some(0x2000), Some("inner")));
        assert_eq!((pointer.target(), pointer.symbol), (None, Some("memcpy@GLIBC_2.14")));
        assert_eq!((ret.mnemonic, ret.operands), ("ret", ""));
    }
}
