//! Group laws, one line per group, at the identity, very near it and at random: the assumptions of the derivation about
//! a group.

use clebsch::Clebsch;
use clebsch_symbolic::{Block, Expr, Graph, Group, Matrix, Property, Role, Shape};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, skew};
use nalgebra::{SMatrix, SVector};

const H: f64 = 0.1;

/// Sums of a few dozen products of numbers of order one, divided by h: some 1e-15 each.
const NEAR: f64 = 1e-12;

/// Sizes of group elements: the identity, where only 1e-9 is left of them, and far from it.
const SIZES: [f64; 4] = [0.0, 1e-9, 0.3, 3.0];

macro_rules! rotations {
    ($module:ident: SO<$n:tt>, $m:literal) => {
        mod $module {
            use super::*;

            /// Acting on itself from the right, with an inertia that singles out axes: no closed form.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                                action = |F: SO<$n>, R: SO<$n>| R * F,
                                cost   = |h, F| (self.weights * (F - I) * (F - I).transpose()).trace() / (2 * h),
                            )]
            pub struct Right {
                #[clebsch(symmetric)]
                pub weights: SMatrix<f64, $n, $n>,
            }

            /// Acting on itself from the left, with the bi-invariant inertia.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(action = |F: SO<$n>, R: SO<$n>| F * R, cost = |h, F| (F - I).norm_squared() / (4 * h))]
            pub struct Left;

            #[test]
            fn laws() {
                let mut random = Random::new(70 + $n);
                rotation_laws::<Right, $n, $m>(|random| Right { weights: random.inertia() }, true, &mut random);
                rotation_laws::<Left, $n, $m>(|_| Left, false, &mut random);
            }
        }
    };
}

rotations!(so2: SO<2>, 1);
rotations!(so3: SO<3>, 3);
rotations!(so4: SO<4>, 6);
rotations!(so5: SO<5>, 10);

fn rotation_laws<S, const N: usize, const M: usize>(system: impl Fn(&mut Random) -> S, right: bool, random: &mut Random)
where
    S: Clebsch<
            Scalar = f64,
            Time = (),
            Configuration = SMatrix<f64, N, N>,
            Element = SMatrix<f64, N, N>,
            Momentum = SVector<f64, M>,
            MomentumMatrix = SMatrix<f64, N, N>,
        > + Clone,
{
    for size in SIZES.into_iter().flat_map(|size| [size; 20]) {
        let system = system(random);
        let (f, g) = (random.rotation::<N>(size), random.rotation::<N>(size));
        let (q, p) = (random.attitude::<N>(), random.matrix::<N, N>());
        let mu: SVector<f64, M> = random.vector();

        // the action and its side
        let product = if right { g * f } else { f * g };
        assert_near(&system.act(&f, &system.act(&g, &q)), &system.act(&product, &q), NEAR, "Φ_FΦ_G");
        assert_near(&system.act(&f.transpose(), &system.act(&f, &q)), &q, NEAR, "Φ_F⁻¹Φ_F");
        assert_near(&system.act(&SMatrix::identity(), &q), &q, 0.0, "Φ_I");

        // Ad* is an action of the opposite group, with no inverse inside
        let twice = system.coadjoint(&g, &system.coadjoint(&f, &mu));
        assert_near(&system.coadjoint(&(f * g), &mu), &twice, NEAR, "Ad*_FG = Ad*_G Ad*_F");
        assert_near(&system.coadjoint(&f.transpose(), &system.coadjoint(&f, &mu)), &mu, NEAR, "Ad*_F⁻¹Ad*_F");

        // J is equivariant under the cotangent lift, p ↦ pF^{-T} or F^{-T}p
        let (moved, lifted) = (system.act(&f, &q), system.act(&f, &p));
        let expected = if right { f } else { f.transpose() };
        let momentum = system.coadjoint(&expected, &system.momentum_map(&q, &p));
        assert_near(&system.momentum_map(&moved, &lifted), &momentum, NEAR, "J∘T*Φ = Ad*∘J");

        // the representing matrix, its components, and the pairing ⟨M, ξ⟩ = Σ m_i ξ_i
        let matrix = S::momentum_matrix(&mu);
        assert_near(&matrix, &(skew::<N, M>(&mu) / 2.0), NEAR, "M = ½ Σ m_i E_i");
        assert_near(&S::momentum_components(&matrix), &mu, NEAR, "m_i = ⟨M, E_i⟩");
        assert_near(&components::<N, M>(&matrix), &mu, NEAR, "m_i = ⟨M, E_i⟩ by hand");
        let xi: SVector<f64, M> = random.vector();
        assert!((matrix.dot(&skew::<N, M>(&xi)) - mu.dot(&xi)).abs() < NEAR, "⟨M, ξ⟩ = Σ m_i ξ_i");

        // without a potential both Legendre transforms are related by Ad*, and the near ones are inverted by the step's solve
        let stepper = system.stepper(H).expect("a regular system");
        let before = stepper.legendre(&q, &f);
        let carried = stepper.coadjoint(&if right { f } else { f.transpose() }, &before);
        assert_near(&stepper.legendre_next(&q, &f), &carried, 10.0 * NEAR, "F⁺ℓd = Ad* F⁻ℓd");
        if size < 1.0 {
            let found = stepper.inverse_legendre(&q, &before).expect("a solvable equation");
            assert_near(&found, &f, NEAR, "(F⁻ℓd)⁻¹");
            // relative to the momentum: entries of F are rounded to 1e-16, so at F − I = 1e-9 a matrix F knows it to 1e-7/h
            assert_near(&(stepper.legendre(&q, &found) / size.max(1e-300)), &(before / size.max(1e-300)), 1e-5, "F⁻ℓd");
        }
    }
}

/// Addition in R³, the same laws.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |a: Translation<3>, x: Vector3| x + a, cost = |h, a| a.dot(&(self.mass * a)) / (2 * h))]
pub struct Translations {
    #[clebsch(symmetric)]
    pub mass: SMatrix<f64, 3, 3>,
}

#[test]
fn translations() {
    let mut random = Random::new(80);
    for size in SIZES.into_iter().flat_map(|size| [size; 20]) {
        let system = Translations { mass: random.inertia() };
        let (a, b) = (random.vector::<3>() * size, random.vector::<3>() * size);
        let (x, p) = (random.vector::<3>(), random.vector::<3>());
        assert_near(&system.act(&a, &system.act(&b, &x)), &system.act(&(a + b), &x), NEAR, "Φ_aΦ_b");
        assert_near(&system.act(&-a, &system.act(&a, &x)), &x, NEAR, "Φ_−aΦ_a");
        assert_near(&system.coadjoint(&a, &p), &p, 0.0, "Ad*");
        assert_near(&system.momentum_map(&system.act(&a, &x), &p), &p, 0.0, "J");
        assert_near(&Translations::momentum_components(&Translations::momentum_matrix(&p)), &p, 0.0, "components");
        let stepper = system.stepper(H).expect("a regular mass");
        let momentum = stepper.legendre(&x, &a);
        assert_near(&stepper.legendre_next(&x, &a), &momentum, NEAR, "F⁺ℓd = F⁻ℓd");
        assert_near(&stepper.inverse_legendre(&x, &momentum).expect("a solvable equation"), &a, NEAR, "(F⁻ℓd)⁻¹");
    }
}

/// The chart as the compiler has it, evaluated: in the group, I at 0, its increment without cancellation, its slope.
fn chart_laws<'g>(graph: &'g Graph, group: Group, random: &mut Random) {
    let chart = group.chart(graph);
    let blocks = graph.blocks(group);
    let symbol = |(k, block): (usize, &Block)| {
        let shape = Shape::vector(block.algebra.dimension);
        graph.symbol(&format!("x{k}"), shape, Role::Chart(k), Property::General)
    };
    let x: Vec<Expr<'g>> = blocks.iter().enumerate().map(symbol).collect();
    let element = chart.element(group, &x);
    let increment = chart.increment(group, &x);
    let product = group.compose(group.inverse(element), element);
    // x = slope · ξ for F = exp ξ, so that F − I = ξ + O(ξ²) with ξ = x/slope
    let tangent = blocks.iter().zip(&x).fold(graph.zero(group.element_shape()), |sum, (block, x)| {
        let (slope, per) = chart.slope_at_identity(block);
        let part = (*x * graph.integer(per) / graph.integer(slope)).wedge(block.algebra);
        sum + part.embed(group.element_shape(), block.row, block.column)
    });
    for size in SIZES.into_iter().flat_map(|size| [size; 5]) {
        // not far beyond where a chart of a group that is not compact ends
        let size = if group.is_orthogonal() { size } else { size.min(0.3) };
        let values: Vec<Vec<f64>> =
            x.iter().map(|x| (0..x.shape().rows).map(|_| size * random.number()).collect()).collect();
        let at = |expr: Expr<'g>| -> Matrix<f64> {
            expr.evaluate(&mut |symbol| {
                let block = x.iter().position(|x| *x == symbol).expect("a coordinate");
                Matrix::new(symbol.shape(), values[block].clone())
            })
        };
        let identity = graph.constant_value(group.identity(graph));
        assert_close(&at(product).entries, &identity.entries, NEAR, "F⁻¹F = I");
        for equation in group.equations(element) {
            assert_close(&at(equation).entries, &vec![0.0; equation.shape().len()], NEAR, "the group's equations");
        }
        let difference: Vec<f64> = at(element).entries.iter().zip(&identity.entries).map(|(f, i)| f - i).collect();
        let expected = match group {
            Group::Translation(_) => values.concat(),
            _ => difference,
        };
        assert_close(&at(increment).entries, &expected, NEAR, "F − I");
        if size <= 1e-9 && has_stable_increment(group) {
            assert_close(&at(increment).entries, &at(tangent).entries, 1e-16, "F − I = ξ + …");
        }
    }
}

/// Whether F − I is known to the last digit near the identity. It is where the chart is not exp or a root, in which F
/// is computed first.
fn has_stable_increment(group: Group) -> bool {
    !matches!(group, Group::SpecialLinear(3..) | Group::SpecialUnitary(_) | Group::Similarity(_))
}

macro_rules! charts {
    ($($name:ident: $group:expr,)*) => {
        $(#[test]
        fn $name() {
            let graph = Graph::new();
            chart_laws(&graph, $group, &mut Random::new(81));
        })*
    };
}

charts! {
    chart_of_so2: Group::SpecialOrthogonal(2),
    chart_of_so3: Group::SpecialOrthogonal(3),
    chart_of_so4: Group::SpecialOrthogonal(4),
    chart_of_so5: Group::SpecialOrthogonal(5),
    chart_of_so12: Group::PseudoOrthogonal(1, 2),
    chart_of_so13: Group::PseudoOrthogonal(1, 3),
    chart_of_se2: Group::SpecialEuclidean(2),
    chart_of_se3: Group::SpecialEuclidean(3),
    chart_of_translation3: Group::Translation(3),
    chart_of_gl2: Group::GeneralLinear(2),
    chart_of_gl3: Group::GeneralLinear(3),
    chart_of_sl2: Group::SpecialLinear(2),
    chart_of_sl3: Group::SpecialLinear(3),
    chart_of_sp2: Group::Symplectic(2),
    chart_of_sp4: Group::Symplectic(4),
    chart_of_u1: Group::Unitary(1),
    chart_of_u2: Group::Unitary(2),
    chart_of_su3: Group::SpecialUnitary(3),
    chart_of_unit_quaternions: Group::UnitQuaternions,
    chart_of_heisenberg1: Group::Heisenberg(1),
    chart_of_heisenberg2: Group::Heisenberg(2),
    chart_of_aff1: Group::Affine(1),
    chart_of_aff2: Group::Affine(2),
    chart_of_sim2: Group::Similarity(2),
    chart_of_sim3: Group::Similarity(3),
}

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let far = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(far <= tolerance && found.len() == expected.len(), "{what}: {far:.1e} apart");
}
