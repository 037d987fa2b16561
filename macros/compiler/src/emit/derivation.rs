//! The constant `DERIVATION`: the derivation in words and formulas, what it costs, and what was left out and why.

use std::fmt::Write;

use clebsch_symbolic::{Chart, Group};

use crate::derive::{Collocation, Equation, MOST_LISTED, Solution, Structure, Substep};
use crate::lower::{Form, LARGEST_UNROLLED, MOST_UNKNOWNS, Program, Solve};
use crate::model::{CodeForm, Discretization, Isotropy, Kinetic, Model, Order, Side, Space};

/// The text of `DERIVATION`.
pub fn derivation(program: &Program<'_>) -> String {
    if program.formulas.model.is_steered() {
        return steered(program);
    }
    let mut text = String::new();
    let model = &program.formulas.model;
    // by construction: writing to a string does not fail
    let _ = write!(
        text,
        "{}\n\n{}{}{}{}{}\n{}{}\n{}\nFormulas\n\n{}\nCost\n\n{}",
        model.power.as_ref().map_or(&model.item, |power| &power.item).ident,
        sites(program),
        frames(model),
        energy(program),
        forces(program),
        conserved(program),
        scheme(program),
        form(program),
        left_out(program),
        program.formulas,
        costs(program),
    );
    text
}

/// How the code is written, and why.
fn form(program: &Program<'_>) -> String {
    let Form { code, estimate, is_asked, is_body_or_point, missing } = program.form;
    let written = match code {
        CodeForm::Unrolled => "Code is written out, entry by entry",
        CodeForm::Matrices => "Code keeps whole matrices, in loops",
    };
    let why = match (is_asked, code) {
        (true, _) => "as the declaration asks".to_string(),
        (false, CodeForm::Unrolled) if estimate > LARGEST_UNROLLED => match missing {
            Some(why) => format!("and {why} has no code with whole matrices"),
            None => "of few unknowns".to_string(),
        },
        (false, CodeForm::Unrolled) => format!("up to {LARGEST_UNROLLED}"),
        (false, CodeForm::Matrices) if estimate <= LARGEST_UNROLLED && is_body_or_point => {
            "and bodies in five dimensions or more and points on S⁷ or larger keep them at any number".to_string()
        }
        (false, CodeForm::Matrices) if estimate <= LARGEST_UNROLLED => {
            format!("and its momentum more than {MOST_UNKNOWNS} components")
        }
        (false, CodeForm::Matrices) => format!("more than {LARGEST_UNROLLED}"),
    };
    let is_pushed = program.formulas.substeps.iter().any(|substep| substep.start.is_some() || substep.end.is_some());
    let in_plane = match (program.turns_in_plane(), is_pushed) {
        (true, true) => {
            "Steps are made in q and w ⊥ q, which a state holds in place of its momentum M = wqᵀ − qwᵀ: q⁺ = cq + aw, w⁺ = cw − a|w|²q, a = h/κ, c² = 1 − a²|w|².\n"
        }
        (true, false) => {
            "A state holds two vectors of the plane in which it turns in place of its momentum M = vuᵀ − uvᵀ, which stays: q⁺ = cq + aw, w = Mq, a = h/κ, c² = 1 − a²|w|².\n"
        }
        (false, _) => "",
    };
    format!(
        "{in_plane}{written}: the matrices of a linearisation and of a move have about {estimate} products of entries, {why}.\n"
    )
}

/// What a power is.
fn sites(program: &Program<'_>) -> String {
    let Some(power) = &program.formulas.model.power else { return String::new() };
    let length = &power.length;
    let equal = match power.is_uniform {
        true => "all with the same kinetic energy, whose constants are made once",
        false => "whose kinetic energies differ, so that the constants of each are made in each step",
    };
    let (formulas, each) = match power.terms.len() {
        1 => ("a sum of one formula".to_string(), "it"),
        count => (format!("sums of {count} formulas"), "each"),
    };
    let added = match program.gathered.is_some() {
        true => "the gradient of a site is gathered from the terms that read it",
        false => "what a term has for its sites is added there",
    };
    let terms = match power.terms.is_empty() {
        true => "Nothing ties them to each other.".to_string(),
        false => format!(
            "They are tied to each other by the potential, {formulas}; {each} is differentiated once, and {added}, in loops: the code does not grow with {length}."
        ),
    };
    format!("A power: {length} sites, {equal}. What follows is said of one site.\n{terms}\n")
}

/// The text of a system whose configuration inputs move.
fn steered(program: &Program<'_>) -> String {
    let (model, formulas) = (&program.formulas.model, &program.formulas);
    let motion = match &model.kinetic {
        Kinetic::Controls { discretization: Discretization::Exponential, .. } => {
            "A step moves the configuration by F = exp(h ξ(u)), exact where the input stays as it is."
        }
        Kinetic::Controls { .. } => {
            "A step moves the configuration by F = (I − h/2 ξ(u))⁻¹(I + h/2 ξ(u)), of second order in h."
        }
        _ => "A step moves the configuration to f(t, h, q, u), by the translation F = f − q.",
    };
    let inputs: Vec<&str> = model.inputs.iter().map(|leaf| leaf.name.as_str()).collect();
    let bounds = match model.control.as_ref().map_or(0, |control| control.bounds.len()) {
        0 => String::new(),
        1 => " and keep one bound".to_string(),
        count => format!(" and keep {count} bounds"),
    };
    format!(
        "{}\n\n{}Inputs: {}; chosen are those of least price among all that reach the target{bounds}.\n{motion}\n\nFormulas\n\n{formulas}\nCost\n\n{}",
        model.item.ident,
        frames(model),
        inputs.join(", "),
        costs(program),
    )
}

/// Which frame momenta are in, factor by factor.
fn frames(model: &Model<'_>) -> String {
    let mut text = String::new();
    for factor in &model.factors {
        if !factor.moves {
            let _ = writeln!(
                text,
                "{} in {} moves no configuration; its cost is invariant under conjugation, so it has no side.",
                factor.name,
                factor.group.name(model.graph),
            );
            continue;
        }
        let (side, frame) = match factor.side {
            Side::Left => ("left", "spatial"),
            Side::Right => ("right", "body"),
        };
        let _ = writeln!(
            text,
            "{} in {} acts from the {side}: momenta and velocities are {frame}, in the basis of {}.",
            factor.name,
            factor.group.name(model.graph),
            factor.group.name(model.graph),
        );
    }
    text + "⟨A, E⟩ stands for the components tr(AᵀE_i); x^ for Σ x_i E_i; h for the step.\n"
}

/// The kinetic energy in coordinates, for a look at what the cost stands for.
fn energy(program: &Program<'_>) -> String {
    let formulas = &program.formulas;
    let names: Vec<String> = formulas
        .symbols
        .algebra
        .iter()
        .flat_map(|xi| (0..xi.shape().rows).map(move |i| format!("{xi}{}", subscript(i + 1))))
        .collect();
    let mut terms = String::new();
    let is_kept = program.form.keeps_matrices();
    for (i, first) in names.iter().enumerate().filter(|_| !is_kept) {
        for (j, second) in names.iter().enumerate().skip(i) {
            let Some(text) = program.energy_coefficient(i, j) else { continue };
            let square = if i == j { format!("{first}²") } else { format!("{first} {second}") };
            let text = if text == "1" { String::new() } else { format!("{} ", grouped(&text)) };
            let _ = write!(terms, "{}{text}{square}", if terms.is_empty() { "" } else { " + " });
        }
    }
    let to_second_order = if formulas.energy.general.is_some() { " to second order" } else { "" };
    let linear = if formulas.energy.gyroscopic.is_zero() { "" } else { ", and a part that is linear in the velocity" };
    let signature = match formulas.signature() {
        Some((_, 0)) => "positive definite for positive parameters".to_string(),
        Some((0, _)) => "negative definite for positive parameters".to_string(),
        Some((positive, negative)) => {
            format!(
                "indefinite, of signature ({positive}, {negative}) for positive parameters: extremals are no minima"
            )
        }
        None => "of a signature that depends on the parameters".to_string(),
    };
    let coordinates =
        if is_kept { String::new() } else { format!(" in these coordinates{to_second_order}: {terms}{linear}") };
    format!("Kinetic energy{coordinates}{} is {signature}.\n", if is_kept { "" } else { ". It" })
}

fn grouped(text: &str) -> String {
    if text.contains(' ') || text.starts_with('-') { format!("({text})") } else { text.to_string() }
}

fn subscript(index: usize) -> String {
    index.to_string().bytes().filter_map(|digit| char::from_u32('₀' as u32 + u32::from(digit - b'0'))).collect()
}

/// What forces take away.
fn forces(program: &Program<'_>) -> String {
    let model = &program.formulas.model;
    if model.force.is_none() {
        return String::new();
    }
    let mut text = String::from(
        "Forces act: half of h·f at each end of the step, with the velocity of the step at both (Lagrange–d'Alembert). \
         The step is not symplectic; the energy changes by the work of f, and the momenta that are conserved are those on which f does not act.\n",
    );
    if model.order == Order::First {
        text = text.replace("half of h·f at each end", "h·f at the end");
    }
    let joins = program
        .formulas
        .substeps
        .iter()
        .any(|substep| substep.force.as_ref().is_some_and(|force| force.start_moving.is_some()));
    if joins {
        text += "The part of f that depends on the velocity joins the momentum equation.\n";
    }
    if !model.inputs.is_empty() {
        let names: Vec<&str> = model.inputs.iter().map(|leaf| leaf.name.as_str()).collect();
        let _ = writeln!(text, "Input: {}; `step` takes none for zero, `step_with` takes one.", names.join(", "));
    }
    if let Some(control) = &model.control {
        let bounds = match control.bounds.len() {
            0 => "without bounds".to_string(),
            1 => "within one bound".to_string(),
            count => format!("within {count} bounds"),
        };
        let _ = writeln!(
            text,
            "`control` chooses inputs of least price {bounds}: the step is differentiated twice, by the multipliers of its momentum equation."
        );
    }
    text
}

/// What is conserved, and what is not known to be.
fn conserved(program: &Program<'_>) -> String {
    let symmetries = &program.formulas.symmetries;
    let mut text = String::new();
    let summed = if program.formulas.model.power.is_some() { ", summed over all sites" } else { "" };
    match symmetries.conserved.as_slice() {
        [first, .., last] if symmetries.conserved.len() > MOST_LISTED => {
            let (count, from, to) = (symmetries.conserved.len(), &first.name, &last.name);
            let _ = writeln!(text, "Conserved: {count} momenta, from that {from}{summed} to that {to}{summed}.");
        }
        few => few.iter().for_each(|momentum| {
            let _ = writeln!(text, "Conserved: the momentum {}{summed}.", momentum.name);
        }),
    }
    if symmetries.conserved.is_empty() {
        let known = if symmetries.undecided { " that could be proved" } else { "" };
        let _ = writeln!(text, "Conserved: no momentum{known}, for general values of the parameters.");
    }
    for sentence in for_any_axis(&symmetries.special) {
        let _ = writeln!(text, "Conserved too: the momentum {sentence}.");
    }
    if symmetries.undecided {
        text += "Not proved: whether more momenta are conserved; roots and functions are compared by their arguments alone.\n";
    }
    text
}

/// Sentences that say the same of e1, e2 and e3 become one of ek.
fn for_any_axis(sentences: &[String]) -> Vec<String> {
    let general =
        |sentence: &String| ["e1", "e2", "e3"].iter().fold(sentence.clone(), |text, axis| text.replace(axis, "ek"));
    let mut told: Vec<String> = Vec::new();
    for sentence in sentences {
        let alike = sentences.iter().filter(|other| general(other) == general(sentence)).count();
        let text = if alike == 3 { format!("{}, k = 1, 2, 3", general(sentence)) } else { sentence.clone() };
        if !told.contains(&text) {
            told.push(text);
        }
    }
    told
}

/// How sums are compensated.
const COMPENSATED: &str = "Sums are compensated: what rounding takes off q and N is kept beside them, and added in the next step, so that errors of rounding are those of the increments q⁺ − q and N⁺ − N.\n";

/// How a step goes and how accurate it is.
fn scheme(program: &Program<'_>) -> String {
    let model = &program.formulas.model;
    let second = if model.order == Order::First { Order::First } else { Order::Second };
    let order = match (second, program.formulas.parts) {
        (Order::First, _) => "First order as asked for: drift, then kick, −h·V at the end of the step.",
        (Order::Second, 1) if program.formulas.lagrangian.couples => {
            "The discrete Lagrangian is time-symmetric, ℓd(q, F; h) = −ℓd(Φ_F q, F⁻¹; −h), so the step is of second order. The cost couples configuration and group element: r(F) = T*∂_F K − J(q, ∂_q K) = N is solved, and N⁺ is the other trivialisation of ∂_F K."
        }
        (Order::Second, 1) if program.formulas.potential_energy.is_zero() && program.links.is_empty() => {
            "The discrete Lagrangian is time-symmetric, K(h, F) = −K(−h, F⁻¹), so the step is of second order."
        }
        (Order::Second, 1) => {
            "The discrete Lagrangian is time-symmetric, K(h, F) = −K(−h, F⁻¹), with −h/2·V at each end: half kick, drift, half kick, second order, one gradient a step."
        }
        _ => {
            "The discrete Lagrangian is not time-symmetric, ℓd(q, F; h) ≠ −ℓd(Φ_F q, F⁻¹; −h): half a step is composed with half a step of its adjoint, which is of second order and costs two solves."
        }
    };
    let mut text = format!("{order}\n");
    if program.formulas.stagger.is_some() {
        text += match (program.formulas.is_staggered, model.force.is_some()) {
            (true, _) => {
                "The momentum N is ahead of its configuration by half of that kick. Taken back by it, π = N − ½ J(q, ∂(U₁ − U₀)), it is that of the step of second order, \
                 half kick, drift, half kick: `synchronized` reads π, and `staggered_state` starts from it.\n"
            }
            (false, true) => {
                "`synchronized` takes back half of the kick of the potential alone; the motion stays of first order, as the force acts with the velocity before it.\n"
            }
            (false, false) => {
                "`synchronized` takes back half of that kick; the motion stays of first order, as the cost is not time-symmetric.\n"
            }
        };
    }
    if let Some(stages) = program.formulas.stages() {
        text += &format!(
            "{stages} such steps of sizes γ_i h, the same forwards and backwards and some of them negative, make a step of order {}{}.\n",
            model.order,
            if program.formulas.potential_energy.is_zero() { "" } else { "; kicks between them are merged" }
        );
    }
    if let Some(collocation) = &program.formulas.collocation {
        return collocated(program, collocation);
    }
    if let Some(splitting) = &program.formulas.splitting {
        text = split(model.order, splitting.has_gradient);
    }
    if program.formulas.is_exact && !program.links.is_empty() {
        text += "Between kicks a site moves exactly.\n";
    } else if program.formulas.is_exact {
        text = "No potential acts, and a step is the exact motion of the time h: there is no error in h.\n".to_string();
    }
    let mut told: Vec<String> = Vec::new();
    for (substep, kernels) in program.formulas.substeps.iter().zip(&program.steps).take(program.formulas.parts) {
        for (equation, solve) in substep.equations.iter().zip(&kernels.solves) {
            let names: Vec<&str> = equation.factors.iter().map(|&k| model.factors[k].name.as_str()).collect();
            told.push(format!(
                "The momentum equation for {} {}.\n",
                part(program, equation, &names),
                how(program, equation, solve)
            ));
        }
        if kernels.update.is_none() && !program.formulas.turns_whole() {
            told.push("Both trivialisations of ∂K agree, so the momentum does not change in the drift.\n".to_string());
        }
    }
    // both halves of a composed step tell the same
    let first = told.iter().enumerate().filter(|(position, line)| !told[..*position].contains(line));
    text.extend(first.map(|(_, line)| line.as_str()));
    if program.formulas.is_compensated() {
        text += COMPENSATED;
    }
    text += &spaces(program);
    text + &tolerance(program) + &iterations(program)
}

/// What keeps configurations on their spaces.
fn spaces(program: &Program<'_>) -> String {
    let is = |which: fn(&Space) -> bool| program.formulas.model.configurations.iter().any(|leaf| which(&leaf.space));
    let rotations = is(|space| matches!(space, Space::Group(group) if group.is_orthogonal()));
    let lengths = is(|space| matches!(space, Space::Unit | Space::Group(Group::UnitQuaternions)));
    let (what, how) = match (rotations, lengths) {
        (false, false) => return String::new(),
        (true, false) => ("orthogonal matrices", "by R(3I − RᵀR)/2 once |R(1, …, 1)|² is off N by 8Nε"),
        (false, true) => ("what has length one", "by q(3 − |q|²)/2 once |q|² is off by 8ε"),
        (true, true) => (
            "orthogonal matrices and what has length one",
            "by R(3I − RᵀR)/2 once |R(1, …, 1)|² is off N by 8Nε, by q(3 − |q|²)/2 once |q|² is off by 8ε",
        ),
    };
    format!("Rounding is taken off {what}, {how}: they stay there for any number of steps of (q, N).\n")
}

/// How much work a step may be.
fn iterations(program: &Program<'_>) -> String {
    let Some(iterations) = &program.formulas.model.iterations else { return String::new() };
    format!(
        "At most {} iterations for each momentum equation, as asked for; a step that needs more is an error.\n",
        iterations.value
    )
}

/// What an iteration that ends early leaves as it is, and what it does not.
fn tolerance(program: &Program<'_>) -> String {
    let Some(tolerance) = &program.formulas.model.tolerance else { return String::new() };
    let kept = program.formulas.conserved_by_any_element();
    let kept: Vec<&str> = kept.into_iter().map(|momentum| momentum.name.as_str()).collect();
    let kept = match kept.is_empty() {
        true => "No momentum is conserved to rounding".to_string(),
        false => format!("As N⁺ is Ad* of N, conserved to rounding all the same: the momentum {}", kept.join("; ")),
    };
    let ends_series = |solve: &Solve| solve.solution == Solution::FreeRotation;
    let (ends, x) = match program.steps.iter().flat_map(|step| &step.solves).any(ends_series) {
        true => ("Series of d end before terms that are below", "d"),
        false => ("Iterations end before a correction that is below", "x"),
    };
    format!(
        "{ends} {:e} of {x}, as asked for. F lies on its group whatever {x} is. {kept}. The energy and other momenta drift, as the step is not symplectic.\n",
        tolerance.value
    )
}

/// How a step of order 16 goes.
fn collocated(program: &Program<'_>, collocation: &Collocation<'_>) -> String {
    let mut text = String::from(
        "Hamilton's equations on T*Q, those of the continuous Clebsch problem, are collocated at the eight nodes of Gauss and Legendre: order 16, symplectic, and \
         what is quadratic in (q, p) is kept, the momenta of symmetries and the orbit of q among it. A step starts from a covector p with J(q, p) = N; N⁺ − N = J(q⁺, p⁺) − J(q, p).\n",
    );
    if collocation.is_affine {
        text += "The action moves the origin: J is affine in q.\n";
    }
    let most = program.formulas.model.iterations.as_ref().map_or(64, |iterations| iterations.value);
    text += match &program.formulas.model.tolerance {
        None => format!("Slopes are found by sweeps over all stages, {most} at most, until only rounding changes.\n"),
        Some(tolerance) => format!(
            "Slopes are found by sweeps over all stages, {most} at most, until the step changes by less than {:e} of q and p, as asked for: that much is missing to a symplectic step, and \
             energy, momenta and the orbit drift with it.\n",
            tolerance.value
        ),
    }
    .as_str();
    if program.formulas.is_compensated() {
        text += COMPENSATED;
    }
    text + &spaces(program)
}

/// How a splitting goes.
fn split(order: Order, has_gradient: bool) -> String {
    let (kicks, kind) = match (order, has_gradient) {
        (Order::Sixth, true) => (5, "with force gradients, of order (8, 6, 6) in V, V² and V³"),
        (_, true) => (4, "with force gradients at the nodes of Gauss and Legendre, of order (8, 4) in V and V²"),
        (Order::Sixth, false) => (10, "without force gradients, as the potential is opaque (Blanes and Moan)"),
        (_, false) => (6, "without force gradients, as the potential is opaque (Blanes and Moan)"),
    };
    format!(
        "The drift is exact, so drifts and kicks in turn make a step of order {order}: {kicks} kicks {kind}, the same forwards and backwards. A part a of the drift with the momentum μ is the whole drift with the momentum a μ.\n"
    )
}

/// The factors of an equation, with the components that are meant where it holds not all of them.
fn part<'g>(program: &Program<'g>, equation: &Equation<'g>, names: &[&str]) -> String {
    let formulas = &program.formulas;
    let whole: usize = equation.factors.iter().map(|&k| formulas.model.factors[k].group.dimension()).sum();
    let names = names.join(", ");
    if equation.residual.shape().rows == whole {
        return names;
    }
    format!("{names} in the coordinates {}", formulas.coordinates_of(equation))
}

/// How an equation is solved, and in which chart.
fn how(program: &Program<'_>, equation: &Equation<'_>, solve: &Solve) -> String {
    let formulas = &program.formulas;
    let cleared = equation.cleared;
    let chart = match formulas.symbols.charts[equation.factors[0]] {
        Chart::Cayley if cleared => {
            "the Cayley chart, denominators cleared by the congruence with I − x^ (I + x^ for a left action)"
        }
        Chart::Cayley => "the Cayley chart",
        Chart::Affine => "the chart F = I + x^ (coordinates of the second kind), in which it is a polynomial",
        Chart::Product if cleared => {
            "the chart of Cayley's map for the rotation and of the translation as it is, denominators cleared by the congruence with I − x^"
        }
        Chart::Product => "the chart of Cayley's map for the rotation and of the translation as it is",
        Chart::Sine => "the chart of the sine",
        Chart::Root => "the chart F = (I + x^) det(I + x^)^(−1/n), as the Cayley map leaves the group",
        Chart::Exponential if cleared => "the exponential chart, freed of dexp⁻¹ by dexp",
        Chart::Exponential => "the exponential chart",
        Chart::Identity => "the coordinates of the translation",
    };
    match equation.solution {
        Solution::Explicit if equation.formula.is_some() && formulas.is_solved_after_others(equation) => {
            format!("is linear in {chart}, given the other coordinates: they are put in, no iteration")
        }
        Solution::Explicit if equation.formula.is_some() && !equation.is_affine(&formulas.symbols) => {
            format!("is triangular in {chart}: solved by substitution, no iteration")
        }
        Solution::Explicit
            if equation.formula.is_none() && formulas.symbols.charts[equation.factors[0]] == Chart::Exponential =>
        {
            "is solved by the velocity itself, x = h Σ⁻¹μ, which commutes with the momentum: no iteration".to_string()
        }
        Solution::Explicit => format!("is linear in {chart}: solved explicitly, no iteration"),
        Solution::ClosedForm => {
            let coordinates = match formulas.symbols.charts[equation.factors[0]] {
                Chart::Sine => ", which is the length of x",
                _ => "",
            };
            format!(
                "is solved in closed form: the kinetic energy is bi-invariant, so the step turns one plane by θ, sin θ = h|μ|/Σ < 1{coordinates}"
            )
        }
        Solution::Linear => {
            format!("is linear in {chart}: solved by one elimination, no iteration")
        }
        Solution::FreeRotation if program.formulas.turns_whole() => {
            "is solved by the free motion itself: F̃J̃ − J̃F̃ᵀ = m = h̃μ with J̃² = D² + β, F = exp(δm + κ⋆m) F̃; the constants of a motion are found once, from its Taylor series, and travel along with the state; then NF̃ = G with N and G polynomials of m, one division a step, no iteration, and no error in h".to_string()
        }
        Solution::FreeRotation => {
            "is solved by the free motion itself: d x − m × x = m for the Gibbs vector x, m = h μ/2, with d = diag(d_i) in principal axes, power series in h² |μ|² and h² μ·Σ⁻¹μ that are made once for the body; no iteration, and no error in h".to_string()
        }
        Solution::Newton if solve.residual.is_some() => format!(
            "is solved by the fixed-point iteration x ← x − s h Σ⁻¹ρ(x) in {chart}, s = dx/dξ, which contracts like h|ω|; by Newton's method \
             where it leaves more than a quarter of a correction{}",
            structure(&solve.structure)
        ),
        Solution::Newton => format!("is solved by Newton's method in {chart}{}", structure(&solve.structure)),
    }
}

/// What its linear systems make use of.
fn structure(structure: &Structure) -> String {
    match structure {
        Structure::Dense => String::new(),
        Structure::Symmetric => "; its Jacobian is symmetric, LDLᵀ where it is definite".to_string(),
        Structure::Triangular(blocks) => {
            let sizes: Vec<String> = blocks.iter().map(|block| block.len().to_string()).collect();
            format!("; its Jacobian is block triangular, with blocks of {} unknowns", sizes.join(", "))
        }
        Structure::Sylvester(n) => {
            format!("; its linear systems are Sylvester's equations, by the Schur form of {n}×{n} matrices")
        }
    }
}

/// What this problem does not need, and what was not proved.
fn left_out(program: &Program<'_>) -> String {
    let formulas = &program.formulas;
    let mut text = String::new();
    if formulas.potential_energy.is_zero() && formulas.links.is_empty() {
        text += "Left out: the kick, as there is no potential.\n";
    }
    if formulas.model.emit.momentum {
        text += "Left out, as asked for by `emit = [momentum]`: the configuration. A step solves for F and carries the momentum along.\n";
    } else if formulas.model.isotropy == Isotropy::Free && !formulas.is_free {
        text += "Left out, as asked for by `isotropy = free`: the check of 𝔤_q^⊥; motions that fix the configuration are motions too.\n";
    } else if formulas.is_free {
        text += "Left out: the check of 𝔤_q^⊥, as only the identity fixes a general configuration.\n";
    } else {
        text += "Some motions fix the configuration: state() demands momenta in 𝔤_q^⊥.\n";
    }
    let uncouples = |substep: &Substep<'_>| {
        let alone = substep.equations.iter().filter(|equation| !formulas.is_solved_after_others(equation));
        alone.count() > 1
    };
    if formulas.substeps.iter().all(uncouples) {
        text += "The momentum equation uncouples: one small solve for each part.\n";
    }
    text
}

/// The operations of each kernel.
fn costs(program: &Program<'_>) -> String {
    let kernels = program.kernels();
    let width = kernels.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    kernels.iter().map(|(name, kernel)| format!("{name:width$}  {}\n", kernel.cost())).collect()
}
