//! The stack that each exported function of a linked program takes at most, from its disassembly.
//!
//! ```text
//! (nm PROGRAM; objdump -d --no-show-raw-insn PROGRAM) | stack table BUDGETS   the table; fails where a function takes more than its budget
//! (nm PROGRAM; objdump -d --no-show-raw-insn PROGRAM) | stack renew BUDGETS   writes the budgets anew
//! (nm PROGRAM; objdump -d --no-show-raw-insn PROGRAM) | stack path FUNCTION   the deepest path from a function
//! ```
//!
//! | file | from | to |
//! |---|---|---|
//! | `assembly` | text of objdump, for x86-64 | functions, instructions |
//! | `frame` | the instructions of a function | how deep the stack is at each of its calls |
//! | `depth` | functions that call each other | the deepest path from each |
//! | `table` | depths of exported functions | one line for each system, compared with its budgets |

mod assembly;
mod depth;
mod frame;
mod table;

use depth::Depths;
use std::collections::BTreeMap;
use std::io::Read;
use std::process::ExitCode;
use std::{env, fs, io};
use table::Table;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [command, argument] = arguments.as_slice() else {
        eprintln!("stack: give `table BUDGETS`, `renew BUDGETS` or `path FUNCTION`");
        return ExitCode::FAILURE;
    };
    match run(command, argument) {
        Ok(text) => {
            print!("{text}");
            ExitCode::SUCCESS
        }
        Err(reasons) => {
            eprintln!("{reasons}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: &str, argument: &str) -> Result<String, String> {
    let mut text = String::new();
    io::stdin().read_to_string(&mut text).map_err(|error| error.to_string())?;
    let functions = assembly::functions(&text);
    let frames = functions.iter().map(|function| Ok((function.name, frame::of(function)?)));
    let frames: BTreeMap<_, _> = frames.collect::<Result<_, String>>()?;
    let depths = Depths::of(&frames)?;
    let places = functions.iter().filter_map(|function| Some((function.instructions.first()?.address, function.name)));
    let places: BTreeMap<u64, &str> = places.collect();
    let names: BTreeMap<&str, &str> =
        assembly::names(&text).into_iter().filter_map(|(name, place)| Some((name, *places.get(&place)?))).collect();
    let own = |(name, code): (&&'_ str, &&str)| Some((name.strip_prefix("clebsch.")?.to_owned(), depths.bytes(code)?));
    let exported = || names.iter().filter_map(own);
    match command {
        "path" => Ok(depths.path(names.get(argument).copied().unwrap_or(argument))),
        "renew" => {
            fs::write(argument, Table::of(exported())?.budgets()).map_err(|error| format!("{argument}: {error}"))?;
            Ok(String::new())
        }
        _ => {
            let budgets = fs::read_to_string(argument).map_err(|error| format!("{argument}: {error}"))?;
            let table = Table::of(exported())?;
            print!("{table}");
            table.check(&Table::read(&budgets)?)?;
            Ok(format!("the largest: {}\n", table.largest()))
        }
    }
}
