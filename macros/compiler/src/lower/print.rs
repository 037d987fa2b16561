//! The program as text: each kernel with its operation counts and its code.

use std::fmt;

use clebsch_symbolic::{Analytic, integer};

use crate::derive::Solution;

use super::{Callee, Code, Cost, Input, Kernel, MatrixOperation, Program, VariationKernels, Whole};

impl Cost {
    /// The sum of two costs.
    pub fn plus(self, other: Cost) -> Cost {
        Cost {
            additions: self.additions + other.additions,
            multiplications: self.multiplications + other.multiplications,
            divisions: self.divisions + other.divisions,
            roots: self.roots + other.roots,
            calls: self.calls + other.calls,
        }
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            (self.additions, "+"),
            (self.multiplications, "×"),
            (self.divisions, "÷"),
            (self.roots, "√"),
            (self.calls, "f"),
        ];
        let text: Vec<String> =
            parts.iter().filter(|(count, _)| *count > 0).map(|(count, symbol)| format!("{count}{symbol}")).collect();
        f.write_str(if text.is_empty() { "no operations".to_string() } else { text.join(" ") }.as_str())
    }
}

impl Program<'_> {
    /// All kernels with their names, in the order of the generated code.
    pub fn kernels(&self) -> Vec<(String, &Kernel)> {
        if self.formulas.model.is_steered() {
            return self.kernels_of_control();
        }
        let mut kernels: Vec<(String, &Kernel)> = vec![
            ("constants".into(), &self.constants),
            ("act".into(), &self.act),
            ("momentum_map".into(), &self.momentum_map),
            ("coadjoint".into(), &self.coadjoint),
            ("legendre".into(), &self.legendre),
            ("legendre_next".into(), &self.legendre_next),
            ("potential".into(), &self.potential),
            ("inertia".into(), &self.inertia),
            ("momentum_matrix".into(), &self.momentum_matrix),
            ("momentum_components".into(), &self.momentum_components),
        ];
        let turns_in_plane = self.turns_in_plane();
        kernels.extend((!turns_in_plane).then(|| ("cotangent_lift".to_string(), &self.cotangent_lift)));
        kernels.extend(self.velocity.iter().map(|kernel| ("velocity".to_string(), kernel)));
        kernels.extend(self.gyroscopic.iter().map(|kernel| ("gyroscopic".to_string(), kernel)));
        kernels.extend(self.conserved.iter().map(|kernel| ("conserved".to_string(), kernel)));
        kernels.extend(self.stagger.iter().map(|kernel| ("stagger".to_string(), kernel)));
        kernels.extend(self.membership.iter().map(|kernel| ("membership".to_string(), kernel)));
        kernels.extend(self.generator.iter().map(|kernel| ("generator".to_string(), kernel)));
        kernels.extend(self.splitting.iter().flat_map(|splitting| {
            [("kick".to_string(), &splitting.kick), ("kick_gradient".to_string(), &splitting.gradient)]
        }));
        kernels.extend(self.collocation.iter().flat_map(|collocation| {
            [
                ("slope".to_string(), &collocation.slope),
                ("covector".to_string(), &collocation.lift),
                ("whole_guess".to_string(), &collocation.guess),
            ]
        }));
        kernels.extend(self.momentum_of_step.iter().map(|kernel| ("momentum_of_step".to_string(), kernel)));
        for (number, link) in self.links.iter().enumerate() {
            kernels.push((format!("term_{}", number + 1), &link.value));
            if self.gathered.is_none() {
                kernels.push((format!("gradient_of_term_{}", number + 1), &link.gradient));
            }
        }
        if let Some(gathered) = &self.gathered {
            kernels.push(("gradient_of_site".to_string(), &gathered.common));
            kernels.extend(
                gathered
                    .stencil
                    .others
                    .iter()
                    .zip(&gathered.others)
                    .map(|((term, place), kernel)| (format!("gradient_of_term_{}_{}", term + 1, place + 1), kernel)),
            );
        }
        kernels.extend(self.variations.iter().flat_map(|variations| self.kernels_of(variations)));
        kernels.extend(self.kernels_of_control());
        for (index, step) in self.steps.iter().enumerate() {
            let suffix = self.suffix(index);
            let named = |name: &str| format!("{name}{suffix}");
            kernels.extend(step.start.iter().map(|kernel| (named("start_kick"), kernel)));
            for (number, solve) in step.solves.iter().enumerate() {
                let of = |name: &str| {
                    if step.solves.len() == 1 { named(name) } else { format!("{}_{}", named(name), number + 1) }
                };
                if let Some(sine_squared) = &solve.sine_squared {
                    kernels.push((of("sine_squared"), sine_squared));
                    kernels.extend(solve.predict.iter().map(|kernel| (of("closed_form"), kernel)));
                    continue;
                }
                if solve.solution == Solution::Explicit {
                    kernels.extend(solve.predict.iter().map(|kernel| (of("explicit"), kernel)));
                    continue;
                }
                if solve.solution == Solution::FreeRotation {
                    continue;
                }
                if solve.solution == Solution::Linear {
                    kernels.push((of("system"), &solve.linearize));
                    continue;
                }
                kernels.push((of("prepare"), &solve.prepare));
                kernels.extend(solve.predict.iter().map(|kernel| (of("predict"), kernel)));
                kernels.extend(solve.residual.iter().map(|kernel| (of("residual"), kernel)));
                kernels.push((of("linearize"), &solve.linearize));
            }
            kernels.extend(step.start_force.iter().map(|kernel| (named("start_force"), kernel)));
            if !self.formulas.turns_whole() {
                kernels.push((named("increment"), &step.increment));
            }
            match &step.displace {
                _ if turns_in_plane => {
                    kernels.extend(step.start_gradient.iter().map(|kernel| (named("start_gradient"), kernel)));
                }
                Some(displace) => kernels.push((named("displace"), displace)),
                None => kernels.push((named("advance"), &step.advance)),
            }
            kernels.extend(step.rest.iter().map(|kernel| (named("rest_kick"), kernel)));
            kernels.extend(step.coupled_gradient.iter().map(|kernel| (named("coupled_gradient"), kernel)));
            kernels.extend(step.update.iter().map(|kernel| (named("update"), kernel)));
            kernels.extend(step.start_moving.iter().map(|kernel| (named("moving_force"), kernel)));
            kernels.extend(step.end_force.iter().map(|kernel| (named("end_force"), kernel)));
            if !step.end_is_start {
                kernels.extend(step.end.iter().map(|kernel| (named("end_kick"), kernel)));
            }
        }
        kernels
    }

    /// The kernels of a choice of inputs.
    fn kernels_of_control(&self) -> Vec<(String, &Kernel)> {
        let of_end = self
            .endpoint
            .iter()
            .flat_map(|end| [("endpoint".to_string(), &end.price), ("endpoint_expanded".to_string(), &end.expanded)]);
        let Some(control) = &self.control else { return of_end.collect() };
        let (step, bend) = (control.step.as_ref(), control.bend.as_ref());
        let named = [
            ("orbit_metric", bend.is_none().then_some(&control.orbit_metric)),
            ("approach", Some(&control.approach)),
            ("increment", step.map(|step| &step.increment)),
            ("advance", step.map(|step| &step.advance)),
            ("expand", step.map(|step| &step.expand)),
            ("by_input", bend.map(|bend| &bend.by_input)),
            ("bend", bend.map(|bend| &bend.curvature)),
            ("bracket", bend.map(|bend| &bend.bracket)),
            ("price", Some(&control.price)),
            ("price_expanded", control.price_expanded.as_ref()),
            ("price_of_time", Some(&control.price_of_time)),
            ("bounds", Some(&control.bounds)),
            ("bounds_expanded", Some(&control.bounds_expanded)),
        ];
        named.into_iter().filter_map(|(name, kernel)| Some((name.to_string(), kernel?))).chain(of_end).collect()
    }

    fn kernels_of<'a>(&self, variations: &'a VariationKernels) -> Vec<(String, &'a Kernel)> {
        let mut kernels = vec![
            ("retractions".to_string(), &variations.retractions),
            ("compose".to_string(), &variations.compose),
            ("infinitesimal_motion".to_string(), &variations.generator),
            ("orbit_metric".to_string(), &variations.orbit_metric),
        ];
        for (index, edge) in variations.edges.iter().enumerate() {
            let suffix = self.suffix(index);
            kernels.push((format!("edge{suffix}"), &edge.edge));
            kernels.push((format!("momenta{suffix}"), &edge.momenta));
            kernels.push((format!("carried{suffix}"), &edge.carried));
            kernels.extend(edge.slopes.iter().map(|slopes| (format!("edge_slopes{suffix}"), slopes)));
        }
        kernels
    }

    /// The suffix of the functions of a substep.
    pub fn suffix(&self, substep: usize) -> &'static str {
        match (self.formulas.stepped, substep) {
            (1, 0) => "",
            (2, 0) => "_first",
            (2, 1) => "_adjoint",
            _ => "_whole",
        }
    }
}

impl fmt::Display for Program<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, kernel) in self.kernels() {
            writeln!(f, "{name}: {}", kernel.cost())?;
            for (index, local) in kernel.locals.iter().enumerate() {
                writeln!(f, "    t{index} = {}", self.text(local, 0))?;
            }
            for (position, code) in kernel.outputs.iter().flat_map(|(_, entries)| entries).enumerate() {
                let target =
                    if name == "constants" { self.constant_names[position].clone() } else { position.to_string() };
                writeln!(f, "    {target} = {}", self.text(code, 0))?;
            }
        }
        self.methods.iter().try_for_each(|method| write!(f, "\nmethod {}\n{}", method.name, method.program))
    }
}

impl Program<'_> {
    /// The coefficient of ξ_i ξ_j in the kinetic energy as text; `None` where it is zero.
    pub fn energy_coefficient(&self, i: usize, j: usize) -> Option<String> {
        let kernel = self.energy_coefficients.as_ref()?;
        let (shape, entries) = &kernel.outputs[0];
        let code = inlined(kernel, &entries[i * shape.columns + j]);
        (code != Code::Number(integer(0))).then(|| self.text(&code, 0))
    }

    /// The text of a code; `place` is 0 in a sum, 1 in a product, 2 below a fraction bar.
    fn text(&self, code: &Code, place: usize) -> String {
        match code {
            Code::Read(input) => read(input),
            Code::Pi => "π".into(),
            Code::Number(value) => value.to_string(),
            Code::Constant(index) => self.constant_names[*index].clone(),
            Code::Term(index) => format!("s{index}"),
            Code::Local(index) => format!("t{index}"),
            Code::Sum(constant, terms) => {
                // people read a + b + c, in whatever order it is added
                let (constant, terms) = Code::summands(constant, terms);
                let mut text = String::new();
                for (coefficient, term) in &terms {
                    let negative = *coefficient < integer(0);
                    let magnitude = if negative { -coefficient.clone() } else { coefficient.clone() };
                    text += sign(text.is_empty(), negative);
                    let scaled = magnitude != integer(1);
                    text += &if scaled { format!("{magnitude}*{}", self.text(term, 1)) } else { self.text(term, 1) };
                }
                if constant != integer(0) {
                    text = if text.is_empty() { constant.to_string() } else { format!("{constant} + {text}") };
                }
                if place == 0 { text } else { format!("({text})") }
            }
            Code::Product(factors) => {
                let product =
                    |factors: &[&Code]| factors.iter().map(|factor| self.text(factor, 1)).collect::<Vec<_>>().join("*");
                let text = match Code::quotient(factors) {
                    None => product(&factors.iter().collect::<Vec<_>>()),
                    Some((above, below)) => {
                        let above = if above.is_empty() { "1".to_string() } else { product(&above) };
                        below.iter().fold(above, |text, divisor| format!("{text}/{}", self.text(divisor, 2)))
                    }
                };
                if place < 2 { text } else { format!("({text})") }
            }
            Code::Reciprocal(x) if place == 0 => format!("1/{}", self.text(x, 2)),
            Code::Reciprocal(x) => format!("(1/{})", self.text(x, 2)),
            Code::Root(x, (1, 2)) => format!("sqrt({})", self.text(x, 0)),
            Code::PerOnePlusCosine(x) => {
                let text = format!("1/(1 + sqrt(1 - {}))", self.text(x, 1));
                if place == 0 { text } else { format!("({text})") }
            }
            Code::Root(x, (numerator, denominator)) => format!("{}^({numerator}/{denominator})", self.text(x, 1)),
            Code::Call(callee, arguments) => {
                let argument = |(_, entries): &(clebsch_symbolic::Shape, Vec<Code>)| {
                    let entries: Vec<String> = entries.iter().map(|entry| self.text(entry, 0)).collect();
                    format!("[{}]", entries.join(", "))
                };
                let arguments: Vec<String> = arguments.iter().map(argument).collect();
                format!("{callee}({})", arguments.join(", "))
            }
            Code::Output(local, callee, output) => match callee {
                Callee::Value(_) => format!("t{local}"),
                Callee::Gradient(_) => format!("t{local}.{}[{},{}]", output.leaf, output.row, output.column),
                _ => format!("t{local}[{},{}]", output.row, output.column),
            },
            Code::Function(function, x) => format!("{}({})", function.name(), self.text(x, 0)),
            Code::Whole(whole) => self.whole(whole, place),
        }
    }

    /// The text of an operation on whole matrices.
    fn whole(&self, whole: &Whole, place: usize) -> String {
        let operands: Vec<String> = whole.operands.iter().map(|operand| self.text(operand, 1)).collect();
        let (text, is_sum) = match &whole.operation {
            MatrixOperation::Argument(input) => (input.name.clone(), false),
            MatrixOperation::Entries => (format!("[{}]", operands.join(", ")), false),
            MatrixOperation::Sum(weights) => {
                let mut text = String::new();
                for (weight, operand) in weights.iter().zip(&operands) {
                    text += sign(text.is_empty(), weight.is_negative());
                    let size = weight.abs();
                    text += &if size == integer(1) { operand.clone() } else { format!("{size}*{operand}") };
                }
                (text, true)
            }
            MatrixOperation::Scaled | MatrixOperation::Product => (operands.join("*"), false),
            MatrixOperation::Shifted => (format!("{} + {}*I", operands[0], operands[1]), true),
            MatrixOperation::Transpose => (format!("{}ᵀ", operands[0]), false),
            MatrixOperation::Skew | MatrixOperation::Hat => (format!("{}^", operands[0]), false),
            MatrixOperation::SkewTimes => (format!("{}^*{}", operands[0], operands[1]), false),
            MatrixOperation::SkewComponents | MatrixOperation::Axial => (format!("⟨{}, E⟩", operands[0]), false),
            MatrixOperation::SkewOuter => (format!("⟨{}*{}ᵀ, E⟩", operands[0], operands[1]), false),
            MatrixOperation::Pairing => (format!("⟨{}, {}⟩", operands[0], operands[1]), false),
            MatrixOperation::Entry(i, j) => (format!("{}[{i},{j}]", operands[0]), false),
            other => (format!("{other:?}({})", operands.join(", ")).to_lowercase(), false),
        };
        if is_sum && place > 0 { format!("({text})") } else { text }
    }
}

/// What stands before a term of a sum.
pub(crate) fn sign(is_first: bool, is_negative: bool) -> &'static str {
    match (is_first, is_negative) {
        (true, false) => "",
        (true, true) => "-",
        (false, false) => " + ",
        (false, true) => " - ",
    }
}

/// A code with the shared terms of its kernel put in.
fn inlined(kernel: &Kernel, code: &Code) -> Code {
    code.with_locals(&|index| inlined(kernel, &kernel.locals[index]))
}

impl fmt::Display for Callee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Callee::Analytic(Analytic::Exponential) => f.write_str("exponential"),
            Callee::Analytic(Analytic::Phi) => f.write_str("phi"),
            Callee::Analytic(Analytic::Logarithm) => f.write_str("logarithm"),
            Callee::Inverse => f.write_str("inverse"),
            Callee::Value(name) => f.write_str(name),
            Callee::Gradient(name) => write!(f, "gradient of {name}"),
        }
    }
}

fn read(input: &Input) -> String {
    match input.is_vector {
        true if input.is_scalar => input.name.clone(),
        true => format!("{}[{}]", input.name, input.row),
        false => format!("{}[{},{}]", input.name, input.row, input.column),
    }
}
