//! Charts: coordinates of a group near the identity, one vector for each block of its Lie algebra.

use super::motion::{blocks, left_matrix, motion};
use super::{Block, Group};
use crate::memory::Map;
use crate::node::{Analytic, ExprNode, Operation};
use crate::{
    Algebra, Elements, Expr, Function, Graph, IntoElements, IntoList, Shape, both, identity, indexed, rational,
};

/// Coordinates of a group near the identity: F as a function of x, with F = I at x = 0.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Chart {
    /// F = (I − Z)⁻¹(I + Z), Z = Σ x_i E_i, so that Z ≈ ½ log F. For SO(3) and SU(2), x = tan(θ/2)·axis.
    Cayley,
    /// F = I + Z, for algebras that are closed under matrix products. Coordinates of the second kind of the Heisenberg group.
    Affine,
    /// (W b; 0 1) with W = (I − Z)⁻¹(I + Z), times exp λ for similarities, and b as it is.
    Product,
    /// F = (I + Z) det(I + Z)^(−1/n).
    Root,
    /// F = I + Z + Z²/(1 + √(1 − |x|²)) for rotations in one plane: x = sin θ·axis, so that Z = ½(F − Fᵀ). Up to a quarter turn.
    Sine,
    /// F = exp Z.
    Exponential,
    /// F = x.
    Identity,
}

impl Group {
    /// The chart in which the implicit equation is solved, unless a declaration chooses another.
    pub fn chart(self, graph: &Graph) -> Chart {
        match self {
            Group::Declared(declared) => graph.definition(declared).chart,
            _ => self.row().chart,
        }
    }

    /// Whether the Cayley map stays in the group.
    pub fn has_cayley_chart(self, graph: &Graph) -> bool {
        match self {
            Group::Translation(_) => false,
            Group::UnitQuaternions | Group::SpecialOrthogonal(_) => true,
            _ => super::sample::is_cayley_tangent(graph, self),
        }
    }
}

impl Chart {
    /// The element with coordinates x, one vector for each block.
    pub fn element<'g>(self, group: Group, x: &[Expr<'g>]) -> Expr<'g> {
        let graph = x[0].graph();
        match self {
            Chart::Identity => x[0],
            Chart::Cayley if group == Group::UnitQuaternions => {
                let scale = (graph.integer(1) + x[0].norm_squared()).power(rational(-1, 2));
                quaternion(scale * x[0], scale)
            }
            // (I − Z)⁻¹(I + Z) = 2(I − Z)⁻¹ − I
            Chart::Cayley => 2 * resolvent(combination(group, x)) - group.identity(graph),
            Chart::Sine => group.identity(graph) + self.increment(group, x),
            Chart::Affine => group.identity(graph) + combination(group, x),
            Chart::Root => {
                let n = group.element_shape().rows;
                let z = combination(group, x);
                let scale = (graph.identity(n) + z).determinant().power(rational(-1, n as i64));
                scale * graph.identity(n) + z.times_each(scale)
            }
            Chart::Product => {
                let turn = 2 * resolvent(x[0].wedge(graph.algebra_of(group)));
                let turn = turn - graph.identity(turn.shape().rows);
                match x {
                    [_, dilation, shift] => motion(dilation.function(Function::Exp) * turn, *shift),
                    _ => motion(turn, x[x.len() - 1]),
                }
            }
            Chart::Exponential if group == Group::UnitQuaternions => {
                let quarter = x[0].norm_squared() / 4;
                let [cosine, sine] = both([0, 1], |k| quarter.function(Function::Stumpff(k)));
                quaternion(sine / 2 * x[0], cosine)
            }
            Chart::Exponential => exponential(combination(group, x)),
        }
    }

    /// F − I (F itself for translations), in a form without cancellation. For rotations with n ≤ 3 it is sZ + sZ² with
    /// s = 2/(1 + |x|²). For n = 4 it is 2(Z + Z² + pZ̃ − p²I)/(1 + s + p²) with s = |x|², the Pfaffian p of Z and its
    /// dual Z̃. Other Cayley charts have 2(I − Z)⁻¹Z, and exponentials have Zφ(Z).
    pub fn increment<'g>(self, group: Group, x: &[Expr<'g>]) -> Expr<'g> {
        let graph = x[0].graph();
        let one = graph.integer(1);
        let turned = |n: usize| turn_increment(n, x[0], x[0].wedge(graph.algebra_of(group)));
        match (self, group) {
            (Chart::Cayley, Group::SpecialOrthogonal(n)) => turn_increment(n, x[0], combination(group, x)),
            (Chart::Cayley, Group::UnitQuaternions) => {
                // w − 1 = −s/(r(1 + r)) with r = √(1 + s)
                let square = x[0].norm_squared();
                let root = (one + square).sqrt();
                quaternion(x[0], -(square / (one + root))) / root
            }
            (Chart::Cayley, Group::SpecialEuclidean(n)) => {
                blocks(turned(n), 2 * (resolvent(x[0].wedge(graph.algebra_of(group))) * x[1]))
            }
            (Chart::Cayley, _) => even_increment(combination(group, x)),
            (Chart::Affine, _) => combination(group, x),
            (Chart::Sine, _) => {
                let z = combination(group, x);
                z + (z * z) / (one + cosine(x[0]))
            }
            (Chart::Root, _) => {
                // r − 1 = (rⁿ − 1)/(1 + r + … + rⁿ⁻¹) with rⁿ = det(I + Z)
                let z = combination(group, x);
                let n = z.shape().rows;
                let excess = determinant_excess(z);
                let root = (one + excess).power(rational(1, n as i64));
                let sum = (1..n).fold(one, |sum, power| sum + root.powi(power as i32));
                (z - (excess / sum) * group.identity(graph)) / root
            }
            (Chart::Product, Group::SpecialEuclidean(n)) => blocks(turned(n), x[1]),
            (Chart::Product, Group::Similarity(n)) => {
                // eᵈ(I + T) − I = g(I + T) + T with g = eᵈ − 1 = 2 sinh(d/2) e^{d/2}
                let turn = turned(n);
                let half = x[1] / 2;
                let growth = 2 * half.function(Function::Sinh) * half.function(Function::Exp);
                blocks(growth * (graph.identity(n) + turn) + turn, x[2])
            }
            (Chart::Identity, _) => x[0],
            (Chart::Exponential, Group::UnitQuaternions) => {
                // cos − 1 = −s c₂(s)
                let quarter = x[0].norm_squared() / 4;
                let [sine, versine] = both([1, 2], |k| quarter.function(Function::Stumpff(k)));
                quaternion(sine / 2 * x[0], -(quarter * versine))
            }
            (Chart::Exponential, _) => {
                let z = combination(group, x);
                let element = exponential(z);
                match (&*element.node(), in_one_plane(z)) {
                    (ExprNode::Of(Operation::Analytic(Analytic::Exponential), inner), _) => {
                        let z = graph.expr(*inner);
                        z * z.analytic(Analytic::Phi)
                    }
                    (_, Some(s)) => {
                        let [sine, versine] = both([1, 2], |k| s.function(Function::Stumpff(k)));
                        sine * z - s * versine * group.identity(graph)
                    }
                    _ => element - group.identity(graph),
                }
            }
            _ => self.element(group, x) - group.identity(graph),
        }
    }

    /// D and c of the increment F − I = c·D of a rotation in space with the Gibbs vector x/w: wZ + Z² and 2/(w² + |x|²).
    pub fn scaled_increment<'g>(x: Expr<'g>, w: Expr<'g>) -> [Expr<'g>; 2] {
        let z = Group::SpecialOrthogonal(3).wedge(x);
        [w * z + z * z, x.graph().integer(1) / ((w * w + x.norm_squared()) / 2)]
    }

    /// α and β of F = I + αZ + βZ², in charts of rotations where F has this form.
    pub fn in_one_plane<'g>(self, x: &[Expr<'g>]) -> Option<(Expr<'g>, Expr<'g>)> {
        let one = x[0].graph().integer(1);
        (self == Chart::Sine).then(|| (one, one / (one + cosine(x[0]))))
    }

    /// The matrices A and C by which ρ ↦ A ρ C frees the momentum equation of a Cayley chart of denominators.
    /// Components of the product vanish where those of ρ do. For rotations acting from the right, the residual has F on
    /// the left or Fᵀ on the right. The map is then (I − Z) ρ (I − Z)ᵀ. For left actions the signs change. Other groups
    /// are alike, with Zᵀ in place of −Z.
    pub fn clearing<'g>(self, group: Group, x: &[Expr<'g>], left_action: bool) -> Option<(Expr<'g>, Expr<'g>)> {
        if self != Chart::Cayley || group == Group::UnitQuaternions {
            return None;
        }
        let z = combination(group, x);
        let identity = group.identity(z.graph());
        let (plus, minus) = (identity + z.transpose(), identity - z.transpose());
        Some(if left_action { (minus, plus) } else { (plus, minus) })
    }

    /// dx/dξ at the identity, for F = exp ξ, in a block.
    pub fn slope_at_identity(self, block: &Block) -> (i64, i64) {
        match self {
            Chart::Cayley => (1, 2),
            // the rotation
            Chart::Product if block.offset == 0 => (1, 2),
            _ => (1, 1),
        }
    }
}

/// cos θ where |x| = sin θ.
fn cosine(x: Expr<'_>) -> Expr<'_> {
    (x.graph().integer(1) - x.norm_squared()).sqrt()
}

/// Z = Σ x_i E_i over all blocks.
fn combination<'g>(group: Group, x: &[Expr<'g>]) -> Expr<'g> {
    group.placed(x[0].graph(), |index, _| x[index])
}

/// exp Z, by Stumpff functions of s where Zᵏ⁺² = −s Zᵏ for a k up to two, s = −½ tr Z². Such groups are rotations,
/// motions of space and of the plane, SL(2) and SO(1, 2).
fn exponential(z: Expr<'_>) -> Expr<'_> {
    let graph = z.graph();
    let square = z * z;
    let s = -square.trace() / 2;
    let stumpff = |k: u8| s.function(Function::Stumpff(k));
    let identity = graph.identity(z.shape().rows);
    if in_one_plane(z).is_some() {
        stumpff(0) * identity + stumpff(1) * z
    } else if identity::vanishes(square * z + s * z) {
        identity + stumpff(1) * z + stumpff(2) * square
    } else if identity::vanishes(square * square + s * square) {
        identity + z + stumpff(2) * square + stumpff(3) * (square * z)
    } else if z.shape().rows == 4 && identity::vanishes(z + z.transpose()) {
        double_turn(z)
    } else {
        z.exponential()
    }
}

/// s where Z² = −s I.
fn in_one_plane(z: Expr<'_>) -> Option<Expr<'_>> {
    let s = -(z * z).trace() / 2;
    identity::vanishes(z * z + s * z.graph().identity(z.shape().rows)).then_some(s)
}

/// exp Z = exp Z₊ exp Z₋ of an antisymmetric 4×4 matrix, Z± = (Z ± Z̃)/2, whose squares are −s±I and which commute.
fn double_turn(z: Expr<'_>) -> Expr<'_> {
    let identity = z.graph().identity(4);
    let halves = both([1, -1], |sign| {
        let half = (z + sign * dual(z)) / 2;
        let s = (1..4).fold(z.graph().integer(0), |s, j| s + half.entry(0, j).powi(2));
        let sine = s.function(Function::Stumpff(1)) * half;
        // cos − 1
        (sine, -s * s.function(Function::Stumpff(2)))
    });
    let [(a, alpha), (b, beta)] = halves;
    // (I + αI + A)(I + βI + B)
    identity + (alpha + beta + alpha * beta) * identity + a + b + beta * a + alpha * b + a * b
}

/// (I − Z)⁻¹, whose powers and transposes carry all of the Cayley chart.
fn resolvent(z: Expr<'_>) -> Expr<'_> {
    (z.graph().identity(z.shape().rows) - z).inverse()
}

fn quaternion<'g>(vector: Expr<'g>, scalar: Expr<'g>) -> Expr<'g> {
    let shape = Shape::vector(4);
    vector.embed(shape, 0, 0) + scalar.embed(shape, 3, 0)
}

/// 2(I − Z)⁻¹Z. Let Z be 4×4 with tr Z = tr Z³ = 0, as in the algebras of a bilinear form. Then Z⁴ + sZ² + d = 0 with s
/// = −½ tr Z² and d = ⅛(tr Z²)² − ¼ tr Z⁴. So the result is 2(Z + Z²)((1 + s)I + Z²)/(1 + s + d).
fn even_increment(z: Expr<'_>) -> Expr<'_> {
    let graph = z.graph();
    let one = graph.integer(1);
    let square = z * z;
    let odd = [z.trace(), (square * z).trace()];
    if z.shape().rows != 4 || !odd.into_iter().all(identity::vanishes) {
        return 2 * (resolvent(z) * z);
    }
    let (second, fourth) = (square.trace(), (square * square).trace());
    let (s, d) = (-second / 2, second * second / 8 - fourth / 4);
    2 * ((z + square) * ((one + s) * graph.identity(4) + square)) / (one + s + d)
}

impl Chart {
    /// The components of Ad*_F μ of the element with the coordinates x/w, where these take fewer operations than F − I.
    ///
    /// For unit quaternions it is μ + 2(wc + c × x)/(w² + |x|²) with c = μ × x, which needs no root.
    ///
    /// Rotations in four dimensions, with w = 1, turn the two parts M ± M̃ by the quaternions (1 ∓ p, Z ± Z̃). So M becomes M + 2(C − pC̃
    /// + [C, Z])/(1 + s + p²). Here C is [M, Z], s is |x|² and p the Pfaffian of Z.
    ///
    /// Source: J. E. Mebius, *A matrix-based proof of the quaternion representation theorem for four-dimensional rotations*, 2005.
    pub fn coadjoint<'g>(self, group: Group, x: Expr<'g>, w: Option<Expr<'g>>, mu: Expr<'g>) -> Option<Expr<'g>> {
        let one = x.graph().integer(1);
        let square = x.norm_squared();
        match (self, group, w) {
            (Chart::Cayley, Group::UnitQuaternions, _) => {
                let w = w.unwrap_or(one);
                let turned = mu.cross(x);
                Some(mu + (w * turned + turned.cross(x)) / ((w * w + square) / 2))
            }
            (Chart::Cayley, Group::SpecialOrthogonal(4), None) => {
                let z = group.wedge(x);
                let pfaffian = -(z * dual(z)).entry(0, 0);
                let turned = commutator(group.wedge(mu), z);
                let change = turned - pfaffian * dual_coordinates(turned) + commutator(group.wedge(turned), z);
                Some(mu + change / ((one + square + pfaffian * pfaffian) / 2))
            }
            _ => None,
        }
    }
}

/// det(I + Z) − 1 = Σ e_k, the elementary symmetric functions of the eigenvalues by Newton's identities.
fn determinant_excess(z: Expr<'_>) -> Expr<'_> {
    let graph = z.graph();
    let n = z.shape().rows;
    let mut powers: Vec<Expr<'_>> = vec![z];
    (2..=n).for_each(|_| powers.push(powers[powers.len() - 1] * z));
    let mut traces: Vec<Expr<'_>> = powers.into_each(Expr::trace);
    if identity::vanishes(traces[0]) {
        traces[0] = graph.integer(0);
    }
    let mut elementary = vec![graph.integer(1)];
    let mut excess = graph.integer(0);
    for k in 1..=n {
        let mut sum = graph.integer(0);
        for i in 1..=k {
            let sign = if i % 2 == 1 { 1 } else { -1 };
            sum = sum + sign * (elementary[k - i] * traces[i - 1]);
        }
        elementary.push(sum / k as i64);
        excess = excess + elementary[k];
    }
    excess
}

/// The increment of a rotation in its Cayley chart.
fn turn_increment<'g>(n: usize, x: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
    let graph = x.graph();
    let one = graph.integer(1);
    let square = x.norm_squared();
    match n {
        2 | 3 => {
            // each entry then is a sum of products, with the scale in their common factor
            let scale = one / ((one + square) / 2);
            scale * z + scale * (z * z)
        }
        4 => {
            // Z³ + sZ = pZ̃, as Z Z̃ = −pI
            let dual = dual(z);
            let pfaffian = -(z * dual).entry(0, 0);
            let scale = one / ((one + square + pfaffian * pfaffian) / 2);
            let [first, last] = [pfaffian * dual, pfaffian * pfaffian * graph.identity(4)];
            scale * (z + first + z * z - last)
        }
        _ => 2 * (resolvent(z) * z),
    }
}

/// Z̃ with Z̃₁₂ = Z₃₄, and so for all even permutations: the dual of an antisymmetric 4×4 matrix, ZZ̃ = −pI with its Pfaffian p.
fn dual(z: Expr<'_>) -> Expr<'_> {
    let entry = |(i, j): (usize, usize)| match (i, j) {
        _ if i == j => z.graph().integer(0),
        (0, 2) | (2, 0) | (1, 3) | (3, 1) => z.entry(3 - i, 3 - j),
        (0, 1) | (1, 0) | (2, 3) | (3, 2) => z.entry((i + 2) % 4, (j + 2) % 4),
        _ => z.entry((j + 2) % 4, (i + 2) % 4),
    };
    let shape = Shape::square(4);
    z.graph().stack(shape, shape.positions().map(entry).into_list())
}

fn dual_coordinates(x: Expr<'_>) -> Expr<'_> {
    let entries = [(5, 1), (4, -1), (3, 1), (2, 1), (1, -1), (0, 1)];
    x.graph().stack(x.shape(), entries.each(|&(k, sign)| sign * x.entry(k, 0)))
}

/// The coordinates of the commutator of two antisymmetric matrices, the entries below its diagonal.
fn commutator<'g>(a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
    let product = a * b;
    let n = product.shape().rows;
    let planes = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    let entries = planes.map(|(i, j)| product.entry(j, i) - product.entry(i, j)).into_list();
    a.graph().stack(Shape::vector(entries.len()), entries)
}

impl Group {
    /// The coordinates of log F, the principal logarithm.
    pub fn logarithm(self, f: Expr<'_>) -> Expr<'_> {
        match self {
            Group::Translation(_) => f,
            // the matrix of q ↦ log(f) q has log(f) = ξ/2 in its last column
            Group::UnitQuaternions => 2 * left_matrix(f).analytic(Analytic::Logarithm).block(0, 3, Shape::vector(3)),
            _ => self.projected_coordinates(f.analytic(Analytic::Logarithm)),
        }
    }

    /// The same by a closed form, where the group has one: of rotations and rigid motions in the plane and in space.
    pub fn closed_logarithm(self, f: Expr<'_>) -> Expr<'_> {
        match self {
            Group::SpecialOrthogonal(2 | 3) | Group::SpecialEuclidean(2 | 3) => {
                self.projected_coordinates(f.analytic(Analytic::MotionLogarithm))
            }
            _ => self.logarithm(f),
        }
    }

    /// The matrix of ad_ξ in the basis of the algebra.
    pub fn ad<'g>(self, xi: Expr<'g>) -> Expr<'g> {
        let graph = xi.graph();
        let known = graph.adjoints.borrow().get(&self).copied();
        let algebra = known.unwrap_or_else(|| {
            let is_of_matrices = !matches!(self, Group::Translation(_) | Group::UnitQuaternions);
            if is_of_matrices { self.adjoint_algebra(graph) } else { self.adjoint_algebra_by_products(graph) }
        });
        graph.adjoints.borrow_mut().insert(self, algebra);
        xi.wedge(algebra)
    }

    /// The algebra of the matrices of ad_{E_i}, for elements that are no matrices.
    fn adjoint_algebra_by_products<'g>(self, graph: &'g Graph) -> Algebra {
        let m = self.dimension();
        let basis = graph.matrices(self);
        let bracket = |a: Expr<'g>, b: Expr<'g>| match self {
            Group::Translation(_) => graph.zero(self.element_shape()),
            _ => self.compose(a, b) - self.compose(b, a),
        };
        let structure = |i: usize| -> crate::Sparse {
            let columns = (0..m).map(|j| self.projected_coordinates(bracket(basis[i], basis[j])));
            let columns: Vec<Expr<'g>> = columns.into_list();
            let number = |(row, column): (usize, usize)| columns[column].entry(row, 0).expand().as_number();
            let entries = Shape::square(m).positions().filter_map(|at| Some((at.0, at.1, number(at)?)));
            entries.filter(|(_, _, value)| !value.is_zero()).into_list()
        };
        graph.algebra(Shape::square(m), indexed(m, structure))
    }

    /// dexp_ξ = φ(ad_ξ), the right trivialisation of the derivative of exp: (d exp ξ) exp(−ξ) = dexp_ξ dξ.
    pub fn exponential_slope(self, xi: Expr<'_>) -> Expr<'_> {
        let graph = xi.graph();
        xi.remembered(&graph.images(Map::ExponentialSlope(self)), || {
            let (ad, one) = (self.ad(xi), graph.identity(self.dimension()));
            let square = ad * ad;
            let s = -square.trace() / 2;
            let stumpff = |k: u8| s.function(Function::Stumpff(k));
            if identity::vanishes(ad) {
                one
            } else if identity::vanishes(square) {
                one + ad / 2
            } else if identity::vanishes(square * ad + s * ad) {
                one + stumpff(2) * ad + stumpff(3) * square
            } else {
                ad.analytic(Analytic::Phi)
            }
        })
    }

    /// dexp_ξ⁻¹ where it is a polynomial in ad_ξ. It is 1 − ½ ad + c ad² where ad³ = −s ad. On SE(3), where ad (ad² + s)² = 0, it is
    /// 1 − ½ ad + (c − s c′) ad² − c′ ad⁴. Both have c(s) = (c₃ − 2c₄)/(2c₂) = (1 − ½θ cot ½θ)/θ² by Stumpff functions, s = θ². `None` for other
    /// groups.
    pub fn logarithm_slope(self, xi: Expr<'_>) -> Option<Expr<'_>> {
        let graph = xi.graph();
        let (ad, one) = (self.ad(xi), graph.identity(self.dimension()));
        let square = ad * ad;
        if identity::vanishes(ad) {
            return Some(one);
        }
        if identity::vanishes(square) {
            return Some(one - ad / 2);
        }
        let trace = -square.trace();
        let is_simple = identity::vanishes(square * ad + trace / 2 * ad);
        let s = if is_simple { trace / 2 } else { trace / 4 };
        let stumpff = |k: u8| s.function(Function::Stumpff(k));
        let (c2, numerator) = (stumpff(2), stumpff(3) - 2 * stumpff(4));
        let c = numerator / (2 * c2);
        if is_simple {
            return Some(one - ad / 2 + c * square);
        }
        let shifted = square + s * one;
        identity::vanishes(ad * (shifted * shifted)).then(|| {
            // c₂′ = c₄ − ½c₃, and the numerator changes by ½(5c₅ − c₄ − 8c₆)
            let change = 5 * stumpff(5) - stumpff(4) - 8 * stumpff(6);
            let slope = (change * c2 + numerator * numerator) / (4 * (c2 * c2));
            one - ad / 2 + (c - s * slope) * square - slope * (square * square)
        })
    }

    /// dexp_ξ on so(4) = so(3) + so(3), where ad of either half vanishes on the other, by four Stumpff functions. It is
    /// many times as long as φ(ad_ξ), and as many times faster. `None` for other groups.
    pub fn exponential_slope_by_halves(self, xi: Expr<'_>) -> Option<Expr<'_>> {
        (self == Group::SpecialOrthogonal(4)).then(|| {
            let half = |sign: i64| self.exponential_slope((xi + sign * dual_coordinates(xi)) / 2);
            half(1) + half(-1) - xi.graph().identity(6)
        })
    }
}
