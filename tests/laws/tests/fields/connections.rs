//! Connections: steps of edges against steps of sites and against the chiral model by hand, curvature, holonomy around a hole, and
//! reconstruction.

use clebsch::{
    CellComplex, Clebsch, ConnectedField, Domain, Error, Field, MovingField, Population, Side, Sides, SiteError,
};
use nalgebra::{Matrix3, Matrix4, Rotation2, Rotation3, SVector, Vector1, Vector2, Vector3, Vector4};
use std::f64::consts::TAU;

/// Bodies in a sheet, each turned by springs to its neighbours.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| ((F - I) * Matrix3::from_diagonal(&self.inertia) * (F - I).transpose()).trace() / (2 * h),
    space  = [
        |dx, W| {
            let x = W.cayley() / dx;
            x.dot(&self.stiffness.component_mul(&x)) / 2
        },
        |dy, W| (W - I).norm_squared() / (4 * dy.powi(2)),
    ],
    emit   = [connection],
)]
struct Crystal {
    inertia: Vector3<f64>,
    stiffness: Vector3<f64>,
}

/// The same model of a line, moved from the left.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| F * R,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
    order  = 4,
    emit   = [connection],
)]
struct Left;

/// The chiral model on a line.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
    emit   = [connection],
)]
struct Chiral;

/// A rod: sections that turn and move.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| {
        let strain = W.cayley() / ds - self.reference;
        ds * strain.dot(&self.stiffness.component_mul(&strain)) / 2
    },
    emit   = [connection],
)]
struct Rod {
    section: Vector4<f64>,
    stiffness: SVector<f64, 6>,
    reference: SVector<f64, 6>,
}

/// Angles and displacements together, at rest.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |(F, a): (SO<2>, Translation<1>), (R, x): (SO<2>, Vector1)| (R * F, x + a),
    space  = |ds, (W, d)| ds * (1 - W[(0, 0)] + (d / ds).norm_squared() / 2 + self.twist * W[(1, 0)] * d.x),
    emit   = [connection],
)]
struct Screw {
    twist: f64,
}

fn rotation(s: f64) -> Matrix3<f64> {
    Rotation3::new(Vector3::new((1.3 * s).sin(), 0.4 * (0.7 * s).cos(), 0.2 * s.sin())).into_inner()
}

fn farthest<A>(found: &[A], expected: &[A], distance: impl Fn(&A, &A) -> f64) -> f64 {
    assert_eq!(found.len(), expected.len());
    found.iter().zip(expected).map(|(a, b)| distance(a, b)).fold(0.0, f64::max)
}

/// The elements and the momenta after some steps are those of the configuration, and so are the energies.
#[track_caller]
fn compare<S, G, P, const N: usize, const M: usize>(
    field: Domain<S, G, P>,
    h: f64,
    q: Vec<nalgebra::SMatrix<f64, N, N>>,
    mu: Vec<SVector<f64, M>>,
    tolerance: f64,
) -> Result<(), SiteError>
where
    S: ConnectedField
        + MovingField
        + Clebsch<
            Scalar = f64,
            Element = nalgebra::SMatrix<f64, N, N>,
            Configuration = nalgebra::SMatrix<f64, N, N>,
            Momentum = SVector<f64, M>,
        > + Clone,
    G: CellComplex<S>,
    P: Population,
{
    let (by_sites, by_edges) = (field.clone().stepper(h)?, field.connection(h)?);
    let mut sites = by_sites.state(q.clone(), mu.clone())?;
    let mut edges = by_edges.state(field.edge_elements(&q)?, mu)?;
    for _ in 0..3 {
        by_sites.advance(&mut sites, 40)?;
        by_edges.advance(&mut edges, 40)?;
        let expected = field.edge_elements(sites.configuration())?;
        let off = farthest(edges.elements(), &expected, |a, b| (a - b).amax());
        assert!(off < tolerance, "elements are {off} off");
        let off = farthest(edges.momentum(), sites.momentum(), |a, b| (a - b).amax());
        assert!(off < tolerance, "momenta are {off} off");
        let (found, expected) = (by_edges.energy(&edges)?, by_sites.energy(&sites)?);
        assert!((found - expected).abs() < tolerance * (1.0 + expected.abs()), "{found} is not {expected}");
        assert!(field.flatness(edges.elements())? < tolerance);
    }
    assert_eq!(edges.steps(), 120);
    // both stand where they should: the last site is where the way along the edges leads to
    let again = field.reconstruct(edges.elements(), (0, sites.configuration()[0]), 1e-10)?;
    assert!(farthest(&again, sites.configuration(), |a, b| (a - b).amax()) < 100.0 * tolerance);
    Ok(())
}

#[test]
fn edges_move_as_sites_do() -> Result<(), SiteError> {
    let crystal = Crystal { inertia: Vector3::new(1.0, 1.4, 0.8), stiffness: Vector3::new(0.5, 1.0, 0.7) };
    let q = |sites: usize| (0..sites).map(|site| rotation(site as f64 / 5.0)).collect::<Vec<_>>();
    let mu = |sites: usize| {
        (0..sites)
            .map(|site| 0.3 * Vector3::new((site as f64).cos(), 0.5, (0.3 * site as f64).sin()))
            .collect::<Vec<_>>()
    };
    let open = Sides::Open(Side::Free, Side::Fixed);
    for sides in [[Sides::Periodic; 2], [open, Sides::Periodic], [Sides::Open(Side::Free, Side::Free); 2], [open; 2]] {
        let grid = crystal.grid([4, 5]).spacing([0.5, 0.7]).sides(sides);
        compare(grid.clone(), 0.05, q(20), mu(20), 1e-12)?;
        let stiff = |[i, _]: [usize; 2]| Crystal { stiffness: crystal.stiffness * (1.0 + i as f64), ..crystal.clone() };
        compare(grid.various(stiff), 0.05, q(20), mu(20), 1e-12)?;
    }
    compare(Left.grid([9]).spacing([0.5]).periodic(), 0.1, q(9), mu(9), 1e-12)?;
    let (vertices, faces) = annulus(5, 2);
    compare(Chiral.mesh(&vertices, &faces)?, 0.05, q(vertices.len()), mu(vertices.len()), 1e-12)?;
    let rod = Rod {
        section: Vector4::new(0.01, 0.01, 0.01, 0.2),
        stiffness: SVector::from([1.0, 1.0, 0.8, 50.0, 50.0, 60.0]),
        reference: SVector::from([0.1, 0.0, 0.0, 0.0, 0.0, 1.0]),
    };
    let bent = |site: usize| {
        let mut q = Matrix4::identity();
        q.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation(site as f64 / 20.0));
        q.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::new(0.01 * site as f64, 0.0, 0.2 * site as f64));
        q
    };
    let kick = |site: usize| SVector::from([0.001, 0.0, 0.002, 0.0, 0.01 * site as f64, 0.02]);
    compare(rod.grid([8]).spacing([0.2]), 0.002, (0..8).map(bent).collect(), (0..8).map(kick).collect(), 1e-11)
}

/// sin θ = h|N| for the kick, W − Wᵀ for the force, and W ← F_a⁻¹ W F_b.
#[test]
fn the_chiral_model_steps_as_by_hand() -> Result<(), SiteError> {
    let (n, dx, h) = (7, 0.4, 0.15);
    let vee = |a: &Matrix3<f64>| {
        let skew = (a - a.transpose()) / 2.0;
        Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)])
    };
    let mut elements: Vec<_> = (0..n).map(|site| rotation(0.4 * site as f64 + 1.0)).collect();
    let mut momenta: Vec<_> = (0..n).map(|site| 0.5 * Vector3::new(0.3, (site as f64).sin(), 0.2)).collect();
    let stepper = Chiral.grid([n]).spacing([dx]).periodic().connection(h)?;
    let mut state = stepper.state(elements.clone(), momenta.clone())?;
    for _ in 0..200 {
        let kicked = |elements: &[Matrix3<f64>], momenta: &mut [Vector3<f64>]| {
            for site in 0..n {
                let force = (vee(&elements[site]) - vee(&elements[(site + n - 1) % n])) / dx.powi(2);
                momenta[site] += h / 2.0 * force;
            }
        };
        kicked(&elements, &mut momenta);
        let turn = |mu: &Vector3<f64>| Rotation3::new(mu.normalize() * (h * mu.norm()).asin()).into_inner();
        let turns: Vec<_> = momenta.iter().map(turn).collect();
        for site in 0..n {
            elements[site] = turns[site].transpose() * elements[site] * turns[(site + 1) % n];
        }
        kicked(&elements, &mut momenta);
        stepper.step(&mut state)?;
        assert!(farthest(state.elements(), &elements, |a, b| (a - b).amax()) < 1e-12);
        assert!(farthest(state.momentum(), &momenta, |a, b| (a - b).amax()) < 1e-12);
    }
    Ok(())
}

/// A flat start stays flat but for rounding, and elements stay rotations.
#[test]
fn steps_keep_connections_flat() -> Result<(), SiteError> {
    let crystal = Crystal { inertia: Vector3::new(1.0, 1.4, 0.8), stiffness: Vector3::new(0.5, 1.0, 0.7) };
    let field = crystal.grid([6, 6]).spacing([0.5, 0.5]).periodic();
    let turn = |site: usize| rotation((site / 6) as f64 + 0.3 * ((site % 6) as f64).sin());
    let q: Vec<_> = (0..36).map(turn).collect();
    let stepper = field.connection(0.05)?;
    let mut state = stepper.state(field.edge_elements(&q)?, vec![Vector3::new(0.1, -0.2, 0.3); 36])?;
    let energy = stepper.energy(&state)?;
    stepper.advance(&mut state, if cfg!(feature = "heavy") { 2000 } else { 500 })?;
    assert!(stepper.domain().flatness(state.elements())? < 1e-12);
    let off = |element: &Matrix3<f64>| (element.transpose() * element - Matrix3::identity()).amax();
    assert!(state.elements().iter().map(off).fold(0.0, f64::max) < 1e-14);
    assert!((stepper.energy(&state)? / energy - 1.0).abs() < 1e-2);
    Ok(())
}

/// An annulus of n sectors and m rings of squares, each of two triangles.
fn annulus(n: usize, m: usize) -> (Vec<Vector2<f64>>, Vec<[usize; 3]>) {
    let place = |site: usize| {
        let (angle, radius) = (TAU * (site % n) as f64 / n as f64, 1.0 + (site / n) as f64);
        Vector2::new(angle.cos(), angle.sin()) * radius
    };
    let square = |k: usize| {
        let (ring, i) = (k / n, k % n);
        let [a, b, c, d] = [ring * n + i, (ring + 1) * n + i, (ring + 1) * n + (i + 1) % n, ring * n + (i + 1) % n];
        [[a, b, c], [a, c, d]]
    };
    ((0..n * (m + 1)).map(place).collect(), (0..n * m).flat_map(square).collect())
}

/// ω = exp(α Δangle) on an annulus has no curvature, and turns by 2πα around the hole.
#[test]
fn a_hole_has_a_holonomy() -> Result<(), SiteError> {
    let (n, m) = (9, 3);
    let (vertices, faces) = annulus(n, m);
    let field = Chiral.mesh(&vertices, &faces)?;
    let axis = Vector3::new(1.0, 2.0, -2.0) / 3.0;
    let about = |alpha: f64| {
        let angle = |[a, b]: [usize; 2]| {
            let (a, b) = (vertices[a], vertices[b]);
            (a.x * b.y - a.y * b.x).atan2(a.dot(&b))
        };
        field
            .lattice()
            .edges()
            .map(|edge| Rotation3::new(axis * (alpha * angle(edge))).into_inner())
            .collect::<Vec<_>>()
    };
    let ring: Vec<usize> = (n..2 * n).collect();
    for alpha in [0.1, 0.37, -0.8] {
        let elements = about(alpha);
        assert!(field.flatness(&elements)? < 1e-15);
        let expected = Rotation3::new(axis * (TAU * alpha)).into_inner();
        assert!((field.holonomy(&elements, &ring)? - expected).amax() < 1e-14);
        let back: Vec<usize> = ring.iter().rev().copied().collect();
        assert!((field.holonomy(&elements, &back)? - expected.transpose()).amax() < 1e-14);
        // no configuration has these elements, and the edge that shows it crosses the cut behind the start
        let refused = field.reconstruct(&elements, (0, Matrix3::identity()), 1e-9).unwrap_err();
        let Error::NotFlat { from, to, distance, tolerance } = refused.error else { panic!("{refused}") };
        assert!(distance > 1e-2 && tolerance == 1e-9 && field.lattice().weight([from, to]).is_ok());
    }
    // all the way round: the same as nothing
    let elements = about(1.0);
    let q = field.reconstruct(&elements, (5, rotation(2.0)), 1e-12)?;
    assert_eq!(q[5], rotation(2.0));
    let again = field.edge_elements(&q)?;
    assert!(farthest(&again, &elements, |a, b| (a - b).amax()) < 1e-14);
    Ok(())
}

/// One element that is turned gives a curvature to the two faces at its edge, and to no other.
#[test]
fn a_turned_element_curves_its_faces() -> Result<(), SiteError> {
    let crystal = Crystal { inertia: Vector3::repeat(1.0), stiffness: Vector3::repeat(1.0) };
    let field = crystal.grid([4, 4]);
    let q: Vec<_> = (0..16).map(|site| rotation(site as f64)).collect();
    let mut elements = field.edge_elements(&q)?;
    let turned = Rotation3::new(Vector3::x() * 0.2).into_inner();
    let (number, is_forward) = field.edge_between(5, 6).expect("an edge");
    assert!(is_forward);
    elements[number] *= turned;
    let curvature = field.curvature(&elements)?;
    assert_eq!(curvature.len(), 9);
    for (face, own) in curvature.iter().enumerate() {
        // squares are numbered by their first site, three in a row: those of the sites 1 and 5 have the edge
        // |Ω − I|² = 8 sin²(angle/2)
        let angle = 2.0 * ((own - Matrix3::identity()).norm() / 8.0_f64.sqrt()).asin();
        let expected = if [1, 4].contains(&face) { 0.2 } else { 0.0 };
        assert!((angle - expected).abs() < 1e-14, "face {face}: {angle}");
    }
    // the way from 5 to 6 is an edge of the tree, the others see it
    let refused = field.reconstruct(&elements, (0, q[0]), 1e-9).unwrap_err();
    assert!(matches!(refused.error, Error::NotFlat { .. }), "{refused}");
    Ok(())
}

/// The momenta of an edge are the slopes of its energy, and their sums at a site those of all edges.
#[test]
fn momenta_of_edges_are_slopes() -> Result<(), SiteError> {
    let crystal = Crystal { inertia: Vector3::repeat(1.0), stiffness: Vector3::new(0.5, 1.0, 0.7) };
    let field = crystal.grid([3, 3]).spacing([0.5, 0.8]);
    let q: Vec<_> = (0..9).map(|site| rotation(0.5 * site as f64)).collect();
    let elements = field.edge_elements(&q)?;
    let (momenta, forces) = (field.edge_momenta(&elements)?, field.forces_of_edges(&elements)?);
    let energy = |site: usize, d: usize, next: usize, moved: usize, motion: Vector3<f64>| {
        let at = |place: usize| if place == moved { q[place] * Rotation3::new(motion) } else { q[place] };
        crystal.edge_energy(d, &[0.5, 0.8], &at(site), &at(next))
    };
    for (site, d, next) in [(0, 0, 3), (4, 1, 5), (1, 0, 4), (3, 1, 4)] {
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for (end, moved) in [site, next].into_iter().enumerate() {
                let a = 1e-5;
                let slope =
                    (energy(site, d, next, moved, axis * a) - energy(site, d, next, moved, axis * -a)) / (2.0 * a);
                // dU = θ⁺ − θ⁻
                let sign = if end == 0 { -1.0 } else { 1.0 };
                let found = sign * momenta[site * 2 + d][end].dot(&axis);
                assert!((found - slope).abs() < 1e-8, "edge {site} {next}, end {end}: {found} is not {slope}");
            }
        }
    }
    let expected = momenta[4 * 2][0] + momenta[4 * 2 + 1][0] - momenta[2][1] - momenta[3 * 2 + 1][1];
    assert!((forces[4] - expected).amax() < 1e-15);
    // all together: no momentum from nowhere, in space
    let total: Vector3<f64> = q.iter().zip(&forces).map(|(q, force)| q * force).sum();
    assert!(total.amax() < 1e-14);
    Ok(())
}

/// At rest the momenta of edges balance at each site inside, for products of groups and fields without a cost too.
#[test]
fn fields_at_rest_balance_their_edges() -> Result<(), SiteError> {
    let screw = Screw { twist: 0.3 }.grid([9]).spacing([0.25]).fixed();
    let mut q: Vec<_> = (0..9)
        .map(|i| (Rotation2::new(if i < 5 { 0.0 } else { 0.8 }).into_inner(), Vector1::new(0.1 * f64::from(i * i))))
        .collect();
    screw.relax().tolerance(1e-13).solve(&mut q)?;
    let elements = screw.edge_elements(&q)?;
    let forces = screw.forces_of_edges(&elements)?;
    assert!(forces[1..8].iter().all(|force| force.amax() < 1e-11));
    assert!(forces[0].amax() > 0.1 && (forces[0] + forces[8]).amax() < 1e-10);
    let again = screw.reconstruct(&elements, (8, q[8]), 1e-12)?;
    assert!(farthest(&again, &q, |a, b| f64::max((a.0 - b.0).amax(), (a.1 - b.1).amax())) < 1e-13);
    Ok(())
}

#[test]
fn mistakes_in_connections_are_named() -> Result<(), SiteError> {
    let chain = Chiral.grid([4]);
    let one = Matrix3::identity();
    let stepper = chain.connection(0.1)?;
    let error = |result: Result<_, SiteError>| result.err();
    let zero = vec![Vector3::zeros(); 4];
    let refused = error(stepper.state(vec![one; 3], zero.clone()));
    assert_eq!(refused, Some(Error::NumberOfEdges { found: 3, edges: 4 }.into()));
    let refused = error(stepper.state(vec![one; 4], zero[1..].to_vec()));
    assert_eq!(refused, Some(Error::NumberOfSites { found: 3, sites: 4 }.into()));
    let refused = error(stepper.state(vec![one, one * 2.0, one, one], zero.clone()));
    assert!(matches!(refused, Some(SiteError { site: Some(1), error: Error::OffOrbit { .. } })));
    // the last edge is not there: its element is not read
    let state = stepper.state(vec![one, one, one, one * 2.0], zero)?;
    assert_eq!(state.elements()[3], one);
    assert_eq!(chain.flatness(&[one; 5]), Err(Error::NumberOfEdges { found: 5, edges: 4 }));
    assert_eq!(chain.holonomy(&[one; 4], &[0, 1, 2]), Err(Error::NoEdge { from: 2, to: 0 }));
    assert_eq!(chain.holonomy(&[one; 4], &[0, 9]), Err(Error::NoEdge { from: 0, to: 9 }));
    let refused = chain.reconstruct(&[one; 4], (1, one * 0.5), 1e-9).unwrap_err();
    assert!(matches!(refused, SiteError { site: Some(1), error: Error::OffOrbit { .. } }));
    let refused = chain.reconstruct(&[one; 4], (7, one), 1e-9).unwrap_err();
    assert_eq!(refused.error, Error::Unreached { site: 0, from: 7 });
    // a vertex without a face
    let (mut vertices, faces) = annulus(3, 1);
    vertices.push(Vector2::new(9.0, 9.0));
    let mesh = Chiral.mesh(&vertices, &faces)?;
    let refused = mesh.reconstruct(&vec![one; mesh.edge_numbers()], (0, one), 1e-9).unwrap_err();
    assert_eq!(refused, SiteError { site: Some(6), error: Error::Unreached { site: 6, from: 0 } });
    Ok(())
}

/// A step whose kick is too long is an error of its site, and stays one.
#[test]
fn a_connection_whose_step_failed_is_not_stepped_again() -> Result<(), SiteError> {
    let stepper = Chiral.grid([3]).connection(0.1)?;
    let mut state =
        stepper.state(vec![Matrix3::identity(); 3], vec![Vector3::zeros(), Vector3::x() * 11.0, Vector3::zeros()])?;
    let error = stepper.step(&mut state).unwrap_err();
    assert_eq!(error.site, Some(1));
    assert_eq!(stepper.step(&mut state), Err(error));
    assert_eq!(state.steps(), 0);
    Ok(())
}
