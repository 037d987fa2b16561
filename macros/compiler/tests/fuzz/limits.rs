//! Texts that are too deep, too long or too large are refused at their place, on the small stack that tests have. The
//! message gives the replacement.

use std::fmt::Display;

use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::{Graph, WORK, compile};
use proc_macro2::Span;

use crate::verdict::verdict;

/// A potential on a particle.
fn potential(formula: impl Display) -> String {
    let kinetic = "action = |a: Translation<3>, x: Vector3| x + a, cost = |h, a| a.norm_squared() / (2 * h)";
    format!("#[clebsch({kinetic}, potential = |x| {formula})] pub struct P {{ pub s: f64 }}")
}

/// A body with this group that acts on itself.
fn group(group: impl Display) -> String {
    format!(
        "#[clebsch(action = |F: {group}, R: {group}| R * F, cost = |h, F| (F - I).norm_squared() / h)] pub struct P {{ pub s: f64 }}"
    )
}

/// A field of this type.
fn field(ty: impl Display) -> String {
    potential("self.f[0] * x.x").replace("pub s: f64", &format!("pub f: {ty}"))
}

/// A body with further tokens of the item.
fn item(before: &str, after: &str) -> String {
    let keys = "action = |F: SO<3>, R: SO<3>| R * F, lagrangian = |v| v.norm_squared() / 2, scalar = f64";
    format!("#[clebsch({keys})] {before} {after}")
}

fn nested(open: &str, inner: &str, close: &str, depth: usize) -> String {
    format!("{}{inner}{}", open.repeat(depth), close.repeat(depth))
}

/// A value that is put in its place again and again.
fn lets(step: &str, times: usize) -> String {
    format!("{{ let b = x.x; {} b }}", format!("let b = {step};").repeat(times))
}

/// The expected text of a verdict: a part of the message, or nothing where it is compiled.
#[rustfmt::skip]
fn table() -> Vec<(&'static str, String, Option<&'static str>)> {
    vec![
        // deep
        ("parentheses",            potential(nested("(", "x.x", ")", 10_000)),               Some("too deep to be read: brackets and operators nest")),
        ("parentheses that nest",  potential(nested("(", "x.x", ")", 30)),                   None),
        ("blocks",                 potential(nested("{", "x.x", "}", 10_000)),               Some("too deep")),
        ("tuples",                 potential(nested("(1, ", "x.x", ")", 60)),                Some("")),
        ("lists",                  potential(nested("[", "x.x", "]", 10_000)),               Some("too deep")),
        ("signs",                  potential(nested("- ", "x.x", "", 10_000)),               Some("too deep to be read: brackets")),
        ("some signs",             potential(nested("- ", "x.x", "", 30)),                   None),
        ("references",             potential(nested("&", "x.x", "", 10_000)),                Some("too")),
        ("negations",              potential(nested("! ", "x.x", "", 10_000)),               Some("too deep")),
        ("closures",               potential(nested("|y| ", "x.x", "", 10_000)),             Some("too deep")),
        ("conditions",             potential(nested("if s { 1 } else ", "{ 2 }", "", 1000)), Some("too deep")),
        ("blocks as keywords",     potential(nested("unsafe ", "{ 2 }", "", 1000)),          Some("too deep")),
        ("ranges",                 potential(nested("..", "x.x", "", 1000)),                 Some("too deep")),
        ("types in types",         field(nested("[", "f64", "; 9]", 1000)),                  Some("too deep")),
        ("arguments of types",     field(nested("Option<", "f64", ">", 1000)),               Some("too deep")),
        ("tuples of types",        field(nested("(f64, ", "f64", ")", 60)),                  Some("")),
        ("pointers",               field(nested("&", "f64", "", 5000)),                      Some("too")),
        ("bounds of a parameter",  item("pub struct P<T: ", &nested("A<", "B", ">", 1000)),  Some("too deep")),
        ("modules of a path",      potential(nested("a::", "b", "", 5000)),                  Some("too long")),
        ("patterns",               potential(format!("{{ let {} = 1; x.x }}", nested("(", "y", ")", 1000))), Some("too deep")),
        // long
        ("sums",                   potential(nested("x.x + ", "1", "", 100_000)),            Some("too long to be read")),
        ("methods",                potential(nested("x.x", ".sin()", "", 1) + &".sin()".repeat(10_000)), Some("too long")),
        ("some methods",           potential(nested("", "x.x", ".sin()", 150)),              None),
        ("indices",                potential(nested("", "x", "[0]", 1900)),                  Some("")),
        ("calls",                  potential(nested("", "x", "()", 1900)),                   Some("")),
        ("questions",              potential(nested("", "x", "?", 1900)),                    Some("")),
        ("conversions",            potential(nested("", "x", " as f64", 90)),                Some("")),
        ("products",               potential(nested("(x.x + 1) * ", "1", "", 190)),          None),
        ("statements",             potential(format!("{{ {} x.x }}", "let y = 1; ".repeat(20_000))), Some("too long")),
        ("squares of squares",     potential(format!("{{ let y = x.x + x.y; {} y }}", "let y = y * y + x.z; ".repeat(60))), Some("this expression grows too large")),
        ("a name",                 potential(format!("self.{}", "n".repeat(100_000))),       Some("cannot find")),
        ("fields",                 field(format!("f64, {}", (0..20_000).map(|k| format!("f{k}: f64, ")).collect::<String>())), Some("too long")),
        ("some fields",            field(format!("[f64; 2], {}", (0..3000).map(|k| format!("f{k}: f64, ")).collect::<String>())), None),
        ("keys",                   item(&"#[clebsch(order = 2)] ".repeat(1000), "pub struct P;"), Some("`order` is given twice")),
        ("functions of functions", potential(lets("b.sin()", 500)),                          None),
        ("some of them",           potential(lets("b.sin()", 100)),                          None),
        ("quotients of sums",      potential(lets("1 / (b + x.y)", 500)),                    Some("")),
        ("roots of sums",          potential(lets("(b + 1).sqrt()", 500)),                   Some("")),
        ("inverses of sums",       potential(format!("{{ let m = x * x.transpose(); {} m.trace() }}", "let m = (m + I).inverse();".repeat(400))), Some("")),
        // numbers
        ("a digit too many",       potential("x.x * 1e308"),                                 None),
        ("a small number",         potential("x.x * 1e-400"),                                None),
        ("a number without end",   potential("x.x * 1e999999999"),                           Some("this number is beyond the range of `f64`")),
        ("an exponent of 20 digits", potential("x.x * 1e99999999999999999999"),              Some("this number is beyond the range of `f64`")),
        ("a long number",          potential(format!("x.x * {}", "7".repeat(10_000))),       Some("this number is beyond the range of `f64`")),
        ("a long fraction",        potential(format!("x.x * 0.{}", "7".repeat(10_000))),     Some("this number is beyond the range of `f64`")),
        ("a hexadecimal number",   potential(format!("x.x * 0x{}", "f".repeat(10_000))),     Some("this number is beyond the range of `f64`")),
        ("a suffix",               potential("x.x * 1u8"),                                   Some("the suffix `u8` has no meaning here")),
        ("a large power",          potential("x.x.powi(2147483647)"),                        Some("an exponent of `powi` goes from -64 to 64")),
        ("the least power",        potential("x.x.powi(-2147483648)"),                       Some("an exponent of `powi` goes from -64 to 64")),
        ("a power out of i64",     potential("x.x.powi(18446744073709551616)"),              Some("")),
        ("a power of powers",      potential(nested("", "x.x", ".powi(64)", 4)),             Some("this expression grows too large")),
        ("a power of a number",    potential(nested("", "x.x * 3", ".powi(64)", 4)),         Some("this expression grows too large")),
        ("a large root",           potential("x.x.powf(1 / 1000000007)"),                    Some("this exponent has too many digits")),
        ("division by zero",       potential("x.x / 0"),                                     Some("")),
        ("a power of zero",        potential("x.x * 0.powi(-1)"),                            Some("")),
        ("an index",               potential("x[18446744073709551616]"),                     Some("")),
        ("a long range",           potential("(0..1000000000).map(|i| x.x).sum()"),          Some("")),
        ("ranges in ranges",       potential(nested("(0..60).map(|i| ", "x.x", ").sum()", 6)), Some("")),
        // sizes
        ("a large group",          group("SO<1000>"),                                        Some("the size 1000 is more than 128")),
        ("the largest size",       group("SO<18446744073709551615>"),                        Some("is more than 128")),
        ("a size above",           group("SO<18446744073709551616>"),                        Some("is more than 128")),
        ("a size of zero",         group("SO<0>"),                                           Some("a size of 0 leaves nothing")),
        ("a long translation",     group("Translation<100000>").replace("R * F", "R + F"),   Some("the size 100000 is more than 128")),
        ("groups of groups",       group("[[[SO<3>; 9]; 9]; 9]").replace("R * F", "R"),      Some("")),
        ("many factors",           group("[SO<3>; 16]").replace("R * F", "R"),               Some("")),
        ("a group of 2016",        group("SO<64>"),                                          Some("has 2016 dimensions, more than 128")),
        ("all matrices",           group("GL<64>"),                                          Some("has 4096 dimensions, more than 128")),
        ("rotations of 20",        group("SO<20>"),                                          Some("has 190 dimensions, more than 128")),
        ("a large matrix",         field("SMatrix<f64, 1000, 1000>"),                        Some("")),
        ("lists of lists",         field("[[[f64; 64]; 64]; 64]"),                           Some("")),
        // the item
        ("no keys",                "#[clebsch()] pub struct P;".into(),                      Some("`P` has no")),
        ("no attribute",           "pub struct P { a: f64 }".into(),                         Some("`P` has no `#[clebsch(…)]`")),
        ("no parentheses",         "#[clebsch] pub struct P;".into(),                        Some("the declaration stands in parentheses")),
        ("a value",                "#[clebsch = 1] pub struct P;".into(),                    Some("the declaration stands in parentheses")),
        ("an enum",                item("pub enum P { A, B }", ""),                          Some("and this is an enum")),
        ("a union",                item("pub union P { a: f64, b: f32 }", ""),               Some("and this is a union")),
        ("a tuple",                item("pub struct P(f64, f64);", ""),                      None),
        ("twice the same",         item("#[clebsch(scalar = f64)] pub struct P;", ""),       Some("`scalar` is given twice")),
        ("a raw name",             item("pub struct r#struct;", ""),                         None),
        ("a raw field",            potential("self.r#type * x.x").replace("pub s:", "pub r#type:"), None),
        ("a raw argument",         potential("r#x.x"),                                       None),
        ("Greek names",            potential("self.ω * x.x").replace("pub s:", "pub ω:"),      None),
        ("a lifetime",             item("pub struct P<'a> { pub name: &'a str }", ""),       None),
        ("a lifetime beside",      item("pub struct P<'a, T> { pub name: core::marker::PhantomData<&'a T> }", ""), None),
        ("a const parameter",      item("pub struct P<const N: usize> { pub s: [f64; N] }", ""), None),
        ("a const parameter of a group", group("SO<N>").replace("struct P", "struct P<const N: usize>"), Some("the const generic `N` as a size")),
        ("an empty closure",       item("pub struct P;", "").replace("|v| v.norm_squared() / 2", "|| {}"), Some("")),
        ("a closure without body", item("pub struct P;", "").replace("|v| v.norm_squared() / 2", "|v|"), Some("")),
        ("a closure of nothing",   item("pub struct P;", "").replace("|v| v.norm_squared() / 2", "|()| 1"), Some("")),
    ]
}

/// Each is refused with this message, or compiled; that none overflows the stack of a test is part of it.
#[test]
fn what_is_too_much_is_refused_at_its_place() {
    let mut failures = Vec::new();
    for (name, text, expected) in table() {
        // the part of a failure that is shown
        let shown: String = text.chars().take(200).collect();

        match (verdict(&text), expected) {
            (Ok(None), None) => {}
            (Ok(Some(errors)), Some(part)) if errors.to_string().contains(part) => {}
            (Ok(found), expected) => failures.push(format!(
                "{name}: expected {expected:?}, found {}\n{shown}",
                found.map_or("no error".into(), |errors| errors.to_string())
            )),
            (Err(failure), _) => failures.push(format!("{name}: {}", failure.chars().take(1000).collect::<String>())),
        }
    }
    assert!(failures.is_empty(), "{} failures\n\n{}", failures.len(), failures.join("\n\n"));
}

/// Bodies in four and in three dimensions in a chart whose derivatives are long: a declaration that exhausts the budget is refused
/// at its cost.
#[test]
fn what_exhausts_its_budget_is_refused_at_its_cost() {
    let cost = "((F - I).dot(&self.weight.component_mul(&(F - I))) + (G - I).norm_squared()) / (2 * h)";
    let action = "|(F, G): (SO<4>, SO<3>), (q, r): (SO<4>, SO<3>)| (q * F, r * G)";
    let keys = format!("action = {action}, cost = |h, (F, G)| {cost}, isotropy = free, chart = exponential");
    let text = format!("#[clebsch({keys})] pub struct Body {{ pub weight: SMatrix<f64, 4, 4> }}");
    let errors = compile(&Graph::new(), text.parse().expect("tokens")).err().expect("an error");
    let said = errors.to_string();
    assert!(said.starts_with("error: `Body` is too large to expand: "), "{said}");
    assert!(said.contains(&format!("more than {WORK} terms")), "{said}");
    assert!(said.contains("help: leave out `chart = exponential`: formulas in Cayley's are shorter"), "{said}");
    assert_within(&errors, &text, cost);
}

/// The tokens of the error stand within a part of the declaration.
fn assert_within(errors: &Diagnostics, text: &str, part: &str) {
    let start = text.find(part).expect("a part of the declaration");
    let places: Vec<_> = errors.to_compile_errors().into_iter().map(|token| token.span()).collect();
    let is_within = |place: &Span| place.start().column >= start && place.end().column <= start + part.len();
    assert!(places.iter().all(is_within), "{errors}");
}

/// A potential or a force that is too long is told at its place, and not at the cost, which is short.
#[test]
fn what_exhausts_the_budget_is_told_at_its_own_closure() {
    let long = lets("(b + self.s * x.y).sin()", 400);
    let factor = |k: usize| format!("({} * v.x + {} * v.y - {} * v.z + {k})", k + 1, k + 2, 2 * k + 1);
    let of_velocity = format!("{} * v", (0..30).map(factor).collect::<Vec<_>>().join(" * "));
    for (key, value, what) in [
        ("potential", format!("|x| {long}"), "this potential"),
        ("force", format!("|v| {of_velocity}"), "this force"),
        ("force_on", format!("|v| {of_velocity}"), "this force"),
    ] {
        let keys = format!(
            "action = |a: Translation<3>, x: Vector3| x + a, cost = |h, a| a.norm_squared() / (2 * h), {key} = {value}"
        );
        let text = format!("#[clebsch({keys})] pub struct P {{ pub s: f64 }}");
        let errors = compile(&Graph::new(), text.parse().expect("tokens")).err().expect("an error");
        let said = errors.to_string();
        assert!(
            said.starts_with(&format!(
                "error: `P` is too large to expand: the formulas of {what} take more than {WORK} terms"
            )),
            "{said}"
        );
        assert_within(&errors, &text, &value);
    }
}
