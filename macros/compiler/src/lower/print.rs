//! The program as text: each kernel with its operation counts and its code, and the facts that the derivation tells of
//! it.

use std::fmt;

use clebsch_symbolic::{Analytic, Elements, IntoList, Operation, Product, Rational, integer, joined};

use super::collect::collected;
use super::{Callee, Code, Form, Input, Kernel, KernelTable, LARGEST_UNROLLED, MOST_UNKNOWNS, MatrixOperation};
use super::{MechanicsProgram, Program, Solve, Whole};
use crate::derive::{self, Id, Iteration, Lowered};
use crate::model::CodeForm;

impl fmt::Display for Program<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Program::Mechanics(program) => write!(f, "{program}"),
            Program::Steered(program) => program.table.print(f, program.kernels()),
        }
    }
}

impl fmt::Display for MechanicsProgram<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.table.print(f, self.kernels())?;
        self.methods.iter().try_for_each(|method| write!(f, "\nmethod {}\n{}", method.name, method.program))
    }
}

impl KernelTable {
    /// Each kernel with its operation counts and its code.
    fn print(&self, f: &mut fmt::Formatter<'_>, kernels: Vec<(String, &Kernel)>) -> fmt::Result {
        for (name, kernel) in kernels {
            writeln!(f, "{name}: {}", kernel.cost())?;
            for (index, local) in kernel.locals.iter().enumerate() {
                writeln!(f, "    t{index} = {}", self.text(local, 0))?;
            }
            for (position, code) in kernel.entries().enumerate() {
                let target =
                    if name == "constants" { self.constant_names[position].clone() } else { position.to_string() };
                writeln!(f, "    {target} = {}", self.text(code, 0))?;
            }
        }
        Ok(())
    }

    /// i, j and the coefficient of ξ_i ξ_j in the kinetic energy, without those that are zero; `None` of long ones.
    fn energy_coefficients(&self) -> Option<Vec<(usize, usize, Product)>> {
        let kernel = self.find(Id::EnergyCoefficients).filter(|kernel| length_inlined(kernel) <= LONGEST_ENERGY)?;
        let (shape, entries) = &kernel.outputs[0];
        let upper = shape.positions().zip(entries).filter(|((i, j), _)| i <= j);
        let coefficients = upper.map(|((i, j), entry)| (i, j, inlined(kernel, entry)));
        let coefficients = coefficients.filter(|(_, _, code)| *code != Code::Number(integer(0)));
        Some(coefficients.map(|(i, j, code)| (i, j, collected(&code, &|factor| self.text(factor, 2)))).into_list())
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
                let mut text = sum(terms.iter().map(|(weight, term)| (weight, self.text(term, 1))));
                if constant != integer(0) {
                    text = if text.is_empty() { constant.to_string() } else { format!("{constant} + {text}") };
                }
                bracketed(text, place > 0)
            }
            Code::Product(factors) => {
                let product = |factors: &[&Code]| factors.each(|factor| self.text(factor, 1)).join("*");
                let text = match Code::quotient(factors) {
                    None => product(&factors.iter().into_list()),
                    Some((above, below)) => {
                        let above = if above.is_empty() { "1".to_string() } else { product(&above) };
                        below.iter().fold(above, |text, divisor| format!("{text}/{}", self.text(divisor, 2)))
                    }
                };
                bracketed(text, place > 1)
            }
            Code::Reciprocal(x) => bracketed(format!("1/{}", self.text(x, 2)), place > 0),
            Code::Root(x, (1, 2)) => format!("sqrt({})", self.text(x, 0)),
            Code::PerOnePlusCosine(x) => bracketed(format!("1/(1 + sqrt(1 - {}))", self.text(x, 1)), place > 0),
            Code::Root(x, (numerator, denominator)) => format!("{}^({numerator}/{denominator})", self.text(x, 1)),
            Code::Call(callee, arguments) => {
                let entries = |entries: &[Code]| entries.each(|entry| self.text(entry, 0));
                let arguments = arguments.iter().map(|(_, argument)| format!("[{}]", entries(argument).join(", ")));
                format!("{callee}({})", arguments.into_list().join(", "))
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

    fn whole(&self, whole: &Whole, place: usize) -> String {
        let operands: Vec<String> = whole.operands.each(|operand| self.text(operand, 1));
        let (text, is_sum) = match &whole.operation {
            MatrixOperation::Argument(input) => (input.name.clone(), false),
            MatrixOperation::Entries => (format!("[{}]", operands.join(", ")), false),
            MatrixOperation::Sum(weights) => (sum(weights.iter().zip(operands)), true),
            MatrixOperation::Scaled | MatrixOperation::Product => (operands.join("*"), false),
            MatrixOperation::Shifted => (format!("{} + {}*I", operands[0], operands[1]), true),
            MatrixOperation::Of(Operation::Transpose) => (format!("{}ᵀ", operands[0]), false),
            MatrixOperation::Skew | MatrixOperation::Hat => (format!("{}^", operands[0]), false),
            MatrixOperation::SkewTimes => (format!("{}^*{}", operands[0], operands[1]), false),
            MatrixOperation::SkewComponents | MatrixOperation::Axial => (format!("⟨{}, E⟩", operands[0]), false),
            MatrixOperation::SkewOuter => (format!("⟨{}*{}ᵀ, E⟩", operands[0], operands[1]), false),
            MatrixOperation::Pairing => (format!("⟨{}, {}⟩", operands[0], operands[1]), false),
            MatrixOperation::Entry(i, j) => (format!("{}[{i},{j}]", operands[0]), false),
            MatrixOperation::Of(Operation::Embed(i, j)) => (format!("embedded({i}, {j})({})", operands[0]), false),
            MatrixOperation::Of(operation) => (format!("{operation:?}({})", operands[0]).to_lowercase(), false),
            other => (format!("{other:?}({})", operands.join(", ")).to_lowercase(), false),
        };
        bracketed(text, is_sum && place > 0)
    }
}

/// Σ weight · term.
fn sum<'a>(terms: impl Iterator<Item = (&'a Rational, String)>) -> String {
    let written = |(weight, term): (&Rational, String)| {
        let size = weight.abs();
        (weight.is_negative(), if size == integer(1) { term } else { format!("{size}*{term}") })
    };
    joined(terms.map(written), '-')
}

fn bracketed(text: String, is_bracketed: bool) -> String {
    if is_bracketed { format!("({text})") } else { text }
}

/// The codes of an energy that is printed, at most.
const LONGEST_ENERGY: usize = 4096;

/// The codes of the outputs of a kernel with its shared terms put in.
fn length_inlined(kernel: &Kernel) -> usize {
    let mut lengths: Vec<usize> = Vec::new();
    let length = |code: &Code, lengths: &[usize]| {
        let mut length = 0_usize;
        code.visit(&mut |part| match part {
            Code::Local(index) => length = length.saturating_add(lengths[*index]),
            _ => length = length.saturating_add(1),
        });
        length
    };
    kernel.locals.iter().for_each(|code| lengths.push(length(code, &lengths)));
    kernel.entries().fold(0, |sum, entry| length(entry, &lengths).saturating_add(sum))
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
            Callee::Analytic(Analytic::MotionLogarithm) => f.write_str("motion_logarithm"),
            Callee::PhiTimes => f.write_str("phi_times"),
            Callee::Inverse => f.write_str("inverse"),
            Callee::SineAndCosine => f.write_str("sin_cos"),
            Callee::Value(name) => f.write_str(name),
            Callee::Gradient(name) => write!(f, "gradient of {name}"),
        }
    }
}

fn read(input: &Input) -> String {
    match input.shape {
        shape if shape.is_scalar() => input.name.clone(),
        shape if shape.is_column() => format!("{}[{}]", input.name, input.row),
        _ => format!("{}[{},{}]", input.name, input.row, input.column),
    }
}

impl Program<'_> {
    /// The text of `DERIVATION`.
    pub fn derivation(&self) -> String {
        match self {
            Program::Mechanics(program) => program.derivation(),
            Program::Steered(program) => derive::derivation_of_control(&program.formulas, &costs(&program.kernels())),
        }
    }
}

impl MechanicsProgram<'_> {
    /// The text of `DERIVATION`.
    pub fn derivation(&self) -> String {
        let lowered = Lowered {
            form: self.form.sentence(),
            energy: self.energy_coefficients(),
            is_gathered: self.gathered.is_some() || self.gathers_edges(),
            turns_in_plane: self.turns_in_plane(),
            iterations: self.iterations(),
            costs: costs(&self.kernels()),
        };
        derive::derivation(&self.formulas, &lowered)
    }

    fn iterations(&self) -> Vec<Vec<Iteration>> {
        let iteration = |solve: &Solve| Iteration {
            structure: solve.structure.clone(),
            tries_fixed_point: self.find(solve.id(Id::Residual)).is_some(),
        };
        self.steps.each(|step| step.solves.each(iteration))
    }
}

/// The operations of each kernel, one line each.
fn costs(kernels: &[(String, &Kernel)]) -> String {
    let width = kernels.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    kernels.iter().map(|(name, kernel)| format!("{name:width$}  {}\n", kernel.cost())).collect()
}

impl Form {
    /// How code is written, and why.
    fn sentence(&self) -> String {
        let Form { code, estimate, is_asked, is_body_or_point, missing, is_beyond, is_plain } = *self;
        let written = match code {
            CodeForm::Unrolled => "Code is unrolled, entry by entry",
            CodeForm::Matrices => "Code is matrix code, in loops",
        };
        let plain = if is_plain { " Some of it is not shortened, as that takes too long." } else { "" };
        let why = match (is_beyond, is_asked, code) {
            (true, ..) => "and unrolled code is too long".to_string(),
            (_, true, _) => "as the declaration asks".to_string(),
            (_, false, CodeForm::Unrolled) if estimate > LARGEST_UNROLLED => match missing {
                Some(why) => format!("and {why} has no matrix code"),
                None => "of few unknowns".to_string(),
            },
            (_, false, CodeForm::Unrolled) => format!("up to {LARGEST_UNROLLED}"),
            (_, false, CodeForm::Matrices) if estimate <= LARGEST_UNROLLED && is_body_or_point => {
                "and bodies in five dimensions or more and points on S⁷ or larger keep them at any number".to_string()
            }
            (_, false, CodeForm::Matrices) if estimate <= LARGEST_UNROLLED => {
                format!("and its momentum more than {MOST_UNKNOWNS} components")
            }
            (_, false, CodeForm::Matrices) => format!("more than {LARGEST_UNROLLED}"),
        };
        format!(
            "{written}: the matrices of a linearisation and of a move have about {estimate} products of entries, {why}.{plain}"
        )
    }
}
