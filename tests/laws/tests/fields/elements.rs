//! Energies of the group element of an edge, against the same energies of both ends and against differences.

use clebsch::{Clebsch, Field, SiteError};
use clebsch_tests::fixtures::cosserat_rod::CosseratRod;
use nalgebra::{Isometry3, Matrix3, Matrix4, Rotation3, SVector, Translation3, Vector2, Vector3, Vector6};

/// A chiral field, its edges by the element that turns a site to its neighbour.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    space  = |dx, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * dx.powi(2)),
)]
struct ByElement {
    #[clebsch(symmetric)]
    mass_matrix: Matrix3<f64>,
}

/// The same by both ends.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    space  = |dx, R, next| (self.mass_matrix * (R.transpose() * next - I) * (R.transpose() * next - I).transpose()).trace() / (2 * dx.powi(2)),
)]
struct ByEnds {
    #[clebsch(symmetric)]
    mass_matrix: Matrix3<f64>,
}

/// The same where the group acts from the left.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| F * R,
    cost   = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    space  = |dx, W| self.stiffness * W.cayley().norm_squared() / (2 * dx),
)]
struct FromTheLeft {
    #[clebsch(symmetric)]
    mass_matrix: Matrix3<f64>,
    stiffness: f64,
}

/// A beam in the plane.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<2>, q: SE<2>| q * F,
    lagrangian = |xi| xi.norm_squared() / 2,
    space      = |ds, W| (W.cayley() / ds - self.reference).norm_squared() * ds / 2,
)]
struct PlaneBeam {
    reference: Vector3<f64>,
}

/// A rod in space and one in the plane, with the strains of the logarithm.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| (W.log() / ds - self.reference).dot(&self.stiffness.component_mul(&(W.log() / ds - self.reference))) * ds / 2,
)]
struct Bent {
    section: nalgebra::Vector4<f64>,
    stiffness: SVector<f64, 6>,
    reference: SVector<f64, 6>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<2>, q: SE<2>| q * F,
    lagrangian = |xi| xi.norm_squared() / 2,
    space      = |ds, W| (W.log() / ds - self.reference).norm_squared() * ds / 2,
)]
struct BentInPlane {
    reference: Vector3<f64>,
}

/// Rotations from the left, and a pair, both of whose elements have their logarithms.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| F * R,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |dx, W| (W.log().norm_squared() + 0.3 * W.log().x.powi(4) + 0.1 * W.cayley().y) / (2 * dx),
)]
struct LeftLogarithm;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |(F, a): (SO<3>, Translation<2>), (R, x): (SO<3>, Vector2)| (R * F, x + a),
    cost   = |h, F, a| (F - I).norm_squared() / (4 * h) + a.norm_squared() / (2 * h),
    space  = |dx, (W, b)| (W.log().norm_squared() + b.log().norm_squared() * W.log().x + b.norm_squared()) / (2 * dx),
)]
struct LogarithmPair;

/// A body and a point, tied to their neighbours.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |(F, a): (SO<3>, Translation<2>), (R, x): (SO<3>, Vector2)| (R * F, x + a),
    cost   = |h, F, a| (F - I).norm_squared() / (4 * h) + a.norm_squared() / (2 * h),
    space  = |dx, (W, b)| ((W - I).norm_squared() + b.norm_squared() * (W - I).norm_squared() + b.cayley().norm_squared()) / (2 * dx),
)]
struct Pair;

fn turn(seed: f64) -> Matrix3<f64> {
    Rotation3::new(Vector3::new((3.0 * seed).sin(), (5.0 * seed).cos(), (7.0 * seed).sin()) * 0.8).into_inner()
}

fn pose(seed: f64) -> Matrix4<f64> {
    let turn = Rotation3::from_matrix_unchecked(turn(seed));
    Isometry3::from_parts(Translation3::new(seed, -0.4 * seed, (4.0 * seed).cos()), turn.into()).to_homogeneous()
}

fn mass() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.4, 0.2, 0.0, 0.2, 0.8)
}

#[test]
fn an_element_has_the_forces_of_its_ends() -> Result<(), SiteError> {
    let (by_element, by_ends) = (ByElement { mass_matrix: mass() }, ByEnds { mass_matrix: mass() });
    for k in 0..20 {
        let (q, next) = (turn(f64::from(k) * 0.3), turn(f64::from(k) * 0.3 + 0.2));
        let [(a, b), (c, d)] =
            [by_element.edge_forces(0, &[0.3], &q, &next), by_ends.edge_forces(0, &[0.3], &q, &next)];
        assert!((a - c).amax() < 1e-13 * a.amax() && (b - d).amax() < 1e-13 * b.amax(), "{k}: {a} {b}");
        let energies = [by_element.edge_energy(0, &[0.3], &q, &next), by_ends.edge_energy(0, &[0.3], &q, &next)];
        assert!((energies[0] - energies[1]).abs() < 1e-13 * energies[0]);
    }
    let q: Vec<_> = (0..8).map(|i| turn(0.1 * f64::from(i))).collect();
    let stepper = by_element.grid([8]).spacing([0.5]).free().stepper(0.05)?;
    let other = by_ends.grid([8]).spacing([0.5]).free().stepper(0.05)?;
    let (mut one, mut two) = (stepper.state(q.clone(), vec![Vector3::x(); 8])?, other.state(q, vec![Vector3::x(); 8])?);
    let before = stepper.conserved(&one)?;
    stepper.advance(&mut one, 200)?;
    other.advance(&mut two, 200)?;
    for (a, b) in one.configuration().iter().zip(two.configuration()) {
        assert!((a - b).amax() < 1e-11);
    }
    for ((name, a), (_, b)) in stepper.conserved(&one)?.iter().zip(before.iter()) {
        assert!((a - b).abs() < 1e-13, "{name}: {a} {b}");
    }
    Ok(())
}

/// The forces are minus the slopes of the energy along motions of each end by the group.
#[track_caller]
fn check<S, const M: usize>(system: &S, q: [&S::Configuration; 2], small: impl Fn(usize, f64) -> S::Element)
where
    S: Field<1> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let (spacing, size) = ([0.3], 1e-5);
    let (on_site, on_neighbour) = system.edge_forces(0, &spacing, q[0], q[1]);
    for k in 0..M {
        let energy = |a: f64, b: f64| {
            system.edge_energy(0, &spacing, &system.act(&small(k, a), q[0]), &system.act(&small(k, b), q[1]))
        };
        let slopes = [energy(size, 0.0) - energy(-size, 0.0), energy(0.0, size) - energy(0.0, -size)];
        for (force, slope) in [on_site, on_neighbour].iter().zip(slopes) {
            let expected = -slope / (2.0 * size);
            assert!((force[k] - expected).abs() < 1e-7 * (1.0 + force.amax()), "{k}: {} {expected}", force[k]);
        }
        // and their changes are slopes of the forces
        let unit = SVector::<f64, M>::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
        let none = SVector::zeros();
        let forces = |a: f64, b: f64| {
            system.edge_forces(0, &spacing, &system.act(&small(k, a), q[0]), &system.act(&small(k, b), q[1]))
        };
        for (a, b) in [(size, 0.0), (0.0, size)] {
            let (up, down) = (forces(a, b), forces(-a, -b));
            let motions = if b == 0.0 { (unit, none) } else { (none, unit) };
            let found = system.edge_forces_along(0, &spacing, q[0], q[1], &motions.0, &motions.1);
            for (found, (up, down)) in [(found.0, (up.0, down.0)), (found.1, (up.1, down.1))] {
                let expected = (up - down) / (2.0 * size);
                assert!((found - expected).amax() < 1e-6 * (1.0 + expected.amax()), "{k}: {found} {expected}");
            }
        }
    }
}

#[test]
fn forces_of_elements_are_slopes() {
    let axis = |k: usize, size: f64| Vector3::ith(k, size);
    let rotation = |k: usize, size: f64| Rotation3::new(axis(k, size)).into_inner();
    let rod = CosseratRod {
        section: nalgebra::Vector4::from_element(1.0),
        weight: 0.3,
        stiffness: Vector6::new(0.5, 0.6, 0.4, 4.0, 5.0, 8.0),
        reference: Vector6::new(0.3, -0.2, 0.1, 0.1, 0.0, 1.0),
        damping: 0.0,
    };
    for k in 0..10 {
        let (s, n) = (f64::from(k) * 0.7, f64::from(k) * 0.7 + 0.1);
        check(&FromTheLeft { mass_matrix: mass(), stiffness: 1.3 }, [&turn(s), &turn(n)], rotation);
        check(&rod, [&pose(s), &pose(n)], |k, size| {
            if k < 3 { rotation(k, size).to_homogeneous() } else { Matrix4::new_translation(&axis(k - 3, size)) }
        });
        let bent = Bent { section: rod.section, stiffness: rod.stiffness, reference: rod.reference };
        check(&bent, [&pose(s), &pose(n)], |k, size| {
            if k < 3 { rotation(k, size).to_homogeneous() } else { Matrix4::new_translation(&axis(k - 3, size)) }
        });
        check(&LeftLogarithm, [&turn(s), &turn(n)], rotation);
        check(&LogarithmPair, [&(turn(s), Vector2::new(s, 0.3)), &(turn(n), Vector2::new(n, -0.4))], |k, size| {
            let turn = rotation(k.min(2), if k < 3 { size } else { 0.0 });
            (turn, if k < 3 { Vector2::zeros() } else { Vector2::ith(k - 3, size) })
        });
        let plane = |seed: f64| {
            let mut pose = nalgebra::Rotation2::new(seed).to_homogeneous();
            (pose[(0, 2)], pose[(1, 2)]) = (seed.cos(), 0.4 * seed);
            pose
        };
        check(&PlaneBeam { reference: Vector3::new(0.2, 1.0, -0.1) }, [&plane(s), &plane(n)], |k, size| {
            let mut small = nalgebra::Rotation2::new(if k == 0 { size } else { 0.0 }).to_homogeneous();
            if k > 0 {
                small[(k - 1, 2)] = size;
            }
            small
        });
        check(&BentInPlane { reference: Vector3::new(0.2, 1.0, -0.1) }, [&plane(s), &plane(n)], |k, size| {
            let mut small = nalgebra::Rotation2::new(if k == 0 { size } else { 0.0 }).to_homogeneous();
            if k > 0 {
                small[(k - 1, 2)] = size;
            }
            small
        });
        check(&Pair, [&(turn(s), Vector2::new(s, 0.3)), &(turn(n), Vector2::new(n, -0.4))], |k, size| {
            let turn = rotation(k.min(2), if k < 3 { size } else { 0.0 });
            (turn, if k < 3 { Vector2::zeros() } else { Vector2::ith(k - 3, size) })
        });
    }
}
