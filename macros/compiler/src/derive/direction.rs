//! Potentials of a fixed direction as a body sees it, by quaternions: y = Rᵀe_k, as that of weight.
//!
//! V is a quadratic form in the quaternion then, and its impulse as derived from its four coordinates is long. As V(y) it is ∂V/∂y × y,
//! for an action from the right.

use clebsch_symbolic::{Expr, Group, Property, Role, Shape, identity, indexed};

use super::SystemFormulas;

/// A direction y in a body, and the potential as a function of it.
pub(super) struct Direction<'g> {
    /// y
    pub(super) symbol: Expr<'g>,
    /// y as a function of the quaternion.
    value: Expr<'g>,
    /// V(y)
    pub(super) potential: Expr<'g>,
}

impl<'g> Direction<'g> {
    /// A function of y as one of the quaternion.
    pub(super) fn inserted(&self, function: Expr<'g>) -> Expr<'g> {
        function.substitute(&[(self.symbol, self.value)])
    }

    /// The impulse ∂U/∂y × y of a function U(y).
    pub(super) fn impulse(&self, function: Expr<'g>) -> Expr<'g> {
        function.gradient(self.symbol).cross(self.symbol)
    }
}

impl<'g> SystemFormulas<'g> {
    /// The direction that a potential of one quaternion depends on, if it depends on one alone. `impulse` is that of the potential.
    pub(super) fn direction(&self, potential: Expr<'g>, impulse: &[Expr<'g>]) -> Option<Direction<'g>> {
        let (graph, model) = (self.model.graph, &self.model);
        let ([factor], [leaf], [impulse]) = (&model.factors[..], &model.configurations[..], impulse) else {
            return None;
        };
        if factor.group != Group::UnitQuaternions || !leaf.is_quaternion || potential.has_methods() {
            return None;
        }
        let q = leaf.symbol;
        let slope = potential.gradient(q);
        // V = ½ qᵀSq but for a constant
        let form = slope.jacobian(q);
        if form.depends_on(q) || !identity::equal(&[slope], &[form * q]) {
            return None;
        }
        let entry = |i: usize, j: usize| form.entry(i, j).expand();
        // Σ C_ij R_ij has (w² − |u|²) tr C + 2 u·Cu + 2w u·a with a_i = C_kj − C_jk, where |u|² + w² = 1
        let trace = entry(0, 0) + entry(1, 1) + entry(2, 2);
        let shift = (entry(3, 3) - trace) / 4;
        let coefficient = |i: usize, j: usize| {
            let even = entry(i, j) / 4 + if i == j { shift / 2 } else { graph.integer(0) };
            let odd = match (3 + j - i) % 3 {
                0 => graph.integer(0),
                // the third axis of (i, j, k) in order
                1 => -(entry(3, 3 - i - j) / 4),
                _ => entry(3, 3 - i - j) / 4,
            };
            (even + odd).expand()
        };
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| coefficient(i, j)));
        let is_there = |row: &[Expr<'g>; 3]| row.iter().any(|entry| !identity::vanishes(*entry));
        let mut there = (0..3).filter(|&i| is_there(&rows[i]));
        let (Some(axis), None) = (there.next(), there.next()) else { return None };
        let symbol = graph.symbol("y", Shape::vector(3), Role::Letter, Property::General);
        let direction =
            Direction { symbol, value: row_of_rotation(q, axis), potential: self.along(&rows[axis], symbol) };
        let short = direction.inserted(direction.impulse(direction.potential));
        identity::equal(&[*impulse], &[short]).then_some(direction)
    }

    /// The sum of coefficients times the entries of y: a multiple of p·y where they are that of a parameter p.
    fn along(&self, coefficients: &[Expr<'g>; 3], y: Expr<'g>) -> Expr<'g> {
        let graph = y.graph();
        let leaves = self.model.parameters.iter().flat_map(|parameter| &parameter.leaves);
        let mut vectors = leaves.map(|leaf| leaf.symbol).filter(|symbol| symbol.shape() == y.shape());
        let multiple = vectors.find_map(|p| {
            let scale = coefficients[0].gradient(p).entry(0, 0).expand();
            let all: Vec<Expr<'g>> = (0..3).map(|j| scale * p.entry(j, 0)).collect();
            identity::equal(coefficients, &all).then(|| scale * p.dot(y))
        });
        let terms = coefficients.iter().enumerate().map(|(j, entry)| *entry * y.entry(j, 0));
        multiple.unwrap_or_else(|| graph.total(Shape::scalar(), terms))
    }
}

/// Rᵀe_i of the rotation R by a unit quaternion (u, w): R = I + 2(w u^ + (u^)²).
fn row_of_rotation<'g>(q: Expr<'g>, i: usize) -> Expr<'g> {
    let graph = q.graph();
    let u = |k: usize| q.entry(k, 0);
    let w = q.entry(3, 0);
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let entry = |column: usize| {
        if column == i {
            graph.integer(1) - 2 * (u(j) * u(j) + u(k) * u(k))
        } else if column == j {
            2 * (u(i) * u(j) - w * u(k))
        } else {
            2 * (u(i) * u(k) + w * u(j))
        }
    };
    graph.stack(Shape::vector(3), indexed(3, entry))
}

#[cfg(test)]
mod tests {
    use clebsch_symbolic::Graph;

    use crate::compile;
    use crate::derive::Id;

    /// The kick at the start of a step of a body by quaternions.
    fn kick(potential: &str) -> String {
        let source = format!(
            "#[clebsch(action = |F: SU<2>, Q: SU<2>| Q * F, lagrangian = |omega| omega.norm_squared(), potential = {potential})]
             struct Body {{ weight: f64, center: Vector3<f64>, other: Vector3<f64> }}"
        );
        let graph = &Graph::new();
        let program = compile(graph, source.parse().expect("tokens")).unwrap_or_else(|errors| panic!("{errors}"));
        let rows = program.mechanics().expect("a body").formulas.table().rows();
        rows.iter().find(|row| row.id == Id::StartKick(0)).expect("a kick").equation()
    }

    /// Weight along each axis is the product of the centre of mass with the direction that the body sees.
    #[test]
    fn weight_is_a_direction() {
        for axis in ["x", "y", "z"] {
            let kick = kick(&format!("|Q| self.weight * (Q * self.center).{axis}"));
            assert!(kick.starts_with("M − N = −weight·h·center^·["), "{kick}");
        }
        let by_other_names = kick("|Q| self.weight * self.center.dot(&(Q.conjugate() * Vector3::z()))");
        assert!(by_other_names.contains("center^·["), "{by_other_names}");
    }

    /// Potentials of several directions, and methods of the user's, are derived from the four coordinates.
    #[test]
    fn other_potentials_are_none() {
        for potential in [
            "|Q| (Q * self.center).z.powi(2)",
            "|Q| (Q * self.center).z + (Q * self.other).x",
            "opaque(Self::value, Self::gradient)",
        ] {
            let kick = kick(potential);
            assert!(!kick.contains("^·[2·Q"), "{potential}: {kick}");
        }
    }
}
