//! The value of the stage `model`: typed matrix expressions with names, shapes, groups and sides.

use std::ops::Deref;
use std::rc::Rc;

use clebsch_symbolic::{Elements, Expr, Graph, Group, Shape};
use proc_macro2::Span;

use super::power::{Joints, Length, SiteIndex, Term};
use super::{Access, Layout};
use crate::diagnostic::Location;
use crate::parse::{
    Dials, Discretization, Emit, Isotropy, Located, Opaque, Order, Pattern, Promise, RungeKutta, Signature, Summation,
};

/// The mathematics of a declaration, checked: names, shapes, groups, the laws of the action.
pub enum Model<'g> {
    /// Momenta move the configuration.
    Mechanics(Box<Mechanics<'g>>),
    /// Inputs move the configuration by themselves, without mass, momentum or force.
    Steered(Box<Steered<'g>>),
}

/// The part that mechanics and control share: the user's struct, the group with its action, and the inputs.
pub struct System<'g> {
    /// The owner of all expressions.
    pub graph: &'g Graph,
    /// The data of the user's struct that generated code needs.
    pub item: Item,
    /// Every field that a closure reads, in order of declaration.
    pub parameters: Vec<Parameter<'g>>,
    /// Scalar constants of the user's crate, in order of their first use.
    pub constants: Vec<Constant<'g>>,
    /// The symbol h.
    pub step_size: Expr<'g>,
    /// The symbol t: the time of the step's start in a cost, of the configuration elsewhere.
    pub time: Expr<'g>,
    /// The factors of the group, in order of their leaves.
    pub factors: Vec<Factor<'g>>,
    /// How the factors nest.
    pub element: Layout,
    /// The leaves of the configuration.
    pub configurations: Vec<Configuration<'g>>,
    /// How the leaves of the configuration nest.
    pub configuration: Layout,
    /// The names of the configuration, as the action has them.
    pub configuration_names: Pattern,
    /// Φ_F(q), one expression for each leaf of the configuration.
    pub action: Vec<Expr<'g>>,
    /// The leaves of the input u of a step; empty where nothing takes one. References of forces are behind those that a plan chooses.
    pub inputs: Vec<Configuration<'g>>,
    /// How the leaves of the input nest.
    pub input: Layout,
    /// The references that forces read, as they are reached in the reference of a step.
    pub given: Vec<Access>,
    /// The leaves of the reference of a step, and how they nest.
    pub reference: (Layout, Vec<Configuration<'g>>),
    /// Those of the reference of the end.
    pub end_reference: (Layout, Vec<Configuration<'g>>),
    /// The choice of the inputs; `None` if there is no choice.
    pub control: Option<InputChoice<'g>>,
    /// The price of the end; `None` if there is none.
    pub endpoint: Option<EndPrice<'g>>,
    /// The conditions of the end; `None` where none are declared.
    pub target: Option<EndConditions<'g>>,
    /// The dials that the user turns and that the model is not made of.
    pub dials: Dials,
    /// The items that are emitted with the integrator.
    pub emit: Emit,
    /// The closures' bodies as written, for the errors of later stages.
    pub spans: Spans,
}

/// A mechanical system.
pub struct Mechanics<'g> {
    /// The part that it shares with other models.
    pub system: Rc<System<'g>>,
    /// The kinetic part of the discrete Lagrangian, or the Lagrangian that it is to be made of.
    pub kinetic: Kinetic<'g>,
    /// V(t, q); a free body has none.
    pub potential: Option<Expr<'g>>,
    /// The methods behind an opaque potential.
    pub opaque: Option<Opaque>,
    /// The monitor that sets the times of steps; `None` where they are of one size.
    pub monitor: Option<Monitor<'g>>,
    /// The forces; `None` where nothing but the potential acts.
    pub force: Option<Force<'g>>,
    /// The constraint; `None` where every velocity is allowed.
    pub constraint: Option<Constraint<'g>>,
    /// The terms that tie sites to each other, if the declaration is a power and this is the model of a site.
    pub power: Option<Power<'g>>,
    /// The energies of a field, if the declaration is one and this is the model of a site.
    pub field: Option<FieldEnergies<'g>>,
    /// The symmetries that the user offers; whether cost and potential have them is still open.
    pub symmetries: Vec<OfferedSymmetry<'g>>,
    /// How to treat motions of the group that move no configuration.
    pub isotropy: Isotropy,
    /// The signs that the kinetic energy may have.
    pub signature: Signature,
    /// Where the potential is placed.
    pub order: Order,
}

/// A configuration that inputs move.
pub struct Steered<'g> {
    /// The part that it shares with other models.
    pub system: Rc<System<'g>>,
    /// How the inputs move it.
    pub motion: Motion<'g>,
}

impl<'g> System<'g> {
    /// The leaves of the input that a plan chooses.
    pub fn chosen(&self) -> &[Configuration<'g>] {
        // a choice has one vector of inputs
        let count = if self.given.is_empty() { self.inputs.len() } else { 1 };
        self.inputs.get(..count).unwrap_or_default()
    }

    /// Whether an expression depends on the configuration.
    pub fn reads_configuration(&self, expression: Expr<'g>) -> bool {
        self.configurations.iter().any(|leaf| expression.depends_on(leaf.symbol))
    }

    /// The number of components of all factors.
    pub fn dimension(&self) -> usize {
        self.offset(self.factors.len())
    }

    /// The index of a factor's first component among those of all.
    pub fn offset(&self, k: usize) -> usize {
        self.factors[..k].iter().map(|factor| factor.group.dimension()).sum()
    }
}

impl Mechanics<'_> {
    /// Whether discrete Lagrangians are differentiated twice.
    pub fn has_variations(&self) -> bool {
        self.emit.variations() || self.control.is_some()
    }

    /// Where compensated sums are asked for.
    pub fn compensated(&self) -> Option<&Located<Summation>> {
        self.dials.summation.as_ref().filter(|summation| summation.value == Summation::Compensated)
    }

    /// Whether the sums of a step keep the rests of their rounding.
    pub fn is_compensated(&self) -> bool {
        self.compensated().is_some()
    }

    /// The order as declared: of a power or a field that of all sites together.
    pub fn declared_order(&self) -> Order {
        let of_sites = self.power.as_ref().map(|power| power.order);
        of_sites.or_else(|| self.field.as_ref().map(|field| field.order)).unwrap_or(self.order)
    }

    /// Whether there are covectors to step: not under forces and constraints, which act in 𝔤*, and not without a
    /// configuration.
    pub fn has_covectors(&self) -> bool {
        self.force.is_none() && self.constraint.is_none() && !self.configurations.is_empty()
    }
}

impl<'g> Deref for Mechanics<'g> {
    type Target = System<'g>;

    fn deref(&self) -> &System<'g> {
        &self.system
    }
}

impl<'g> Deref for Steered<'g> {
    type Target = System<'g>;

    fn deref(&self) -> &System<'g> {
        &self.system
    }
}

/// The user's struct, as generated code has to name it.
#[derive(Clone)]
pub struct Item {
    /// Its name.
    pub ident: syn::Ident,
    /// Its generics.
    pub generics: syn::Generics,
    /// The scalar of its fields.
    pub scalar: ScalarType,
    /// The path of the runtime, `::clebsch` unless `crate = path` says otherwise.
    pub krate: syn::Path,
}

/// The scalar that a system is computed with.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ScalarType {
    /// `f32`.
    F32,
    /// `f64`.
    F64,
    /// A type parameter of the struct.
    Parameter(syn::Ident),
}

/// A field that a closure reads.
#[derive(Clone)]
pub struct Parameter<'g> {
    /// The field, with the span of its declaration.
    pub field: syn::Member,
    /// The field's name, for symbols and messages.
    pub name: String,
    /// Where a closure first reads it.
    pub first_use: Span,
    /// The user's promise about its values.
    pub promise: Option<Promise>,
    /// Whether it is an array with one entry for each site of a power. The other fields then describe one entry.
    pub per_site: bool,
    /// Whether bounds alone read it, so that it may be infinite.
    pub is_limit: bool,
    /// How arrays nest.
    pub structure: Layout,
    /// One entry for each scalar, vector or matrix in it.
    pub leaves: Vec<Leaf<'g>>,
}

/// A scalar, vector or matrix of a parameter.
#[derive(Clone, Debug)]
pub struct Leaf<'g> {
    /// Its symbol.
    pub symbol: Expr<'g>,
    /// How it is reached from the field, `[0]`; empty for a field that is no array.
    pub accessor: Access,
    /// Its shape.
    pub shape: Shape,
    /// Whether the Rust type is the scalar itself, not a 1×1 matrix.
    pub is_scalar: bool,
}

/// A scalar constant of the user's crate.
pub struct Constant<'g> {
    /// Its path, with the spans of its first use.
    pub path: syn::Path,
    /// Its symbol.
    pub symbol: Expr<'g>,
}

/// A factor of the group.
#[derive(Clone)]
pub struct Factor<'g> {
    /// The group.
    pub group: Group,
    /// The symbol of its element, F.
    pub symbol: Expr<'g>,
    /// The user's name for the element, `F`, `F[0]`.
    pub name: String,
    /// The side from which it acts; if it moves nothing, that of the other factors.
    pub side: Side,
    /// Whether it moves any configuration.
    pub moves: bool,
    /// How it is reached in the element, `.0[1]`.
    pub accessor: Access,
    /// Where its type is written.
    pub span: Span,
}

/// The side of an action.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Side {
    /// Φ_{F1 F2} = Φ_{F1} Φ_{F2}.
    Left,
    /// Φ_{F1 F2} = Φ_{F2} Φ_{F1}.
    Right,
}

impl Side {
    /// The frame that momenta and velocities of such an action are in.
    pub fn frame(self) -> &'static str {
        if self == Side::Left { "spatial" } else { "body" }
    }
}

/// A leaf of the configuration.
#[derive(Clone)]
pub struct Configuration<'g> {
    /// Its symbol, q.
    pub symbol: Expr<'g>,
    /// The user's name for it, `q`, `q[0]`.
    pub name: String,
    /// The space that it lies in.
    pub space: LeafSpace,
    /// Its shape.
    pub shape: Shape,
    /// Whether its Rust type is a quaternion, whose coordinates are i, j, k, w.
    pub is_quaternion: bool,
    /// How it is reached in the configuration, `.0[1]`.
    pub accessor: Access,
}

/// The promise about a leaf of the configuration.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum LeafSpace {
    /// Any vector or matrix.
    Vectors,
    /// A vector of length one.
    Unit,
    /// A symmetric matrix.
    Symmetric,
    /// The orthogonal projector to a subspace of this dimension.
    Projector(usize),
    /// A matrix of orthonormal columns, fewer than its rows.
    Orthonormal,
    /// An element of a group.
    Group(Group),
}

/// How inputs move the configuration.
pub enum Motion<'g> {
    /// F = τ(h ξ(t, q, u)).
    Controls {
        /// ξ in the components of each factor.
        velocity: Vec<Expr<'g>>,
        /// How F is made from ξ: by the exponential or Cayley's map.
        discretization: Discretization,
    },
    /// q⁺ = f(t, h, q, u), for each leaf of the configuration: translations by f − q.
    Dynamics {
        /// f, for each leaf.
        next: Vec<Expr<'g>>,
        /// The right-hand side of x′ that it comes from, and how it is integrated.
        from: Option<(Expr<'g>, RungeKutta)>,
    },
}

/// The kinetic part of the discrete Lagrangian.
pub enum Kinetic<'g> {
    /// K(t, h, q, F) as declared.
    Cost(Expr<'g>),
    /// To be made from a Lagrangian.
    Lagrangian {
        /// ℓ(t, q, ξ).
        energy: Expr<'g>,
        /// The symbols of ξ, one for each factor, in the components of its group's basis.
        velocities: Vec<Expr<'g>>,
        /// The user's name for ξ.
        name: String,
        /// How ξ is made from F and h.
        discretization: Discretization,
    },
}

impl<'g> Kinetic<'g> {
    /// The cost, or the Lagrangian.
    pub fn energy(&self) -> Expr<'g> {
        match self {
            Kinetic::Cost(energy) | Kinetic::Lagrangian { energy, .. } => *energy,
        }
    }

    /// T of a Lagrangian T(ξ) − V(q), and V with the declared potential: the same step, and shorter, as nothing couples in it.
    pub fn without_potential(self, system: &System<'g>, declared: Option<Expr<'g>>) -> (Kinetic<'g>, Option<Expr<'g>>) {
        let Kinetic::Lagrangian { energy, velocities, name, discretization } = self else { return (self, declared) };
        let at_rest = velocities.each(|xi| (*xi, system.graph.zero(xi.shape())));
        let potential = -energy.substitute(&at_rest);
        let depends = |energy: Expr<'g>| system.configurations.iter().any(|leaf| energy.depends_on(leaf.symbol));
        let moving = energy + potential;
        let moving = if depends(moving) { moving.expand() } else { moving };
        if !depends(potential) || depends(moving) || energy.depends_on(system.time) {
            return (Kinetic::Lagrangian { energy, velocities, name, discretization }, declared);
        }
        let all = declared.map_or(potential, |declared| declared + potential);
        (Kinetic::Lagrangian { energy: moving, velocities, name, discretization }, Some(all))
    }

    /// How a Lagrangian becomes a cost; `None` for a cost.
    pub fn discretization(&self) -> Option<Discretization> {
        if let Kinetic::Lagrangian { discretization, .. } = self { Some(*discretization) } else { None }
    }
}

/// The monitor that `step` declares.
pub struct Monitor<'g> {
    /// g(q): dt = g ds.
    pub value: Expr<'g>,
    /// The function as written.
    pub written: Written,
}

/// The forces other than that of the potential, as functions of t, q, ξ and the input u.
pub struct Force<'g> {
    /// The force in 𝔤*, in the components of each factor; `None` if there is none.
    pub of_group: Option<Vec<Expr<'g>>>,
    /// The force on each leaf of the configuration, a covector; `None` if there is none.
    pub on_configuration: Option<Vec<Expr<'g>>>,
    /// The symbols of ξ, one for each factor.
    pub velocities: Vec<Expr<'g>>,
    /// The closures' bodies as written.
    pub written: Vec<Written>,
}

/// Equations that the velocity or the configuration obeys.
pub struct Constraint<'g> {
    /// φ(t, q) with φ = 0, equations of scalars one below the other: holonomic. `None` if there is none.
    pub places: Option<Expr<'g>>,
    /// The equations of velocities, nonholonomic; `None` if there is none.
    pub velocities: Option<VelocityRows<'g>>,
    /// Each of them as written, those of places first.
    pub equations: Vec<Equation>,
    /// How the velocity of a step is made from F and h, if the declaration says so.
    pub discretization: Option<Discretization>,
}

/// a(t, q) ξ = b(t, q), equations of scalars one below the other.
#[derive(Copy, Clone)]
pub struct VelocityRows<'g> {
    /// a, in the components of all factors.
    pub rows: Expr<'g>,
    /// b.
    pub values: Expr<'g>,
}

impl<'g> Constraint<'g> {
    /// The functions of time and configuration in it.
    pub fn parts(&self) -> impl Iterator<Item = Expr<'g>> {
        let of_velocities = self.velocities.into_iter().flat_map(|VelocityRows { rows, values }| [rows, values]);
        self.places.into_iter().chain(of_velocities)
    }
}

/// An equation of a constraint.
#[derive(Clone)]
pub struct Equation {
    /// As it was written.
    pub written: Written,
    /// How many equations of scalars it is.
    pub count: usize,
    /// Whether it is of velocities.
    pub is_of_velocities: bool,
}

/// The choice of inputs.
pub struct InputChoice<'g> {
    /// ℓ(t, h, q, ξ, u), the price of a step.
    pub price: Expr<'g>,
    /// ξ for each factor, the velocity of the step; none where neither price nor bounds take it.
    pub velocities: Vec<Expr<'g>>,
    /// The conditions that have to be satisfied.
    pub bounds: Vec<Bound<'g>>,
    /// The price as written.
    pub written: Written,
}

impl InputChoice<'_> {
    /// The number of bounds that are equations.
    pub fn equations(&self) -> usize {
        self.bounds.iter().filter(|bound| matches!(bound.kind, BoundKind::Equation)).count()
    }

    /// The number of bounds that may be violated, at a price.
    pub fn soft_bounds(&self) -> usize {
        self.bounds.iter().filter(|bound| matches!(bound.kind, BoundKind::Soft(_))).count()
    }
}

/// φ(t, q, ξ), the price of the end.
pub struct EndPrice<'g> {
    /// φ.
    pub value: Expr<'g>,
    /// ξ for each factor, the velocity at the end; none if the price takes none.
    pub velocities: Vec<Expr<'g>>,
    /// The price as written.
    pub written: Written,
}

/// The conditions of the end that `target` declares.
pub struct EndConditions<'g> {
    /// The equations, and the inequalities after them.
    pub conditions: Vec<Condition<'g>>,
    /// The number of equations.
    pub equations: usize,
    /// ξ for each factor, the velocity at the end; none if no condition takes it.
    pub velocities: Vec<Expr<'g>>,
    /// The closure as written.
    pub written: Written,
}

/// a = b or a ≤ b, with functions of (t, q, ξ).
pub struct Condition<'g> {
    /// a.
    pub left: Expr<'g>,
    /// b.
    pub right: Expr<'g>,
    /// Whether both are equal.
    pub is_equation: bool,
    /// Where it was written.
    pub place: Location,
    /// As it was written, `q.x == 1`; the same for all entries of vectors.
    pub text: String,
}

/// a(t, q, ξ, u) ≤ 0 or a = 0. Equations come first, and the soft ones, of a price with max(a, 0), last.
pub struct Bound<'g> {
    /// a.
    pub value: Expr<'g>,
    /// Whether a = 0 or a ≤ 0, and the price of violating it.
    pub kind: BoundKind<'g>,
    /// As it was written, `u.x <= 1`.
    pub text: String,
}

/// The kind of a bound, by its value a.
pub enum BoundKind<'g> {
    /// a = 0.
    Equation,
    /// a ≤ 0.
    Inequality,
    /// a ≤ 0, or the price w(t, h) of each unit of a.
    Soft(Expr<'g>),
}

impl<'g> Bound<'g> {
    /// w(t, h), where the bound may be violated.
    pub fn price(&self) -> Option<Expr<'g>> {
        match self.kind {
            BoundKind::Soft(price) => Some(price),
            BoundKind::Equation | BoundKind::Inequality => None,
        }
    }
}

/// A symmetry that the user offers: an action of a group on configurations and group elements together, with
/// Φ_{F′}(q′) = (Φ_F q)′. Whether the discrete Lagrangian has it is for the next stage to find.
pub struct OfferedSymmetry<'g> {
    /// The group.
    pub group: Group,
    /// The symbol of its element, S.
    pub symbol: Expr<'g>,
    /// The user's name for the element.
    pub name: String,
    /// The side from which it acts.
    pub side: Side,
    /// q′, one expression for each leaf of the configuration.
    pub configurations: Vec<Expr<'g>>,
    /// F′, one expression for each factor.
    pub elements: Vec<Expr<'g>>,
    /// The closure's body as written.
    pub written: Written,
}

/// The bodies of the closures as they were written.
pub struct Spans {
    /// The action's.
    pub action: Written,
    /// The cost's or the Lagrangian's.
    pub kinetic: Written,
    /// The order's, where it is written.
    pub order: Option<Span>,
    /// A mass among the fields, as messages show it: `self.mass`; `None` if no field is one.
    pub mass: Option<String>,
}

/// An expression as the user wrote it.
#[derive(Clone)]
pub struct Written {
    /// Where it is.
    pub place: crate::diagnostic::Location,
    /// Its text.
    pub text: String,
}

/// The energies of a field other than the kinetic energies of its sites.
#[derive(Clone)]
pub struct FieldEnergies<'g> {
    /// Those of the edges, one for each direction of space.
    pub edges: Vec<EdgeEnergy<'g>>,
    /// V(t, q) of a site; the model of a site has no potential.
    pub potential: Option<Expr<'g>>,
    /// The order of a step of all sites; the model of a site has order 2 where that is composed.
    pub order: Order,
    /// Whether the field rests: the kinetic energy of its model measures motions and nothing else.
    pub is_static: bool,
}

/// The energy of an edge from a site to its neighbour in one direction.
#[derive(Clone)]
pub struct EdgeEnergy<'g> {
    /// U, a function of the configurations at the places 0 and 1, the site and its neighbour. It may be of the group element
    /// between them.
    pub value: Expr<'g>,
    /// The symbol of the spacing.
    pub spacing: Expr<'g>,
    /// The names of the leaves at both ends.
    pub names: [Vec<String>; 2],
    /// That element for each factor, a function of both configurations; empty where U is one.
    pub element: Vec<Expr<'g>>,
    /// The closure.
    pub written: Written,
}

/// The data that turns the model of a site into a power.
#[derive(Clone)]
pub struct Power<'g> {
    /// The user's struct; that of the model is the site.
    pub item: Item,
    /// N
    pub length: Length,
    /// N in ranges and indices.
    pub sites: Expr<'g>,
    /// The sites that terms read.
    pub places: Vec<SiteIndex<'g>>,
    /// The potential, a sum of terms.
    pub terms: Vec<Term<'g>>,
    /// The constraint; `None` where sites move freely.
    pub joints: Option<Joints<'g>>,
    /// The fields that terms read; those of the model are the fields that the site reads.
    pub parameters: Vec<Parameter<'g>>,
    /// The user's fields that the site has copies of, in the order of the model's parameters.
    pub copied: Vec<syn::Member>,
    /// Whether no field that the site reads differs from site to site.
    pub is_uniform: bool,
    /// Whether each site has an input of its own; else all share one.
    pub has_own_inputs: bool,
    /// The least N that has all sites that closures name.
    pub least: i64,
    /// The order of a step of all sites; a composed step is composed of those, and the model of the site has order 2.
    pub order: Order,
}
