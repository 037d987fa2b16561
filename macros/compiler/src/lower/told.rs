//! What the derivation tells of the program: how it is written and iterated, and what it costs.

use super::{Form, Kernel, LARGEST_UNROLLED, MOST_UNKNOWNS, MechanicsProgram, Program, SteeredProgram};
use crate::derive::{self, Id, Iteration, Lowered};
use crate::model::CodeForm;

impl Program<'_> {
    /// The text of `DERIVATION`.
    pub fn derivation(&self) -> String {
        match self {
            Program::Mechanics(program) => program.derivation(),
            Program::Steered(program) => program.derivation(),
        }
    }
}

impl SteeredProgram<'_> {
    /// The text of `DERIVATION`.
    pub fn derivation(&self) -> String {
        derive::derivation_of_control(&self.formulas, &costs(&self.kernels()))
    }
}

impl MechanicsProgram<'_> {
    /// The text of `DERIVATION`.
    pub fn derivation(&self) -> String {
        derive::derivation(&self.formulas, &self.told())
    }

    fn told(&self) -> Lowered {
        Lowered {
            form: self.form.sentence(),
            energy: (!self.form.keeps_matrices()).then(|| self.energy_coefficients()),
            is_gathered: self.gathered.is_some(),
            turns_in_plane: self.turns_in_plane(),
            iterations: self.iterations(),
            costs: costs(&self.kernels()),
        }
    }

    fn energy_coefficients(&self) -> Vec<(usize, usize, String)> {
        let dimension = self.formulas.inertia.shape().rows;
        let places = (0..dimension).flat_map(|i| (i..dimension).map(move |j| (i, j)));
        places.filter_map(|(i, j)| Some((i, j, self.energy_coefficient(i, j)?))).collect()
    }

    fn iterations(&self) -> Vec<Vec<Iteration>> {
        let iteration = |solve: &super::Solve| Iteration {
            structure: solve.structure.clone(),
            tries_fixed_point: self.find(solve.id(Id::Residual)).is_some(),
        };
        self.steps.iter().map(|step| step.solves.iter().map(iteration).collect()).collect()
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
        let Form { code, estimate, is_asked, is_body_or_point, missing } = *self;
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
        format!(
            "{written}: the matrices of a linearisation and of a move have about {estimate} products of entries, {why}."
        )
    }
}
