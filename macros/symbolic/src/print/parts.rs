//! Formulas in which parts that stand in several places have names: P₁, P₂, …

use super::{Binding, Notation, Printer, in_digits};
use crate::node::Id;
use crate::{Elements, Expr, Graph, IntoList, Table};

/// A shorter part has no name.
const SHORTEST: usize = 12;

impl Graph {
    /// Formulas in a notation, and their parts as `P₁ = …`, each behind those that it is made of. `None` where they have more
    /// characters than these.
    pub fn written_in_parts(
        &self,
        formulas: &[Expr<'_>],
        notation: Notation,
        most: usize,
    ) -> Option<(Vec<String>, Vec<String>)> {
        let (mut printer, mut parts) = (Printer::new(self, notation, most), Vec::new());
        for id in self.repeated(formulas) {
            let text = printer.node(id).text;
            if printer.left.get() == 0 {
                return None;
            }
            if text.chars().count() >= SHORTEST {
                let number = parts.len() as i64 + 1;
                let name = notation.either(format!("P{}", in_digits(number, "₋₀₁₂₃₄₅₆₇₈₉")), format!("P_{{{number}}}"));
                parts.push(format!("{name} = {text}"));
                printer.names.insert(id, name);
            }
        }
        let formulas = formulas.each(|formula| printer.print(formula.id, Binding::Sum));
        let characters: usize = formulas.iter().chain(&parts).map(|text| text.chars().count()).sum();
        (printer.left.get() > 0 && characters <= most).then_some((formulas, parts))
    }

    /// The expressions that stand in several others within these, or in several places of one, children before parents.
    fn repeated(&self, formulas: &[Expr<'_>]) -> Vec<Id> {
        let mut uses: Table<Id, usize> = Table::default();
        let mut open: Vec<Id> = formulas.each(|formula| formula.id);
        while let Some(id) = open.pop() {
            let count = uses.entry(id);
            *count += 1;
            if *count == 1 {
                self.node(id).each_child(|child| open.push(child));
            }
        }
        let mut repeated = uses.iter().filter(|(_, count)| **count > 1).map(|(id, _)| *id).into_list();
        repeated.sort_unstable();
        repeated
    }
}
