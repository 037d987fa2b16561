//! A momentum equation: its residual in the chart, its solution, and the structure of its Jacobian.

use std::ops::Deref;

use clebsch_symbolic::{Chart, Elements, Expr, IntoElements, identity};

use super::trivialisation::Covector;
use super::{ChartBlock, ConstraintFormulas, Symbols, SystemFormulas};
use crate::model::Mechanics;

/// The momentum equation of coordinates that depend on each other.
#[derive(Clone)]
pub struct MomentumEquation<'g> {
    /// Its coordinates, by their indices among those of all factors.
    pub components: Vec<usize>,
    /// The factors that they belong to, by index.
    pub factors: Vec<usize>,
    /// ρ(x), the components of all its coordinates, with μ standing for the momentum after the kick.
    pub residual: Expr<'g>,
    /// Dρ(x)·δ.
    pub directional: Expr<'g>,
    /// How the residual is written.
    pub form: Form,
    /// How it is solved.
    pub solution: Solution,
    /// x, where a formula gives it that is not the predictor; the coordinates of equations before it may occur in it.
    pub formula: Option<Expr<'g>>,
    /// |a|² of the closed form, which has to be below one.
    pub sine_squared: Option<Expr<'g>>,
    /// The closed form in the chart of the sine, where there is one.
    pub(super) sine: Option<SineForm<'g>>,
    /// The known structure of its Jacobian.
    pub structure: Structure,
    /// The coordinates that were put in and have inertia in common with its own.
    pub coupled: Vec<usize>,
    /// Whether Dρ at x = 0 and μ = 0 is Σ/(s·h), before the substitution of coordinates. It is not if a cost adds to it
    /// at every step size.
    pub is_inertial: bool,
    /// Whether it depends on the configuration or on the time.
    pub moves: bool,
}

/// How a residual is written.
#[derive(Copy, Clone, Default)]
pub struct Form {
    /// Whether the congruence with I ∓ Z has freed it of denominators.
    pub cleared: bool,
    /// Whether it is written with D(x) = F − I, after terms have cancelled. Then no products are distributed.
    pub is_near: bool,
}

/// A body whose momentum equation has one scalar unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotatingBody {
    /// In space, with a diagonal inertia or with any, by the chord of Moser and Veselov or by the Cayley map.
    Space {
        /// Whether the inertia is diagonal.
        is_principal: bool,
        /// Whether the discretisation is that of the Cayley map.
        is_cayley: bool,
    },
    /// In four dimensions, with a distribution of mass.
    FourSpace,
}

/// How an equation is solved.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Solution {
    /// By the predictor x = s·h·Σ⁻¹μ, or by substituting known coordinates into equations of constant slope.
    Explicit,
    /// By a formula with one square root.
    ClosedForm,
    /// By the power series of the free motion of a rigid body.
    FreeRotation,
    /// By a root of one scalar equation, that of a rotating body.
    Rotation(RotatingBody),
    /// By one elimination, as the residual is affine in x.
    Linear,
    /// By Newton's method from the predictor.
    Newton,
}

/// The structure of a Jacobian, which its linear systems are solved by.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Structure {
    /// None that helps: elimination with pivoting.
    Dense,
    /// Symmetric for all x: LDLᵀ.
    Symmetric,
    /// Blocks of unknowns, by their positions. Each depends on itself and on those before it: one small system for
    /// each.
    Triangular(Vec<Vec<usize>>),
    /// δ ↦ ⟨δ^B, E⟩ for skew matrices of so many rows: by the Schur form of B.
    Sylvester(usize),
}

/// The momentum equation in the chart of the sine, where it is linear: its solution is a itself.
#[derive(Copy, Clone)]
pub struct SineForm<'g> {
    /// a = hμ/Σ.
    pub(super) solution: Expr<'g>,
    /// ρ(x) = Σx/h − μ.
    pub(super) residual: Expr<'g>,
    /// Dρ·δ.
    pub(super) directional: Expr<'g>,
}

/// The data from which an equation is derived.
pub(super) struct Sources<'a, 'g> {
    pub(super) model: &'a Mechanics<'g>,
    pub(super) system: &'a SystemFormulas<'g>,
    pub(super) inertia: Expr<'g>,
    /// The number of substeps in a step, by which h is divided.
    pub(super) divisor: i64,
    /// Whether exponentials are substituted late, as their products are long.
    pub(super) keeps_exponentials: bool,
}

/// The momentum r(F) = T* ∂_F K − J(q, ∂_q K) of a substep, which its equations solve for F.
pub(super) struct Momentum<'a, 'g> {
    /// T* ∂_F K for each factor.
    pub(super) before: Vec<Covector<'g>>,
    /// The components that a coupled cost, −J(q, ∂_q K), and forces add for each factor.
    pub(super) coupling: Option<Vec<Expr<'g>>>,
    /// −r(q, I) for each factor; `None` if it vanishes.
    pub(super) rest: Option<Vec<Expr<'g>>>,
    /// Whether the cost couples configuration and group element.
    pub(super) couples: bool,
    /// Whether a force that depends on the velocity joins the equations: then Σ alone gives no coordinate.
    pub(super) is_forced: bool,
    /// The constraint whose force joins the equations.
    pub(super) constraint: Option<&'a ConstraintFormulas<'g>>,
}

impl Sources<'_, '_> {
    /// Whether D(x) is substituted late in a chart.
    pub(super) fn keeps(&self, chart: Chart, couples: bool) -> bool {
        is_kept(chart, couples || self.keeps_exponentials)
    }
}

impl<'g> Deref for Sources<'_, 'g> {
    type Target = SystemFormulas<'g>;

    fn deref(&self) -> &SystemFormulas<'g> {
        self.system
    }
}

impl<'g> MomentumEquation<'g> {
    /// An equation for Newton's method.
    pub(super) fn new(
        system: &SystemFormulas<'g>,
        components: Vec<usize>,
        residual: Expr<'g>,
        form: Form,
    ) -> MomentumEquation<'g> {
        let symbols = &system.symbols;
        let blocks: Vec<_> = symbols.blocks_of(&components).into_each(|i| symbols.blocks[i]);
        let mut factors: Vec<usize> = blocks.each(|block| block.factor);
        factors.dedup();
        let directions: Vec<_> = blocks.each(|block| (block.coordinates, block.direction));
        let moves = system.is_moving(residual);
        let slope = residual.differential(&directions);
        let kept = form.is_near || factors.iter().any(|&k| is_kept(symbols.charts[k], moves));
        MomentumEquation {
            components,
            factors,
            residual,
            directional: if kept { slope } else { slope.expand_within(DISTRIBUTED) },
            form,
            solution: Solution::Newton,
            formula: None,
            sine_squared: None,
            sine: None,
            structure: Structure::Dense,
            coupled: Vec::new(),
            is_inertial: true,
            moves,
        }
    }

    /// Whether Dρ(x) holds no coordinate.
    pub fn is_affine(&self, symbols: &Symbols<'g>) -> bool {
        !symbols.blocks.iter().any(|block| self.directional.depends_on(block.coordinates))
    }

    /// The columns of Dρ(x), one for each of its coordinates.
    pub fn columns(&self, symbols: &Symbols<'g>) -> Vec<Expr<'g>> {
        let graph = self.residual.graph();
        let blocks: Vec<_> = symbols.blocks_of(&self.components).into_each(|i| symbols.blocks[i]);
        let column = |&component: &usize| {
            let direction = |block: &ChartBlock<'g>| {
                let shape = block.direction.shape();
                let is_own = block.components().contains(&component);
                let unit = if is_own { graph.unit(shape, component - block.offset, 0) } else { graph.zero(shape) };
                (block.direction, unit)
            };
            self.directional.substitute(&blocks.each(direction))
        };
        self.components.each(column)
    }
}

/// The work to distribute the products of a formula. A longer one stays as it is.
pub(super) const DISTRIBUTED: u64 = 30_000;

/// Whether a matrix is zero off its diagonal for all values of its symbols.
pub(super) fn is_diagonal(matrix: Expr<'_>) -> bool {
    matrix.shape().positions().filter(|(i, j)| i != j).all(|(i, j)| identity::vanishes(matrix.entry(i, j)))
}

/// Whether D(x) = F − I is substituted late and its products are not distributed, because that would make them many
/// times longer. This is so in a chart with roots, and with exponentials if the cost couples configuration and group
/// element.
fn is_kept(chart: Chart, couples: bool) -> bool {
    chart == Chart::Root || chart == Chart::Exponential && couples
}
