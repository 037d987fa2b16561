//! The operations of kernels.

use clebsch_symbolic::integer;

use super::{Code, Kernel};

/// The operations of a kernel.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Default, Debug)]
pub struct Cost {
    /// Additions and subtractions.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions and reciprocals.
    pub divisions: usize,
    /// Square and other roots.
    pub roots: usize,
    /// Calls of elementary functions.
    pub calls: usize,
}

impl Kernel {
    /// The operations of this kernel.
    pub fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        self.locals.iter().for_each(|code| cost.count(code));
        self.outputs.iter().flat_map(|(_, entries)| entries).for_each(|code| cost.count(code));
        cost
    }

    /// The operations that stand in its code: one on whole matrices is one.
    pub fn length(&self) -> usize {
        let outputs = self.outputs.iter().flat_map(|(_, entries)| entries);
        let whole: usize = self.locals.iter().chain(outputs).map(Cost::within_matrices).sum();
        self.cost().total() - whole
    }
}

impl Cost {
    /// The operations on entries that operations on whole matrices are made of, but for one each.
    fn within_matrices(code: &Code) -> usize {
        let parts: usize = code.parts().into_iter().map(Cost::within_matrices).sum();
        match code {
            Code::Whole(whole) => parts + whole.cost.total().saturating_sub(1),
            _ => parts,
        }
    }

    /// So many times the cost.
    pub fn times(self, count: usize) -> Cost {
        Cost {
            additions: self.additions * count,
            multiplications: self.multiplications * count,
            divisions: self.divisions * count,
            roots: self.roots * count,
            calls: self.calls * count,
        }
    }

    /// All operations.
    pub fn total(self) -> usize {
        self.additions + self.multiplications + self.divisions + self.roots + self.calls
    }

    fn count(&mut self, code: &Code) {
        match code {
            Code::Sum(constant, terms) => {
                self.additions += terms.len() - 1 + (*constant != integer(0)) as usize;
                for (coefficient, term) in terms {
                    self.multiplications += !(*coefficient == integer(1) || *coefficient == integer(-1)) as usize;
                    self.count(term);
                }
            }
            Code::Product(factors) => {
                // a division takes the place of a multiplication
                let below =
                    Code::quotient(factors).map_or(0, |(above, below)| below.len().min(above.len() + below.len() - 1));
                self.multiplications += factors.len() - 1 - below;
                factors.iter().for_each(|factor| self.count(factor));
            }
            Code::Reciprocal(x) => {
                self.divisions += 1;
                self.count(x);
            }
            Code::Root(x, _) => {
                self.roots += 1;
                self.count(x);
            }
            // at worst: next to θ = 0 it is a polynomial
            Code::PerOnePlusCosine(x) => {
                (self.additions, self.divisions, self.roots) = (self.additions + 2, self.divisions + 1, self.roots + 1);
                self.count(x);
            }
            Code::Function(_, x) => {
                self.calls += 1;
                self.count(x);
            }
            Code::Call(_, arguments) => {
                self.calls += 1;
                arguments.iter().flat_map(|(_, entries)| entries).for_each(|entry| self.count(entry));
            }
            Code::Whole(whole) => {
                *self = self.plus(whole.cost);
                whole.operands.iter().for_each(|operand| self.count(operand));
            }
            Code::Read(_) | Code::Pi | Code::Number(_) | Code::Constant(_) | Code::Term(_) => {}
            Code::Local(_) | Code::Output(..) => {}
        }
    }
}
