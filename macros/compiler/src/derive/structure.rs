//! The structure of the Jacobian of a momentum equation that is known before any number is. These are coordinates that
//! the others determine, linear equations, symmetric and block triangular Jacobians.
//!
//! Entries are evaluated at random points of a prime field, so that terms that cancel count as zero, however they are
//! written.

mod pattern;
mod sylvester;

use clebsch_symbolic::{Elements, Expr, IntoElements, IntoList, Shape, identity, work};

use super::equation::{Form, MomentumEquation, Solution, Sources};
use super::symbols::{ChartBlock, rows_at};
use pattern::Pattern;
pub(super) use pattern::connected;

/// Jacobians of more unknowns are taken as they are: those of large groups are full.
const LARGEST: usize = 20;

/// The equations, to be solved in this order, that an equation for Newton's method falls into.
///
/// If the slope of a coordinate in its own equation is constant, that equation is solved for it, and the solution
/// substituted into the others. There are two conditions. The others stay affine in the momentum, which the path from
/// the identity needs, or they become linear and regular for every momentum.
pub(super) fn specialised<'g>(sources: &Sources<'_, 'g>, equation: MomentumEquation<'g>) -> Vec<MomentumEquation<'g>> {
    if equation.solution != Solution::Newton {
        return vec![equation];
    }
    let is_small = equation.components.len() <= LARGEST;
    let found = is_small.then(|| work::within(SEARCH, || parts(sources, equation.clone())).ok()).flatten();
    found.unwrap_or_else(|| {
        let is_inertial = pattern::is_inertial_as_a_whole(sources, &equation);
        vec![MomentumEquation { is_inertial, ..equation }]
    })
}

/// The equation without coordinates that stay zero; `None` if these are all.
pub(super) fn without_still<'g>(
    sources: &Sources<'_, 'g>,
    equation: MomentumEquation<'g>,
    still: &[usize],
) -> Option<MomentumEquation<'g>> {
    let is_still = |i: &usize| still.contains(&equation.components[*i]);
    let (gone, left): (Vec<usize>, Vec<usize>) = (0..equation.components.len()).partition(is_still);
    if gone.is_empty() {
        return Some(equation);
    }
    let component = |i: usize| equation.components[i];
    let (gone, own) = (gone.into_each(component), left.each(|&i| component(i)));
    let zero = sources.model.graph.zero(Shape::vector(gone.len()));
    let residual = put_in(sources, (&gone, zero), rows_at(equation.residual, &left));
    let residual = if equation.form.is_near { residual } else { residual.expand() };
    (!own.is_empty()).then(|| MomentumEquation::new(sources, own, residual, equation.form))
}

/// The work to look for the structure of a Jacobian. One that takes more is taken as it is.
const SEARCH: u64 = 700_000;

fn parts<'g>(sources: &Sources<'_, 'g>, equation: MomentumEquation<'g>) -> Vec<MomentumEquation<'g>> {
    let mut whole = Reduced::new(sources, equation);
    whole.equation.is_inertial = pattern::is_inertial(sources, &whole.equation, &whole.columns);
    if let Some(explicit) = whole.substituted() {
        return vec![explicit];
    }
    let reduced = whole.reduced();
    let mut equations = reduced.parts();
    equations.extend(reduced.eliminated.into_iter().rev());
    equations
}

/// An equation without the coordinates that the others determine.
struct Reduced<'a, 'b, 'g> {
    sources: &'a Sources<'b, 'g>,
    equation: MomentumEquation<'g>,
    columns: Vec<Expr<'g>>,
    pattern: Pattern,
    /// The equations of the coordinates that were put in, in the order in which they were.
    eliminated: Vec<MomentumEquation<'g>>,
}

impl<'a, 'b, 'g> Reduced<'a, 'b, 'g> {
    fn new(sources: &'a Sources<'b, 'g>, equation: MomentumEquation<'g>) -> Reduced<'a, 'b, 'g> {
        let columns = equation.columns(&sources.symbols);
        let pattern = Pattern::of(sources, &equation, &columns);
        Reduced { sources, equation, columns, pattern, eliminated: Vec::new() }
    }

    /// The solution by substitution, where coordinate after coordinate has a constant slope and needs only those before it.
    fn substituted(&self) -> Option<MomentumEquation<'g>> {
        let mut rest = self.without(&self.leaves())?;
        while !rest.equation.components.is_empty() {
            rest = rest.without(&rest.leaves())?;
        }
        let value = |component: &usize| {
            rest.eliminated.iter().find_map(|equation| {
                let row = equation.components.iter().position(|other| other == component)?;
                Some(equation.formula?.entry(row, 0))
            })
        };
        let values: Vec<Expr<'g>> = self.equation.components.iter().filter_map(value).into_list();
        let formula = self.sources.model.graph.stack(Shape::vector(values.len()), values);
        Some(MomentumEquation { solution: Solution::Explicit, formula: Some(formula), ..self.equation.clone() })
    }

    /// Puts coordinates into the equations of the others as long as that can be done and is of use.
    fn reduced(mut self) -> Reduced<'a, 'b, 'g> {
        while !self.pattern.is_linear() {
            let sets = std::iter::once(self.leaves()).chain(self.constant_blocks());
            match sets.filter_map(|set| self.without(&set)).find(Reduced::is_solvable) {
                Some(next) => self = next,
                None => return self,
            }
        }
        self
    }

    /// The positions of the coordinates whose equations hold no other and have a constant slope.
    fn leaves(&self) -> Vec<usize> {
        let is_leaf = |i: &usize| self.may_go(*i) && self.pattern.is_alone(*i) && self.is_uncoupled(*i);
        (0..self.columns.len()).filter(is_leaf).into_list()
    }

    /// The chart blocks whose equations have a constant multiple of each of their coordinates, and nothing else of them.
    fn constant_blocks(&self) -> Vec<Vec<usize>> {
        let (symbols, components) = (&self.sources.symbols, &self.equation.components);
        let position = |component| components.iter().position(|other| *other == component);
        let block = |i: usize| symbols.blocks[i].components().map(position).collect::<Option<Vec<usize>>>();
        let uncouples = |block: &[usize], i: usize| block.iter().all(|&j| i == j || self.pattern.is_zero(i, j));
        let is_constant = |block: &Vec<usize>| block.iter().all(|&i| self.may_go(i) && uncouples(block, i));
        symbols.blocks_of(components).into_iter().filter_map(block).filter(is_constant).into_list()
    }

    /// Whether a coordinate has a constant slope that is its inertia: any other may vanish at some step size.
    fn may_go(&self, i: usize) -> bool {
        let is_still = !self.equation.moves && !self.sources.is_moving(self.sources.inertia);
        is_still && self.equation.is_inertial && self.pattern.is_constant(i)
    }

    /// Whether a coordinate has no inertia in common with others, so that its slope is zero only where the inertia is singular.
    fn is_uncoupled(&self, i: usize) -> bool {
        let (component, inertia) = (self.equation.components[i], self.sources.inertia);
        (0..inertia.shape().rows).filter(|k| *k != component).all(|k| identity::vanishes(inertia.entry(component, k)))
    }

    /// The equation with the coordinates at these positions put in, x_i = −ρ_i(x_i = 0)/(∂ρ_i/∂x_i); `None` if there are none.
    fn without(&self, positions: &[usize]) -> Option<Reduced<'a, 'b, 'g>> {
        let first = self.slope(*positions.first()?);
        let (sources, graph, whole) = (self.sources, self.sources.model.graph, &self.equation);
        let gone: Vec<usize> = positions.each(|&i| whole.components[i]);
        // if leaves are alone, the other leaves in their formulas cancel
        let absent = if positions.iter().all(|&i| self.pattern.is_alone(i)) { &whole.components } else { &gone };
        let rest = self.with(absent, graph.zero(Shape::vector(absent.len())), rows_at(whole.residual, positions));
        let rest = identity::without_vanishing_terms(rest.expand());
        let value = |(row, &i): (usize, &usize)| -(rest.entry(row, 0) / self.slope(i));
        let formula = if positions.iter().all(|&i| identity::equal(&[self.slope(i)], &[first])) {
            -(rest / first)
        } else {
            graph.stack(Shape::vector(positions.len()), positions.iter().enumerate().map(value).into_list())
        };
        let own = identity::without_vanishing_terms(rows_at(whole.residual, positions));
        let own = MomentumEquation::new(sources, gone.clone(), own, whole.form);
        let mut eliminated = self.eliminated.clone();
        eliminated.push(MomentumEquation { solution: Solution::Explicit, formula: Some(formula), ..own });
        let left: Vec<usize> = (0..self.columns.len()).filter(|i| !positions.contains(i)).into_list();
        let residual = self.with(&gone, formula, rows_at(whole.residual, &left)).expand();
        let residual = identity::without_vanishing_terms(residual);
        let left = left.into_each(|i| whole.components[i]);
        let cleared = whole.form.cleared || whole.residual.has_inverse() && !residual.has_inverse();
        let left =
            Reduced::new(sources, MomentumEquation::new(sources, left, residual, Form { cleared, ..whole.form }));
        Some(Reduced { eliminated, ..left })
    }

    /// The constant ∂ρ_i/∂x_i, from the inertia where it is that: Σ_ii/(s·h).
    fn slope(&self, i: usize) -> Expr<'g> {
        let (sources, component) = (self.sources, self.equation.components[i]);
        let inertia = sources.inertia.entry(component, component).expand().blockwise();
        let expected = inertia / sources.chart_step(sources.symbols.blocks_of(&[component])[0], sources.divisor);
        if identity::equal(&[self.columns[i].entry(i, 0)], &[expected]) {
            return expected;
        }
        self.columns[i].entry(i, 0).substitute(&sources.symbols.at_rest()).expand()
    }

    /// An expression with values for some coordinates.
    fn with(&self, components: &[usize], values: Expr<'g>, expression: Expr<'g>) -> Expr<'g> {
        put_in(self.sources, (components, values), expression)
    }

    /// Whether a path from the identity leads to the solution, or none is needed, and the orientation at its start is
    /// known. A path leads there if the equation is affine in the momentum. A linear equation that is regular for every
    /// momentum needs none.
    fn is_solvable(&self) -> bool {
        let is_regular = self.pattern.is_linear() && self.pattern.has_constant_determinant();
        let is_oriented = self.coupled().is_empty() || self.pattern.connected().len() == 1;
        is_oriented && (is_regular || self.is_affine_in_momenta())
    }

    /// Whether ρ(x; sμ) = ρ(x; 0) + s(ρ(x; μ) − ρ(x; 0)).
    fn is_affine_in_momenta(&self) -> bool {
        let scaled = |factor: i64| {
            let momenta = self.sources.symbols.momenta.iter().map(|mu| (*mu, factor * *mu));
            self.equation.residual.substitute(&momenta.into_list())
        };
        identity::equal(&[scaled(2) + scaled(0)], &[2 * scaled(1)])
    }

    /// The coordinates that were put in and have inertia in common with those that are left.
    fn coupled(&self) -> Vec<usize> {
        let inertia = self.sources.inertia;
        let meets = |i: usize| self.equation.components.iter().any(|&j| !identity::vanishes(inertia.entry(i, j)));
        let gone = self.eliminated.iter().flat_map(|eliminated| eliminated.components.iter().copied());
        gone.filter(|&component| meets(component)).into_list()
    }

    /// One equation for each set of coordinates that depend on each other.
    fn parts(&self) -> Vec<MomentumEquation<'g>> {
        let sets = self.pattern.connected();
        if sets.len() == 1 { vec![self.whole()] } else { sets.each(|positions| self.part(positions)) }
    }

    fn whole(&self) -> MomentumEquation<'g> {
        MomentumEquation {
            solution: if self.pattern.is_linear() { Solution::Linear } else { Solution::Newton },
            structure: self.pattern.structure(),
            coupled: self.coupled(),
            ..self.equation.clone()
        }
    }

    /// The equation of coordinates that do not depend on the others.
    fn part(&self, positions: &[usize]) -> MomentumEquation<'g> {
        let (sources, whole) = (self.sources, &self.equation);
        let is_other = |i: &usize| !positions.contains(i);
        let others: Vec<usize> = (0..self.columns.len()).filter(is_other).map(|i| whole.components[i]).into_list();
        let absent = sources.model.graph.zero(Shape::vector(others.len()));
        let residual = self.with(&others, absent, rows_at(whole.residual, positions)).expand();
        let residual = identity::without_vanishing_terms(residual);
        let components = positions.each(|&i| whole.components[i]);
        let part = MomentumEquation::new(sources, components, residual, whole.form);
        let part = Reduced::new(sources, MomentumEquation { is_inertial: whole.is_inertial, ..part });
        part.substituted().unwrap_or_else(|| part.whole())
    }
}

/// An expression with values for some coordinates.
pub(super) fn put_in<'g>(
    sources: &Sources<'_, 'g>,
    (components, values): (&[usize], Expr<'g>),
    expression: Expr<'g>,
) -> Expr<'g> {
    let symbols = &sources.symbols;
    let value = |block: &ChartBlock<'g>| {
        let known = |component: usize| components.iter().position(|other| *other == component);
        let first = known(block.offset).filter(|_| block.components().all(|component| known(component).is_some()));
        let entry = |component: usize| match known(component) {
            Some(row) => values.entry(row, 0),
            None => block.coordinates.entry(component - block.offset, 0),
        };
        match first {
            Some(first) => values.block(first, 0, block.coordinates.shape()),
            None => values.graph().stack(block.coordinates.shape(), block.components().map(entry).into_list()),
        }
    };
    let blocks = symbols.blocks_of(components).into_iter().map(|i| &symbols.blocks[i]);
    expression.substitute(&blocks.map(|block| (block.coordinates, value(block))).into_list())
}
