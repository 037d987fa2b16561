//! Methods: several programs of one system.

use clebsch_symbolic::{Elements, both};
use proc_macro2::Ident;

use crate::diagnostic::{Diagnostics, bail};
use crate::lower::{MechanicsProgram, Program};

/// A further way to step the system of a program.
pub struct MethodProgram<'g> {
    /// The unit struct of the user that stands for it.
    pub name: Ident,
    /// Its program; its system is that of the declared dials.
    pub program: MechanicsProgram<'g>,
}

impl<'g> MechanicsProgram<'g> {
    /// The text of `DERIVATION` of a method.
    pub(crate) fn derivation_by(&self, name: &Ident) -> String {
        let system = self.formulas.model.item.ident.to_string();
        self.derivation().replacen(&system, &format!("{system} by {name}"), 1)
    }

    /// Whether the steps of another program of the system are differentiated with respect to the same quantities.
    pub(crate) fn has_the_same_quantities(&self, other: &Program<'g>) -> bool {
        let Program::Mechanics(other) = other else { return false };
        let [these, others] = both([&self.formulas, &other.formulas], |formulas| &formulas.quantities);
        these.iter().map(|quantity| &quantity.name).eq(others.iter().map(|quantity| &quantity.name))
    }
}

impl<'g> MethodProgram<'g> {
    /// The method of a program, next to that of the declared dials.
    ///
    /// # Errors
    /// Where it conserves less: `Conserves` is of the system and speaks for all of its methods.
    pub(crate) fn new(
        name: &Ident,
        program: Program<'g>,
        declared: &MechanicsProgram<'g>,
    ) -> Result<MethodProgram<'g>, Diagnostics> {
        // by construction: a method has the system of its declaration
        let Program::Mechanics(program) = program else { return Err(Diagnostics::new()) };
        let of = |program: &MechanicsProgram<'g>| -> Vec<String> {
            program.formulas.symmetries.conserved.each(|momentum| momentum.name.clone())
        };
        let conserved = of(&program);
        if let Some(lost) = of(declared).into_iter().find(|momentum| !conserved.contains(momentum)) {
            bail!(name, "the method `{name}` does not conserve the momentum `{lost}`";
                help "write another `discretization` for it, or declare another struct";
                note "the steps with the declared dials do, and the conserved momenta are those of the system");
        }
        Ok(MethodProgram { name: name.clone(), program: *program })
    }
}
