//! Fields: grids, the forces of edges, and steps of all sites.

use crate::arbitrary::{cases, vector};
use crate::runner::proptest;
use clebsch::__private as private;
use clebsch::{
    Alike, CellComplex, Clebsch, Clock, ConnectedField, Error, Field, FieldSite, FieldState, Grid, Lattice, Mesh,
    MidpointSite, Population, SavedField, Side, Sides, SiteError, Various,
};
use nalgebra::{Matrix3, Rotation3, SVector, Vector1, Vector2, Vector3};
use proptest::prelude::*;

/// Spins with springs between them in two directions, in a field that grows with the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |t, q| -self.field.dot(&q) * (1 + t),
    space     = [
        |dx, q, next| self.stiffness * (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| self.exchange * q.dot(&next).powi(2) / dy + self.twist.dot(&q.cross(&next)),
    ],
    force     = |omega, torque: Vector3| torque,
)]
pub struct Spins {
    pub field: Vector3<f64>,
    pub stiffness: f64,
    pub exchange: f64,
    pub twist: Vector3<f64>,
}

/// The same without a field and without inputs.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, q, next| self.stiffness * (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| -self.exchange * q.dot(&next).powi(2) / dy,
    ],
)]
pub struct FreeSpins {
    pub stiffness: f64,
    pub exchange: f64,
}

fn spins() -> Spins {
    Spins { field: Vector3::new(0.1, -0.2, 0.3), stiffness: 0.8, exchange: 0.4, twist: Vector3::new(0.2, 0.1, -0.3) }
}

/// Unit vectors, and momenta across them.
fn site() -> impl Strategy<Value = (Vector3<f64>, Vector3<f64>)> {
    let is_long = |q: &Vector3<f64>| q.norm() > 0.1;
    (vector::<3>(1.0).prop_filter("a direction", is_long), vector::<3>(1.0)).prop_map(|(q, p)| {
        let q = q.normalize();
        (q, q.cross(&p) * 0.2)
    })
}

fn side() -> impl Strategy<Value = Sides> {
    let one = || prop_oneof![Just(Side::Free), Just(Side::Fixed)];
    prop_oneof![Just(Sides::Periodic), (one(), one()).prop_map(|(first, last)| Sides::Open(first, last))]
}

/// Configurations and momenta of so many sites.
fn states(sites: usize) -> impl Strategy<Value = (Vec<Vector3<f64>>, Vec<Vector3<f64>>)> {
    prop::collection::vec(site(), sites).prop_map(|sites| sites.into_iter().unzip())
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

fn turned(q: &Vector3<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
    Rotation3::new(*axis) * q
}

/// Springs between unit vectors at the edges of a mesh, in a field.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    potential = |q| -self.field.dot(&q),
    space     = |length, q, next| (next - q).norm_squared() / (2 * length),
)]
pub struct Needles {
    pub field: Vector3<f64>,
}

/// The same on a grid.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    potential = |q| -self.field.dot(&q),
    space     = [
        |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
    ],
)]
pub struct Vanes {
    pub field: Vector3<f64>,
}

/// Bodies in a row with springs of their turns and places between them, in a field that grows with the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(F, a): (SO<3>, Translation<2>), (R, x): (SO<3>, Vector2)| (R * F, x + a),
    cost      = |h, F, a| (F - I).norm_squared() / (4 * h) + self.mass * a.norm_squared() / (2 * h),
    potential = |t, (R, x)| self.weight * (1 + t) * R[(2, 2)] * x.x,
    space     = |dx, (W, b)| (W.log().norm_squared() + b.norm_squared() + W.log().x * b.y) / (2 * dx),
    force     = |(R, x), (omega, v), u: Vector1| (u.x * x.y * omega, vector![u.x * R[(0, 1)] * v.y, 0]),
    emit      = [midpoint],
)]
pub struct Row {
    pub mass: f64,
    pub weight: f64,
}

/// Rotations with springs between them, in two directions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
        |dy, W| self.stiffness * (W - I).norm_squared() / (4 * dy.powi(2)),
    ],
    emit   = [connection],
)]
pub struct Crystal {
    pub stiffness: f64,
}

/// A film, its height x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    space  = [|dx, x, next| (next - x).norm_squared() / 2, |dy, x, next| (next - x).norm_squared() / 2],
)]
pub struct Film;

/// The vertices and triangles of a sheet of n × m squares, with places and diagonals of choice.
fn sheet(n: usize, m: usize, shifts: &[Vector3<f64>], turned: &[bool]) -> (Vec<Vector3<f64>>, Vec<[usize; 3]>) {
    let site = |i: usize, j: usize| i * (m + 1) + j;
    let place =
        |s: usize| Vector3::new((s / (m + 1)) as f64, (s % (m + 1)) as f64, 0.0) + 0.2 * shifts[s % shifts.len()];
    let square = |k: usize| {
        let (i, j) = (k / m, k % m);
        let [a, b, c, d] = [site(i, j), site(i + 1, j), site(i + 1, j + 1), site(i, j + 1)];
        if turned[k % turned.len()] { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    ((0..(n + 1) * (m + 1)).map(place).collect(), (0..n * m).flat_map(square).collect())
}

proptest! {
    #![proptest_config(cases(12))]

    #[test]
    fn meshes_have_edges_and_borders(
        n in 1_usize..5, m in 1_usize..5, shifts in prop::collection::vec(vector::<3>(1.0), 7), turned in prop::collection::vec(any::<bool>(), 5), at in any::<prop::sample::Index>(),
    ) {
        let (vertices, faces) = sheet(n, m, &shifts, &turned);
        let mesh = Mesh::new(&vertices, &faces).expect("a mesh");
        let edges: Vec<[usize; 2]> = mesh.edges().collect();
        // Euler: a disk
        prop_assert_eq!(mesh.sites() + faces.len(), edges.len() + 1);
        prop_assert_eq!(mesh.faces().collect::<Vec<_>>(), faces.iter().map(|face| &face[..]).collect::<Vec<_>>());
        for site in 0..mesh.sites() {
            let (i, j) = (site / (m + 1), site % (m + 1));
            prop_assert_eq!(mesh.is_border(site), i == 0 || j == 0 || i == n || j == m);
        }
        let area = |[a, b, c]: [usize; 3]| (vertices[b] - vertices[a]).cross(&(vertices[c] - vertices[a])).norm() / 2.0;
        let total: f64 = (0..mesh.sites()).map(|site| mesh.area(site)).sum();
        near(total, faces.iter().map(|face| area(*face)).sum(), 1e-12);
        // ½ (cot α + cot β)
        let cotangents = mesh.clone().cotangent_weights().expect("triangles");
        let weighted = mesh.weights(|[a, b]| (a + 2 * b) as f64);
        for [a, b] in edges {
            let opposite = faces.iter().filter(|face| face.contains(&a) && face.contains(&b)).map(|face| face.iter().sum::<usize>() - a - b);
            let angle = |c: usize| (vertices[a] - vertices[c]).angle(&(vertices[b] - vertices[c]));
            let expected: f64 = opposite.map(|c| 0.5 / angle(c).tan()).sum();
            near(cotangents.weight([b, a]).expect("an edge"), expected, 1e-9 * (1.0 + expected.abs()));
            prop_assert_eq!(weighted.weight([a, b]), Ok((a + 2 * b) as f64));
        }
        // one face the other way round
        let mut flipped = faces.clone();
        flipped[at.index(faces.len())].reverse();
        let is_refused = matches!(Mesh::new(&vertices, &flipped), Err(Error::FlippedFace { .. }));
        prop_assert!(faces.len() == 1 || is_refused);
    }

    #[test]
    fn relaxed_fields_rest(
        n in 1_usize..4, m in 1_usize..4, shifts in prop::collection::vec(vector::<3>(1.0), 7), turned in prop::collection::vec(any::<bool>(), 5),
        all in states(16), field in vector::<3>(1.0), factor in 0.5_f64..1.8, weight in 0.5_f64..2.0,
    ) {
        let (vertices, faces) = sheet(n, m, &shifts, &turned);
        let (sites, needles) = (vertices.len(), Needles { field });
        let domain = needles.mesh(&vertices, &faces).expect("a mesh").weights(|_| weight).fixed_where(|site| site == 0);
        prop_assert!(domain.lattice().is_fixed(0) && !domain.lattice().is_fixed(1));
        prop_assert!((0..sites).all(|site| domain.clone().fixed().lattice().is_fixed(site) == domain.lattice().is_border(site)));
        prop_assert!(domain.clone().cotangent_weights().is_ok());
        let start: Vec<_> = (0..sites).map(|site| all.0[site % 16]).collect();
        let energy = |q: &[Vector3<f64>]| {
            let edge = |[a, b]: [usize; 2]| weight * (q[a] - q[b]).norm_squared() / (2.0 * (vertices[a] - vertices[b]).norm());
            domain.lattice().edges().map(edge).sum::<f64>() - q.iter().map(|q| field.dot(q)).sum::<f64>()
        };
        let [a, b] = domain.lattice().edges().next().expect("an edge");
        let first = |q: &[Vector3<f64>]| {
            let mut found = None;
            Lattice::<Needles>::visit_edges(domain.lattice(), a, |edge, _| {
                if edge.ends == [a, b] {
                    found = Some(domain.lattice().energy_of_edge(&needles, edge, [&q[a], &q[b]]));
                }
            });
            found.expect("the edge")
        };
        near(first(&start), weight * (start[a] - start[b]).norm_squared() / (2.0 * (vertices[a] - vertices[b]).norm()), 1e-12);
        for relaxation in [domain.relax(), domain.relax().over_relaxation(factor)] {
            let mut q = start.clone();
            let found = match relaxation.tolerance(1e-11).sweeps(20_000).solve(&mut q) {
                Ok(found) => found,
                // a saddle nearby may be left slowly
                Err(SiteError { error: Error::NotRelaxed { .. }, .. }) => continue,
                Err(error) => return Err(TestCaseError::fail(error.to_string())),
            };
            prop_assert_eq!(q[0], start[0]);
            prop_assert!(found.sweeps() <= 20_000 && found.correction() <= 1e-11);
            near(found.energy(), energy(&q), 1e-12 * (1.0 + energy(&q).abs()));
            prop_assert!(found.energy() <= energy(&start) + 1e-12);
            for site in 1..sites {
                // by differences
                for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                    let moved = |a: f64| {
                        let mut q = q.clone();
                        q[site] = self::turned(&q[site], &(axis * a));
                        energy(&q)
                    };
                    near((moved(1e-4) - moved(-1e-4)) / 2e-4, 0.0, 1e-7);
                }
            }
            near(found.residual(), 0.0, 1e-8);
        }
    }

    #[test]
    fn cycles_bring_fields_to_rest(
        n in 1_usize..10, m in 1_usize..10, sides in [side(), side()], spacing in [0.3_f64..2.0, 0.3_f64..2.0], all in states(100), field in vector::<3>(1.0),
    ) {
        let domain = Vanes { field }.grid([n, m]).sides(sides).spacing(spacing);
        let start = all.0[..n * m].to_vec();
        let energy = |q: &[Vector3<f64>]| {
            let edge = |site: usize, next: usize, d: usize| (q[site] - q[next]).norm_squared() / (2.0 * spacing[d].powi(2));
            let mut total = -q.iter().map(|q| field.dot(q)).sum::<f64>();
            for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
                if i + 1 < n || sides[0] == Sides::Periodic {
                    total += edge(i * m + j, (i + 1) % n * m + j, 0);
                }
                if j + 1 < m || sides[1] == Sides::Periodic {
                    total += edge(i * m + j, i * m + (j + 1) % m, 1);
                }
            }
            total
        };
        let mut q = start.clone();
        if let Err(error) = domain.relax().multigrid().cycles(1).solve(&mut q) {
            let is_unfinished = matches!(error.error, Error::NotRelaxed { sweeps: 4, .. });
            prop_assert!(is_unfinished, "{}", error);
        }
        prop_assert!(energy(&q) <= energy(&start) + 1e-12);
        let found = match domain.relax().multigrid().tolerance(1e-11).cycles(5000).solve(&mut q) {
            Ok(found) => found,
            // a saddle nearby may be left slowly
            Err(SiteError { error: Error::NotRelaxed { .. }, .. }) => return Ok(()),
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        prop_assert!(found.correction() <= 1e-11);
        near(found.energy(), energy(&q), 1e-12 * (1.0 + energy(&q).abs()));
        prop_assert!(found.energy() <= energy(&start) + 1e-12);
        for site in 0..n * m {
            if domain.lattice().is_fixed(site) {
                prop_assert_eq!(q[site], start[site]);
                continue;
            }
            // by differences
            for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let moved = |a: f64| {
                    let mut q = q.clone();
                    q[site] = self::turned(&q[site], &(axis * a));
                    energy(&q)
                };
                near((moved(1e-4) - moved(-1e-4)) / 2e-4, 0.0, 1e-6);
            }
        }
    }

    #[test]
    fn connections_are_those_of_configurations(
        sides in [side(), side()], all in states(12), turns in prop::collection::vec(vector::<3>(1.0), 12), spacing in 0.4_f64..2.0,
        walk in prop::collection::vec(0_usize..4, 1..12), at in any::<prop::sample::Index>(), turn in vector::<3>(0.5),
    ) {
        let domain = Crystal { stiffness: 0.7 }.grid([3, 4]).sides(sides).spacing([spacing, 1.0]);
        let q: Vec<Matrix3<f64>> = turns.iter().map(|turn| Rotation3::new(*turn).into_inner()).collect();
        let elements = domain.edge_elements(&q).expect("elements");
        prop_assert_eq!((elements.len(), domain.edge_numbers()), (24, 24));
        let nearby = |a: &[Matrix3<f64>], b: &[Matrix3<f64>]| a.iter().zip(b).for_each(|(a, b)| near((a - b).amax(), 0.0, 1e-11));
        let mut faces = 0;
        CellComplex::<Crystal>::visit_faces(domain.lattice(), |path| {
            assert_eq!(path.len(), 4);
            faces += 1;
        });
        prop_assert_eq!(domain.curvature(&elements).expect("numbers of edges").len(), faces);
        // flat, and the same again from any site
        near(domain.flatness(&elements).expect("numbers of edges"), 0.0, 1e-14);
        for curvature in domain.curvature(&elements).expect("numbers of edges") {
            near((curvature - Matrix3::identity()).amax(), 0.0, 1e-14);
        }
        let start = at.index(12);
        nearby(&domain.reconstruct(&elements, (start, q[start]), 1e-12).expect("a configuration"), &q);
        // around any closed walk: there and back
        let mut path = vec![start];
        for direction in walk {
            let place = [path[path.len() - 1] / 4, path[path.len() - 1] % 4];
            let next = [[place[0] + 1, place[1]], [place[0], place[1] + 1], [place[0].wrapping_sub(1), place[1]], [place[0], place[1].wrapping_sub(1)]];
            if let Some(site) = domain.lattice().index(next[direction]) {
                path.push(site);
            }
        }
        let steps: Vec<[usize; 2]> = path.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        for [from, to] in &steps {
            let (number, is_forward) = domain.edge_between(*from, *to).expect("an edge");
            let element = Crystal { stiffness: 1.0 }.edge_element(&q[*from], &q[*to]);
            let expected = if is_forward { elements[number] } else { elements[number].transpose() };
            // in a ring of two sites there are two edges
            near((element - expected).amax(), 0.0, 1e-14);
        }
        let back: Vec<usize> = path.iter().chain(path.iter().rev().skip(1)).copied().collect();
        if back.len() > 1 {
            let around = domain.holonomy(&elements, &back[..back.len() - 1]).expect("a closed path");
            near((around - Matrix3::identity()).amax(), 0.0, 1e-13);
        }
        // one element that is turned curves the faces at its edge
        if let Some([from, to]) = steps.first() {
            let (number, _) = domain.edge_between(*from, *to).expect("an edge");
            let mut curved = elements.clone();
            curved[number] *= Rotation3::new(turn).into_inner();
            let expected = (Rotation3::new(turn).into_inner() - Matrix3::identity()).norm();
            let found = domain.curvature(&curved).expect("numbers of edges");
            let sizes = found.iter().map(|own| (own - Matrix3::identity()).norm());
            prop_assert!(sizes.clone().filter(|size| (size - expected).abs() < 1e-12).count() >= 1);
            prop_assert!(domain.flatness(&curved).expect("numbers of edges") <= expected + 1e-12);
        }
        // momenta of edges are forces of configurations
        let (momenta, forces) = (domain.edge_momenta(&elements).expect("momenta"), domain.forces_of_edges(&elements).expect("forces"));
        for (site, force) in forces.iter().enumerate() {
            let own = domain.lattice().force(|_| domain.system(0).expect("a site"), 0.0, &q, site);
            near((force - own).amax(), 0.0, 1e-11);
        }
        let total = |end: usize| momenta.iter().map(|both| both[end]).sum::<Vector3<f64>>();
        near((total(0) - total(1) - forces.iter().sum::<Vector3<f64>>()).amax(), 0.0, 1e-11);
        // steps of edges are those of sites
        let mu: Vec<_> = all.1.iter().map(|mu| mu * 0.3).collect();
        let (by_sites, by_edges) = (domain.clone().stepper(0.02).expect("a stepper"), domain.connection(0.02).expect("a stepper"));
        let mut sites = by_sites.state(q, mu.clone()).expect("a state");
        let mut edges = by_edges.state(elements, mu).expect("a state");
        by_edges.step(&mut edges).expect("a step");
        by_edges.advance(&mut edges, 4).expect("steps");
        by_sites.advance(&mut sites, 5).expect("steps");
        nearby(edges.elements(), &by_edges.domain().edge_elements(sites.configuration()).expect("elements"));
        for (found, expected) in edges.momentum().iter().zip(sites.momentum()) {
            near((found - expected).amax(), 0.0, 1e-11);
        }
        near(by_edges.energy(&edges).expect("an energy"), by_sites.energy(&sites).expect("an energy"), 1e-10);
        prop_assert_eq!(edges.steps(), 5);
        // a state that was written and read goes on with the same bits
        let text = serde_json::to_string(&edges).expect("numbers");
        let read = |text: &str| serde_json::from_str::<SavedField<Vec<Matrix3<f64>>, Vec<Vector3<f64>>>>(text).expect("numbers");
        let mut resumed = by_edges.resume(read(&text)).expect("a state");
        prop_assert_eq!(&resumed, &edges);
        by_edges.advance(&mut edges, 3).expect("steps");
        by_edges.advance(&mut resumed, 3).expect("steps");
        prop_assert_eq!(&resumed, &edges);
        let (number, _) = by_edges.domain().edge_between(0, 1).expect("an edge");
        let mut changed: serde_json::Value = serde_json::from_str(&text).expect("text");
        changed["configuration"][number][0] = serde_json::Value::from(3.0);
        prop_assert!(by_edges.resume(read(&changed.to_string())).is_err());
    }

    /// A kick and a drift in one pass through blocks of rows have the bits of one after the other, and the same errors.
    #[test]
    fn blocks_of_rows_have_the_bits_of_all_sites(
        sides in [side(), side()], row in 1_usize..60, more in 0_usize..700, axis in vector::<3>(1.0), fast in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let rows = (1600 + more).div_ceil(row);
        let wave = |site: usize, speed: f64| (site as f64 * speed).sin();
        let q: Vec<_> = (0..rows * row).map(|site| turned(&Vector3::x(), &(axis * wave(site, 0.7)))).collect();
        let mut mu: Vec<_> = q.iter().enumerate().map(|(site, q)| q.cross(&axis) * wave(site, 0.3)).collect();
        if let Some(fast) = fast {
            // an angle that no step turns by
            let site = fast.index(mu.len());
            mu[site] = q[site].cross(&Vector3::new(0.0, 0.6, 0.8)) * 1e3;
        }
        let stepper = spins().grid([rows, row]).sides(sides).stepper(0.05).expect("a stepper");
        let mut state = stepper.state(q, mu).expect("a state");
        let mut expected = state.clone();
        let result = stepper.advance(&mut state, 3);
        prop_assert_eq!(result, stepper.par_advance(&mut expected, 3));
        prop_assert!(result.is_err() || state == expected);
        prop_assert_eq!(Lattice::<Spins>::rows_of_neighbours(stepper.lattice(), true), Some(row));
        prop_assert_eq!(Lattice::<Spins>::rows_of_neighbours(stepper.lattice(), false), None);
        // and along a line, whose edges push one after the other
        let (bodies, count) = (Row { mass: 0.4, weight: 0.2 }, 1600 + more);
        let stepper = bodies.grid([count]).spacing([0.5]).sides([sides[0]]).stepper(0.01).expect("a stepper");
        let place = |site: usize| (Rotation3::new(axis * wave(site, 0.7)).into_inner(), Vector2::new(wave(site, 0.2), 0.3));
        let momentum = |site: usize| SVector::<f64, 5>::from_fn(|i, _| 0.1 * wave(site + i, 0.9));
        let mut state = stepper.state((0..count).map(place).collect::<Vec<_>>(), (0..count).map(momentum).collect::<Vec<_>>()).expect("a state");
        let mut expected = state.clone();
        prop_assert_eq!(Lattice::<Row>::rows_of_neighbours(stepper.lattice(), false), Some(1));
        stepper.advance(&mut state, 2).expect("steps");
        stepper.par_advance(&mut expected, 2).expect("steps");
        prop_assert!(state == expected);
    }

    #[test]
    fn harmonic_functions_pair_to_zero(
        n in 2_usize..7, m in 2_usize..7, inside in prop::collection::vec(any::<bool>(), 49), coefficients in [vector::<4>(1.0), vector::<4>(1.0)],
    ) {
        // a film that does not move at its sides
        let film = Film.grid([n, m]).fixed();
        let harmonic = |c: &SVector<f64, 4>| -> Vec<Vector1<f64>> {
            let place = |site: usize| ((site / m) as f64, (site % m) as f64);
            (0..n * m).map(place).map(|(x, y)| Vector1::new(c[0] * x + c[1] * y + c[2] * x * y + c[3] * (x * x - y * y))).collect()
        };
        let [v, w] = coefficients.each_ref().map(harmonic);
        let sum = film.multisymplectic(&vec![Vector1::zeros(); n * m], [&v, &w], |site| inside[site]).expect("a sum");
        near(sum, 0.0, 1e-10);
        near(film.multisymplectic(&vec![Vector1::zeros(); n * m], [&v, &v], |site| inside[site]).expect("a sum"), 0.0, 1e-12);
    }

    #[test]
    fn degrees_are_integers(all in states(20), turns in 1_i32..4) {
        // a periodic grid, and a mesh of the same squares
        let (grid, q) = (Grid::<f64, 2>::new([4, 5]).periodic(), all.0);
        let found = grid.degree(&q).expect("a degree");
        near(found, found.round(), 1e-12);
        let site = |i: usize, j: usize| i % 4 * 5 + j % 5;
        let square = |k: usize| [site(k / 5, k % 5), site(k / 5 + 1, k % 5), site(k / 5 + 1, k % 5 + 1), site(k / 5, k % 5 + 1)];
        let faces: Vec<[usize; 4]> = (0..20).map(square).collect();
        let places: Vec<_> = (0..20).map(|k| Vector3::new((k / 5) as f64, (k % 5) as f64, 0.1 * k as f64)).collect();
        near(Mesh::new(&places, &faces).expect("a torus").degree(&q).expect("a degree"), found, 1e-12);
        prop_assert_eq!(grid.degree(&q[1..]), Err(Error::NumberOfSites { found: 19, sites: 20 }));
        // from pole to pole and so many times around
        let sphere = Grid::<f64, 2>::new([24, 24 * turns as usize + 1]);
        let place = |k: usize| {
            let (i, j) = (k / (24 * turns as usize + 1), k % (24 * turns as usize + 1));
            let (polar, around) = (std::f64::consts::PI * i as f64 / 23.0, std::f64::consts::TAU * j as f64 / 24.0);
            Vector3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos())
        };
        let whole: Vec<_> = (0..sphere.sites()).map(place).collect();
        near(sphere.degree(&whole).expect("a degree"), f64::from(turns), 1e-11);
    }

    #[test]
    fn small_motions_move_sites(all in states(1), motion in vector::<3>(1.0)) {
        let (q, size) = (all.0[0], 1e-4);
        let moved = spins().moved_by(&q, &(motion * size));
        near((moved - turned(&q, &(motion * size))).amax(), 0.0, 1e-7 * (1.0 + motion.norm_squared()));
        near(moved.norm(), 1.0, 1e-14);
    }

    /// Where nothing but q drifts, it turns about N by θ with sin θ = h|N|, without a step around it.
    #[test]
    fn drifts_alone_turn_unit_vectors((q, mu) in site(), h in 0.0_f64..3.0, defect in -1e-4_f64..1e-4) {
        let free = FreeSpins { stiffness: 0.8, exchange: 0.4 };
        let constants = free.constants(h).expect("a step");
        let moved = free.drifted(&constants, &q, &mu).expect("a drift of q alone");
        let sine = h * mu.norm();
        let turn = Rotation3::from_scaled_axis(mu * if sine > 0.0 { sine.asin() / mu.norm() } else { 0.0 });
        near((moved - turn * q).amax(), 0.0, 1e-14);
        near((moved - private::drifted(&free, &q, &(mu * h))).amax(), 0.0, 1e-15);
        let beyond = free.drifted(&constants, &q, &(mu / sine * 1.01)).expect("a drift");
        prop_assert!(sine == 0.0 || !FreeSpins::mended(beyond).1);
        let (mended, is_there) = FreeSpins::mended(moved * (1.0 + defect));
        prop_assert!(is_there && (mended.norm() - 1.0).abs() < 2.0 * defect * defect + 4.0 * f64::EPSILON);
        prop_assert_eq!((mended, is_there), private::near_length_one(moved * (1.0 + defect)));
        prop_assert!(!FreeSpins::mended(moved * 1.1).1);
        // an input acts during the drift
        let forced = spins();
        prop_assert_eq!(forced.drifted(&forced.constants(h).expect("a step"), &q, &mu), None);
        for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let sites = [Vector3::new(q.x, broken, q.z), Vector3::new(broken, -broken, q.z)];
            prop_assert!(private::is_finite(&q) && !sites.iter().any(private::is_finite));
        }
    }

    #[test]
    fn grids_number_their_sites(sizes in [1_usize..5, 1..5, 1..5], spacing in [0.1_f64..2.0, 0.1..2.0, 0.1..2.0]) {
        let grid = Grid::new(sizes).spacing(spacing);
        prop_assert_eq!((grid.sizes(), *grid.spacings(), grid.sites()), (sizes, spacing, sizes.iter().product()));
        for index in 0..grid.sites() {
            let place = grid.place(index).expect("a site");
            prop_assert_eq!(grid.index(place), Some(index));
        }
        prop_assert_eq!((grid.place(grid.sites()), grid.index(sizes)), (None, None));
        let plane = Grid::new([sizes[0], sizes[1]]);
        prop_assert_eq!(Lattice::<Spins>::sites(&plane), plane.sites());
        prop_assert_eq!(Lattice::<Spins>::check(&plane), Ok(()));
        let empty = Lattice::<Spins>::check(&Grid::new([sizes[0], 0]));
        prop_assert_eq!(empty, Err(Error::EmptyGrid { direction: 1, sites: 0 }));
    }

    #[test]
    fn sides_fix_their_sites(sizes in [1_usize..5, 1..5], sides in [side(), side()]) {
        let domain = spins().grid(sizes).sides(sides);
        let grid = *domain.lattice();
        let mut has_fixed = false;
        for index in 0..grid.sites() {
            let place = grid.place(index).expect("a site");
            let is_fixed = (0..2).any(|d| match sides[d] {
                Sides::Periodic => false,
                Sides::Open(first, last) => {
                    (place[d] == 0 && first == Side::Fixed) || (place[d] + 1 == sizes[d] && last == Side::Fixed)
                }
            });
            prop_assert_eq!(grid.is_fixed(index), is_fixed);
            prop_assert_eq!(Lattice::<Spins>::is_fixed(&grid, index), is_fixed);
            has_fixed |= is_fixed;
        }
        prop_assert_eq!(Lattice::<Spins>::has_fixed(&grid), has_fixed);
        let domain = spins().grid(sizes);
        let all = [domain.clone().free(), domain.clone().fixed(), domain.clone().periodic()].map(|domain| *domain.lattice());
        let expected = [Sides::Open(Side::Free, Side::Free), Sides::Open(Side::Fixed, Side::Fixed), Sides::Periodic];
        for ((grid, sides), by_hand) in all.into_iter().zip(expected).zip([Grid::free, Grid::fixed, Grid::periodic]) {
            prop_assert_eq!(grid, Grid::new(sizes).sides([sides; 2]));
            prop_assert_eq!(grid, by_hand(Grid::new(sizes)));
            prop_assert_eq!(grid.all_sides(), &[sides; 2]);
        }
        let stepper = domain.stepper(0.1).expect("a stepper");
        prop_assert_eq!(*stepper.lattice(), Grid::new(sizes));
    }

    #[test]
    fn forces_of_edges_are_slopes(
        all in states(5), t in 0.0_f64..1.0, spacing in [0.4_f64..2.0, 0.4..2.0], axis in vector::<3>(1.0),
    ) {
        let (system, q, size) = (spins(), all.0, 1e-5);
        for d in 0..2 {
            let energy = |a: f64, b: f64| system.edge_energy(d, &spacing, &turned(&q[0], &(axis * a)), &turned(&q[1], &(axis * b)));
            let (own, next) = system.edge_forces(d, &spacing, &q[0], &q[1]);
            let slopes = [energy(size, 0.0) - energy(-size, 0.0), energy(0.0, size) - energy(0.0, -size)];
            for (force, slope) in [own, next].iter().zip(slopes) {
                near(force.dot(&axis), -slope / (2.0 * size), 1e-7 * (1.0 + axis.norm_squared() * 20.0));
            }
        }
        let potential = |a: f64| system.potential(t, &turned(&q[0], &(axis * a)));
        let slope = (potential(size) - potential(-size)) / (2.0 * size);
        near(system.force_on_site(t, &q[0]).dot(&axis), -slope, 1e-7 * (1.0 + axis.norm_squared()));
        // all edges at once
        let mut sum = system.force_on_site(t, &q[0]);
        for d in 0..2 {
            sum += system.edge_forces(d, &spacing, &q[0], &q[1 + 2 * d]).0;
            sum += system.edge_forces(d, &spacing, &q[2 + 2 * d], &q[0]).1;
        }
        let inside = system.force_inside(t, &spacing, &q[0], &[&q[2], &q[4]], &[&q[1], &q[3]]);
        near((inside - sum).amax(), 0.0, 1e-12);
    }

    #[test]
    fn changes_of_forces_are_slopes(
        all in states(2), t in 0.0_f64..1.0, spacing in [0.4_f64..2.0, 0.4..2.0], axes in [vector::<3>(1.0), vector::<3>(1.0)],
    ) {
        let (system, q, size) = (spins(), all.0, 1e-5);
        let close = |found: Vector3<f64>, [after, before]: [Vector3<f64>; 2]| {
            near((found - (after - before) / (2.0 * size)).amax(), 0.0, 1e-7);
        };
        for d in 0..2 {
            let forces = |a: f64| system.edge_forces(d, &spacing, &turned(&q[0], &(axes[0] * a)), &turned(&q[1], &(axes[1] * a)));
            let [after, before] = [size, -size].map(forces);
            let (own, next) = system.edge_forces_along(d, &spacing, &q[0], &q[1], &axes[0], &axes[1]);
            close(own, [after.0, before.0]);
            close(next, [after.1, before.1]);
        }
        // each edge of a lattice with its ends
        let ring = Grid::new([1, 2]).spacing(spacing).sides([Sides::Open(Side::Free, Side::Free), Sides::Periodic]);
        let mut seen = Vec::new();
        Lattice::<Spins>::visit_edges(&ring, 0, |edge, end| {
            let ends = edge.ends.map(|site| &q[site]);
            let motions = edge.ends.map(|site| &axes[site]);
            assert_eq!(ring.forces(&system, edge, ends), system.edge_forces(1, &spacing, ends[0], ends[1]));
            let along = system.edge_forces_along(1, &spacing, ends[0], ends[1], motions[0], motions[1]);
            assert_eq!(ring.forces_along(&system, edge, ends, motions), along);
            seen.push((edge.direction, edge.ends, end));
        });
        prop_assert_eq!(seen, [(1, [1, 0], 1), (1, [0, 1], 0)]);
        let force = |a: f64| system.force_on_site(t, &turned(&q[0], &(axes[0] * a)));
        close(system.force_on_site_along(t, &q[0], &axes[0]), [size, -size].map(force));
        // Σ = 1
        prop_assert_eq!(system.momentum_of_velocity(t, &q[0], &axes[0]), axes[0]);
    }

    #[test]
    fn stable_steps_are_below_all_frequencies(all in states(6), sides in [side(), side()], spacing in [0.4_f64..2.0, 0.4..2.0]) {
        let domain = spins().grid([2, 3]).spacing(spacing).sides(sides);
        let (q, still) = (all.0, vec![Vector3::zeros(); 6]);
        prop_assert_eq!(domain.system(3).map(|site| site.stiffness), Some(0.8));
        let stable = domain.stable_step(&q).expect("a step");
        let stepper = domain.stepper(0.1).expect("a stepper");
        let state = stepper.state(q.clone(), still.clone()).expect("a state");
        prop_assert_eq!(stepper.stable_step(&state), Ok(stable));
        prop_assert_eq!(stepper.check_stable(&state).is_ok(), 0.1 <= stable);
        let suggested = stepper.suggest_step_size(&state, 1e-2, 1.0).expect("a step");
        prop_assert!(suggested <= stable);
        // (2/h)² is no less than any second difference of the energy over the squared length of the motion
        let energy = |motion: &[Vector3<f64>], a: f64| {
            let is_free = |site: usize| !stepper.lattice().is_fixed(site);
            let moved = |site: usize| if is_free(site) { turned(&q[site], &(motion[site] * a)) } else { q[site] };
            let state = stepper.state((0..6).map(moved).collect::<Vec<_>>(), still.clone()).expect("a state");
            stepper.energy(&state).expect("an energy")
        };
        let mut motion: Vec<Vector3<f64>> = all.1.iter().map(|mu| mu + Vector3::new(0.3, 0.2, -0.1)).collect();
        motion.iter_mut().enumerate().filter(|(site, _)| stepper.lattice().is_fixed(*site)).for_each(|(_, x)| x.fill(0.0));
        // the quotient of Rayleigh, which climbs to the largest frequency; velocities of momenta across q are across it
        for _ in 0..10 {
            motion.iter_mut().zip(&q).for_each(|(x, q)| *x -= q * q.dot(x));
            let length: f64 = motion.iter().map(|x| x.norm_squared()).sum::<f64>().sqrt();
            if length == 0.0 {
                break;
            }
            motion.iter_mut().for_each(|x| *x /= length);
            let squared = (energy(&motion, 1e-4) - 2.0 * energy(&motion, 0.0) + energy(&motion, -1e-4)) / 1e-8;
            prop_assert!(squared <= (2.0 / stable).powi(2) + 1e-5, "{squared} is above {}", (2.0 / stable).powi(2));
            let change = |a: f64| {
                let moved: Vec<_> = (0..6).map(|site| turned(&q[site], &(motion[site] * a))).collect();
                let mut force = vec![Vector3::zeros(); 6];
                stepper.lattice().kick((|_| stepper.system(0).expect("a site"), true), (0.0, 1.0), &moved, (0, &mut force));
                force
            };
            motion = change(-1e-4).iter().zip(change(1e-4)).map(|(before, after)| (before - after) / 2e-4).collect();
        }
    }

    #[test]
    fn residuals_are_rounding_errors(all in states(6), sides in [side(), side()], weights in prop::collection::vec(0.5_f64..2.0, 6)) {
        let spins = |stiffness: f64| FreeSpins { stiffness, exchange: 0.4 };
        let domain = spins(1.0).grid([2, 3]).sides(sides).various(|[i, j]| spins(weights[3 * i + j]));
        let stepper = domain.stepper(0.05).expect("a stepper");
        let mut state = stepper.state(all.0, all.1).expect("a state");
        let mut residuals = [[1.0; 3]; 6];
        if stepper.step_with_residuals(&mut state, &mut residuals).is_ok() {
            for residual in residuals.iter().flatten() {
                near(*residual, 0.0, 1e-14);
            }
        }
    }

    #[test]
    fn kicks_are_slopes_of_the_energy(all in states(9), spacing in [0.4_f64..2.0, 0.4..2.0], sides in [side(), side()], axis in vector::<3>(1.0)) {
        let (system, q) = (spins(), all.0);
        let grid = Grid::new([3, 3]).spacing(spacing).sides(sides);
        let mut kick = vec![Vector3::zeros(); 9];
        grid.kick((|_| &system, true), (0.0, 0.5), &q, (0, &mut kick));
        // the forces on some sites alone
        let mut some = vec![Vector3::zeros(); 4];
        grid.kick((|_| &system, true), (0.0, 0.5), &q, (3, &mut some));
        prop_assert_eq!(&some[..], &kick[3..7]);
        let stepper = system.grid([3, 3]).spacing(spacing).sides(sides).stepper(0.1).expect("a stepper");
        let whole = |q: &Vec<Vector3<f64>>| {
            let state = stepper.state(q.clone(), vec![Vector3::zeros(); 9]).expect("a state");
            stepper.energy(&state).expect("an energy")
        };
        let sites: f64 = q.iter().map(|q| system.potential(0.0, q)).sum();
        near(whole(&q), sites + grid.energy(|_| &system, &q, 0..q.len()), 1e-12);
        for site in 0..9 {
            let moved = |a: f64| {
                let mut q = q.clone();
                q[site] = turned(&q[site], &(axis * a));
                whole(&q)
            };
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            let expected = if grid.is_fixed(site) { 0.0 } else { -0.5 * slope };
            near(kick[site].dot(&axis), expected, 1e-6 * (1.0 + 100.0 * axis.norm_squared()));
            let force = grid.force(|_| &system, 0.0, &q, site).dot(&axis);
            near(force, -slope, 2e-6 * (1.0 + 100.0 * axis.norm_squared()));
            prop_assert_eq!(Lattice::<Spins>::share(&grid, site), 1.0);
        }
    }

    #[test]
    fn fields_run_back(all in states(6), sides in [side(), side()], torque in vector::<3>(1.0)) {
        let (q, mu) = all;
        let domain = spins().grid([2, 3]).sides(sides);
        let (forth, back) = (domain.clone().stepper(0.05).expect("a stepper"), domain.stepper(-0.05).expect("a stepper"));
        prop_assert_eq!((forth.step_size(), back.step_size()), (0.05, -0.05));
        let run = || -> Result<(), SiteError> {
            let start = forth.state(q.clone(), mu.clone())?;
            let mut state = start.clone();
            forth.advance(&mut state, 3)?;
            forth.step(&mut state)?;
            assert_eq!(state.steps(), 4);
            near(state.time::<f64>(), 0.2, 1e-15);
            back.advance(&mut state, 4)?;
            for (found, expected) in state.configuration().iter().zip(start.configuration()) {
                near((found - expected).amax(), 0.0, 1e-12);
            }
            for (found, expected) in state.momentum().iter().zip(start.momentum()) {
                near((found - expected).amax(), 0.0, 1e-12);
            }
            // without a torque the input changes nothing, and with one it is an impulse
            let (mut one, mut other, mut pushed) = (start.clone(), start.clone(), start.clone());
            forth.step(&mut one)?;
            forth.step_with(&mut other, &[Vector3::zeros(); 6])?;
            assert_eq!(one, other);
            forth.step_with(&mut pushed, &[torque * 1e-6; 6])?;
            let (_, momenta) = pushed.into_storage();
            for (site, (found, expected)) in momenta.iter().zip(one.momentum()).enumerate() {
                let impulse = if forth.lattice().is_fixed(site) { Vector3::zeros() } else { torque * (0.05 * 1e-6) };
                near((found - expected - impulse).amax(), 0.0, 1e-8 * (1.0 + torque.amax()));
            }
            Ok(())
        };
        match run() {
            // momenta of random sites may be too large for the step
            Err(SiteError { error: Error::Unsolvable { .. } | Error::StepTooLong { .. }, .. }) | Ok(()) => {}
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn implicit_steps_are_those_of_their_parts(
        turns in prop::collection::vec(vector::<3>(1.0), 4),
        places in prop::collection::vec(vector::<2>(1.0), 4),
        momenta in prop::collection::vec(vector::<5>(0.3), 4),
        half in vector::<5>(0.4),
        motion in vector::<5>(1.0),
        sides in side(),
        mass in 0.5_f64..2.0,
    ) {
        let (row, h) = (Row { mass, weight: 0.2 }, 0.1);
        // a motion of the midpoint by differences: the configuration Φ_G(q), and the equation
        let act = |half: &SVector<f64, 5>, q: &(Matrix3<f64>, Vector2<f64>)| row.act(&Row::half_step(half), q);
        let start = (Rotation3::new(turns[0]).into_inner(), places[0]);
        let along = |size: f64| half + Row::half_step_motion(&half, &motion) * size;
        let [(a, x), (b, y)] = [1e-6, -1e-6].map(|size| act(&along(size), &start));
        let (turn, place) = act(&half, &start);
        let turned = turn * motion.fixed_rows::<3>(0).into_owned().cross_matrix();
        near(((a - b) / 2e-6 - turned).amax(), 0.0, 1e-8);
        near(((x - y) / 2e-6 - motion.fixed_rows::<2>(3)).amax(), 0.0, 1e-8);
        near((place - places[0] - half.fixed_rows::<2>(3) * 2.0).amax(), 0.0, 1e-14);
        let equation = |half: &SVector<f64, 5>| row.midpoint_equation(h, 0.0, &Row::half_step(half), &momenta[0]);
        let (sum, slope) = equation(&half);
        let found = (equation(&along(1e-6)).0 - equation(&along(-1e-6)).0) / 2e-6;
        near((found - slope * motion).amax(), 0.0, 1e-6 * (1.0 + slope.amax()));
        let push = |half: &SVector<f64, 5>, u: f64| row.midpoint_force(h, 0.0, &act(half, &start), half, &Vector1::new(u));
        let none = push(&half, 0.0).expect("a force");
        prop_assert_eq!((none.0.amax(), none.1.amax()), (0.0, 0.0));
        let [(up, _), (down, _), (_, slope)] = [along(1e-6), along(-1e-6), half].map(|half| push(&half, 1.0).expect("a force"));
        near(((up - down) / 2e-6 - slope * motion).amax(), 0.0, 1e-6 * (1.0 + slope.amax()));
        // without forces the momentum before the step is the Legendre transform of F = G², and that after it the next one
        let step = row.act(&Row::half_step(&half), &(Row::half_step(&half).0, Vector2::zeros()));
        let step = (step.0, half.fixed_rows::<2>(3) * 4.0);
        let before = row.legendre(h, 0.0, &start, &step);
        near(row.midpoint_equation(h, 0.0, &Row::half_step(&half), &before).0.amax(), 0.0, 1e-12);
        let carried = |mu| Row::half_carried(&Row::half_step(&half), mu);
        let after = carried(&carried(&before));
        near((after - row.legendre_next(h, 0.0, &start, &step)).amax(), 0.0, 1e-12);
        prop_assert!(sum.iter().all(|entry| entry.is_finite()));
        // steps back undo steps
        let pushes = [Vector1::new(0.1); 4];
        let q: Vec<_> = turns.iter().zip(&places).map(|(turn, place)| (Rotation3::new(*turn).into_inner(), *place)).collect();
        let domain = row.grid([4]).spacing([0.5]).sides([sides]);
        let (forth, back) = (domain.clone().midpoint(h).expect("a stepper"), domain.midpoint(-h).expect("a stepper"));
        prop_assert_eq!((forth.step_size(), forth.lattice().sites()), (h, 4));
        prop_assert_eq!(forth.system(3).map(|row| row.mass), Some(mass));
        let mut state = forth.state(q.clone(), momenta.clone()).expect("a state");
        let first = (state.configuration().clone(), state.momentum().clone());
        let conserved = |state: &FieldState<_, _, _>| forth.conserved(state).map(|momenta| momenta.iter().map(|(_, value)| value).sum::<f64>());
        let before = conserved(&state).expect("momenta");
        forth.advance(&mut state, 2).expect("a step");
        forth.step(&mut state).expect("a step");
        prop_assert!((1..20).contains(&state.iterations()));
        type Saved = SavedField<Vec<(Matrix3<f64>, Vector2<f64>)>, Vec<SVector<f64, 5>>, Clock<f64>>;
        let text = serde_json::to_string(&state).expect("numbers");
        let mut resumed = forth.resume(serde_json::from_str::<Saved>(&text).expect("numbers")).expect("a state");
        let mut gone_on = state.clone();
        for state in [&mut gone_on, &mut resumed] {
            forth.step(state).expect("a step");
        }
        prop_assert_eq!(&*resumed, &*gone_on);
        let mut pushed = state.clone();
        forth.step_with(&mut pushed, &pushes).expect("a step");
        prop_assert!(pushed.momentum() != state.momentum());
        back.step_with(&mut pushed, &pushes).expect("a step");
        for (found, expected) in pushed.momentum().iter().zip(state.momentum()) {
            near((found - expected).amax(), 0.0, 1e-11);
        }
        prop_assert!(forth.energy(&state).is_ok_and(f64::is_finite));
        if !(0..4).any(|site| forth.lattice().is_fixed(site)) {
            near(conserved(&state).expect("momenta"), before, 1e-12);
        }
        back.advance(&mut state, 3).expect("a step");
        let (q, mu) = state.into_storage();
        for (i, (q, expected)) in q.iter().zip(&first.0).enumerate() {
            near((q.0 - expected.0).amax().max((q.1 - expected.1).amax()), 0.0, 1e-11);
            near((mu[i] - first.1[i]).amax(), 0.0, 1e-11);
        }
    }

    #[test]
    fn saved_fields_resume_bit_for_bit(all in states(6), sides in [side(), side()], torque in vector::<3>(1.0), steps in 0_u64..5, wrong in any::<prop::sample::Index>()) {
        let stepper = spins().grid([2, 3]).sides(sides).stepper(0.05).expect("a stepper");
        let mut state = stepper.state(all.0, all.1).expect("a state");
        if stepper.advance(&mut state, steps).is_err() {
            prop_assert!(serde_json::to_string(&state).is_err());
            return Ok(());
        }
        let text = serde_json::to_string(&state).expect("numbers");
        let read = |text: &str| serde_json::from_str::<SavedField<Vec<Vector3<f64>>, Vec<Vector3<f64>>, Clock<f64>>>(text).expect("numbers");
        let mut resumed = stepper.resume(read(&text)).expect("a state");
        prop_assert_eq!(&resumed, &state);
        let goes_on = stepper.step_with(&mut state, &[torque; 6]);
        prop_assert_eq!(stepper.step_with(&mut resumed, &[torque; 6]), goes_on);
        prop_assert_eq!(&resumed, &state);
        prop_assert_eq!(resumed.time::<f64>().to_bits(), state.time::<f64>().to_bits());
        // a file that was changed
        let site = wrong.index(6);
        let mut changed: serde_json::Value = serde_json::from_str(&text).expect("text");
        changed["configuration"][site][0] = serde_json::Value::from(3.0);
        let refused = stepper.resume(read(&changed.to_string())).map_err(|error| error.site);
        prop_assert_eq!(refused.err(), Some(Some(site)));
        let other = spins().grid([2, 2]).stepper(0.05).expect("a stepper");
        let refused = other.resume(read(&text)).map_err(|error| error.error);
        prop_assert_eq!(refused.err(), Some(Error::NumberOfSites { found: 6, sites: 4 }));
    }

    #[test]
    fn total_momenta_stay(all in states(8), weights in prop::collection::vec(0.5_f64..2.0, 8)) {
        let (q, mu) = all;
        let spins = |stiffness: f64| FreeSpins { stiffness, exchange: 0.4 };
        let stepper = spins(1.0).grid([2, 4]).periodic().various(|[i, j]| spins(weights[4 * i + j])).stepper(0.05).expect("a stepper");
        for (site, weight) in weights.iter().enumerate() {
            prop_assert_eq!(stepper.system(site).map(|site| site.stiffness), Some(*weight));
        }
        prop_assert!(stepper.system(8).is_none());
        let mut state = stepper.state(q, mu.clone()).expect("a state");
        let before = stepper.conserved(&state).expect("momenta");
        let sum: Vector3<f64> = mu.iter().sum();
        for k in 0..3 {
            near(before[k], sum[k], 1e-12);
        }
        let mut other = state.clone();
        let is_stepped = stepper.advance(&mut state, 10).is_ok();
        prop_assert_eq!(stepper.par_advance(&mut other, 10).is_ok(), is_stepped);
        if is_stepped {
            prop_assert_eq!(&other, &state);
            let after = stepper.conserved(&state).expect("momenta");
            for k in 0..3 {
                near(after[k], before[k], 1e-12);
            }
        }
        let double = |site: usize, value: &f64| Ok::<_, Error>(value * 2.0 + site as f64);
        prop_assert_eq!(Various::each(&weights, double).expect("values")[3], weights[3] * 2.0 + 3.0);
        prop_assert_eq!(Alike::each(&[weights[0]], double).expect("a value"), [weights[0] * 2.0]);
        prop_assert_eq!((Various::number(3), Alike::number(3)), (3, 0));
        prop_assert_eq!(Various::some(&weights, [3, 1].into_iter()), [weights[3], weights[1]]);
        prop_assert_eq!(Alike::some(&[weights[0]], [3, 1].into_iter()), [weights[0]]);
    }

    #[test]
    fn slabs_have_the_edges_of_the_grid(
        all in states(12), sides in [side(), side()], rows in 1_usize..5, cut in [any::<prop::sample::Index>(), any::<prop::sample::Index>()],
    ) {
        let sizes = [rows, 3];
        let (cut, sites) = (cut.map(|cut| cut.index(rows)), 3 * rows);
        let rows = cut[0].min(cut[1])..cut[0].max(cut[1]) + 1;
        let domain = spins().grid(sizes).sides(sides);
        let part = domain.slab(rows.clone()).expect("a slab");
        let slab = part.lattice();
        prop_assert_eq!((slab.grid(), slab.rows()), (domain.lattice(), rows.clone()));
        prop_assert_eq!((Lattice::<Spins>::own(slab), Lattice::<Spins>::row_length(slab)), (slab.own(), 3));
        let number = |site: usize| domain.lattice().index(slab.place(site).expect("a place")).expect("a site");
        prop_assert_eq!(slab.own().map(number).collect::<Vec<_>>(), (3 * rows.start..3 * rows.end).collect::<Vec<_>>());
        prop_assert_eq!(slab.place(slab.sites()), None);
        // rows in the order of the grid, each once
        let numbers: Vec<usize> = (0..slab.sites()).map(number).collect();
        prop_assert!(numbers.is_sorted_by(|a, b| a < b));
        for row in 0..sizes[0] + 1 {
            let expected = (0..slab.sites()).find(|site| numbers[*site] == 3 * row).map(|site| site..site + 3);
            prop_assert_eq!(slab.row(row), expected);
        }
        let mut there: Vec<usize> = slab.rows().chain(slab.rows_before()).chain(slab.rows_after()).collect();
        there.sort_unstable();
        there.dedup();
        prop_assert_eq!(there.len() * 3, slab.sites());
        // the edges at each site that is moved here, in the same order from the lower rows on
        for site in slab.own() {
            let (mut here, mut expected) = (Vec::new(), Vec::new());
            Lattice::<Spins>::visit_edges(slab, site, |edge, end| here.push((edge.ends.map(number), end)));
            Lattice::<Spins>::visit_edges(domain.lattice(), number(site), |edge, end| expected.push((edge.ends, end)));
            prop_assert_eq!(here, expected);
        }
        for site in 0..slab.sites() {
            let moves = slab.own().contains(&site) && !domain.lattice().is_fixed(number(site));
            prop_assert_eq!(Lattice::<Spins>::is_fixed(slab, site), !moves);
        }
        // sums, row by row
        let (q, mu) = (&all.0[..sites], &all.1[..sites]);
        let here = |values: &[Vector3<f64>]| numbers.iter().map(|site| values[*site]).collect::<Vec<_>>();
        let springs = FreeSpins { stiffness: 0.9, exchange: 0.4 }.grid(sizes).sides(sides);
        let stepper = springs.clone().stepper(0.05).expect("a stepper");
        let state = stepper.state(q.to_vec(), mu.to_vec()).expect("a state");
        let (mut energies, mut momenta) = (Vec::new(), Vec::new());
        for rows in [0..rows.start, rows.clone(), rows.end..sizes[0]].into_iter().filter(|rows| !rows.is_empty()) {
            let part = springs.slab(rows).expect("a slab").various(|_| FreeSpins { stiffness: 0.9, exchange: 0.4 });
            let numbers: Vec<usize> = (0..part.lattice().sites()).map(|site| domain.lattice().index(part.lattice().place(site).expect("a place")).expect("a site")).collect();
            let stepper = part.stepper(0.05).expect("a stepper");
            let (q, mu): (Vec<_>, Vec<_>) = numbers.iter().map(|site| (q[*site], mu[*site])).unzip();
            let state = stepper.state(q, mu).expect("a state");
            energies.extend(stepper.energy_of_rows(&state).expect("energies"));
            momenta.extend(stepper.conserved_of_rows(&state).expect("momenta"));
        }
        prop_assert_eq!(stepper.total(energies), stepper.energy(&state).expect("an energy"));
        let expected = stepper.conserved(&state).expect("momenta");
        for k in 0..3 {
            prop_assert_eq!(stepper.total(momenta.iter().map(|momenta| momenta[k])), expected[k]);
        }
        // a slab whose neighbours do not move
        let stepper = part.stepper(0.02).expect("a stepper");
        let (mut alone, mut told) = (stepper.state(here(q), here(mu)).expect("a state"), stepper.state(here(q), here(mu)).expect("a state"));
        let mut calls = 0;
        let results = [stepper.advance(&mut alone, 2), stepper.advance_exchanging(&mut told, 2, |_, result| { calls += 1; result })];
        prop_assert_eq!(&results[0], &results[1]);
        if results[0].is_ok() {
            prop_assert_eq!((&alone, calls), (&told, 2));
        }
        let stop = SiteError { site: Some(1), error: Error::NotFinite { name: "a row" } };
        let mut stopped = stepper.state(here(q), here(mu)).expect("a state");
        prop_assert_eq!(stepper.advance_exchanging(&mut stopped, 2, |_, _| Err(stop)), Err(stop));
        prop_assert_eq!(stepper.advance(&mut stopped, 1), Err(stop));
    }
}
