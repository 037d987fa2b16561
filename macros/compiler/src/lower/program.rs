//! The value of this stage: a table of kernels, each with the id of its formula.

use clebsch_symbolic::{Elements, IntoList};
use std::ops::Deref;

use super::{Cost, Form, Kernel, Solve};
use crate::MethodProgram;
use crate::derive::{Id, MechanicsFormulas, Solution, SteeredFormulas, Stencil};

/// The program of a system.
pub enum Program<'g> {
    /// Of mechanics.
    Mechanics(Box<MechanicsProgram<'g>>),
    /// Of a configuration that inputs move.
    Steered(Box<SteeredProgram<'g>>),
}

/// All kernels of a system.
pub struct KernelTable {
    /// The kernels, in the order in which they were made.
    pub(super) kernels: Vec<(Id, Kernel)>,
    /// A short name for each constant.
    pub constant_names: Vec<String>,
}

/// The program of a configuration that inputs move.
pub struct SteeredProgram<'g> {
    /// The formulas that it computes.
    pub formulas: SteeredFormulas<'g>,
    /// Its kernels.
    pub table: KernelTable,
}

/// The program of a mechanical system.
pub struct MechanicsProgram<'g> {
    /// The formulas that it computes.
    pub formulas: MechanicsFormulas<'g>,
    /// Its kernels.
    pub table: KernelTable,
    /// Whether kernels are unrolled or matrix code, and why.
    pub form: Form,
    /// The data of each substep other than its kernels.
    pub steps: Vec<Step>,
    /// How the gradient of one site of a power is gathered from the terms that read it, where it is.
    pub gathered: Option<Stencil<'g>>,
    /// Further ways to step the system, none behind this stage alone.
    pub methods: Vec<MethodProgram<'g>>,
}

/// The data of a substep other than its kernels.
pub struct Step {
    /// Whether the end kick of a step is the start kick of the next.
    pub end_is_start: bool,
    /// The momentum equations.
    pub solves: Vec<Solve>,
}

/// Names of kernels with their ids, in the order of prints and of tables of costs.
type Names<Of> = &'static [(&'static str, Of)];

const OF_SYSTEM: Names<Id> = &[
    ("constants", Id::Constants),
    ("act", Id::Action),
    ("momentum_map", Id::MomentumMap),
    ("coadjoint", Id::Coadjoint),
    ("legendre", Id::Legendre),
    ("legendre_next", Id::LegendreNext),
    ("potential", Id::PotentialEnergy),
    ("inertia", Id::Inertia),
    ("momentum_matrix", Id::MomentumMatrix),
    ("momentum_components", Id::MomentumComponents),
    ("cotangent_lift", Id::Lift),
    ("velocity", Id::Lagrangian),
    ("gyroscopic", Id::Gyroscopic),
    ("conserved", Id::ConservedMomenta),
    ("places", Id::Places),
    ("constraint", Id::Constraint),
    ("momentum_of_velocity", Id::MomentumOfVelocity),
    ("mobility", Id::Mobility),
    ("stagger", Id::SynchronizedMomentum),
    ("membership", Id::Membership),
    ("generator", Id::Isotropy),
    ("kick", Id::SplittingKick),
    ("kick_gradient", Id::SplittingGradient),
    ("monitor", Id::Monitor),
    ("kick_of_monitor", Id::MonitoredKick),
    ("monitor_slope", Id::MonitorSlope),
    ("slope", Id::HamiltonEquations),
    ("terms_of_time", Id::TermsOfTime),
    ("covector", Id::Covector),
    ("whole_guess", Id::Guess),
    ("momentum_of_step", Id::MomentumOfStep),
];

const OF_MOTIONS: Names<Id> = &[
    ("retractions", Id::Retraction),
    ("compose", Id::Composition),
    ("infinitesimal_motion", Id::Generator),
    ("orbit_metric", Id::OrbitMetric),
];

const OF_EDGE: Names<fn(usize) -> Id> = &[
    ("edge", Id::Edge),
    ("momenta", Id::EdgeMomenta),
    ("carried", Id::Carried),
    ("edge_slopes", Id::EdgeSlopes),
    ("constraint_at_start", Id::ConstraintAtStart),
    ("constraint_at_end", Id::ConstraintAtEnd),
    ("slopes_at_start", Id::SlopesAtStart),
    ("slopes_at_end", Id::SlopesAtEnd),
];

const OF_STEERING: Names<Id> = &[
    ("orbit_metric", Id::OrbitMetric),
    ("approach", Id::Approach),
    ("increment", Id::Increment),
    ("advance", Id::Advance),
    ("retraction", Id::Retraction),
    ("infinitesimal_motion", Id::Generator),
    ("expand", Id::StepExpanded),
];

const OF_CHOICE: Names<Id> = &[
    ("by_input", Id::ByInput),
    ("bend", Id::Bend),
    ("crossed", Id::Crossed),
    ("bracket", Id::Bracket),
    ("price", Id::Price),
    ("price_expanded", Id::PriceExpanded),
    ("price_of_time", Id::PriceOfTime),
    ("bounds", Id::Bounds),
    ("bounds_expanded", Id::BoundsExpanded),
    ("bound_prices", Id::BoundPrices),
    ("endpoint", Id::PriceOfEnd),
    ("endpoint_expanded", Id::PriceOfEndExpanded),
    ("target_expanded", Id::TargetExpanded),
];

const OF_EQUATION: Names<fn(usize, usize) -> Id> = &[
    ("sine_squared", Id::SineSquared),
    ("closed_form", Id::ClosedForm),
    ("explicit", Id::Explicit),
    ("system", Id::System),
    ("prepare", Id::Preparation),
    ("predict", Id::Predictor),
    ("residual", Id::Residual),
    ("linearize", Id::Linearization),
];

const OF_SUBSTEP: Names<fn(usize) -> Id> = &[
    ("start_force", Id::StartForce),
    ("increment", |_| Id::Increment),
    ("scaled_increment", |_| Id::ScaledIncrement),
    ("start_gradient", Id::StartGradient),
    ("displace", |_| Id::Displacement),
    ("advance", |_| Id::Advance),
    ("scaled_advance", |_| Id::ScaledAdvance),
    ("rest_kick", Id::RestKick),
    ("coupled_gradient", Id::CoupledGradient),
    ("update", Id::MomentumAfter),
    ("moving_force", Id::MovingForce),
    ("end_force", Id::EndForce),
    ("reaction", Id::Reaction),
    ("projection", Id::Projection),
    ("end_kick", Id::EndKick),
];

impl KernelTable {
    /// The kernel with an id; one without outputs where a system does not have it.
    pub fn kernel(&self, id: Id) -> &Kernel {
        const NONE: &Kernel = &Kernel { locals: Vec::new(), outputs: Vec::new() };
        self.find(id).unwrap_or(NONE)
    }

    /// The kernel with an id, where a system has it.
    pub fn find(&self, id: Id) -> Option<&Kernel> {
        self.kernels.iter().find(|(other, _)| *other == id).map(|(_, kernel)| kernel)
    }

    /// All kernels, with their ids.
    pub fn all(&self) -> impl Iterator<Item = (Id, &Kernel)> {
        self.kernels.iter().map(|(id, kernel)| (*id, kernel))
    }

    /// Those that a system has of these kernels.
    fn named(&self, ids: impl IntoIterator<Item = (String, Id)>) -> Vec<(String, &Kernel)> {
        ids.into_iter().filter_map(|(name, id)| Some((name, self.find(id)?))).into_list()
    }
}

impl Deref for MechanicsProgram<'_> {
    type Target = KernelTable;

    fn deref(&self) -> &KernelTable {
        &self.table
    }
}

impl<'g> Program<'g> {
    /// The program of a mechanical system; `None` of another one.
    pub fn mechanics(&self) -> Option<&MechanicsProgram<'g>> {
        if let Program::Mechanics(program) = self { Some(program) } else { None }
    }

    /// The kernels with their names, in the order of prints and of tables of costs.
    pub fn kernels(&self) -> Vec<(String, &Kernel)> {
        match self {
            Program::Mechanics(program) => program.kernels(),
            Program::Steered(program) => program.kernels(),
        }
    }
}

impl SteeredProgram<'_> {
    /// The kernels with their names, in the order of prints and of tables of costs.
    pub fn kernels(&self) -> Vec<(String, &Kernel)> {
        self.table.named(OF_STEERING.iter().chain(OF_CHOICE).map(|&(name, id)| (name.to_string(), id)))
    }
}

impl MechanicsProgram<'_> {
    /// The kernels with their names, in the order of prints and of tables of costs.
    pub fn kernels(&self) -> Vec<(String, &Kernel)> {
        let named = |&(name, id): &(&str, Id)| (name.to_string(), id);
        let mut ids: Vec<(String, Id)> = OF_SYSTEM.each(named);
        ids.extend(self.ids_of_terms());
        ids.extend(OF_MOTIONS.iter().map(named));
        for index in 0..self.steps.len() {
            ids.extend(OF_EDGE.iter().map(|(name, id)| (format!("{name}{}", self.suffix(index)), id(index))));
        }
        ids.push(("approach".to_string(), Id::Approach));
        ids.extend(OF_CHOICE.iter().map(named));
        for (index, step) in self.steps.iter().enumerate() {
            let suffix = self.suffix(index);
            ids.push((format!("start_kick{suffix}"), Id::StartKick(index)));
            for solve in &step.solves {
                let number = if step.solves.len() == 1 { String::new() } else { format!("_{}", solve.number + 1) };
                ids.extend(OF_EQUATION.iter().map(|(name, id)| (format!("{name}{suffix}{number}"), solve.id(*id))));
            }
            ids.extend(OF_SUBSTEP.iter().map(|(name, id)| (format!("{name}{suffix}"), id(index))));
        }
        self.named(ids.into_iter().filter(|(_, id)| self.is_listed(*id)))
    }

    /// The terms of a power with their gradients.
    fn ids_of_terms(&self) -> Vec<(String, Id)> {
        let links = &self.formulas.links;
        let of_term = |term: usize| {
            let (value, gradient) = (format!("term_{}", term + 1), format!("gradient_of_term_{}", term + 1));
            [(value, Id::Term(term)), (gradient, Id::TermGradients(term))]
        };
        let of_place = |&(term, number): &(usize, usize)| {
            let place = links[term].gradient[number].0;
            (format!("gradient_of_term_{}_{}", term + 1, number + 1), Id::TermGradient(term, place))
        };
        let others = self.gathered.iter().flat_map(|stencil| &stencil.others).map(of_place);
        let of_site = [("gradient_of_site".to_string(), Id::SiteGradient)];
        let joints = self.formulas.joints.as_ref().map_or(0, |joints| joints.all.len());
        let of_joint = |joint: usize| {
            let (places, rows) = (format!("places_of_joint_{}", joint + 1), format!("rows_of_joint_{}", joint + 1));
            [(places, Id::JointPlaces(joint)), (rows, Id::Joint(joint))]
        };
        let joints = (0..joints).flat_map(of_joint);
        let field = self.formulas.field.as_ref();
        let of_edge = |direction: usize| {
            let names = [format!("energy_of_edge_{}", direction + 1), format!("forces_of_edge_{}", direction + 1)];
            names.into_iter().zip([Id::EdgeEnergy(direction), Id::EdgeForces(direction)])
        };
        let edges = (0..field.map_or(0, |field| field.edges.len())).flat_map(of_edge);
        let of_sites = [
            ("element_of_edge", Id::EdgeElement),
            ("coordinates_of_edge", Id::EdgeCoordinates),
            ("logarithm_of_edge", Id::EdgeLogarithm),
            ("force_on_site", Id::SiteForce),
            ("force_inside", Id::ForceInside),
        ];
        let field =
            edges.chain(of_sites.map(|(name, id)| (name.to_string(), id)).into_iter().filter(|_| field.is_some()));
        (0..links.len()).flat_map(of_term).chain(of_site).chain(others).chain(joints).chain(field).into_list()
    }

    /// Whether a step or a method calls a kernel.
    fn is_listed(&self, id: Id) -> bool {
        let (turns_in_plane, is_displaced) = (self.turns_in_plane(), self.find(Id::Displacement).is_some());
        match id {
            Id::Lift => !turns_in_plane,
            Id::StartGradient(_) => turns_in_plane,
            Id::Displacement => !turns_in_plane,
            Id::Advance => !turns_in_plane && !is_displaced && self.find(Id::ScaledAdvance).is_none(),
            Id::EndKick(index) => !self.steps[index].end_is_start,
            _ => true,
        }
    }

    /// Whether the force on a site of a field is found from all of its edges at once. It is where that takes no more operations
    /// than each edge and the potential by themselves.
    pub fn gathers_edges(&self) -> bool {
        let Some(field) = self.formulas.field.as_ref().filter(|field| field.force_inside.is_some()) else {
            return false;
        };
        let cost = |id: Id| self.find(id).map_or(0, |kernel| kernel.cost().total());
        let by_edges: usize = (0..field.edges.len()).map(|direction| cost(Id::EdgeForces(direction))).sum();
        // two additions of a momentum for each edge
        let added = 2 * field.edges.len() * self.formulas.model.dimension();
        cost(Id::ForceInside) <= by_edges + cost(Id::SiteForce) + added
    }

    /// The suffix of the functions of a substep.
    pub fn suffix(&self, substep: usize) -> &'static str {
        match (self.formulas.stepped, substep) {
            (1, 0) => "",
            (2, 0) => "_first",
            (2, 1) => "_adjoint",
            _ => "_whole",
        }
    }

    /// Whether steps of a point on a sphere are made in the point and its velocity, without the matrices of the group.
    pub fn turns_in_plane(&self) -> bool {
        self.form.keeps_matrices() && self.formulas.follows_great_circles()
    }

    /// Whether a step makes the increments F − I, and does not move by the chart coordinates alone.
    pub fn makes_increments(&self, substep: usize) -> bool {
        self.find(Id::Displacement).is_none() || self.find(Id::MomentumAfter(substep)).is_some()
    }

    /// The operations of a step apart from those of iterations.
    pub fn cost_of_moves(&self, substep: usize) -> Cost {
        let kicks = [Id::StartKick, Id::EndKick, Id::StartForce, Id::EndForce, Id::MomentumAfter].map(|id| id(substep));
        let solved = [Id::Predictor, Id::ClosedForm, Id::Explicit, Id::SineSquared];
        let solves = self.steps[substep].solves.iter().flat_map(|solve| solved.map(|id| solve.id(id)));
        let made = if self.find(Id::ScaledIncrement).is_some() { Id::ScaledIncrement } else { Id::Increment };
        let increment = self.makes_increments(substep).then_some(made);
        let moves = [Id::Displacement, Id::ScaledAdvance].into_iter().find(|id| self.find(*id).is_some());
        let moves = moves.unwrap_or(Id::Advance);
        let ids = solves.chain(kicks).chain(increment).chain([moves]);
        ids.map(|id| self.kernel(id).cost()).fold(Cost::default(), Cost::plus)
    }

    /// ρ(x) and Dρ(x) of an equation; of a linear one −ρ(0) and Dρ.
    pub fn linearization(&self, solve: &Solve) -> &Kernel {
        let id = if solve.solution == Solution::Linear { Id::System } else { Id::Linearization };
        self.kernel(solve.id(id))
    }
}
