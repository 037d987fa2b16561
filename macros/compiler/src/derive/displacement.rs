//! Vectors that turn in one plane move without the matrix of the turn: q⁺ = q + α x_Q(q) + β x_Q(x_Q(q)).

use clebsch_symbolic::{Chart, Expr, identity};

use super::MechanicsFormulas;
use crate::model::Isotropy;

impl<'g> MechanicsFormulas<'g> {
    /// q⁺ for each leaf from q and the chart coordinates, or q⁺ − q where sums keep their rests; `None` where a leaf is no vector or does not
    /// move like that.
    ///
    /// The increments D = αZ + βZ² of the group elements are applied one Z after the other, as cross products in space.
    pub fn displaced(&self) -> Option<Vec<Expr<'g>>> {
        (0..self.model.configurations.len()).map(|leaf| displaced_leaf(self, leaf)).collect()
    }
}

fn displaced_leaf<'g>(formulas: &MechanicsFormulas<'g>, leaf: usize) -> Option<Expr<'g>> {
    let (model, symbols) = (&formulas.model, &formulas.symbols);
    let (q, image) = (model.configurations[leaf].symbol, model.action[leaf]);
    if q.shape().columns != 1 {
        return None;
    }
    let mut movers = (0..model.factors.len()).filter(|&k| image.depends_on(model.factors[k].symbol));
    let Some(k) = movers.next() else { return Some(if formulas.is_compensated() { image - q } else { image }) };
    if movers.next().is_some() {
        return None;
    }
    let group = model.factors[k].group;
    let x = symbols.stacked_coordinates(k);
    let (alpha, beta) = symbols.charts[k].in_one_plane(&symbols.coordinates(k))?;
    let moved = |q: Expr<'g>| {
        formulas.generator[leaf].substitute(&[(symbols.algebra[k], x), (model.configurations[leaf].symbol, q)])
    };
    let (once, twice) = (moved(q), moved(moved(q)));
    // affine in Z and Z²: the step size and the time stand for two free numbers
    let (z, free) = (group.wedge(x), [model.step_size, model.time]);
    let element = group.identity(model.graph) + free[0] * z + free[1] * (z * z);
    let turned = image.substitute(&[(model.factors[k].symbol, element)]);
    if !identity::equal(&[turned], &[q + free[0] * once + free[1] * twice]) {
        return None;
    }
    let added = if is_perpendicular(formulas, k, leaf, twice) {
        alpha * once - (beta * x.norm_squared()) * q
    } else {
        alpha * once + beta * twice
    };
    Some(if formulas.is_compensated() { added } else { q + added })
}

/// Whether x_Q(x_Q(q)) = −|x|² q, because x is a multiple of a momentum J(q, p): on a sphere, turned about an axis perpendicular to q.
fn is_perpendicular<'g>(formulas: &MechanicsFormulas<'g>, k: usize, leaf: usize, twice: Expr<'g>) -> bool {
    let (model, symbols) = (&formulas.model, &formulas.symbols);
    // forces in 𝔤*, and what a cost gives at rest, need not be momenta of that kind
    let is_momentum = symbols.charts[k] == Chart::Sine
        && model.isotropy == Isotropy::Fixed
        && model.force.is_none()
        && formulas.substeps.iter().all(|substep| substep.rest.is_none());
    let momentum = formulas.momentum_map[k];
    let seen = twice.substitute(&[(symbols.stacked_coordinates(k), momentum)]);
    let q = model.configurations[leaf].symbol;
    is_momentum && identity::equal(&[seen], &[-(momentum.norm_squared() * q)])
}
