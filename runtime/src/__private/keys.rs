//! The keys of `#[clebsch(…)]` and their words, for editors: a derive names them where they are written.
//!
//! Printed by `cargo run -p clebsch-compiler --example reference hints > runtime/src/__private/keys.rs`; a test compares the two.

/// The type of the first argument is the group, that of the second the space of configurations. The value is the moved configuration. Whether the action is left or right is found.
///
/// Example: `action = |F: SO<3>, R: SO<3>| …`
pub mod action {}

/// The kinetic part of the discrete Lagrangian of one step, in J·s. The macro subtracts h·V. With `controls` or `dynamics` it is the price of the input of one step.
///
/// Example: `cost = |h, F| …`
pub mod cost {}

/// The Lagrangian ℓ(q, ξ), most often the kinetic energy, in joules. The macro discretises it. The last argument is a new name for ξ, the velocity in the basis of the group. A T(ξ) − V(q) without the time in one closure is the same as T here and V in `potential`.
///
/// Example: `lagrangian = |omega| …`
pub mod lagrangian {}

/// The potential energy V(q), in joules. Where no formula exists, `opaque(Self::value, Self::gradient)` names two methods of the struct. `opaque(t, …)` is for methods that take the time first.
///
/// Example: `potential = |q| …`
pub mod potential {}

/// A symmetry that lies outside the declared group, such as rotations of a system of translations. The value is the pair of the moved configuration and the group element of the moved step. The macro checks it and adds its momentum to the conserved ones. `[closure, closure]` offers several.
///
/// Example: `symmetry = |S: SO<3>, q, F| (S * q, S * F * S.transpose())`
pub mod symmetry {}

/// A force that is no gradient, in the components of the momentum. A last argument with a type is an input, which each step is given or which `effort` chooses. With `effort`, names with types behind it are references: data of each step of a plan.
///
/// Example: `force = |omega, torque: Vector3| torque - self.damping * omega`
pub mod force {}

/// A force as a covector of the configuration, in its shape. It takes the same arguments as `force`.
///
/// Example: `force_on = |x, thrust: Vector3| thrust`
pub mod force_on {}

/// Equations that the motion obeys. With the velocity ξ among the arguments, a new name, they are affine in ξ, as for rolling without slipping. Without it they are equations of the configuration, as for joints. Both sides may be vectors, and a block with `let` ends in the list. An element `(0..3).map(|i| a == b)` is an equation for each number. `[closure, closure]` has both kinds.
///
/// Example: `constraint = |xi| [xi.z == 0]`
pub mod constraint {}

/// The energy of an edge from a site to its neighbour, in joules: one closure for each direction of space. The declaration is that of one site. The number of sites and their boundary are said at run time: `field.grid([64, 64])`. The first argument is a new name for the spacing of the direction, the last one for the configuration of the neighbour.
///
/// Example: `space = [|dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2))]`
pub mod space {}

/// The velocity that an input gives, in the basis of the group. It moves the configuration directly, without mass or momentum. Names with types behind the input are references: data of each step.
///
/// Example: `controls = |u: Vector2| vector![u.x, u.y, 0]`
pub mod controls {}

/// The next configuration, by any map of a vector space. It replaces `action`. Its first two typed arguments are the configuration and the input. Those behind them are references: data of each step. A right-hand side of x′ = f(t, x, u) stands in the parentheses of a method: `rk4(|x: Vector2, u: Vector1| vector![x.y, u.x])`.
///
/// Example: `dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x]`
pub mod dynamics {
    /// The classical Runge–Kutta method, of order 4.
    pub mod rk4 {}

    /// The explicit midpoint rule, of order 2: x⁺ = x + h·f(t + h/2, x + h·f(t, x, u)/2, u).
    pub mod midpoint {}
}

/// The price of the input of one step. Plans make the sum of these prices least.
///
/// Example: `effort = |h, torque| h * torque.norm_squared() / 2`
pub mod effort {}

/// Inequalities of scalars, with `<=` or `>=`, and equations of scalars or vectors, with `==`, that hold in every step of a plan. A field that only inequalities read may be infinite: plans are then those without them.
///
/// Example: `bounds = |u| [u.x <= 1, u.x + u.y == 0]`
pub mod bounds {}

/// The price of the end of a plan, or of a path of least action with a free end. It is added to the prices of all steps.
///
/// Example: `endpoint = |q| …`
pub mod endpoint {}

/// Conditions that hold at the end of plans to `Target::Conditions`: equations of scalars or vectors, and inequalities of scalars. A block with `let` may end in the list.
///
/// Example: `target = |q| [q.x == 1, q.y <= 2]`
pub mod target {}

/// The monitor g(q) > 0, for close approaches. A step of the size h takes the time t with dt = g(q) ds, s from 0 to h. It is short where g is small. Steps are reversible and conserve momenta. For g = c/(V₀ − V) and exact drifts they are symplectic in s.
///
/// Example: `step = |q| q.norm()`
pub mod step {}

/// The order of accuracy: the error at a fixed time shrinks like this power of h.
///
/// Example: `order = 2`
///
/// * 1: Drift, then kick: h·V at the end of the step.
/// * 2: Half kick, drift, half kick: h·V/2 at each end. Time-symmetric, with one gradient a step.
/// * 4: Composed of 5 steps of order 2, or a splitting where the drift is exact.
/// * 6: Composed of 11 steps of order 2, or a splitting where the drift is exact.
/// * 8: Composed of 17 steps of order 2.
/// * 16: Collocation of Hamilton's equations at the eight nodes of Gauss and Legendre.
pub mod order {}

/// How the velocity ξ of a step belongs to its group element F. `controls` take `cayley` and `exponential`.
///
/// Example: `discretization = cayley`
pub mod discretization {
    /// ξ = 2(F − I)(F + I)⁻¹/h, projected to the Lie algebra if it leaves it. A step cannot turn by π.
    pub mod cayley {}

    /// ξ = log(F)/h.
    pub mod exponential {}

    /// ξ = P(F − I)/h with the orthogonal projection P to the Lie algebra.
    pub mod projection {}

    /// (F − I)/h for ξ in the form ½tr(ξ 𝕄 ξᵀ) of the kinetic energy. On SO(3) it ends near h|ω| = 1.
    pub mod moser_veselov {}

    /// The discrete Lagrangian is the action of the free motion. A step without a potential has no error in h.
    pub mod exact {}
}

/// The coordinates in which a step looks for its group element F.
///
/// Example: `chart = exponential`
pub mod chart {
    /// F = (I − Z)⁻¹(I + Z).
    pub mod cayley {}

    /// F = exp ξ.
    pub mod exponential {}
}

/// How a step starts to solve its momentum equation ρ(x) = 0.
///
/// Example: `solver = fixed_point`
pub mod solver {
    /// Newton's method.
    pub mod newton {}

    /// x ← x − s·h·Σ⁻¹ρ(x), then Newton's method where that does not contract.
    pub mod fixed_point {}
}

/// The most iterations for each momentum equation, a positive integer. A step that needs more is `Error::NotConverged`, in bounded time.
///
/// Example: `iterations = 4`
pub mod iterations {}

/// An iteration ends before a correction below this fraction of the step, a number between 0 and 1. The step is then no longer symplectic, and energies drift.
///
/// Example: `tolerance = 1e-8`
pub mod tolerance {}

/// How a step adds its increments to configuration and momentum.
///
/// Example: `summation = compensated`
pub mod summation {
    /// Floating-point addition.
    pub mod plain {}

    /// Kahan's summation: the rounding error of a step is added in the next one.
    pub mod compensated {}
}

/// How the code of a step is written.
///
/// Example: `code = matrices`
pub mod code {
    /// Entry by entry, without loops.
    pub mod unrolled {}

    /// Operations on matrices, for large groups.
    pub mod matrices {}
}

/// Motions of the group that move no configuration, such as turns about a point on a sphere. With `fixed` the kinetic energy may omit them, as |Φ_F(q) − q|² does: a vertical term is added, which does not change the motion of q.
///
/// Example: `isotropy = free`
pub mod isotropy {
    /// They are no motions: `state()` refuses a momentum along them.
    pub mod fixed {}

    /// They are motions: `state()` takes any momentum.
    pub mod free {}
}

/// The signs that the kinetic energy may have. `stepper()` checks the inertia of the parameters; `state()` checks an inertia that depends on the configuration or the time.
///
/// Example: `signature = indefinite`
pub mod signature {
    /// It is positive for every velocity ξ but 0: others are `Error::IndefiniteKineticEnergy`.
    pub mod definite {}

    /// It may be negative, as on Lorentz groups: extremals of the action are then no minima.
    pub mod indefinite {}
}

/// Further items that the macro derives, a list of words.
///
/// Example: `emit = [generated]`
pub mod emit {
    /// The constant `GENERATED`, the generated code as text; needs the feature `generated`.
    pub mod generated {}

    /// The constant `DERIVATION_LATEX`, the formulas in LaTeX.
    pub mod latex {}

    /// The methods `step_tangent` and `step_sensitivity`, the derivatives of a step.
    pub mod tangent {}

    /// The method `boundary()`, the path of least action between two configurations.
    pub mod boundary {}

    /// Steps of the momentum alone: the configuration is `()`.
    pub mod momentum {}

    /// The trait `ConnectedField`: the group elements of the edges of a field, stepped without configurations.
    pub mod connection {}

    /// The trait `MidpointSite`: implicit steps of a field along a line, stable at any step size.
    pub mod midpoint {}
}

/// The scalar type: `f64`, `f32` or a type parameter of the struct. Fields and spaces that name a scalar decide it otherwise.
///
/// Example: `scalar = f64`
pub mod scalar {}

/// A group of your own: `group NAME = |F: Matrix4| a == b`, or `group NAME = basis([A, B])`.
pub mod group {}

/// A further way to step the same system, a unit struct of yours: `method Fine = (order = 6)`.
pub mod method {}

/// Promises on the values of a field.
pub mod field {
    /// A square matrix with Aᵀ = A.
    pub mod symmetric {}

    /// A square matrix with zeros off its diagonal.
    pub mod diagonal {}

    /// A vector of length one.
    pub mod unit {}
}
