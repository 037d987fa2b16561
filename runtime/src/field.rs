//! Fields: one declared site at each place of a grid, and an energy for each edge between neighbours.
//!
//! ```text
//! S = Σ over edges in time of K(F) − h Σ over edges in space of U(q, q⁺) − h Σ over sites of V(q)
//!
//! N ← N − ½h (J(q, ∂V) + Σ over edges at q of J(q, ∂U)),    each site moves,    the same again
//! ```
//! A step is explicit in space: each site moves by itself. It is symmetric in time and of second order. It conserves the
//! product of the symplectic forms of all sites, and the total momentum of each symmetry. Orders 4, 6 and 8 are compositions of it.
//!
//! Source: Marsden, Patrick and Shkoller, *Multisymplectic geometry, variational integrators, and nonlinear PDEs*,
//! Communications in Mathematical Physics 199 (1998).

#[cfg(feature = "alloc")]
mod complex;
#[cfg(feature = "alloc")]
mod connection;
mod degree;
mod domain;
mod edges;
mod grid;
mod lattice;
#[cfg(feature = "alloc")]
mod mesh;
#[cfg(feature = "alloc")]
mod midpoint;
#[cfg(feature = "alloc")]
mod multigrid;
mod multisymplectic;
mod relaxation;
mod residuals;
#[cfg(feature = "serde")]
mod saved;
mod sites;
mod slab;
mod stability;
mod stepper;
mod sweep;

#[cfg(feature = "alloc")]
pub use complex::CellComplex;
#[cfg(feature = "alloc")]
pub use connection::{ConnectionState, ConnectionStepper};
pub use domain::Domain;
pub use grid::{Grid, Side, Sides};
pub use lattice::Lattice;
#[cfg(feature = "alloc")]
pub use mesh::Mesh;
#[cfg(feature = "alloc")]
pub use midpoint::{MidpointState, MidpointStepper};
#[cfg(feature = "alloc")]
pub use multigrid::Multigrid;
pub use relaxation::{Relaxation, Relaxed};
#[cfg(feature = "serde")]
pub use saved::SavedField;
#[cfg(feature = "alloc")]
pub use sites::Various;
pub use sites::{Alike, Population};
pub use slab::Slab;
pub use stepper::{FieldState, FieldStepper};

use crate::parts::{F, Mu, Parts, Q, T, U};
use crate::space::plus;
use crate::{Clebsch, Mask, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// A site of a field by itself. `#[derive(Clebsch)]` implements it where there is the key `space`.
///
/// ```
/// use clebsch::{Clebsch, FieldSite};
/// use nalgebra::Vector1;
///
/// /// A string on springs, its displacement x.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |a: Translation<1>, x: Vector1| x + a,
///     cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
///     potential = |x| x.norm_squared(),
///     space     = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// )]
/// struct Strand { mass: f64 }
///
/// let (strand, x) = (Strand { mass: 3.0 }, Vector1::new(2.0));
/// assert_eq!(strand.force_on_site(0.0, &x), Vector1::new(-4.0));
/// assert_eq!(strand.momentum_of_velocity(0.0, &x, &Vector1::new(0.5)), Vector1::new(1.5));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no field",
    note = "a field has an energy for each direction of space: `space = |dx, q, next| …`"
)]
pub trait FieldSite: Clebsch {
    /// Whether a site has a potential of its own.
    #[doc(hidden)]
    const HAS_POTENTIAL: bool;

    /// The order of a step of all sites: 2, 4, 6 or 8.
    const ORDER_OF_FIELD: u32;

    /// The force of the potential on a site at the time t, −J(q, ∂V); 0 as provided.
    #[inline]
    fn force_on_site(&self, _t: T<Self>, _q: &Q<Self>) -> Mu<Self> {
        Space::origin()
    }

    /// The change of [`force_on_site`](Self::force_on_site) by a small motion of the site; 0 as provided.
    #[inline]
    fn force_on_site_along(&self, _t: T<Self>, _q: &Q<Self>, _motion: &Mu<Self>) -> Mu<Self> {
        Space::origin()
    }

    /// q after a drift that is a formula of q and N, and does not change N: NaN where there is none. Rounding is not yet taken off it.
    /// `None` where a drift is more, as provided.
    #[doc(hidden)]
    #[inline(always)]
    fn drifted(&self, _c: &Self::Constants, _q: &Q<Self>, _mu: &Mu<Self>) -> Option<Q<Self>> {
        None
    }

    /// Whether rounding moves q off its space.
    #[doc(hidden)]
    const MENDS: bool = false;

    /// q of such a drift without the rounding that has moved it off its space, and whether it is a configuration. q itself where it is
    /// finite, as provided.
    #[doc(hidden)]
    #[inline(always)]
    fn mended(q: Q<Self>) -> (Q<Self>, bool) {
        (q, is_finite(&q))
    }

    /// q after a small motion by η, q + η_Q(q) to first order in η.
    fn moved_by(&self, q: &Q<Self>, motion: &Mu<Self>) -> Q<Self>;

    /// The momentum of a velocity: ∂ℓ/∂ξ at (t, q, ξ), in the components of all factors.
    fn momentum_of_velocity(&self, t: T<Self>, q: &Q<Self>, velocity: &Mu<Self>) -> Mu<Self>;
}

/// A field with a cost, which moves: [`Domain::stepper`] steps it. `#[derive(Clebsch)]` implements it.
///
/// ```
/// use clebsch::{Clebsch, Domain, Error, Grid, MovingField, FieldStepper, Lattice};
///
/// /// The stepper of half of a step.
/// fn halved<S: MovingField<Scalar = f64> + Clone, G: Lattice<S>>(field: Domain<S, G>, h: f64) -> Result<FieldStepper<S, G>, Error> {
///     field.stepper(h / 2.0)
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no cost, so that it is not stepped",
    note = "relax it, `domain.relax().solve(&mut configuration)`, or write `cost = |h, F| …`"
)]
pub trait MovingField: FieldSite {}

/// A field without a cost, which rests: [`Domain::relax`] finds where. `#[derive(Clebsch)]` implements it.
///
/// ```
/// use clebsch::{Clebsch, Domain, Lattice, Relaxed, SiteError, StaticField};
/// use nalgebra::SVector;
///
/// /// Relaxed to few digits.
/// fn roughly<S, G, const M: usize>(field: &Domain<S, G>, q: &mut [S::Configuration]) -> Result<Relaxed<f64>, SiteError>
/// where
///     S: StaticField<Scalar = f64, Momentum = SVector<f64, M>> + Clone,
///     G: Lattice<S>,
/// {
///     field.relax().tolerance(1e-3).solve(q)
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has a cost, so that it is stepped and not relaxed",
    note = "step it, `domain.stepper(h)`, or leave out its cost"
)]
pub trait StaticField: FieldSite {}

/// A field whose edges have energies of their group elements alone. `#[derive(Clebsch)]` implements it with `emit = [connection]`.
///
/// ```
/// use clebsch::{Clebsch, ConnectedField};
/// use nalgebra::{Rotation3, Vector3};
///
/// /// Rotations along a line, each with a spring to the next.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |F: SO<3>, R: SO<3>| R * F,
///     space  = |ds, W| (W - I).norm_squared() / (4 * ds),
///     emit   = [connection],
/// )]
/// struct Ribbon;
///
/// let [a, b] = [0.1, 0.4].map(|angle| Rotation3::new(Vector3::z() * angle).into_inner());
/// assert!((Ribbon.edge_element(&a, &b) - a.transpose() * b).amax() < 1e-15);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no connection",
    note = "write `emit = [connection]`; the energies of its edges are those of elements, `space = |dx, W| …`"
)]
pub trait ConnectedField: FieldSite + Parts + Clebsch<Configuration = <Self as Clebsch>::Element> {
    /// The group element W with Φ_W(q) = next: q⁻¹·next for a right action, next·q⁻¹ for a left one.
    fn edge_element(&self, q: &Q<Self>, next: &Q<Self>) -> Q<Self>;
}

/// A site of a field with implicit steps. `#[derive(Clebsch)]` implements it with `emit = [midpoint]`.
///
/// ```
/// use clebsch::{Clebsch, MidpointSite};
/// use nalgebra::Vector1;
///
/// /// A string on springs, its displacement x.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |a: Translation<1>, x: Vector1| x + a,
///     cost   = |h, a| self.mass * a.norm_squared() / (2 * h),
///     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
///     emit   = [midpoint],
/// )]
/// struct Strand { mass: f64 }
///
/// // G is half of the step, and s is what the momentum lacks for a step of 2G
/// let (half, momentum) = (Strand::half_step(&Vector1::new(0.1)), Vector1::new(1.0));
/// let (sum, slope) = Strand { mass: 3.0 }.midpoint_equation(0.5, 0.0, &half, &momentum);
/// assert_eq!(half, Vector1::new(0.2));
/// assert!((sum.x - 2.0 * (3.0 * 0.4 / 0.5 - 1.0)).abs() < 1e-15);
/// assert_eq!(slope.x, 2.0 * 3.0 * 2.0 / 0.5);
/// ```
#[diagnostic::on_unimplemented(message = "`{Self}` has no implicit steps", note = "write `emit = [midpoint]`")]
pub trait MidpointSite<const M: usize>:
    FieldSite + Parts + Clebsch<Momentum = SVector<<Self as Clebsch>::Scalar, M>>
{
    /// The group element G of half of a step by its Cayley coordinates: (I − Z)⁻¹(I + Z), and 2z of a translation.
    fn half_step(x: &Mu<Self>) -> F<Self>;

    /// The change of these coordinates by a small motion of the midpoint Φ_G(q).
    fn half_step_motion(x: &Mu<Self>, motion: &Mu<Self>) -> Mu<Self>;

    /// The left side s + C s of the equation of a step by F = G² from the momentum N, in the units of momenta. Behind it are its
    /// derivatives by small motions of the midpoint.
    fn midpoint_equation(
        &self,
        h: T<Self>,
        t: T<Self>,
        f: &F<Self>,
        mu: &Mu<Self>,
    ) -> (Mu<Self>, SMatrix<T<Self>, M, M>);

    /// The force of the key `force` where the midpoint is at `q` and the half step has the coordinates `x`. Behind it are its derivatives
    /// by small motions of the midpoint. `None` if there is none. The velocity is that of half of a step, 4x/h.
    #[inline]
    fn midpoint_force(
        &self,
        _h: T<Self>,
        _t: T<Self>,
        _q: &Q<Self>,
        _x: &Mu<Self>,
        _u: &U<Self>,
    ) -> Option<(Mu<Self>, SMatrix<T<Self>, M, M>)> {
        None
    }

    /// C μ, the momentum μ carried along half of a step: Ad*_G μ for a right action, Ad*_{G⁻¹} μ for a left one.
    fn half_carried(f: &F<Self>, mu: &Mu<Self>) -> Mu<Self>;
}

/// A site of a field with neighbours in D directions of space. `#[derive(Clebsch)]` implements it where there is the key `space`.
///
/// ```
/// use clebsch::{Clebsch, Field};
/// use nalgebra::Vector1;
///
/// /// A string of density 1 and tension 1, its displacement x.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |a: Translation<1>, x: Vector1| x + a,
///     cost   = |h, a| a.norm_squared() / (2 * h),
///     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// )]
/// struct Strand;
///
/// let energy = Strand.edge_energy(0, &[0.5], &Vector1::new(1.0), &Vector1::new(2.0));
/// assert_eq!(energy, 2.0);
/// ```
///
/// One site by itself is not stepped. This does not compile:
///
/// ```compile_fail
/// # use clebsch::Clebsch;
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let stepper = Strand.stepper(0.1);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no field with {D} directions of space",
    note = "a field has an energy for each direction, `space = [|dx, q, next| …, |dy, q, next| …]`, and a size for each, `grid([64, 64])`"
)]
pub trait Field<const D: usize>: FieldSite {
    /// Whether the force on a site is found from all of its edges at once, by [`force_inside`](Self::force_inside).
    #[doc(hidden)]
    const GATHERS: bool;

    /// The number of neighbours on each side, in a direction, on which the force on a site depends. Edges join a site to the next one, so it is 1.
    ///
    /// A [`Slab`](crate::Slab) has so many rows of its neighbours.
    const REACH: usize = 1;

    /// The energy U of the edge from `q` to its neighbour `next` in a direction, in joules: the value of the closure of `space`.
    /// Directions count from 0; one that is not there is taken for the last. `spacing` has the spacings of all directions.
    fn edge_energy(&self, direction: usize, spacing: &[T<Self>; D], q: &Q<Self>, next: &Q<Self>) -> T<Self>;

    /// The forces of this edge: −J(q, ∂₁U) on its site, and −J(next, ∂₂U) on the neighbour. They are momenta per time, in the
    /// components of all factors.
    fn edge_forces(
        &self,
        direction: usize,
        spacing: &[T<Self>; D],
        q: &Q<Self>,
        next: &Q<Self>,
    ) -> (Mu<Self>, Mu<Self>);

    /// The change of [`edge_forces`](Self::edge_forces) by small motions of both ends: `motion` η moves the site by η_Q(q), and
    /// `next_motion` the neighbour. These are the second derivatives of U, with the other sign.
    fn edge_forces_along(
        &self,
        direction: usize,
        spacing: &[T<Self>; D],
        q: &Q<Self>,
        next: &Q<Self>,
        motion: &Mu<Self>,
        next_motion: &Mu<Self>,
    ) -> (Mu<Self>, Mu<Self>);

    /// The force on a site between the neighbours `before` and `after` it in each direction: that of its potential, and those of
    /// all edges.
    fn force_inside(
        &self,
        t: T<Self>,
        spacing: &[T<Self>; D],
        q: &Q<Self>,
        before: &[&Q<Self>; D],
        after: &[&Q<Self>; D],
    ) -> Mu<Self> {
        let mut force = self.force_on_site(t, q);
        for d in 0..D {
            force = plus(&force, &self.edge_forces(d, spacing, before[d], q).1);
            force = plus(&force, &self.edge_forces(d, spacing, q, after[d]).0);
        }
        force
    }

    /// A grid with so many sites in each direction, free at its ends, with the spacing 1.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Field};
    /// # use nalgebra::Vector1;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action = |a: Translation<1>, x: Vector1| x + a,
    /// #     cost   = |h, a| a.norm_squared() / (2 * h),
    /// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    /// # )]
    /// # struct Strand;
    /// let stepper = Strand.grid([100]).spacing([0.01]).fixed().stepper(0.005)?;
    /// let shape = |i: usize| Vector1::new((core::f64::consts::PI * i as f64 / 99.0).sin());
    /// let mut state = stepper.state((0..100).map(shape).collect::<Vec<_>>(), vec![Vector1::zeros(); 100])?;
    /// let energy = stepper.energy(&state)?;
    /// stepper.advance(&mut state, 1000)?;
    /// assert!((stepper.energy(&state)? / energy - 1.0).abs() < 1e-3);
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    fn grid(&self, sizes: [usize; D]) -> Domain<Self, Grid<T<Self>, D>>
    where
        Self: Clone,
    {
        Domain::new(self.clone(), Grid::new(sizes))
    }

    /// A mesh of these vertices and oriented faces, free at its border. The spacing of an edge is its length.
    ///
    /// `vertices` are places in a space of any dimension. Faces are the numbers of their corners in cyclic order.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::{Vector1, Vector3};
    ///
    /// /// A membrane of density 1 and tension 1, its displacement x.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |a: Translation<1>, x: Vector1| x + a,
    ///     cost   = |h, a| self.area * a.norm_squared() / (2 * h),
    ///     space  = |length, x, next| (next - x).norm_squared() / 2,
    /// )]
    /// struct Membrane { area: f64 }
    ///
    /// // a tent of four triangles
    /// let vertices = [Vector3::z(), Vector3::x(), Vector3::y(), -Vector3::x(), -Vector3::y()];
    /// let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    /// let domain = Membrane { area: 1.0 }.mesh(&vertices, &faces)?.cotangent_weights()?.fixed();
    /// let areas: Vec<f64> = (0..5).map(|site| domain.lattice().area(site)).collect();
    /// let stepper = domain.various(|site| Membrane { area: areas[site] }).stepper(0.01)?;
    /// let mut state = stepper.state(vec![Vector1::zeros(); 5], vec![Vector1::new(1.0); 5])?;
    /// stepper.advance(&mut state, 100)?;
    /// assert_eq!(state.configuration()[1].x, 0.0); // the border does not move
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Mesh::new`].
    #[cfg(feature = "alloc")]
    fn mesh<const K: usize>(
        &self,
        vertices: &[nalgebra::SVector<T<Self>, K>],
        faces: &[impl AsRef<[usize]>],
    ) -> Result<Domain<Self, Mesh<T<Self>>>, crate::Error>
    where
        Self: Field<1> + Clone,
        T<Self>: crate::Real,
    {
        Ok(Domain::new(self.clone(), Mesh::new(vertices, faces)?))
    }
}

/// q moved by the group element with the coordinates x.
#[inline(always)]
pub fn drifted<S: Parts>(system: &S, q: &Q<S>, x: &S::Coordinates) -> Q<S> {
    system.advance(q, &system.motion(x, || system.increment(x)))
}

/// Whether the sum of all numbers is finite: then each of them is.
#[inline(always)]
pub fn is_finite<T: Scalar>(q: &impl Space<T>) -> bool {
    let sum = q.sum();
    (sum * T::zero()).equals(T::zero()).all()
}
