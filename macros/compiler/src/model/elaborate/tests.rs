//! Tables: an expression and its meaning, an expression and its mistake.

use super::super::slots::COST;
use clebsch_symbolic::{Graph, Property, Role, Shape, identity};

use super::super::typed::Arguments;
use super::super::value::Value;
use super::super::{arguments, fields};
use super::{Context, Elaborator};
use crate::diagnostic::Diagnostics;
use crate::parse::parse;

/// Elaborates an expression as the body of a cost `|h, (R, q, x, Q), (F, a)|` over a struct with fields of every kind.
fn elaborate(expression: &str) -> Result<String, Diagnostics> {
    with_value(expression, print)
}

fn with_value<R>(expression: &str, look: impl FnOnce(&Value) -> R) -> Result<R, Diagnostics> {
    let source = format!(
        "#[clebsch(
            action = |(F, a): (SO<3>, Translation<2>), (R, q, x, Q): (SO<3>, Unit<Vector3>, [Vector2; 2], Quaternion)| R,
            cost   = |h, (R, q, x, Q), (F, a)| {expression},
        )]
        struct Everything<const K: usize> {{
            mass: f64,
            center: Vector3<f64>,
            #[clebsch(symmetric)]
            inertia: Matrix3<f64>,
            wide: SMatrix<f64, 2, 3>,
            pair: [f64; 2],
            #[clebsch(unit)]
            axis: Vector3<f64>,
        }}"
    );
    let declaration = parse(source.parse().expect("the table holds Rust"))?;
    let graph = Graph::new();
    let diagnostics = Diagnostics::new();
    let fields = fields::read(&graph, &declaration, &[], None, &diagnostics);
    diagnostics.propagate(())?;
    let diagnostics = Diagnostics::new();
    let names =
        arguments::of_action(&declaration, arguments::ByNumber::Unrolled, &diagnostics).expect("two typed arguments");
    let symbol = |name, shape, role, property| Value::Matrix(graph.symbol(name, shape, role, property));
    let point = |index, name| symbol(name, Shape::vector(2), Role::Configuration(index), Property::General);
    let arguments = Arguments {
        names,
        element_value: Some(Value::Tuple(vec![
            symbol("F", Shape::square(3), Role::Element(0), Property::Orthogonal),
            symbol("a", Shape::vector(2), Role::Element(1), Property::General),
        ])),
        configuration_value: Some(Value::Tuple(vec![
            symbol("R", Shape::square(3), Role::Configuration(0), Property::Orthogonal),
            symbol("q", Shape::vector(3), Role::Configuration(1), Property::Unit),
            Value::Array(vec![point(2, "x[0]"), point(3, "x[1]")]),
            Value::Quaternion(graph.symbol("Q", Shape::vector(4), Role::Configuration(4), Property::General)),
        ])),
        members: Vec::new(),
        step_size: graph.symbol("h", Shape::scalar(), Role::StepSize, Property::General),
        time: graph.symbol("t", Shape::scalar(), Role::Time, Property::General),
        references: [None, None],
    };
    let closure = declaration.kinetic.closure();
    let scope = arguments.scope_of(closure, COST);
    let mut context = Context::new(&graph, &fields, &declaration.generics, None, &diagnostics);
    let value = Elaborator::new(&mut context, "cost", scope).elaborate(&closure.body);
    diagnostics.propagate(())?;
    Ok(look(&value.expect("a value, since there are no errors")))
}

/// The expressions of each line have equal values.
#[track_caller]
fn equals(table: &[(&str, &str)]) {
    let wrong: Vec<&str> =
        table.iter().filter(|(left, right)| !are_equal(left, right)).map(|(left, _)| *left).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

fn are_equal(left_text: &str, right_text: &str) -> bool {
    let verdict = with_value(&format!("({left_text}, {right_text})"), |value| {
        let Value::Tuple(pair) = value else { panic!("a pair is {}", value.describe()) };
        match (&pair[0], &pair[1]) {
            (Value::Matrix(left), Value::Matrix(right)) => identity::equal(&[*left], &[*right]),
            (Value::Quaternion(left), Value::Quaternion(right)) => identity::equal(&[*left], &[*right]),
            (left, right) => panic!("`{left_text}` is {} and `{right_text}` is {}", left.describe(), right.describe()),
        }
    });
    verdict.unwrap_or_else(|errors| panic!("{errors}"))
}

fn print(value: &Value) -> String {
    let all = |parts: &[Value]| parts.iter().map(print).collect::<Vec<_>>().join(", ");
    match value {
        Value::Matrix(expr) => expr.to_string(),
        Value::Identity(scale) => format!("{scale} of I"),
        Value::Quaternion(expr) => format!("quaternion {expr}"),
        Value::Tuple(parts) => format!("({})", all(parts)),
        Value::Array(parts) => format!("[{}]", all(parts)),
        other => other.describe(),
    }
}

/// The first line of the only error.
fn refusal(expression: &str) -> String {
    match elaborate(expression) {
        Ok(value) => format!("means {value}"),
        Err(errors) if errors.len() > 1 => errors.to_string(),
        Err(errors) => errors.to_string().lines().next().unwrap_or_default().trim_start_matches("error: ").to_string(),
    }
}

fn meaning(expression: &str) -> String {
    elaborate(expression).unwrap_or_else(|errors| errors.to_string())
}

/// All lines of a table that fail, with the actual result.
#[track_caller]
fn check(table: &[(&str, &str)], found: impl Fn(&str) -> String) {
    let differs = |(expression, expected): &(&str, &str)| {
        let found = found(expression);
        (found != *expected).then(|| format!("`{expression}`\n  found    {found}\n  expected {expected}"))
    };
    let wrong: Vec<String> = table.iter().filter_map(differs).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[track_caller]
fn means(table: &[(&str, &str)]) {
    check(table, meaning);
}

#[track_caller]
fn refuses(table: &[(&str, &str)]) {
    check(table, refusal);
}

#[test]
#[rustfmt::skip]
fn numbers_are_exact() {
    means(&[
        ("1 / 2",                  "1/2"),
        ("0.1",                    "1/10"),
        ("1e-3",                   "1/1000"),
        ("2.5E2",                  "250"),
        ("6.67e-11 * 1e11",        "667/100"),
        ("1_000.000_1",            "10000001/10000"),
        ("1 / 3 + 1 / 6",          "1/2"),
        ("2 * h",                  "2·h"),
        ("h * 3",                  "3·h"),
        ("-(-h)",                  "h"),
        ("7 % 3",                  "1"),
        ("2.powi(10)",             "1024"),
        ("4.sqrt() - 2",           "√(4) − 2"),
        ("PI",                     "π"),
        ("std::f64::consts::PI",   "π"),
        ("GRAVITY * crate::units::METRE", "GRAVITY·crate::units::METRE"),
    ]);
}

#[test]
#[rustfmt::skip]
fn the_identity_takes_the_size_that_fits() {
    means(&[
        ("F - I",                                    "F − I"),
        ("I - F",                                    "I − F"),
        ("2 * I - self.inertia",                     "2·I − inertia"),
        ("self.inertia.trace() / 2 * I - self.inertia", "tr(inertia)·I/2 − inertia"),
        ("I * q",                                    "q"),
        ("F * I",                                    "F"),
        ("(I / 2 + I) * F",                          "3·F/2"),
        ("2 * I",                                    "2 of I"),
        ("I.transpose() + F",                        "F + I"),
        ("(2 * I).inverse() + F",                    "F + I/2"),
        ("F.dot(&I)",                                "tr(F)"),
        ("self.inertia.component_mul(&I)",           "inertia ∘ I"),
        ("{ let twice = 2 * I; F - twice }",         "F − 2·I"),
    ]);
}

#[test]
#[rustfmt::skip]
fn products_and_parts() {
    means(&[
        ("R * F * self.center",                      "R·F·center"),
        ("q.transpose() * q",                        "1"),
        ("self.center.transpose() * q * h",          "h·centerᵀ·q"),
        ("self.wide * q",                            "wide·q"),
        ("self.wide.transpose() * x[0]",             "wideᵀ·x[0]"),
        ("(R * self.center).z",                      "(R·center)[2]"),
        ("self.center.x + self.center[1]",           "center[0] + center[1]"),
        ("R[(0, 2)]",                                "R[0, 2]"),
        ("x[1].y",                                   "x[1][1]"),
        ("x[(0 + 1) % 2]",                           "x[1]"),
        ("self.pair[1]",                             "pair[1]"),
        ("(q, x).1[0]",                              "x[0]"),
        ("&&F * &q",                                 "F·q"),
        ("self.center.xy()",                         "center[0..2]"),
        ("R.column(1)",                              "R[0..3, 1]"),
        ("R.row(2)",                                 "R[2, 0..3]"),
        ("R.fixed_view::<2, 2>(1, 0)",               "R[1..3, 0..2]"),
        ("self.center.fixed_rows::<2>(1)",           "center[1..3]"),
    ]);
}

#[test]
#[rustfmt::skip]
fn methods_and_functions() {
    means(&[
        ("F.transpose()",                            "Fᵀ"),
        ("F.inverse()",                              "Fᵀ"),
        ("F.determinant()",                          "1"),
        ("self.inertia.transpose()",                 "inertia"),
        ("self.inertia.symmetric_part()",            "inertia"),
        ("q.norm_squared()",                         "1"),
        ("self.axis.norm()",                         "1"),
        ("x[0].norm()",                              "√(x[0]ᵀ·x[0])"),
        ("q.dot(&self.center)",                      "qᵀ·center"),
        ("q.cross(&self.center)",                    "q^·center"),
        ("self.center.cross_matrix()",               "center^"),
        ("q.component_mul(&self.center)",            "center ∘ q"),
        ("F.trace()",                                "tr(F)"),
        ("h.sin() + h.ln() * h.exp()",               "sin(h) + ln(h)·exp(h)"),
        ("0.cos()",                                  "1"),
        ("h.powi(-2)",                               "1/h²"),
        ("h.powf(3 / 2)",                            "h^(3/2)"),
        ("h.recip()",                                "1/h"),
        ("self.mass.powf(h)",                        "exp(h·ln(mass))"),
    ]);
}

#[test]
#[rustfmt::skip]
fn sequences_and_blocks() {
    means(&[
        ("(0..2).map(|i| self.pair[i])",                  "[pair[0], pair[1]]"),
        ("(0..2).map(|i| self.pair[i] * x[i]).sum()",     "pair[0]·x[0] + pair[1]·x[1]"),
        ("(0..=2).map(|i| i).sum()",                      "3"),
        ("(0..0).map(|i| x[i]).sum()",                    "0"),
        ("x.map(|point| point.norm_squared()).sum()",     "x[0]ᵀ·x[0] + x[1]ᵀ·x[1]"),
        ("[h; 3].sum()",                                  "3·h"),
        ("(F, [q, q])",                                   "(F, [q, q])"),
        ("{ let a1 = h; let a1 = a1 * 2; a1 }",           "2·h"),
        ("{ let (u, v) = (h, 2); u + { let u = v; u } }", "h + 2"),
        ("{ let [u, v] = self.pair; u - v }",             "pair[0] − pair[1]"),
        ("{ let [u, [v, w]] = [h, [2, 3]]; u * v * w }",  "6·h"),
        ("vector![h, 2, 3].y",                            "2"),
        ("vector![1, 2, 3]",                              "[1; 2; 3]"),
        ("matrix![h, 0; 0, 1]",                           "[h, 0; 0, 1]"),
        ("Vector3::new(h, 0, 1)",                         "[h; 0; 1]"),
        ("Matrix2::new(1, 2, 3, 4) * a",                  "[1, 2; 3, 4]·a"),
        ("Matrix3::identity() - F",                       "I − F"),
        ("SMatrix::<f64, 2, 2>::zeros() * a",             "0"),
        ("Matrix3::from_diagonal(&self.center)",          "diag(center)"),
        ("Matrix3::from_columns(&[Vector3::x(), Vector3::y(), Vector3::z()])", "I"),
        ("Matrix2::from_rows(&[x[0].transpose(), x[1].transpose()])", "[x[0]ᵀ[0, 0], x[0]ᵀ[0, 1]; x[1]ᵀ[0, 0], x[1]ᵀ[0, 1]]"),
    ]);
}

#[test]
#[rustfmt::skip]
fn quaternions() {
    means(&[
        ("Q.scalar()",                                   "Q[3]"),
        ("Q.imag()",                                     "Q[0..3]"),
        ("Q.w + Q.i + Q.j - Q.k",                        "Q[3] + Q[0] + Q[1] − Q[2]"),
        ("Quaternion::new(1, 2, 3, 4)",                  "quaternion [2; 3; 4; 1]"),
        ("Q.norm_squared()",                             "Qᵀ·Q"),
        ("Q.dot(&I)",                                    "Q[3]"),
    ]);
    equals(&[
        ("Quaternion::new(1, 2, 3, 4) * Quaternion::new(5, 6, 7, 8)",           "Quaternion::new(-60, 12, 30, 24)"),
        ("Quaternion::new(0, 1, 0, 0) * Quaternion::new(0, 0, 1, 0)",           "Quaternion::new(0, 0, 0, 1)"),
        ("Quaternion::new(0, 0, 0, 1) * Vector3::new(1, 2, 3)",                 "Vector3::new(-1, -2, 3)"),
        ("Quaternion::new(3, 0, 0, 3) * Vector3::new(1, 2, 3)",                 "Vector3::new(-2, 1, 3)"),
        ("Quaternion::new(1, 2, 3, 4).inverse() * Quaternion::new(1, 2, 3, 4)", "Quaternion::identity()"),
        ("Q * (Q * self.center)",                                               "(Q * Q) * self.center"),
        ("Q.conjugate() * (Q * self.center)",                                   "self.center"),
        ("(Q * Q.conjugate()).scalar()",                                        "Q.norm_squared()"),
        ("Quaternion::new(1, 2, 3, 4).conjugate() - I",                         "Quaternion::new(0, -2, -3, -4)"),
        ("2 * Quaternion::new(1, 2, 3, 4) / 4 * I",                             "Quaternion::new(1 / 2, 1, 3 / 2, 2)"),
        ("-Quaternion::identity()",                                             "Quaternion::new(-1, 0, 0, 0)"),
    ]);
    refuses(&[
        ("Q * F",                       "`Q` is a quaternion and `F` is 3x3: they cannot be multiplied"),
        ("q * Q",                       "`q` is 3x1 and `Q` is a quaternion: they cannot be multiplied"),
        ("Q + h",                       "`Q` is a quaternion and `h` is a scalar: they cannot be added"),
        ("h / Q",                       "`h` is a scalar and `Q` is a quaternion: they cannot be divided"),
        ("Q / 0",                       "`0` is zero: nothing can be divided by it"),
        ("Q.x",                         "the quaternion `Q` has no coordinate `x`"),
        ("Q.transpose()",               "`Q` is a quaternion and has no `transpose`"),
        ("Q.imag(2)",                   "`imag` has 0 arguments, not 1"),
        ("q.imag()",                    "`q` is 3x1, but `imag` is of a quaternion"),
        ("Q.dot(&q)",                   "`Q` is a quaternion and `q` is 3x1: `dot` needs two of a kind"),
        ("Quaternion::new(1, 2, 3)",    "`Quaternion::new` has 4 coordinates, not 3"),
        ("Quaternion::from_imag(q)",    "unknown constructor `from_imag` of a quaternion"),
        ("F + Q",                       "`F` is 3x3 and `Q` is a quaternion: they cannot be added"),
        ("[Q, Q].sum()",                "`[Q, Q].sum()` is a quaternion, not a matrix or a scalar"),
    ]);
}

#[test]
#[rustfmt::skip]
fn shapes_that_do_not_fit() {
    refuses(&[
        ("F + q",                       "`F` is 3x3 and `q` is 3x1: they cannot be added"),
        ("F - h",                       "`F` is 3x3 and `h` is a scalar: they cannot be subtracted"),
        ("q * q",                       "`q` is 3x1 and `q` is 3x1: they cannot be multiplied"),
        ("q * F",                       "`q` is 3x1 and `F` is 3x3: they cannot be multiplied"),
        ("h / F",                       "`F` is 3x3: only scalars divide"),
        ("h / (h - h)",                 "`(h - h)` is zero: nothing can be divided by it"),
        ("h + I",                       "`I` is an identity matrix, but `h` is a scalar"),
        ("I + q",                       "`I` is square, but `q` is 3x1: they cannot be added"),
        ("I.trace()",                   "the size of `I` is not known here"),
        ("q.trace()",                   "`q` is 3x1, but `trace` is of a square matrix"),
        ("q.sin()",                     "`q` is 3x1, but `sin` is of a scalar"),
        ("q.dot(&a)",                   "`q` is 3x1 and `a` is 2x1: `dot` needs equal shapes"),
        ("a.cross(&a)",                 "`a` is 2x1 and `a` is 2x1: `cross` is of two vectors 3x1"),
        ("h.norm()",                    "`h` is a scalar: its norm has no derivative at 0"),
        ("a.z",                         "`a` is 2x1 and has no component `z`"),
        ("F.z",                         "`F` is 3x3: `.z` is a component of a vector"),
        ("F[1]",                        "`F` is 3x3: an entry has two indices"),
        ("x[2]",                        "the index 2 is out of range"),
        ("F[(0, 3)]",                   "the index 3 is out of range"),
        ("x[h]",                        "`h` is no index: an index is a whole number known here"),
        ("x * 2",                       "`x` is an array of 2 and cannot be multiplied"),
        ("Vector3::new(1, 2)",          "`Vector3::new` has 3 entries, not 2"),
        ("[h, q].sum()",                "the terms of `[h, q]` are 1x1 and 3x1: they cannot be added"),
    ]);
}

#[test]
#[rustfmt::skip]
fn names_that_are_not_known() {
    refuses(&[
        ("self.mas",                    "cannot find `mas` in the cost"),
        ("mass * h",                    "cannot find `mass` in the cost"),
        ("W * q",                       "cannot find `W` in the cost"),
        ("t",                           "cannot find `t` in the cost"),
        ("self",                        "`self` alone is no quantity"),
        ("self.energy(q)",              "the method `energy` of the struct in a formula is not supported yet"),
        ("energy(q)",                   "the function `energy` is not known in the cost"),
        ("h.abs()",                     "`abs` has no derivative at 0, so no cost can use it"),
        ("h.atan2(h)",                  "`atan2` has a jump, so no cost can use it"),
        ("h.sine()",                    "unknown method `sine` in the cost"),
        ("q.clone()",                   "unknown method `clone` in the cost"),
        ("println!(\"\")",              "unknown macro `println!` in the cost"),
        ("{ let h = 1; h }",            "`h` is reserved and cannot be the name of a `let`"),
        ("{ let F = 1; F }",            "`F` is an argument and cannot be redefined"),
        ("{ let [u, v, w] = self.pair; u }", "`[u, v, w]` does not fit an array of 2"),
        ("{ let [u, v] = (h, 2); u }",  "`[u, v]` does not fit a tuple of 2"),
        ("(0..2).map(|q| q).sum()",     "`q` is an argument and cannot be redefined"),
    ]);
}

#[test]
#[rustfmt::skip]
fn rust_that_is_no_mathematics() {
    refuses(&[
        ("1.5f32",                      "the suffix `f32` has no meaning here"),
        ("1u8",                         "the suffix `u8` has no meaning here"),
        ("\"text\"",                    "the only literals are numbers"),
        ("h as f64",                    "`as` cannot stand in the cost"),
        ("if h { h } else { h }",       "`if` cannot stand in the cost"),
        ("match h { _ => h }",          "`match` cannot stand in the cost"),
        ("h == h",                      "the operator `==` has no meaning in the cost"),
        ("h ^ 2",                       "the operator `^` has no meaning in the cost"),
        ("*h",                          "there is nothing to dereference"),
        ("&mut h",                      "`&mut` cannot stand in the cost"),
        ("{ h; }",                      "the block ends without a value"),
        ("{}",                          "this block is empty"),
        ("|x| x",                       "a closure cannot stand in the cost"),
        ("h(q)",                        "the function `h` is not known in the cost"),
        ("(-1).sqrt()",                 "`(-1).sqrt()` has no real value"),
        ("0.ln()",                      "`0.ln()` has no real value"),
        ("h.powi(h)",                   "`h` is no whole number known here"),
        ("h.powi(65)",                  "an exponent of `powi` goes from -64 to 64"),
        ("(0..K).map(|i| i).sum()",     "`K` is no index: an index is a whole number known here"),
    ]);
}

#[test]
#[rustfmt::skip]
fn whatever_grows_is_bounded() {
    let doubled = |step: &str, times: usize| {
        let lines: String = (0..times).map(|_| format!("let b = {step};")).collect();
        format!("{{ let b = 2 * h; {lines} b }}")
    };
    refuses(&[
        (&doubled("b * b", 60),                        "this expression grows too large"),
        (&doubled("b + b", 60),                        "this expression grows too large"),
        (&doubled("b.powi(64)", 12),                   "this expression grows too large"),
        (&doubled("b.powi(-64)", 12),                  "this expression grows too large"),
        (&doubled("b.sin()", 600),                     "this expression grows too large"),
        (&doubled("b.sqrt() + 1", 60),                 "this expression grows too large"),
        ("{ let b = q + self.center; let b = b.component_mul(&b); let b = b.component_mul(&b); let b = b.component_mul(&b); \
          let b = b.component_mul(&b); b.component_mul(&b) }", "this expression grows too large"),
        ("(0..1000000).map(|i| i).sum()",              "the range `0..1000000` has 1000000 terms, more than 4096"),
        ("(0..4000).map(|i| (0..4000).map(|j| i * j).sum()).sum()", "the cost has more than 100000 operations"),
        ("1e999",                                      "this number is beyond the range of `f64`"),
    ]);
    const TOO_DEEP: &str = "the declaration is too deep to be read: brackets and operators nest 41 levels deep, or fewer with long chains of operators on the way";
    let nested = format!("{}h{}", "(".repeat(70), ")".repeat(70));
    assert_eq!(refusal(&nested), TOO_DEEP);
    let signs = format!("{}h", "- ".repeat(200));
    assert_eq!(refusal(&signs), TOO_DEEP);
    let chain = format!("h{}", ".recip()".repeat(250));
    assert_eq!(refusal(&chain), "more than 200 operations inside each other");
    let long = format!("h{}", " + h".repeat(1500));
    assert_eq!(refusal(&long), "the declaration is too long to be read: more than 2000 tokens in one expression");
    means(&[(&format!("h{}", " + h".repeat(900)), "901·h")]);
}
