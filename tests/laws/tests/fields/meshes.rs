//! Meshes: against grids, against spheres in closed form, and the mistakes in them.

use clebsch::{Clebsch, Error, Field, Mesh, SiteError};
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Vector1, Vector2, Vector3};

/// The waves of `WaveMap` at the edges of a mesh.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |length, q, next| (next - q).norm_squared() / (2 * length.powi(2)),
)]
struct Waves;

/// A membrane, its height x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| self.mass * a.norm_squared() / (2 * h),
    space  = |length, x, next| (next - x).norm_squared() / 2,
)]
struct Membrane {
    mass: f64,
}

/// A film at rest, its height x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    space  = |length, x, next| (next - x).norm_squared() / 2,
)]
struct Film;

/// Rotations, each tied to its neighbours by the element between them, with a direction of its own for the edge.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |length, W| (W.cayley() - length * self.twist).norm_squared() / 2,
)]
struct Twisted {
    twist: Vector3<f64>,
}

/// The faces of a torus of n × m sites: one square at each.
fn torus(n: usize, m: usize) -> Vec<[usize; 4]> {
    let site = |i: usize, j: usize| (i % n) * m + j % m;
    let square = |i: usize, j: usize| [site(i, j), site(i + 1, j), site(i + 1, j + 1), site(i, j + 1)];
    (0..n).flat_map(|i| (0..m).map(move |j| square(i, j))).collect()
}

/// A grid that is periodic and a mesh of its squares are the same. Edges have the length 1 in more dimensions than three.
#[test]
fn a_torus_of_squares_is_a_periodic_grid() -> Result<(), SiteError> {
    let (n, m, h) = (6, 5, 0.3);
    let circle = |i: usize, n: usize| {
        let (angle, radius) =
            (std::f64::consts::TAU / n as f64 * i as f64, 0.5 / (std::f64::consts::PI / n as f64).sin());
        Vector2::new(angle.cos(), angle.sin()) * radius
    };
    let place = |site: usize| {
        let (a, b) = (circle(site / m, n), circle(site % m, m));
        nalgebra::Vector4::new(a.x, a.y, b.x, b.y)
    };
    let vertices: Vec<_> = (0..n * m).map(place).collect();
    let mesh = Waves.mesh(&vertices, &torus(n, m))?.stepper(h)?;
    assert_eq!((mesh.lattice().sites(), mesh.lattice().edges().count(), mesh.lattice().faces().count()), (30, 60, 30));
    let grid = WaveMap.grid([n, m]).periodic().stepper(h)?;
    let q: Vec<_> =
        (0..n * m).map(|i| Vector3::new((0.7 * i as f64).sin(), (0.4 * i as f64).cos(), 1.0).normalize()).collect();
    let mu: Vec<_> = q.iter().enumerate().map(|(i, q)| q.cross(&Vector3::new(0.1, (i as f64).sin(), 0.0))).collect();
    let (mut a, mut b) = (mesh.state(q.clone(), mu.clone())?, grid.state(q, mu)?);
    assert!((mesh.energy(&a)? - grid.energy(&b)?).abs() < 1e-12);
    assert!((mesh.stable_step(&a)? - grid.stable_step(&b)?).abs() < 1e-12);
    mesh.advance(&mut a, 50)?;
    grid.advance(&mut b, 50)?;
    let farthest = a.configuration().iter().zip(b.configuration()).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    assert!(farthest < 1e-11, "{farthest}");
    let mut residuals = [[1.0; 3]; 30];
    mesh.step_with_residuals(&mut a, &mut residuals)?;
    assert!(residuals.iter().flatten().all(|residual| residual.abs() < 1e-13));
    Ok(())
}

/// Forces are slopes of the energy, with weights, parameters of each site, and edges by their element.
#[test]
fn kicks_are_slopes_of_the_energy() -> Result<(), SiteError> {
    let vertices = [(0.0, 0.0), (1.0, 0.1), (1.2, 0.9), (0.1, 1.1), (0.5, 0.4)].map(|(x, y)| Vector2::new(x, y));
    let faces = [vec![0, 1, 4], vec![1, 2, 3, 4], vec![3, 0, 4]];
    let twist = |site: usize| Twisted { twist: Vector3::new(0.1 * site as f64, 0.2, -0.3) };
    let domain = twist(0).mesh(&vertices, &faces)?.weights(|[a, b]| 1.0 + (a * b) as f64).various(twist);
    let h = 1e-3;
    let stepper = domain.stepper(h)?;
    let turn = |axis: Vector3<f64>| nalgebra::Rotation3::new(axis).into_inner();
    let q: Vec<_> = (0..5).map(|i| turn(Vector3::new(0.3 * i as f64, -0.2, 0.1 * (i * i) as f64))).collect();
    let still = vec![Vector3::zeros(); 5];
    let energy = |q: &[nalgebra::Matrix3<f64>]| -> Result<f64, SiteError> {
        stepper.energy(&stepper.state(q.to_vec(), still.clone())?)
    };
    // half a kick: a step back and forth of sites at rest is not needed, the state after it tells
    let mut pushed = stepper.state(q.clone(), still.clone())?;
    stepper.step(&mut pushed)?;
    for site in 0..5 {
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let moved = |a: f64| {
                let mut q = q.clone();
                q[site] *= turn(axis * a);
                energy(&q)
            };
            let slope = (moved(1e-5)? - moved(-1e-5)?) / 2e-5;
            // the forces change by O(h²) during the step
            let force = pushed.momentum()[site].dot(&axis) / h;
            assert!((force + slope).abs() < 1e-3 * (1.0 + slope.abs()), "site {site}: {force} and {slope}");
        }
    }
    Ok(())
}

/// The octahedron with each triangle divided so many times, on the unit sphere.
fn sphere(times: usize) -> (Vec<Vector3<f64>>, Vec<[usize; 3]>) {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let mut vertices = vec![x, y, z, -x, -y, -z];
    let mut faces = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..times {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                vertices.push((vertices[a] + vertices[b]).normalize());
                vertices.len() - 1
            })
        };
        let divided = faces.iter().flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        });
        faces = divided.collect();
    }
    (vertices, faces)
}

/// Waves on a sphere with linear finite elements: a spherical harmonic of degree l turns with ω² = l(l + 1), to second order.
#[test]
fn waves_on_a_sphere_have_the_frequencies_of_harmonics() -> Result<(), SiteError> {
    let mut errors = Vec::new();
    // the finest sphere with the feature `heavy` alone; on the one before the error is four times as large
    let (finest, most) = if cfg!(feature = "heavy") { (4, 0.01) } else { (3, 0.04) };
    for times in 2..=finest {
        let (vertices, faces) = sphere(times);
        let domain = Membrane { mass: 1.0 }.mesh(&vertices, &faces)?.cotangent_weights()?;
        let areas: Vec<f64> = (0..vertices.len()).map(|site| domain.lattice().area(site)).collect();
        assert!((0..vertices.len()).all(|site| !domain.lattice().is_border(site)));
        let domain = domain.various(|site| Membrane { mass: areas[site] });
        // the harmonic xy, of degree 2
        let shape: Vec<_> = vertices.iter().map(|v| Vector1::new(v.x * v.y)).collect();
        let h = 0.05 * domain.stable_step(&shape)?;
        let steps = (1.0 / h).round() as u64;
        let stepper = domain.stepper(1.0 / steps as f64)?;
        let mut state = stepper.state(shape.clone(), vec![Vector1::new(0.0); vertices.len()])?;
        stepper.advance(&mut state, steps)?;
        // the part along the harmonic is cos ωt
        let product = |x: &[Vector1<f64>]| -> f64 {
            x.iter().zip(&shape).zip(&areas).map(|((x, shape), area)| x.x * shape.x * area).sum()
        };
        let part = product(state.configuration()) / product(&shape);
        errors.push((part.acos() - 6.0_f64.sqrt()).abs());
    }
    assert!(errors[errors.len() - 1] < most, "{errors:?}");
    let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.3), "{orders:?} of {errors:?}");
    Ok(())
}

/// Linear functions are at rest with cotangent weights, whatever the triangles are.
#[test]
fn linear_functions_rest_on_triangles() -> Result<(), SiteError> {
    let inner = [(0.3, 0.2), (0.8, 0.3), (0.7, 0.8), (0.25, 0.6)].map(|(x, y)| Vector2::new(x, y));
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
    let vertices = [corners, inner].concat();
    let faces =
        [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 6, 5], [2, 3, 6], [3, 7, 6], [3, 0, 7], [0, 4, 7], [4, 5, 6], [4, 6, 7]];
    let film = Film.mesh(&vertices, &faces)?.cotangent_weights()?.fixed();
    assert!((0..8).all(|site| film.lattice().is_border(site) == (site < 4)));
    let height = |site: usize| 2.0 * vertices[site].x - 0.5 * vertices[site].y;
    let mut x: Vec<_> = (0..8).map(|site| Vector1::new(if site < 4 { height(site) } else { 7.0 })).collect();
    let found = film.relax().tolerance(1e-14).solve(&mut x)?;
    assert!((0..8).all(|site| (x[site].x - height(site)).abs() < 1e-12), "{x:?}");
    // ½|∇x|² times the area
    assert!((found.energy() - 0.5 * (4.0 + 0.25)).abs() < 1e-12, "{}", found.energy());
    let total: f64 = (0..8).map(|site| film.lattice().area(site)).sum();
    assert!((total - 1.0).abs() < 1e-15);
    Ok(())
}

#[test]
fn wrong_meshes_are_named() {
    let vertices = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)].map(|(x, y)| Vector2::new(x, y));
    let made = |faces: &[Vec<usize>]| Mesh::new(&vertices, faces).map(|_| ());
    assert_eq!(made(&[vec![0, 1, 2], vec![0, 2, 3]]), Ok(()));
    assert_eq!(made(&[vec![0, 1, 2], vec![0, 3, 2]]), Err(Error::FlippedFace { face: 1, from: 2, to: 0 }));
    assert_eq!(
        made(&[vec![0, 1, 2], vec![0, 2, 3], vec![1, 2, 3]]),
        Err(Error::FlippedFace { face: 2, from: 1, to: 2 })
    );
    assert_eq!(
        made(&[vec![0, 1, 2], vec![0, 2, 3], vec![2, 0, 4]]),
        Err(Error::FlippedFace { face: 2, from: 2, to: 0 })
    );
    assert_eq!(made(&[vec![0, 1, 5]]), Err(Error::FaceCorner { face: 0, vertex: 5, vertices: 5 }));
    assert_eq!(made(&[vec![0, 1, 2], vec![2, 3]]), Err(Error::FaceSize { face: 1, corners: 2 }));
    assert_eq!(made(&[vec![0, 1, 2, 1]]), Err(Error::FaceSize { face: 0, corners: 3 }));
    assert_eq!(made(&[vec![0, 1, 4]]), Err(Error::EdgeLength { from: 4, to: 0, value: 0.0 }));
    let square = Membrane { mass: 1.0 }.mesh(&vertices[..4], &[[0, 1, 2, 3]]).expect("a square");
    let refused = square.clone().cotangent_weights().map(|_| ());
    assert_eq!(refused, Err(Error::FaceSize { face: 0, corners: 4 }));
    assert_eq!(square.lattice().weight([0, 2]), Err(Error::NoEdge { from: 0, to: 2 }));
    let refused = square.weights(|ends| if ends == [2, 3] { f64::INFINITY } else { 1.0 }).stepper(0.1).map(|_| ());
    assert_eq!(refused, Err(Error::EdgeWeight { from: 2, to: 3, value: f64::INFINITY }));
    let empty = Membrane { mass: 1.0 }.mesh(&vertices[..0], &[[0; 3]; 0]).expect("no vertices");
    assert_eq!(empty.stepper(0.1).map(|_| ()), Err(Error::EmptyGrid { direction: 0, sites: 0 }));
}
