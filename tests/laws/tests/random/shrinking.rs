//! From a problem that fails to a smaller one that fails in the same way.

use crate::formula::Formula;
use crate::problem::{Declared, Kinetic};

/// The smallest problem that `fails`, as far as leaving out one part after the other leads.
pub fn shrunk(problem: &Declared, fails: impl Fn(&Declared) -> bool) -> Declared {
    let mut smallest = problem.clone();
    while let Some(smaller) = smaller(&smallest).into_iter().find(&fails) {
        smallest = smaller;
    }
    smallest
}

/// The same problem with one part left out.
fn smaller(problem: &Declared) -> Vec<Declared> {
    let mut all = Vec::new();
    let mut with = |change: &dyn Fn(&mut Declared)| {
        let mut changed = problem.clone();
        change(&mut changed);
        all.push(changed);
    };
    if problem.potential.is_some() {
        with(&|problem| problem.potential = None);
    }
    if problem.order == 1 {
        with(&|problem| problem.order = 2);
    }
    for k in 0..problem.dials.len() {
        with(&|problem| {
            problem.dials.remove(k);
        });
    }
    for (k, closure) in problem.constraint.iter().enumerate() {
        for at in 0..closure.all.len() {
            with(&|problem| problem.without_equation((k, at)));
        }
    }
    for formula in problem.potential.iter().flat_map(parts) {
        with(&|problem| problem.potential = Some(formula.clone()));
    }
    match &problem.kinetic {
        Kinetic::Cost(cost) => {
            parts(cost).into_iter().for_each(|part| with(&|problem| problem.kinetic = Kinetic::Cost(part.clone())));
        }
        Kinetic::Lagrangian(lagrangian, discretization) => parts(lagrangian)
            .into_iter()
            .for_each(|part| with(&|problem| problem.kinetic = Kinetic::Lagrangian(part.clone(), *discretization))),
        // the cost would have to shrink with it
        Kinetic::MoserVeselov(..) => {}
    }
    all
}

/// The formula with one side of a sum or a factor of a product left out.
fn parts(formula: &Formula) -> Vec<Formula> {
    let Formula::Operator(sign, pair) = formula else { return Vec::new() };
    let [a, b] = &**pair;
    let rebuilt = |a: Formula, b: Formula| Formula::Operator(*sign, Box::new([a, b]));
    let left_out = match sign {
        '+' => vec![a.clone(), b.clone()],
        '-' => vec![a.clone()],
        '*' => vec![a.clone(), b.clone()],
        _ => Vec::new(),
    };
    let left = parts(a).into_iter().map(|a| rebuilt(a, b.clone()));
    let right = parts(b).into_iter().map(|b| rebuilt(a.clone(), b));
    left_out.into_iter().chain(left).chain(right).collect()
}
