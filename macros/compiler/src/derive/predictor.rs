//! The start of iterations, and equations in the form in which they are solved.

use clebsch_symbolic::{Elements, Expr, IntoElements, IntoList, Shape, both, indexed};

use super::constraint;
use super::exact::{by_inertia, inertia_inverse};
use super::symbols::{at_zero, entries, rows_at};
use super::{MatrixForm, MechanicsFormulas, MomentumEquation, Solution, Substep};

impl<'g> MechanicsFormulas<'g> {
    /// Whether an equation is started from, or solved by, a solution that is right to first order in h. This is so if Σ
    /// does not change, and nothing better is known.
    pub(super) fn is_predicted(&self, equation: &MomentumEquation<'g>) -> bool {
        let is_known = matches!(equation.solution, Solution::Linear | Solution::FreeRotation | Solution::Rotation(_));
        equation.formula.is_none() && !is_known && !self.inertia_moves()
    }

    /// Whether an equation with a constraint is right to the rounding of places. Where no predictor tells the size of μ, it
    /// may be right to that of μ.
    pub fn has_extent(&self, substep: &Substep<'g>, equation: &MomentumEquation<'g>) -> bool {
        let has_places = self.constraint.as_ref().is_some_and(|constraint| constraint.places.is_some());
        substep.reaction.is_some() && (has_places || !self.is_predicted(equation))
    }

    /// x = s·h·Σ⁻¹μ with s = dx/dξ at the identity, component by component.
    pub(super) fn predictor(&self, substep: &Substep<'g>, equation: &MomentumEquation<'g>) -> Vec<Expr<'g>> {
        let graph = self.model.graph;
        let count = equation.components.len();
        let components = [equation.components.as_slice(), &equation.coupled].concat();
        let shape = Shape::square(components.len());
        let block = |matrix: Expr<'g>| {
            let entry = |(i, j): (usize, usize)| matrix.entry(components[i], components[j]);
            graph.stack(shape, shape.positions().map(entry).into_list())
        };
        let inertia = block(self.inertia);
        let momenta = entries(&self.symbols.momenta);
        let momentum: Vec<Expr<'g>> = components.each(|&component| momenta[component]);
        let inverse = || block(inertia_inverse(graph, self.inertia.shape()));
        let velocity = if substep.still.is_empty() {
            by_inertia(inertia, inverse, &momentum)
        } else {
            let all = self.velocity_without(&substep.still, &momenta);
            components.each(|&component| all[component])
        };
        let coordinate =
            |(velocity, component): (Expr<'g>, usize)| self.step_of_component(component, substep.divisor) * velocity;
        velocity.into_iter().take(count).zip(components).map(coordinate).into_list()
    }

    /// The velocity Σ⁻¹μ of a momentum, where a constraint chooses μ_i so that some components of the velocity are zero.
    fn velocity_without(&self, still: &[usize], momenta: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let (graph, inverse) = (self.model.graph, constraint::inverse(self, self.inertia));
        let moving: Vec<usize> = (0..momenta.len()).filter(|i| !still.contains(i)).into_list();
        let moved = |i: usize| {
            let terms = moving.iter().map(|&j| inverse.entry(i, j) * momenta[j]);
            graph.total(Shape::scalar(), terms)
        };
        let shape = Shape::square(still.len());
        let own = graph.stack(shape, shape.positions().map(|(i, j)| inverse.entry(still[i], still[j])).into_list());
        let right = graph.stack(Shape::vector(still.len()), still.each(|&i| moved(i)));
        let push = if own.shape().is_scalar() { right / own } else { own.inverse() * right };
        let pushed = |i: usize| {
            let terms = still.iter().enumerate().map(|(k, &j)| inverse.entry(i, j) * push.entry(k, 0));
            moved(i) - graph.total(Shape::scalar(), terms)
        };
        indexed(momenta.len(), pushed)
    }

    /// The same for all components of each block at once, as matrix code computes it; `None` if there is none.
    pub fn whole_predictor(&self, index: usize, number: usize) -> Option<Vec<Expr<'g>>> {
        let substep = self.substeps.get(index)?;
        let equation = substep.equations.get(number).filter(|equation| self.is_predicted(equation))?;
        Some(self.predictor_by_blocks(substep, equation, inertia_inverse(self.model.graph, self.inertia.shape())))
    }

    /// The same with an inverse of Σ.
    pub(super) fn predictor_by_blocks(
        &self,
        substep: &Substep<'g>,
        equation: &MomentumEquation<'g>,
        inverse: Expr<'g>,
    ) -> Vec<Expr<'g>> {
        let all = self.model.graph.below(&self.symbols.momenta);
        let (first, count) = (equation.components[0], equation.components.len());
        let is_run = equation.coupled.is_empty() && equation.components.iter().copied().eq(first..first + count);
        // of the momentum those components are read that the equation is about
        let (start, momentum) = if is_run { (first, all.block(first, 0, Shape::vector(count))) } else { (0, all) };
        let velocity = match self.uniform_inertia {
            Some(kappa) => momentum / kappa,
            None => inverse.block(start, start, Shape::square(momentum.shape().rows)) * momentum,
        };
        let part = |i: usize| {
            // an equation may be about some components of a block
            let block = self.symbols.blocks[i].components();
            let within = equation.components.iter().filter(|component| block.contains(component));
            let positions: Vec<usize> = within.map(|component| component - start).into_list();
            self.chart_step(i, substep.divisor) * rows_at(velocity, &positions)
        };
        self.symbols.blocks_of(&equation.components).into_each(part)
    }

    /// The chart coordinates of the motion by the velocity of the start of a step that is collocated, to first order in h.
    pub(super) fn guess(&self) -> Option<Vec<Expr<'g>>> {
        let velocities = entries(&self.collocation.as_ref()?.algebra).into_iter().enumerate();
        Some(velocities.map(|(component, velocity)| self.step_of_component(component, 1) * velocity).into_list())
    }

    /// −ρ(0) and Dρ(0), of an equation that is linear in the chart: column by column, or along one direction.
    pub fn linear_system(&self, equation: &MomentumEquation<'g>, keeps_matrices: bool) -> [MatrixForm<'g>; 2] {
        let zero = at_zero(self.symbols.blocks.iter().map(|block| block.coordinates));
        let right_side = -equation.residual.substitute(&zero);
        if keeps_matrices {
            return both([right_side, equation.directional], MatrixForm::Whole);
        }
        let columns = equation.columns(&self.symbols).into_iter().map(|column| column.substitute(&zero));
        [MatrixForm::Whole(right_side), MatrixForm::of_columns(columns)]
    }

    /// ρ(x) and Dρ(x), of an equation that Newton's method solves: column by column, or along one direction, of bodies as B(x).
    pub fn newton_system(&self, equation: &MomentumEquation<'g>, keeps_matrices: bool) -> [MatrixForm<'g>; 2] {
        let jacobian = if keeps_matrices {
            MatrixForm::Whole(equation.large_jacobian_factor(self).unwrap_or(equation.directional))
        } else {
            MatrixForm::of_columns(equation.columns(&self.symbols))
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
        let slopes: Vec<_> = slopes.into_list();
        if slopes.is_empty() { equation.residual } else { equation.residual.substitute(&slopes) }
    }

    /// s·h for a component of one of so many parts of a step.
    fn step_of_component(&self, component: usize, divisor: i64) -> Expr<'g> {
        self.chart_step(self.symbols.blocks_of(&[component])[0], divisor)
    }
}
