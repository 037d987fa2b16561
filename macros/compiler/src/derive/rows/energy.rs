//! The rows of the energies, as functions of the velocity and of the momentum.

use clebsch_symbolic::{Expr, Property, Role, Shape, identity};

use super::Names;
use crate::derive::{Formula, Id, MechanicsFormulas};

impl<'g> MechanicsFormulas<'g> {
    /// The energies, as functions of the velocity and of the momentum.
    pub(super) fn rows_of_energy(&self, names: &Names) -> [Formula<'g>; 10] {
        let Names { q, xi, mu, .. } = names;
        let slopes = self.symbols.algebra.iter().map(|xi| self.energy.kinetic.gradient(*xi).expand());
        let slopes: Vec<Expr<'g>> = slopes.collect();
        let general: Vec<Expr<'g>> = self.energy.general.into_iter().collect();
        let gradient: Vec<_> = general.iter().map(|lagrangian| self.symbols.slope(*lagrangian)).collect();
        let hessian: Vec<_> = gradient.iter().map(|gradient| self.symbols.slopes(*gradient)).collect();
        let linear = self.symbols.slope(self.energy.gyroscopic);
        let gyroscopic = if identity::vanishes(linear) { Vec::new() } else { vec![linear] };
        let parts = [Some(self.energy.kinetic), Some(self.energy.gyroscopic), self.energy.general];
        let moves = parts.into_iter().flatten().any(|part| self.model.reads_configuration(part));
        let kinetic = if moves { format!("T({q}, {mu})") } else { format!("T({mu})") };
        [
            Formula::new(Id::Inertia, format!("Σ{xi}"), slopes),
            Formula::new(Id::KineticEnergy, format!("T({xi})"), [self.energy.kinetic + self.energy.gyroscopic]),
            Formula::new(Id::Lagrangian, format!("ℓ({xi})"), general),
            Formula::new(Id::LagrangianGradient, format!("∂ℓ/∂{xi}"), gradient),
            Formula::new(Id::LagrangianHessian, format!("∂²ℓ/∂{xi}²"), hessian),
            Formula::new(Id::Gyroscopic, "A", gyroscopic),
            Formula::new(Id::PotentialEnergy, format!("V({q})"), [self.potential_energy]),
            self.row_of_energy(names, Id::Hamiltonian, format!("H({q}, {mu})"), self.potential_energy),
            self.row_of_energy(names, Id::KineticEnergyOfMomentum, kinetic, self.model.graph.integer(0)),
            Formula::new(Id::Force, "f", self.covector.clone().unwrap_or_default()),
        ]
    }

    /// ½ (μ − A)·Σ⁻¹(μ − A), or μ·ξ − ℓ(ξ) where ℓ is not quadratic, and a potential energy added to it.
    fn row_of_energy(&self, names: &Names, id: Id, symbol: String, potential: Expr<'g>) -> Formula<'g> {
        let (Names { xi, mu, .. }, graph) = (names, self.model.graph);
        if let Some(lagrangian) = self.energy.general {
            let pairs = self.symbols.momenta.iter().zip(&self.symbols.algebra);
            let pairing = graph.total(Shape::scalar(), pairs.map(|(mu, xi)| mu.dot(*xi)));
            return Formula::new(id, format!("{symbol}, with {mu} = ∂ℓ/∂{xi}"), [pairing - lagrangian + potential]);
        }
        let shape = self.inertia.shape();
        let momentum = graph.symbol(mu, Shape::vector(shape.rows), Role::Letter, Property::General);
        let inertia = graph.symbol("Σ", shape, Role::Letter, Property::Symmetric);
        let momentum = momentum - self.symbols.slope(self.energy.gyroscopic);
        let kinetic = momentum.dot(inertia.inverse() * momentum) / 2;
        Formula::new(id, symbol, [kinetic + potential])
    }
}
