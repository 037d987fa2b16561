//! How group elements act on each other and on momenta: products, translations of tangent vectors, Ad*.

use super::{Block, Group};
use crate::algebra::Sparse;
use crate::node::Operation;
use crate::{Expr, Graph, IntoList, Rational, Shape, indexed, integer, rational};

impl Group {
    /// The identity element.
    pub fn identity(self, graph: &Graph) -> Expr<'_> {
        match self {
            Group::Translation(n) => graph.zero(Shape::vector(n)),
            Group::UnitQuaternions => graph.unit(Shape::vector(4), 3, 0),
            _ => graph.identity(self.element_shape().rows),
        }
    }

    /// The product g·h.
    pub fn compose<'g>(self, g: Expr<'g>, h: Expr<'g>) -> Expr<'g> {
        match self {
            Group::Translation(_) => g + h,
            Group::UnitQuaternions => quaternion_product(g, h),
            _ => g * h,
        }
    }

    /// The inverse element, as short as it can be written: Fᵀ of a rotation, the letter F⁻¹ of other matrices.
    pub fn inverse(self, f: Expr<'_>) -> Expr<'_> {
        match self {
            Group::Translation(_) => -f,
            Group::UnitQuaternions => conjugate(f),
            _ if self.is_orthogonal() => f.transpose(),
            _ => f.inverse(),
        }
    }

    /// The inverse element without the inverse of a matrix, where the group has such a formula: η⁻¹FᵀηF = I, block elimination, a
    /// finite series.
    pub fn explicit_inverse<'g>(self, f: Expr<'g>) -> Expr<'g> {
        let graph = f.graph();
        let linear = |n: usize| f.block(0, 0, Shape::square(n));
        let moved_back = |n: usize, back: Expr<'g>| motion(back, -(back * f.block(0, n, Shape::vector(n))));
        match self {
            Group::PseudoOrthogonal(p, q) => graph.metric(p, q) * f.transpose() * graph.metric(p, q),
            // Ω⁻¹ = −Ω
            Group::Symplectic(n) => -(graph.symplectic_form(n) * f.transpose() * graph.symplectic_form(n)),
            Group::SpecialEuclidean(n) => moved_back(n, linear(n).transpose()),
            Group::Similarity(n) => {
                let scale = linear(n).block(0, 0, Shape::vector(n)).norm_squared();
                moved_back(n, linear(n).transpose() / scale)
            }
            Group::Affine(n) => moved_back(n, linear(n).inverse()),
            Group::Heisenberg(_) => {
                // F = I + Z with Z³ = 0
                let identity = self.identity(graph);
                let z = f - identity;
                identity - z + z * z
            }
            _ => self.inverse(f),
        }
    }

    /// f⁻¹g, or g f⁻¹ with `from_left`. For rigid motions it is (RᵀS, Rᵀ(y − x)) of (R, x) and (S, y), or (S Rᵀ, y − S Rᵀx).
    pub fn quotient<'g>(self, f: Expr<'g>, g: Expr<'g>, from_left: bool) -> Expr<'g> {
        let Group::SpecialEuclidean(n) = self else {
            let inverse = self.explicit_inverse(f);
            return if from_left { self.compose(g, inverse) } else { self.compose(inverse, g) };
        };
        let [r, s] = [f, g].map(|element| element.block(0, 0, Shape::square(n)));
        let [x, y] = [f, g].map(|element| element.block(0, n, Shape::vector(n)));
        if from_left {
            let turn = s * r.transpose();
            return motion(turn, y - turn * x);
        }
        motion(r.transpose() * s, r.transpose() * (y - x))
    }

    /// The tangent vector F·η, the derivative of F exp(εη): left translation of η.
    pub fn translate_left<'g>(self, f: Expr<'g>, eta: Expr<'g>) -> Expr<'g> {
        if self.is_translation() { eta } else { self.compose(f, eta) }
    }

    /// The tangent vector η·F, the derivative of exp(εη) F.
    pub fn translate_right<'g>(self, f: Expr<'g>, eta: Expr<'g>) -> Expr<'g> {
        if self.is_translation() { eta } else { self.compose(eta, f) }
    }

    /// An array whose components ⟨·, E_i⟩ are those of T*_id L_F D: FᵀD for a matrix group.
    pub fn cotangent_left<'g>(self, f: Expr<'g>, d: Expr<'g>) -> Expr<'g> {
        match self {
            Group::Translation(_) => d,
            Group::UnitQuaternions => left_matrix(f).transpose() * d,
            _ => f.transpose() * d,
        }
    }

    /// An array whose components ⟨·, E_i⟩ are those of T*_id R_F D: D Fᵀ for a matrix group.
    pub fn cotangent_right<'g>(self, f: Expr<'g>, d: Expr<'g>) -> Expr<'g> {
        match self {
            Group::Translation(_) => d,
            Group::UnitQuaternions => right_matrix(f).transpose() * d,
            _ => d * f.transpose(),
        }
    }

    /// The algebra element Σ ξ_i E_i with components ξ.
    pub fn wedge(self, xi: Expr<'_>) -> Expr<'_> {
        self.placed(xi.graph(), |_, block| xi.block(block.offset, 0, Shape::vector(block.algebra.dimension)))
    }

    /// Σ over the blocks, with their indices, of the element that has the given coordinates in each.
    pub(crate) fn placed<'g>(self, graph: &'g Graph, coordinates: impl Fn(usize, &Block) -> Expr<'g>) -> Expr<'g> {
        let shape = self.element_shape();
        let part = |(index, block): (usize, &Block)| {
            coordinates(index, block).wedge(block.algebra).embed(shape, block.row, block.column)
        };
        graph.total(shape, graph.blocks(self).iter().enumerate().map(part))
    }

    /// The vector with the given components in each block.
    fn by_blocks<'g>(self, graph: &'g Graph, components: impl Fn(&Block) -> Expr<'g>) -> Expr<'g> {
        let shape = Shape::vector(self.dimension());
        let part = |block: &Block| components(block).embed(shape, block.offset, 0);
        graph.total(shape, graph.blocks(self).iter().map(part))
    }

    /// The components ⟨A, E_i⟩ of an array of the shape of elements.
    pub fn components(self, array: Expr<'_>) -> Expr<'_> {
        self.by_blocks(array.graph(), |block| {
            array.block(block.row, block.column, block.algebra.shape).components(block.algebra)
        })
    }

    /// The coordinates ξ of the element of the algebra that is nearest to an array: G⁻¹⟨A, E_i⟩.
    pub fn projected_coordinates(self, array: Expr<'_>) -> Expr<'_> {
        self.raised(self.components(array))
    }

    /// The representing matrix M = Σ G^{ij} m_j E_i of a momentum with components m.
    pub fn momentum_matrix(self, mu: Expr<'_>) -> Expr<'_> {
        self.wedge(self.raised(mu))
    }

    /// G⁻¹m, block by block.
    fn raised(self, mu: Expr<'_>) -> Expr<'_> {
        let graph = mu.graph();
        self.by_blocks(graph, |block| {
            graph.raise(block.algebra, mu.block(block.offset, 0, Shape::vector(block.algebra.dimension)))
        })
    }

    /// The coordinates of Ad_F ξ = F ξ F⁻¹.
    pub fn adjoint<'g>(self, f: Expr<'g>, xi: Expr<'g>) -> Expr<'g> {
        match self {
            Group::SpecialOrthogonal(3) => f * xi,
            Group::SpecialOrthogonal(2) | Group::Translation(_) => xi,
            _ => self.projected_coordinates(self.compose(self.compose(f, self.wedge(xi)), self.inverse(f))),
        }
    }

    /// The components of Ad*_F μ = (Ad_F)* μ, with no inverse in the definition: ⟨M, F E_i F⁻¹⟩.
    pub fn coadjoint<'g>(self, f: Expr<'g>, mu: Expr<'g>) -> Expr<'g> {
        match self {
            // (F a)^ = F a^ Fᵀ, so Ad_F is F itself in the hat basis
            Group::SpecialOrthogonal(3) => f.transpose() * mu,
            Group::SpecialOrthogonal(2) | Group::Translation(_) => mu,
            Group::UnitQuaternions => {
                let adjoint = left_matrix(f) * right_matrix(conjugate(f));
                self.components(adjoint.transpose() * self.momentum_matrix(mu))
            }
            // Ad_F (ω, v) = (R ω, R v + d × R ω) for F = (R d; 0 1)
            Group::SpecialEuclidean(3) => {
                let turned_back = f.block(0, 0, Shape::square(3)).transpose();
                let [angular, linear] = [0, 3].map(|start| mu.block(start, 0, Shape::vector(3)));
                let lever = linear.cross(f.block(0, 3, Shape::vector(3)));
                f.graph().below(&[turned_back * (angular + lever), turned_back * linear])
            }
            _ => {
                let inverse = self.inverse(f);
                self.components(f.transpose() * self.momentum_matrix(mu) * inverse.transpose())
            }
        }
    }

    /// Expressions in F that vanish on the group and, near the identity, nowhere else.
    pub fn equations<'g>(self, f: Expr<'g>) -> Vec<Expr<'g>> {
        let graph = f.graph();
        let n = self.element_shape().rows;
        let form = |eta: Expr<'g>| f.transpose() * eta * f - eta;
        let last_row = || f.block(n - 1, 0, Shape::new(1, n)) - graph.unit(Shape::new(1, n), 0, n - 1);
        let linear = || f.block(0, 0, Shape::square(n - 1));
        match self {
            Group::SpecialOrthogonal(_) => vec![form(graph.identity(n))],
            Group::PseudoOrthogonal(p, q) => vec![form(graph.metric(p, q))],
            Group::Symplectic(n) => vec![form(graph.symplectic_form(n))],
            Group::SpecialEuclidean(n) => {
                vec![linear().transpose() * linear() - graph.identity(n), last_row()]
            }
            Group::Similarity(n) => {
                let square = linear().transpose() * linear();
                vec![n as i64 * square / square.trace() - graph.identity(n), last_row()]
            }
            Group::Affine(_) => vec![last_row()],
            Group::Translation(_) | Group::GeneralLinear(_) => Vec::new(),
            // not `determinant`, which knows that it is 1 on the group
            Group::SpecialLinear(_) => vec![f.atom_of(Operation::Determinant, Shape::scalar()) - graph.integer(1)],
            Group::Unitary(n) | Group::SpecialUnitary(n) => {
                let complex = graph.symplectic_form(2 * n);
                let mut equations = vec![form(graph.identity(2 * n)), f * complex - complex * f];
                if self == Group::SpecialUnitary(n) && n <= LARGEST_DETERMINANT {
                    let (real, imaginary) = complex_determinant(f, &(0..n).into_list(), 0);
                    equations.extend([real - graph.integer(1), imaginary]);
                }
                equations
            }
            Group::UnitQuaternions => vec![f.norm_squared() - graph.integer(1)],
            Group::Heisenberg(_) => {
                let z = f - graph.identity(n);
                vec![z - self.wedge(self.projected_coordinates(z))]
            }
            Group::Declared(declared) => graph.definition(declared).equation(f),
        }
    }

    /// How the terms of [`equations`](Self::equations) grow with F, and their rounding error with them:
    /// ((1 + |F|²/n)/2)^(d/2) for equations of the degree d. It is 1 at the identity. `None` where terms are bounded on the
    /// group, or of first degree.
    pub fn growth(self, f: Expr<'_>) -> Option<Expr<'_>> {
        let degree = match self {
            Group::PseudoOrthogonal(..) | Group::Symplectic(_) => 2,
            Group::SpecialLinear(n) => n as u32,
            Group::Declared(_) => self.equations(f).iter().map(|equation| equation.degree(f)).max().unwrap_or(0),
            _ => 0,
        };
        let n = i64::from(self.element_shape().rows as u32);
        let mean = (f.graph().integer(1) + f.norm_squared() / n) / 2;
        (degree > 1).then(|| mean.power(rational(i64::from(degree), 2)))
    }
}

/// Beyond this size a complex determinant has more terms than a check is worth.
const LARGEST_DETERMINANT: usize = 4;

/// Real and imaginary part of the determinant of A + iB, given as (A −B; B A), over some rows and the columns from `column` on.
fn complex_determinant<'g>(f: Expr<'g>, rows: &[usize], column: usize) -> (Expr<'g>, Expr<'g>) {
    let (graph, n) = (f.graph(), f.shape().rows / 2);
    if rows.is_empty() {
        return (graph.integer(1), graph.integer(0));
    }
    let mut sum = (graph.integer(0), graph.integer(0));
    for (position, &row) in rows.iter().enumerate() {
        let others: Vec<usize> = rows.iter().copied().filter(|&other| other != row).into_list();
        let (real, imaginary) = complex_determinant(f, &others, column + 1);
        let (a, b) = (f.entry(row, column), f.entry(n + row, column));
        let sign = if position % 2 == 0 { 1 } else { -1 };
        sum = (sum.0 + sign * (a * real - b * imaginary), sum.1 + sign * (a * imaginary + b * real));
    }
    sum
}

/// (A b; 0 1).
pub(crate) fn motion<'g>(linear: Expr<'g>, shift: Expr<'g>) -> Expr<'g> {
    let n = linear.shape().rows;
    blocks(linear, shift) + linear.graph().unit(Shape::square(n + 1), n, n)
}

/// (A b; 0 0).
pub(crate) fn blocks<'g>(linear: Expr<'g>, shift: Expr<'g>) -> Expr<'g> {
    let n = linear.shape().rows;
    let shape = Shape::square(n + 1);
    linear.embed(shape, 0, 0) + shift.embed(shape, 0, n)
}

/// The basis of the matrices q ↦ a q (or q a) of the quaternions a = i, j, k, 1 on (i, j, k, w).
fn multiplication(from_left: bool) -> Vec<Sparse> {
    let unit = |a: usize, b: usize| -> (usize, i64) {
        match (a, b) {
            (3, other) | (other, 3) => (other, 1),
            _ if a == b => (3, -1),
            _ => (3 - a - b, if (a + 1) % 3 == b { 1 } else { -1 }),
        }
    };
    let column = |a: usize, b: usize| -> (usize, usize, Rational) {
        let (row, sign) = if from_left { unit(a, b) } else { unit(b, a) };
        (row, b, integer(sign))
    };
    indexed(4, |a| indexed(4, |b| column(a, b)))
}

/// The matrix of q ↦ a q.
pub(crate) fn left_matrix(a: Expr<'_>) -> Expr<'_> {
    a.wedge(a.graph().algebra(Shape::square(4), multiplication(true)))
}

/// The matrix of q ↦ q a.
pub(crate) fn right_matrix(a: Expr<'_>) -> Expr<'_> {
    a.wedge(a.graph().algebra(Shape::square(4), multiplication(false)))
}

/// The product of quaternions (i, j, k, w).
pub fn quaternion_product<'g>(a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
    left_matrix(a) * b
}

/// The conjugate quaternion.
pub fn conjugate(a: Expr<'_>) -> Expr<'_> {
    let signs = (0..4).map(|i| (i, i, integer(if i < 3 { -1 } else { 1 })));
    a.graph().sparse_literal(Shape::square(4), signs) * a
}
