//! What iterations start from, and equations in the form in which they are solved.

use clebsch_symbolic::{Expr, Property, Role, Shape};

use super::equation::chart_slope;
use super::exact::{by_inertia, inertia_inverse};
use super::{MatrixForm, MechanicsFormulas, MomentumEquation, Solution, Substep};

impl<'g> MechanicsFormulas<'g> {
    /// Whether an equation is started from, or solved by, what is right to first order in h: Σ does not change, and nothing better is known.
    pub(super) fn is_predicted(&self, equation: &MomentumEquation<'g>) -> bool {
        let is_known = matches!(equation.solution, Solution::Linear | Solution::FreeRotation);
        equation.formula.is_none() && !is_known && !self.inertia_moves()
    }

    /// x = s·h·Σ⁻¹μ with s = dx/dξ at the identity, component by component.
    pub(super) fn predictor(&self, substep: &Substep<'g>, equation: &MomentumEquation<'g>) -> Vec<Expr<'g>> {
        let graph = self.model.graph;
        let count = equation.components.len();
        let components = [equation.components.as_slice(), &equation.coupled].concat();
        let shape = Shape::square(components.len());
        let block = |matrix: Expr<'g>| {
            let entry = |(i, j): (usize, usize)| matrix.entry(components[i], components[j]);
            graph.stack(shape, shape.positions().map(entry).collect())
        };
        let inertia = block(self.inertia);
        let momentum: Vec<Expr<'g>> = components.iter().map(|&component| self.momentum_entry(component)).collect();
        let inverse = || block(inertia_inverse(graph, self.inertia.shape()));
        let velocity = by_inertia(inertia, inverse, &momentum);
        let coordinate = |(velocity, component): (Expr<'g>, usize)| {
            self.slope_of_chart(component, substep.divisor) * self.model.step_size * velocity
        };
        velocity.into_iter().take(count).zip(components).map(coordinate).collect()
    }

    /// The same for all components of each block at once, as code with whole matrices computes it; `None` where there is none.
    pub fn whole_predictor(&self, index: usize, number: usize) -> Option<Vec<Expr<'g>>> {
        let substep = self.substeps.get(index)?;
        let equation = substep.equations.get(number).filter(|equation| self.is_predicted(equation))?;
        self.predictor_by_blocks(substep, equation, inertia_inverse(self.model.graph, self.inertia.shape()))
    }

    /// The same with an inverse of Σ.
    fn predictor_by_blocks(
        &self,
        substep: &Substep<'g>,
        equation: &MomentumEquation<'g>,
        inverse: Expr<'g>,
    ) -> Option<Vec<Expr<'g>>> {
        let (symbols, h) = (&self.symbols, self.model.step_size);
        let all = stacked(&symbols.momenta)?;
        let (first, count) = (*equation.components.first()?, equation.components.len());
        let is_run = equation.coupled.is_empty() && equation.components.iter().copied().eq(first..first + count);
        // of the momentum those components are read that the equation is about
        let (start, momentum) = if is_run { (first, all.block(first, 0, Shape::vector(count))) } else { (0, all) };
        let velocity = match self.uniform_inertia {
            Some(kappa) => momentum / kappa,
            None => inverse.block(start, start, Shape::square(momentum.shape().rows)) * momentum,
        };
        let blocks = symbols.blocks_of(&equation.components).into_iter().map(|i| {
            // an equation may be about some components of a block
            let is_within = |component: &&usize| symbols.blocks[i].components().contains(component);
            let within: Vec<usize> = equation.components.iter().filter(is_within).copied().collect();
            let entries = || within.iter().map(|component| velocity.entry(component - start, 0)).collect();
            let is_run = within.windows(2).all(|pair| pair[1] == pair[0] + 1);
            let shape = Shape::vector(within.len());
            let part = if is_run {
                velocity.block(within[0] - start, 0, shape)
            } else {
                self.model.graph.stack(shape, entries())
            };
            self.slope_of_chart(within[0], substep.divisor) * h * part
        });
        Some(blocks.collect())
    }

    /// The predictor as it is printed, with Σ for the inertia.
    pub(super) fn printed_predictor(
        &self,
        substep: &Substep<'g>,
        equation: &MomentumEquation<'g>,
    ) -> Option<Vec<Expr<'g>>> {
        let inertia = self.model.graph.symbol("Σ", self.inertia.shape(), Role::Letter, Property::Symmetric);
        self.predictor_by_blocks(substep, equation, inertia.inverse())
    }

    /// The chart coordinates of the motion by the velocity of the start of a step that is collocated, to first order in h.
    pub(super) fn guess(&self) -> Option<Vec<Expr<'g>>> {
        let collocation = self.collocation.as_ref()?;
        let entries = collocation.algebra.iter().flat_map(|xi| (0..xi.shape().rows).map(|i| xi.entry(i, 0)));
        let coordinate = |(component, velocity): (usize, Expr<'g>)| {
            self.slope_of_chart(component, 1) * self.model.step_size * velocity
        };
        Some(entries.enumerate().map(coordinate).collect())
    }

    /// −ρ(0) and Dρ(0), of an equation that is linear in the chart: column by column, or along one direction.
    pub fn linear_system(&self, equation: &MomentumEquation<'g>, keeps_matrices: bool) -> [MatrixForm<'g>; 2] {
        let zero = self.chart_at_zero();
        let right_side = -equation.residual.substitute(&zero);
        if keeps_matrices {
            return [right_side, equation.directional].map(MatrixForm::Whole);
        }
        let columns = equation.columns(&self.symbols).into_iter().map(|column| column.substitute(&zero));
        [MatrixForm::Whole(right_side), MatrixForm::of_columns(columns)]
    }

    /// ρ(x) and Dρ(x), of an equation that Newton's method solves: column by column, or along one direction, of bodies as B(x).
    pub fn newton_system(&self, equation: &MomentumEquation<'g>, keeps_matrices: bool) -> [MatrixForm<'g>; 2] {
        let jacobian = match keeps_matrices {
            true => MatrixForm::Whole(equation.large_jacobian_factor(self).unwrap_or(equation.directional)),
            false => MatrixForm::of_columns(equation.columns(&self.symbols)),
        };
        [MatrixForm::Whole(equation.residual), jacobian]
    }

    /// ρ(x) with the slopes of exponentials on so(4) by its halves.
    pub fn residual_by_halves(&self, equation: &MomentumEquation<'g>) -> Expr<'g> {
        let slopes = equation.factors.iter().flat_map(|&k| {
            let (group, x) = (self.model.factors[k].group, self.symbols.stacked_coordinates(k));
            let by_halves = move |x| {
                let halves = group.exponential_slope_by_halves(x)?;
                Some((group.exponential_slope(x), halves))
            };
            [x, -x].into_iter().filter_map(by_halves)
        });
        let slopes: Vec<_> = slopes.collect();
        if slopes.is_empty() { equation.residual } else { equation.residual.substitute(&slopes) }
    }

    /// The replacement of all chart coordinates by zero.
    fn chart_at_zero(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let coordinates = self.symbols.blocks.iter().map(|block| block.coordinates);
        coordinates.map(|x| (x, self.model.graph.zero(x.shape()))).collect()
    }

    /// dx/dξ at the identity for a component of one of so many parts of a step.
    fn slope_of_chart(&self, component: usize, divisor: i64) -> Expr<'g> {
        let block = self.symbols.blocks_of(&[component])[0];
        let (numerator, denominator) = chart_slope(&self.model, &self.symbols, block);
        self.model.graph.rational(numerator, denominator * divisor)
    }

    /// A component of the momentum, counted through all factors.
    fn momentum_entry(&self, mut component: usize) -> Expr<'g> {
        for mu in &self.symbols.momenta {
            if component < mu.shape().rows {
                return mu.entry(component, 0);
            }
            component -= mu.shape().rows;
        }
        self.model.graph.integer(0)
    }
}

/// Vectors, one after the other.
pub(crate) fn stacked<'g>(expressions: &[Expr<'g>]) -> Option<Expr<'g>> {
    let (&first, rest) = expressions.split_first()?;
    if rest.is_empty() {
        return Some(first);
    }
    let shape = Shape::vector(expressions.iter().map(|part| part.shape().rows).sum());
    let mut row = 0;
    Some(expressions.iter().fold(first.graph().zero(shape), |sum, part| {
        let placed = part.embed(shape, row, 0);
        row += part.shape().rows;
        sum + placed
    }))
}
