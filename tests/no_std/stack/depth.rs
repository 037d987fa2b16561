//! The deepest path from each function.

use super::frame::Frame;
use std::collections::BTreeMap;

/// Functions of the C library without a frame of their own.
const MEMORY: [&str; 5] = ["memcpy", "memmove", "memset", "memcmp", "bcmp"];

/// The stack that functions take, with all that they call.
#[derive(Debug)]
pub struct Depths<'a>(BTreeMap<&'a str, Depth<'a>>);

/// Bytes below the address that the caller has pushed, and the call that they are taken by.
#[derive(Clone, Copy, Debug)]
struct Depth<'a> {
    bytes: u64,
    own: u64,
    deepest: Option<&'a str>,
}

impl<'a> Depths<'a> {
    /// Those of functions with these frames.
    ///
    /// # Errors
    /// Where functions call each other in a circle, or something that is not in the program.
    pub fn of(frames: &BTreeMap<&'a str, Frame<'a>>) -> Result<Self, String> {
        let mut depths = Self(BTreeMap::new());
        for name in frames.keys() {
            depths.add(frames, name, &mut Vec::new())?;
        }
        Ok(depths)
    }

    fn add(
        &mut self,
        frames: &BTreeMap<&'a str, Frame<'a>>,
        name: &'a str,
        callers: &mut Vec<&'a str>,
    ) -> Result<u64, String> {
        if let Some(known) = self.0.get(name) {
            return Ok(known.bytes);
        }
        if callers.contains(&name) {
            return Err(format!("stack: a recursion has no bound: {} → {name}", callers.join(" → ")));
        }
        let Some(frame) = frames.get(name).filter(|_| !is_memory(name)) else {
            return if is_memory(name) { Ok(0) } else { Err(format!("stack: {name} is not in the program")) };
        };
        callers.push(name);
        let mut depth = Depth { bytes: frame.bytes, own: frame.bytes, deepest: None };
        for (&called, &bytes) in &frame.calls {
            let bytes = bytes + self.add(frames, called, callers)?;
            if bytes > depth.bytes {
                depth = Depth { bytes, deepest: Some(called), ..depth };
            }
        }
        callers.pop();
        self.0.insert(name, depth);
        Ok(depth.bytes)
    }

    /// The stack of a call of a function, the address that is pushed with it.
    pub fn bytes(&self, name: &str) -> Option<u64> {
        self.0.get(name).map(|depth| depth.bytes + 8)
    }

    /// The deepest path from a function: for each its total stack, its own frame and its name.
    pub fn path(&self, name: &str) -> String {
        let mut text = String::new();
        let mut next = self.0.get_key_value(name);
        while let Some((name, depth)) = next {
            text += &format!("{:8} {:8} {name}\n", depth.bytes + 8, depth.own);
            next = depth.deepest.and_then(|deepest| self.0.get_key_value(deepest));
        }
        text
    }
}

/// `memcpy`, `memcpy@plt` and `memcpy@GLIBC_2.14`.
fn is_memory(name: &str) -> bool {
    name.split('@').next().is_some_and(|name| MEMORY.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::{Depths, Frame};
    use std::collections::BTreeMap;

    fn frame<'a>(bytes: u64, calls: &[(&'a str, u64)]) -> Frame<'a> {
        Frame { bytes, calls: calls.iter().copied().collect() }
    }

    #[test]
    fn the_deepest_path_is_not_that_of_the_largest_frame() {
        let frames = BTreeMap::from([
            ("root", frame(32, &[("large", 16), ("deep", 40)])),
            ("large", frame(100, &[])),
            ("deep", frame(16, &[("leaf", 24)])),
            ("leaf", frame(64, &[("memcpy@plt", 72)])),
        ]);
        let depths = Depths::of(&frames).expect("no recursion");
        // 40 + 24 + 72, and the address of root's caller
        assert_eq!(depths.bytes("root"), Some(144));
        assert_eq!(depths.path("root").lines().count(), 3);
    }

    #[test]
    fn a_circle_is_an_error() {
        let frames = BTreeMap::from([("a", frame(8, &[("b", 16)])), ("b", frame(8, &[("a", 16)]))]);
        assert!(Depths::of(&frames).is_err_and(|error| error.contains("recursion")));
    }

    #[test]
    fn so_is_what_is_not_in_the_program() {
        assert!(
            Depths::of(&BTreeMap::from([("a", frame(8, &[("malloc", 16)]))]))
                .is_err_and(|error| error.contains("malloc"))
        );
    }
}
