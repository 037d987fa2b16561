//! The value of the stage `derive`: all that follows from a model, and the questions that later stages ask of it.

use std::fmt;
use std::ops::Deref;

use clebsch_symbolic::{Chart, Expr, Group, IntoList, Property, Role};

use super::energy::is_multiple_of_identity;
use super::{
    Collocation, ConstraintFormulas, DiscreteLagrangian, Energy, FieldFormulas, FormulaTable, InputStep, JointFormulas,
    MomentumEquation, MonitorFormulas, Quantity, RotatingBody, SiteTerm, Solution, Splitting, Substep, SymmetricParts,
    Symmetries, SystemFormulas, Vertical, exact, signature,
};
use crate::model::{Factor, Isotropy, LeafSpace, Mechanics, Signature, Steered};

/// The derived formulas, as matrix expressions.
pub enum Formulas<'g> {
    /// Of mechanics.
    Mechanics(Box<MechanicsFormulas<'g>>),
    /// Of a configuration that inputs move.
    Steered(Box<SteeredFormulas<'g>>),
}

/// The formulas of a configuration that inputs move.
pub struct SteeredFormulas<'g> {
    /// The formulas of the action and of the prices.
    pub system: SystemFormulas<'g>,
    /// The model that all of it is derived from.
    pub model: Steered<'g>,
    /// The step that inputs make.
    pub step: InputStep<'g>,
}

/// The formulas of mechanics.
pub struct MechanicsFormulas<'g> {
    /// The formulas of the action and of the prices.
    pub system: SystemFormulas<'g>,
    /// The model that all of it is derived from.
    pub model: Mechanics<'g>,
    /// Whether only the identity fixes a general configuration.
    pub is_free: bool,
    /// J(q, μ_Q(q))/c for each factor, where some motions fix q and that is the orthogonal projection of μ to 𝔤_q^⊥, as on spheres.
    pub projection: Option<Vec<Expr<'g>>>,
    /// Ad*_F μ, for each factor.
    pub coadjoint: Vec<Expr<'g>>,
    /// (TΦ_F)^{-*} p as a function of F, q⁺ and p, for each leaf of the configuration.
    pub cotangent_lift: Vec<Expr<'g>>,
    /// Σ, the Hessian of ℓ(ξ) in the components of all factors.
    pub inertia: Expr<'g>,
    /// κ, where Σ = κ I.
    pub uniform_inertia: Option<Expr<'g>>,
    /// The kinetic part of the continuous Lagrangian, ½ ξ·Σξ + A·ξ.
    pub energy: Energy<'g>,
    /// The matrices that the kinetic energy takes the symmetric part of.
    pub symmetric: SymmetricParts<'g>,
    /// V(q), that of the cost included.
    pub potential_energy: Expr<'g>,
    /// ½J(q, ∂(U₁ − U₀)) for each factor: the momentum of a step of first order is ahead of its configuration by it.
    /// `None` if it is not ahead.
    pub stagger: Option<Vec<Expr<'g>>>,
    /// Whether a step of first order is one of second order but for that shift.
    pub is_staggered: bool,
    /// The terms that tie the sites of a power to each other.
    pub links: Vec<SiteTerm<'g>>,
    /// The conserved quantities.
    pub symmetries: Symmetries<'g>,
    /// The vertical term; `None` where the declared kinetic energy is regular.
    pub vertical: Option<Vertical<'g>>,
    /// The discrete Lagrangian, with the vertical term.
    pub lagrangian: DiscreteLagrangian<'g>,
    /// F⁻ℓd(q, F) for each factor: T* ∂_F K − J(q, ∂_q K) − J(q, ∂U₀).
    pub legendre: Vec<Expr<'g>>,
    /// F⁺ℓd(q, F) for each factor without its last kick: the other trivialisation of ∂_F K.
    pub legendre_next: Vec<Expr<'g>>,
    /// J(q, ∂U₁), the last kick of F⁺ℓd, to be taken at q⁺; `None` if there is none.
    pub legendre_kick: Option<Vec<Expr<'g>>>,
    /// The quantities with respect to which steps are differentiated, if the declaration asks for that.
    pub quantities: Vec<Quantity<'g>>,
    /// The substeps of a step. A time-symmetric Lagrangian has one of full length, others have two of half the length.
    /// The two of a composed step are followed by the declared Lagrangian itself, since its Legendre transform is
    /// inverted.
    pub substeps: Vec<Substep<'g>>,
    /// How many of the substeps make a step: two where ℓd is composed with its adjoint.
    pub stepped: usize,
    /// The drifts and kicks that make a step of higher order, where drifts are exact and there is a potential.
    pub splitting: Option<Splitting<'g>>,
    /// The monitor that sets the times of steps; `None` where they are of one size.
    pub monitor: Option<MonitorFormulas<'g>>,
    /// Hamilton's equations, where a step collocates them.
    pub collocation: Option<Collocation<'g>>,
    /// Whether a step is exact for lack of a potential, so that its order says nothing.
    pub is_exact: bool,
    /// The force in 𝔤* for each factor, a function of t, q, ξ and u; `None` if the potential is the only force.
    pub covector: Option<Vec<Expr<'g>>>,
    /// The constraint; `None` where every velocity is allowed.
    pub constraint: Option<ConstraintFormulas<'g>>,
    /// The joints of a power; `None` where its sites move freely.
    pub joints: Option<JointFormulas<'g>>,
    /// The forces of a field; `None` where there is one site.
    pub field: Option<FieldFormulas<'g>>,
}

impl<'g> Deref for MechanicsFormulas<'g> {
    type Target = SystemFormulas<'g>;

    fn deref(&self) -> &SystemFormulas<'g> {
        &self.system
    }
}

impl<'g> Deref for SteeredFormulas<'g> {
    type Target = SystemFormulas<'g>;

    fn deref(&self) -> &SystemFormulas<'g> {
        &self.system
    }
}

impl<'g> Formulas<'g> {
    /// All formulas.
    pub fn table(&self) -> &FormulaTable<'g> {
        match self {
            Formulas::Mechanics(formulas) => formulas.table(),
            Formulas::Steered(formulas) => formulas.table(),
        }
    }

    /// The formulas that `DERIVATION` lists, in an `align*` of LaTeX.
    pub fn latex(&self) -> String {
        self.table().latex()
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// How many directions the kinetic energy is positive and negative in, for positive parameters.
    pub fn signature(&self) -> Option<(usize, usize)> {
        let (positive, negative) = signature::signature(self.block_of_inertia())?;
        let copies = self.inertia.shape().rows / self.block_of_inertia().shape().rows;
        Some((positive * copies, negative * copies))
    }

    /// Σ, or κ where it is κI.
    fn block_of_inertia(&self) -> Expr<'g> {
        if is_multiple_of_identity(self.inertia) { self.inertia.entry(0, 0) } else { self.inertia }
    }

    /// Whose parameters that is: those of any size, or typical ones, where others may have another signature.
    pub fn parameters_of_signature(&self) -> &'static str {
        let inertia = self.block_of_inertia();
        let is_symmetric = |symbol: &Expr<'_>| {
            matches!(symbol.role(), Some(Role::Parameter(_))) && symbol.property() == Property::Symmetric
        };
        let are_symmetric = inertia.symbols().iter().any(is_symmetric);
        if !are_symmetric && signature::holds_for_all(inertia, false) {
            "positive parameters"
        } else if signature::holds_for_all(inertia, true) {
            "positive parameters and positive definite matrices"
        } else {
            "typical parameters, and not for all positive ones"
        }
    }

    /// Whether a step does not begin and end with half a kick.
    pub fn has_own_schedule(&self) -> bool {
        self.splitting.is_some() || self.monitor.is_some() || self.collocation.is_some()
    }

    /// Of how many steps of second order a step is composed, where it is.
    pub fn stages(&self) -> Option<usize> {
        self.model.order.stages().filter(|_| self.splitting.is_none() && self.monitor.is_none() && !self.is_exact)
    }

    /// Whether nothing but the kinetic energy moves the system: no potential, and no other site.
    pub(super) fn moves_freely(&self) -> bool {
        !super::energy::pushes(&self.model, self.potential_energy) && self.links.is_empty() && self.field.is_none()
    }

    /// Whether this is the model of one of many sites.
    pub(super) fn has_sites(&self) -> bool {
        self.model.power.is_some() || self.field.is_some()
    }

    /// The same of a step of all sites of a power. Free sites whose motion is exact need none.
    pub fn stages_of_sites(&self) -> Option<usize> {
        let power = self.model.power.as_ref()?;
        power.order.stages().filter(|_| !self.is_exact || !self.links.is_empty())
    }

    /// The rotations and unit quaternions whose chart coordinates x/w are given by x and w: F − I saves the division.
    pub fn weighted(&self) -> Vec<usize> {
        let is_found = |k: &usize| match self.model.factors[*k].group {
            Group::SpecialOrthogonal(3) | Group::UnitQuaternions => {
                exact::is_free_rotation(&self.model, *k) || self.has_scalar_equation(*k)
            }
            _ => false,
        };
        (0..self.model.factors.len()).filter(is_found).into_list()
    }

    /// Whether a rotation in space is a free motion, exactly.
    pub fn turns_freely(&self) -> bool {
        let rotates = |k: &usize| self.model.factors[*k].group == Group::SpecialOrthogonal(3);
        (0..self.model.factors.len()).any(|k| rotates(&k) && exact::is_free_rotation(&self.model, k))
    }

    /// Whether each step has the same scalars: those of bodies that turn freely, whose momenta move with them.
    pub fn keeps_scalars(&self) -> bool {
        let [substep] = self.substeps.as_slice() else { return false };
        // 1 + |x|² of the Cayley map changes along a motion
        let is_scalar = |equation: &MomentumEquation<'_>| match equation.solution {
            Solution::Rotation(RotatingBody::Space { is_cayley, .. }) => !is_cayley,
            solution => matches!(solution, Solution::Rotation(_)),
        };
        let is_solved = |equation: &MomentumEquation<'_>| {
            is_scalar(equation) || equation.solution == Solution::Explicit && equation.formula.is_none()
        };
        let is_group = |factor: &Factor<'_>| match factor.group {
            Group::SpecialOrthogonal(n) => n == 3,
            group => group == Group::UnitQuaternions || group.is_translation(),
        };
        let is_free = substep.start.is_none() && substep.end.is_none() && substep.rest.is_none();
        let is_alone = substep.coupling.is_none() && substep.force.is_none() && self.constraint.is_none();
        is_free
            && is_alone
            && self.moves_freely()
            && !self.has_sites()
            && !self.is_timed()
            && self.stages().is_none()
            && self.collocation.is_none()
            && self.model.factors.iter().all(is_group)
            && substep.equations.iter().any(is_scalar)
            && substep.equations.iter().all(is_solved)
    }

    /// Whether the motion of a factor is found by one scalar in all substeps, and moves alone take its coordinates.
    fn has_scalar_equation(&self, k: usize) -> bool {
        let is_scalar = |equation: &MomentumEquation<'_>| matches!(equation.solution, Solution::Rotation(_));
        let is_free = self.constraint.is_none() && self.joints.is_none() && self.field.is_none();
        is_free
            && self.collocation.is_none()
            && self.substeps.iter().all(|substep| {
                let mut own = substep.equations.iter().filter(|equation| equation.factors.contains(&k)).peekable();
                own.peek().is_some() && own.all(is_scalar) && !self.ends_with_velocity(substep)
            })
    }

    /// Whether the force at the end of a substep depends on the velocity: it reads chart coordinates.
    fn ends_with_velocity(&self, substep: &Substep<'_>) -> bool {
        let end = substep.force.iter().flat_map(|force| &force.end);
        let elements = self.model.factors.iter().map(|factor| factor.symbol);
        let velocities: Vec<_> = elements.chain(self.symbols.logarithms.iter().copied()).into_list();
        end.into_iter().any(|part| velocities.iter().any(|velocity| part.depends_on(*velocity)))
    }

    /// Whether the step is found as F − I and the next momentum themselves, not by chart coordinates.
    pub fn turns_whole(&self) -> bool {
        exact::turns_whole(&self.model)
    }

    /// Whether the cost or the potential depends on the time.
    pub fn is_timed(&self) -> bool {
        is_timed(&self.model, &self.lagrangian)
    }

    /// Whether a step turns a point on a sphere along a great circle, and leaves its momentum M = wqᵀ − qwᵀ as it is.
    /// Steps can then be made in (q, w).
    pub fn follows_great_circles(&self) -> bool {
        let ([factor], [leaf], [substep]) =
            (self.model.factors.as_slice(), self.model.configurations.as_slice(), self.substeps.as_slice())
        else {
            return false;
        };
        matches!(factor.group, Group::SpecialOrthogonal(n) if n > 3)
            && self.monitor.is_none()
            && leaf.space == LeafSpace::Unit
            && self.generator[0] == factor.group.wedge(self.symbols.algebra[0]) * leaf.symbol
            && self.symbols.charts[0] == Chart::Sine
            && self.uniform_inertia.is_some()
            && self.model.isotropy == Isotropy::Fixed
            && substep.unchanged[0]
            && substep.rest.is_none()
            && substep.force.is_none()
            && substep.reaction.is_none()
            && substep.coupling.is_none()
            && !self.is_timed()
            && !self.is_compensated()
    }

    /// Whether the inertia has to be positive definite.
    pub fn is_definite(&self) -> bool {
        self.model.signature == Signature::Definite
    }

    /// Whether the kinetic energy changes with the configuration or the time.
    pub fn inertia_moves(&self) -> bool {
        self.is_moving(self.inertia)
    }

    /// Whether each row of the constraint says that a coordinate of a step is zero.
    pub(super) fn has_no_multiplier(&self, substep: &Substep<'_>) -> bool {
        self.constraint.as_ref().is_some_and(|constraint| substep.still.len() == constraint.rows.shape().rows)
    }

    /// Whether the solution of an equation is given in terms of the coordinates of others, which are solved before it.
    pub(super) fn is_solved_after_others(&self, equation: &MomentumEquation<'_>) -> bool {
        let holds = |formula: Expr<'_>| self.symbols.blocks.iter().any(|block| formula.depends_on(block.coordinates));
        equation.formula.is_some_and(holds)
    }
}

impl fmt::Display for Formulas<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.table())
    }
}

/// Whether a discrete Lagrangian depends on the time.
pub(super) fn is_timed(model: &Mechanics<'_>, lagrangian: &DiscreteLagrangian<'_>) -> bool {
    let forces = model.force.iter().flat_map(|force| force.of_group.iter().chain(&force.on_configuration).flatten());
    let energies = [lagrangian.kinetic, lagrangian.start, lagrangian.end];
    let terms = model.power.iter().flat_map(|power| power.terms.iter().map(|term| &term.value));
    let joints = model.power.iter().flat_map(|power| &power.joints).flat_map(|joints| &joints.all);
    let joints = joints.map(|joint| &joint.term.value);
    let of_field = model.field.iter().filter_map(|field| field.potential.as_ref());
    let mut constraint = model.constraint.iter().flat_map(|constraint| constraint.parts());
    energies.iter().chain(forces).chain(terms).chain(of_field).chain(joints).any(|part| part.depends_on(model.time))
        || constraint.any(|part| part.depends_on(model.time))
}
