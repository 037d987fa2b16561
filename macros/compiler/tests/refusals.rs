//! A declaration that is too large is refused after bounded work, and a change of dials that the refusal offers is
//! accepted. Work is counted: a budget takes about a second in a crate of a user, where nothing is optimised. Searches for
//! fewer operations have an allowance of their own, which bounds them without a count.

use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::{Graph, WORK, compile, emit};
use clebsch_symbolic::work;

/// The most work of a refusal: that of the declaration, of others next to it, and of one operation beyond a limit.
const MOST: u64 = WORK + WORK / 6 + WORK / 50;

/// Numbers that look random.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }
}

/// A particle with keys that make it move.
fn particle(keys: &str) -> String {
    let kinetic = "action = |a: Translation<3>, x: Vector3| x + a, cost = |h, a| self.s * a.norm_squared() / (2 * h)";
    format!("#[clebsch({kinetic}, {keys})] struct P {{ s: f64, a: SVector<f64, 32>, b: SVector<f64, 32> }}")
}

/// The product of n linear factors, with numbers or with parameters in them.
fn product(n: u64, numbers: &mut Numbers) -> String {
    let has_parameters = numbers.below(2) == 0;
    let factor = |k| match has_parameters {
        true => format!("(self.a[{k}] * x.x + self.b[{k}] * x.y + {} * x.z + 1)", 1 + numbers.below(9)),
        false => format!("({} * x.x + {} * x.y - x.z + {k})", 1 + numbers.below(99), numbers.below(99)),
    };
    (0..n).map(factor).collect::<Vec<_>>().join(" * ")
}

/// A polynomial with so many terms.
fn polynomial(terms: u64, numbers: &mut Numbers) -> String {
    let term = |_| {
        let factors = (0..1 + numbers.below(8)).map(|_| ["x.x", "x.y", "x.z"][numbers.below(3) as usize]);
        let factors: Vec<&str> = factors.collect();
        format!("self.a[{}] * {}", numbers.below(32), factors.join(" * "))
    };
    (0..terms).map(term).collect::<Vec<_>>().join(" + ")
}

/// A function of a function, so deep.
fn nest(depth: u64, numbers: &mut Numbers) -> String {
    let steps = ["(b + self.s * x.y).sin()", "1 / (b + x.y)", "(b + x.z).cos() * self.s", "(b + 2 * x.y).exp()"];
    let step = steps[numbers.below(4) as usize];
    format!("{{ let b = x.x; {} b }}", format!("let b = {step};").repeat(depth as usize))
}

/// A metric on a group of so many dimensions that acts on itself.
fn metric(group: &str, dimension: usize, factor: &str, keys: &str) -> String {
    format!(
        "#[clebsch(action = |F: {group}, q: {group}| F * q, lagrangian = |q, w| w.dot(&(self.inertia * w)) / 2 * {factor}, {keys})]
        struct P {{ inertia: SMatrix<f64, {dimension}, {dimension}> }}"
    )
}

/// The affine-invariant metric of covariance matrices, times a factor.
fn covariance(n: usize, factor: &str, keys: &str) -> String {
    format!(
        "#[clebsch(action = |F: GL<{n}>, P: Symmetric<SMatrix<{n}, {n}>>| F * P * F.transpose(),
            lagrangian = |P, xi| {{
                let velocity = xi.matrix() * P + P * xi.matrix().transpose();
                (P.inverse() * velocity * P.inverse() * velocity).trace() / 2 * {factor}
            }}, {keys} scalar = f64)]
        struct P;"
    )
}

/// A body whose cost has a weight for each entry of F − I.
fn weighted(group: &str, n: usize, keys: &str) -> String {
    format!(
        "#[clebsch(action = |F: {group}, q: {group}| q * F, cost = |h, F| (F - I).dot(&self.weight.component_mul(&(F - I))) / (2 * h), {keys})]
        struct B {{ weight: SMatrix<f64, {n}, {n}> }}"
    )
}

/// Metrics and costs of groups.
fn groups() -> Vec<String> {
    let moving = "(1 + q[(0, 0)] * q[(0, 1)])";
    vec![
        metric("SL<3>", 8, moving, ""),
        metric("Sim<2>", 4, moving, "discretization = projection"),
        metric("SO<5>", 10, moving, "emit = [tangent]"),
        metric("U<3>", 9, moving, "discretization = projection"),
        metric("SO<4>", 6, "1", "chart = exponential"),
        covariance(3, "1", ""),
        covariance(4, "(1 + P[(0, 0)])", "discretization = projection,"),
        covariance(3, "(1 + P[(0, 0)])", "discretization = projection, order = 8,"),
        weighted("SO<4>", 4, "chart = exponential, isotropy = free"),
        "#[clebsch(action = |(F, G): (SO<4>, SO<3>), (q, r): (SO<4>, SO<3>)| (q * F, r * G),
            cost = |h, (F, G)| ((F - I).dot(&self.weight.component_mul(&(F - I))) + (G - I).norm_squared()) / (2 * h),
            chart = exponential)]
        struct B { weight: SMatrix<f64, 4, 4> }"
            .to_string(),
        weighted("U<2>", 4, "chart = exponential"),
        weighted("SO<5>", 5, "emit = [tangent]"),
    ]
}

/// Forces and potentials on a particle. Where `CLEBSCH_FUZZ` is set there are more of those that are made at random.
fn particles() -> Vec<String> {
    let is_long = std::env::var_os("CLEBSCH_FUZZ").is_some();
    let force = product(30, &mut Numbers(3)).replace("x.", "v.");
    let mut all = vec![particle(&format!("force = |v| ({force}) * v"))];
    for seed in 3..if is_long { 7 } else { 5 } {
        let product = product(14, &mut Numbers(seed));
        all.push(particle(&format!("potential = |x| {product}, emit = [tangent]")));
    }
    let mut numbers = Numbers(1);
    let mut potentials = vec![product(20, &mut numbers), nest(40, &mut numbers), nest(400, &mut numbers)];
    for _ in 0..if is_long { 3 } else { 1 } {
        let (n, terms, depth) = (8 + numbers.below(16), 10 + numbers.below(40), 5 + numbers.below(300));
        potentials.extend([product(n, &mut numbers), polynomial(terms, &mut numbers), nest(depth, &mut numbers)]);
    }
    for potential in potentials {
        let rest = ["", ", emit = [tangent]", ", order = 8"][numbers.below(3) as usize];
        all.push(particle(&format!("potential = |x| {potential}{rest}")));
        all.push(particle(&format!("potential = |x| {potential}, emit = [tangent]")));
    }
    all
}

/// The result of a declaration, with its work.
fn counted(declaration: &str) -> (Result<(), Diagnostics>, u64) {
    let (graph, before) = (Graph::new(), work::spent());
    let program = compile(&graph, declaration.parse().expect("Rust tokens"));
    let result = program.map(|program| drop(emit::emit(&program)));
    (result, work::spent() - before)
}

/// The declaration as the help of a refusal says.
fn helped(declaration: &str, help: &str) -> Option<String> {
    let changed = match help {
        _ if help.contains("leave `tangent` out of `emit`") => declaration.replace("emit = [tangent]", ""),
        _ if help.contains("leave out `chart`") => declaration.replace("chart = exponential", ""),
        _ if help.contains("write `order = 2`") => declaration.replace("order = 8", "order = 2"),
        _ if help.contains("write `discretization = exponential`") => {
            let plain = declaration.replace("discretization = projection", "");
            plain.replace("lagrangian =", "discretization = exponential, lagrangian =")
        }
        _ => return None,
    };
    // an empty key stands between two commas
    Some(changed.replace(", ,", ","))
}

#[test]
fn refusals_of_groups_take_bounded_work() {
    check(&groups());
}

#[test]
fn refusals_of_forces_and_potentials_take_bounded_work() {
    check(&particles());
}

fn check(declarations: &[String]) {
    let (mut refused, mut accepted, mut offered) = (0, 0, 0);
    let mut failures = Vec::new();
    for declaration in declarations {
        let (result, spent) = counted(declaration);
        let shown: String = declaration.chars().take(300).collect();
        let Err(errors) = result else {
            accepted += 1;
            continue;
        };
        refused += 1;
        let said = errors.to_string();
        if !said.contains("is too large") && !said.contains("grows too large") && !said.contains("has poles") {
            failures.push(format!("{said}\n{shown}"));
        }
        if spent > MOST {
            failures.push(format!("{spent} units of work, {MOST} is the most\n{shown}"));
        }
        for other in said.lines().filter_map(|help| helped(declaration, help)) {
            offered += 1;
            if let (Err(errors), _) = counted(&other) {
                failures.push(format!("{errors}\nafter the help of\n{said}\n{shown}"));
            }
        }
    }
    println!("{refused} refused, {accepted} accepted, {offered} offered");
    assert!(failures.is_empty(), "{} failures\n\n{}", failures.len(), failures.join("\n\n"));
    assert!(refused > 5 && accepted > 2 && offered > 2, "{refused} refused, {accepted} accepted, {offered} offered");
}
