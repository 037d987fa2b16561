//! Matrix Lie groups: what the derivation needs to know of a group, and nothing else.

use crate::{Algebra, Expr, Graph, Property, Shape};

/// A matrix Lie group.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Group {
    /// SO(n): RᵀR = I, det R = 1.
    SpecialOrthogonal(usize),
    /// Rⁿ with addition; elements are vectors.
    Translation(usize),
}

/// Coordinates of a group near the identity: F as a function of x in R^m, with F = I at x = 0.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Chart {
    /// F = (I − Z)⁻¹(I + Z), Z = Σ x_i E_i, so that Z ≈ ½ log F. For SO(3), x = tan(θ/2)·axis.
    Cayley,
    /// F = x.
    Identity,
}

impl Group {
    /// The name that a declaration uses, `SO<3>`.
    pub fn name(self) -> String {
        match self {
            Group::SpecialOrthogonal(n) => format!("SO<{n}>"),
            Group::Translation(n) => format!("Translation<{n}>"),
        }
    }

    /// The Lie algebra with its documented basis.
    pub fn algebra(self) -> Algebra {
        match self {
            Group::SpecialOrthogonal(n) => Algebra::SpecialOrthogonal(n),
            Group::Translation(n) => Algebra::Translation(n),
        }
    }

    /// The dimension m.
    pub fn dimension(self) -> usize {
        self.algebra().dimension()
    }

    /// The shape of the arrays that represent elements.
    pub fn element_shape(self) -> Shape {
        self.algebra().matrix_shape()
    }

    /// What holds for every element.
    pub fn element_property(self) -> Property {
        match self {
            Group::SpecialOrthogonal(_) => Property::Orthogonal,
            Group::Translation(_) => Property::General,
        }
    }

    /// The identity element.
    pub fn identity(self, graph: &Graph) -> Expr<'_> {
        match self {
            Group::SpecialOrthogonal(n) => graph.identity(n),
            Group::Translation(n) => graph.zero(Shape::vector(n)),
        }
    }

    /// The product g·h.
    pub fn compose<'g>(self, g: Expr<'g>, h: Expr<'g>) -> Expr<'g> {
        match self {
            Group::SpecialOrthogonal(_) => g * h,
            Group::Translation(_) => g + h,
        }
    }

    /// The inverse element.
    pub fn inverse(self, f: Expr<'_>) -> Expr<'_> {
        match self {
            Group::SpecialOrthogonal(_) => f.transpose(),
            Group::Translation(_) => -f,
        }
    }

    /// The tangent vector F·η, the derivative of F exp(εη): left translation of η.
    pub fn translate_left<'g>(self, f: Expr<'g>, eta: Expr<'g>) -> Expr<'g> {
        match self {
            Group::SpecialOrthogonal(_) => f * eta,
            Group::Translation(_) => eta,
        }
    }

    /// An array whose components ⟨·, E_i⟩ are those of T*_id R_F D: D Fᵀ for a matrix group.
    pub fn cotangent_right<'g>(self, f: Expr<'g>, d: Expr<'g>) -> Expr<'g> {
        match self {
            Group::SpecialOrthogonal(_) => d * f.transpose(),
            Group::Translation(_) => d,
        }
    }

    /// An array whose components ⟨·, E_i⟩ are those of T*_id L_F D: FᵀD for a matrix group.
    pub fn cotangent_left<'g>(self, f: Expr<'g>, d: Expr<'g>) -> Expr<'g> {
        match self {
            Group::SpecialOrthogonal(_) => f.transpose() * d,
            Group::Translation(_) => d,
        }
    }

    /// The representing matrix M = Σ G^{ij} m_j E_i of a momentum with components m.
    pub fn momentum_matrix(self, mu: Expr<'_>) -> Expr<'_> {
        match self {
            // ⟨E_i, E_i⟩ = 2 for every element of the basis
            Group::SpecialOrthogonal(_) => mu.wedge(self.algebra()) / 2,
            Group::Translation(_) => mu,
        }
    }

    /// The components of Ad*_F μ = (Ad_F)* μ, with no inverse inside.
    pub fn coadjoint<'g>(self, f: Expr<'g>, mu: Expr<'g>) -> Expr<'g> {
        match self {
            // (F a)^ = F a^ Fᵀ, so Ad_F is F itself in the hat basis
            Group::SpecialOrthogonal(3) => f.transpose() * mu,
            Group::SpecialOrthogonal(2) | Group::Translation(_) => mu,
            Group::SpecialOrthogonal(_) => (f.transpose() * self.momentum_matrix(mu) * f).components(self.algebra()),
        }
    }

    /// The chart in which the implicit equation is solved.
    pub fn chart(self) -> Chart {
        match self {
            Group::SpecialOrthogonal(_) => Chart::Cayley,
            Group::Translation(_) => Chart::Identity,
        }
    }
}

impl Chart {
    /// The element with coordinates x.
    pub fn element<'g>(self, group: Group, x: Expr<'g>) -> Expr<'g> {
        match self {
            // (I − Z)⁻¹(I + Z) = 2(I − Z)⁻¹ − I
            Chart::Cayley => 2 * self.resolvent(group, x) - group.identity(x.graph()),
            Chart::Identity => x,
        }
    }

    /// (I − Z)⁻¹ for the Cayley chart, whose powers and transposes carry all of F.
    fn resolvent<'g>(self, group: Group, x: Expr<'g>) -> Expr<'g> {
        (group.identity(x.graph()) - x.wedge(group.algebra())).inverse()
    }

    /// F − I, with the numerator and the denominator of a form without cancellation:
    /// 2(Z + Z²)/(1 + |x|²) for n ≤ 3, 2(Z + Z²)((1 + s)I + Z²)/(1 + s + p²) with s = |x|² and p the Pfaffian of Z for n = 4,
    /// and 2(I − Z)⁻¹Z otherwise. For translations, F itself.
    pub fn increment<'g>(self, group: Group, x: Expr<'g>) -> (Expr<'g>, Expr<'g>) {
        let graph = x.graph();
        let one = graph.integer(1);
        let Group::SpecialOrthogonal(n) = group else { return (x, one) };
        let z = x.wedge(group.algebra());
        let square = x.norm_squared();
        match n {
            2 | 3 => (2 * (z + z * z), one + square),
            4 => {
                let pfaffian = [(0, 5, 1), (1, 4, -1), (2, 3, 1)]
                    .iter()
                    .fold(graph.integer(0), |sum, &(i, j, sign)| sum + sign * (x.entry(i, 0) * x.entry(j, 0)));
                let shifted = (one + square) * graph.identity(4) + z * z;
                (2 * ((z + z * z) * shifted), one + square + pfaffian * pfaffian)
            }
            _ => (2 * (self.resolvent(group, x) * z), one),
        }
    }

    /// The matrix A by whose congruence ρ ↦ A ρ Aᵀ the momentum equation is freed of denominators: I − Z for right actions,
    /// whose residual has F on the left or Fᵀ on the right, I + Z for left actions. `None` if there is nothing to clear.
    pub fn clearing<'g>(self, group: Group, x: Expr<'g>, left_action: bool) -> Option<Expr<'g>> {
        let z = x.wedge(group.algebra());
        let identity = group.identity(x.graph());
        match self {
            Chart::Cayley if left_action => Some(identity + z),
            Chart::Cayley => Some(identity - z),
            Chart::Identity => None,
        }
    }

    /// dx/dξ at the identity, for F = exp ξ.
    pub fn slope_at_identity(self) -> (i64, i64) {
        match self {
            Chart::Cayley => (1, 2),
            Chart::Identity => (1, 1),
        }
    }
}
