//! Valid problems with one mistake: each is refused, with a message, at a place, and with a help or a note.

use crate::problem::{Declared, Kind, Kinetic};

/// The text of a declaration with a mistake, and the name of the mistake.
pub struct Mistake {
    pub name: &'static str,
    pub text: String,
}

/// Mistakes in the constraint of a problem, and a part of the help for each.
pub fn mistakes_in_constraint(problem: &Declared) -> Vec<(Mistake, &'static str)> {
    let text = problem.text();
    let Some((before, constraint)) = text.split_once("constraint = ") else { return Vec::new() };
    let mut found = Vec::new();
    let mut replaced = |name: &'static str, help: &'static str, old: &str, new: &str| {
        if constraint.contains(old) {
            let constraint = constraint.replacen(old, new, 1);
            found.push((Mistake { name, text: format!("{before}constraint = {constraint}") }, help));
        }
    };
    replaced("an inequality", "==", " == ", " <= ");
    replaced("an assignment", "==", " == ", " = ");
    replaced("equations that are joined", "separate equations by commas", " == ", " == 0 && 1 == ");
    replaced("no equation", "== 0", " == ", " + ");
    replaced("an unknown name", "", "v.x", "u.x");
    replaced("a velocity squared", "sums of components", "v.x)", "v.x * v.x)");
    replaced("a step", "", "| [", ", h| [");
    if problem.constraint.len() == 1 {
        replaced("another key", "constraint", "", "");
        let last = found.len() - 1;
        found[last].0.text = text.replacen("constraint =", "constraints =", 1);
    }
    found
}

/// All mistakes that this problem offers.
pub fn mistakes(problem: &Declared) -> Vec<Mistake> {
    let text = problem.text();
    let mut found = Vec::new();
    let mut replaced = |name: &'static str, old: &str, new: &str| {
        if text.contains(old) {
            found.push(Mistake { name, text: text.replacen(old, new, 1) });
        }
    };
    replaced("an unknown key", "action =", "acton =");
    replaced("an unknown field", "self.field_0", "self.field_9");
    replaced("an unknown argument", "potential = |", "potential = |xi, ");
    replaced("the step in a potential", "potential = |", "potential = |h, ");
    replaced("a name that is none", "action = |F: ", "action = |f: ");
    replaced("an unknown group", ": SO<", ": OS<");
    replaced("a group without its size", ": SU<2>,", ": SU,");
    replaced("a method that is none", ".trace()", ".tarce()");
    replaced("a method without a derivative", "potential = |q| ", "potential = |q| 1.5.floor() * ");
    replaced("a cost that forgot the step", " / (2 * h))", " / 2)");
    replaced("an order that is none", "order = 1", "order = 3");
    replaced("an unknown dial", "isotropy = free", "isotropy = loose");
    replaced("an unknown discretisation", "discretization = cayley", "discretization = caley");
    replaced("the metric of no matrix", "discretization = projection", "discretization = moser-veselov");
    replaced("two actions", "action =", "action = |F: SO<3>, q: SO<3>| q * F,\n    action =");
    replaced("a forgotten comma", ",\n    potential", "\n    potential");
    replaced("a closure that is none", "action = |", "action = ");
    replaced("a field of text", ": f64,", ": &'static str,");
    if problem.fields.len() > 1 {
        replaced("a field of another scalar", ": f64,", ": f32,");
    }
    if problem.leaves[0].start.entries().len() > 1 {
        replaced("a vector in place of a scalar", "potential = |q| ", "potential = |q| q * ");
    }
    if problem.factors.len() == 1 && problem.factors[0].group.kind == Kind::Matrix {
        let n = problem.factors[0].group.group.size();
        // F q F is an action where everything commutes, and for the identity alone on 1×1
        let commutes = problem.factors[0].group.group.basis.len() == 1;
        if problem.factors[0].group.name.starts_with(['S', 'G']) && !commutes {
            replaced("no action", "| (q * F)", "| (F * q * F)");
            replaced("no action", "| (F * q)", "| (q + F * q)");
        }
        replaced("another size", &format!("q: SVector<{n}>"), &format!("q: SVector<{}>", n + 1));
        replaced("a row for a vector", &format!("q: SVector<{n}>"), &format!("q: SMatrix<1, {n}>"));
    }
    if let Kinetic::Cost(_) = problem.kinetic {
        replaced("a cost without step", "cost = |h, F| ", "cost = |F| ");
        replaced("a cost and a Lagrangian", "cost = |", "lagrangian = |v| v.norm_squared(),\n    cost = |");
    }
    found
}
