//! The formulas that a move runs. Elements are increments D = F − I, in the chart, so that values near the identity are
//! computed without cancellation.

use clebsch_symbolic::{Chart, Elements, Expr, Group, IntoElements, IntoList, Property, Role, Shape, both, identity};

use super::equation::DISTRIBUTED;
use super::summation::with_arrival;
use super::{MechanicsFormulas, Substep, SystemFormulas, cayley};
use crate::model::{Factor, Isotropy, Side};

impl<'g> SystemFormulas<'g> {
    /// The replacement of each group element by I + D (D for translations), and of its inverse by that of I + D.
    pub(super) fn increments(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let mut replacements = Vec::new();
        for (k, factor) in self.model.factors.iter().enumerate() {
            let element = from_increment(factor.group, self.symbols.increments[k]);
            let logarithm = (self.symbols.logarithms[k], factor.group.logarithm(element));
            replacements.extend(inverse_by(factor.group, factor.symbol, element));
            replacements.extend([logarithm, (factor.symbol, element)]);
        }
        replacements.extend(self.cayley_letters());
        replacements
    }

    /// The replacements of Cayley coordinates by functions of D.
    fn cayley_letters(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let increments = self.symbols.increments.iter().enumerate();
        increments.filter_map(|(k, d)| cayley::of_turn(&self.model, k, *d)).into_list()
    }

    /// An expression with I + D put in for F, products distributed, with symbols for q⁺ and for Cayley coordinates.
    pub(super) fn near_elements(&self, part: Expr<'g>) -> Expr<'g> {
        let is_element = |(letter, _): &(Expr<'g>, Expr<'g>)| !matches!(letter.role(), Some(Role::Cayley(_)));
        let elements: Vec<_> = self.increments().into_iter().filter(is_element).into_list();
        part.substitute(&elements).expand()
    }

    /// Functions of both ends with I + D put in for F, and q⁺ and Cayley coordinates as functions of D.
    pub(super) fn at_both_ends(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let action = self.at_increments(&self.model.action);
        let images = self.symbols.images.iter().copied().zip(action);
        let late: Vec<_> = images.chain(self.cayley_letters()).into_list();
        parts.each(|part| self.near_elements(*part).substitute(&late))
    }

    /// Expressions with I + D put in for F, products distributed. D(2I + D)⁻¹ stays a product: as I − 2(2I + D)⁻¹ it would
    /// cancel, and 1/h enlarges the rounding.
    pub(super) fn at_increments(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let letters = self.cayley_letters();
        parts.each(|part| self.near_elements(*part).substitute(&letters))
    }
}

/// The replacement of the letters F⁻¹ and F⁻ᵀ by the explicit inverse of an element.
pub(super) fn inverse_by<'g>(group: Group, symbol: Expr<'g>, element: Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    if group.is_translation() || group.is_orthogonal() || group == Group::UnitQuaternions {
        return Vec::new();
    }
    let inverse = group.explicit_inverse(element);
    vec![(symbol.inverse(), inverse), (symbol.transpose().inverse(), inverse.transpose())]
}

pub(super) fn from_increment<'g>(group: Group, increment: Expr<'g>) -> Expr<'g> {
    if group.is_translation() { increment } else { group.identity(increment.graph()) + increment }
}

/// An expression with I + D put in for F, its products distributed.
pub(super) fn inserted<'g>(expression: Expr<'g>, elements: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
    distributed(expression.substitute(elements))
}

/// An expression in I + D, products distributed, so that terms cancel. Products around an inverse are not, since that only
/// makes them many times longer: there F occurs as F − I and F + I. Nor are those of long formulas.
pub(super) fn distributed(inserted: Expr<'_>) -> Expr<'_> {
    if inserted.has_inverse() { inserted } else { inserted.expand_within(DISTRIBUTED) }
}

impl<'g> MechanicsFormulas<'g> {
    /// Functions of the time at which a step starts, of functions of a time that is `later`.
    pub(super) fn as_of_start(&self, later: Expr<'g>, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        parts.each(|part| self.later(*part, later))
    }

    /// The gradients of a part of the discrete Lagrangian with respect to the configuration; none where they vanish.
    ///
    /// Forces in 𝔤* have no covectors, so that a forced system has no kicks of covectors.
    pub(super) fn covector_kick(&self, part: Expr<'g>, later: Expr<'g>) -> Vec<Expr<'g>> {
        let gradients = self.gradients(self.later(part, later));
        let acts = self.model.force.is_none() && gradients.iter().any(|gradient| !identity::vanishes(*gradient));
        if acts { gradients } else { Vec::new() }
    }

    /// ∂_q K of a cost that couples, at F = I + D; none of another. A function of both ends has ∂_q K + (TΦ_F)* ∂_q⁺ K.
    pub(super) fn coupled_kick(&self, substep: &Substep<'g>) -> Vec<Expr<'g>> {
        if !substep.lagrangian.couples || self.model.force.is_some() {
            return Vec::new();
        }
        let symbols = &self.symbols;
        let by_ends = substep.lagrangian.by_ends.substitute(&cayley::replacements(&self.model));
        let pairs = self.model.action.iter().zip(&symbols.covectors).map(|(image, p)| p.dot(*image));
        let pulled = self.gradients(self.model.graph.total(Shape::scalar(), pairs));
        let arrived = symbols.images.each(|image| by_ends.gradient(*image));
        let covectors: Vec<_> = symbols.covectors.iter().copied().zip(arrived).into_list();
        let own = self.gradients(by_ends).into_iter().zip(pulled);
        let kick = own.map(|(own, pulled)| own + pulled.substitute(&covectors));
        let images: Vec<_> = symbols.images.iter().copied().zip(self.model.action.iter().copied()).into_list();
        let (letters, moved) = (self.cayley_letters(), self.increments());
        kick.map(|part| part.substitute(&images).substitute(&letters).substitute(&moved)).into_list()
    }

    /// A force that depends on the velocity, in the chart: with its elements, and with their logarithms.
    pub(super) fn in_chart(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let symbols = &self.symbols;
        let mut elements = Vec::new();
        for (k, factor) in self.model.factors.iter().enumerate() {
            let element = self.chart_element(k);
            let logarithm = match symbols.charts[k] {
                Chart::Exponential => symbols.stacked_coordinates(k),
                _ => factor.group.logarithm(element),
            };
            elements.extend([(factor.symbol, element), (symbols.logarithms[k], logarithm)]);
        }
        parts.each(|part| part.substitute(&elements).expand())
    }

    /// F − I of each factor, from the chart coordinates. The rotation with the Gibbs vector x/w has 2 (w x^ + (x^)²)/(w² + |x|²).
    /// Its quaternion has (x, −|x|²/(w + n))/n with n² = w² + |x|².
    pub(super) fn chart_increments(&self) -> Vec<Expr<'g>> {
        let increment = |(k, factor): (usize, &Factor<'g>)| {
            let Some(w) = self.weight(k) else { return self.chart_increment(k) };
            let x = self.symbols.stacked_coordinates(k);
            if factor.group != Group::UnitQuaternions {
                let [increment, scale] = Chart::scaled_increment(x, w);
                return scale * increment;
            }
            let square = w * w + x.dot(x);
            let size = square.sqrt();
            let scalar = -(x.dot(x) / (square + w * size));
            self.model.graph.below(&[x / size, scalar])
        };
        self.model.factors.iter().enumerate().map(increment).into_list()
    }

    /// The factors whose increments are made as c·D: rotations in space with known x/w. The products with D do not wait for the
    /// division in c then.
    pub fn scaled(&self) -> Vec<usize> {
        let serves = !self.turns_momenta() && !self.turns_whole() && self.field.is_none();
        let is_scaled = |k: &usize| self.model.factors[*k].group == Group::SpecialOrthogonal(3);
        self.weighted().into_iter().filter(|k| serves && is_scaled(k)).into_list()
    }

    /// D of each factor and c of those that are [scaled](Self::scaled), from the chart coordinates; none if no factor is.
    pub(super) fn scaled_increments(&self) -> Vec<Expr<'g>> {
        let scaled = self.scaled();
        let mut increments = if scaled.is_empty() { Vec::new() } else { self.chart_increments() };
        for k in scaled {
            // by construction: scaled factors have weights
            let Some(w) = self.weight(k) else { continue };
            let [increment, scale] = Chart::scaled_increment(self.symbols.stacked_coordinates(k), w);
            increments[k] = increment;
            increments.push(scale);
        }
        increments
    }

    /// The same as [`advance`](Self::advance) with c·D for D; none if no factor is [scaled](Self::scaled).
    pub(super) fn scaled_advance(&self) -> Vec<Expr<'g>> {
        if self.scaled().is_empty() { Vec::new() } else { self.by_scaled(self.advance()) }
    }

    /// Functions with c·D for D where factors are [scaled](Self::scaled).
    fn by_scaled(&self, moved: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
        let (graph, increments) = (self.model.graph, &self.symbols.increments);
        let scaled = self.scaled().into_iter().enumerate().map(|(number, k)| {
            let scale = graph.symbol("c", Shape::scalar(), Role::IncrementScale(number), Property::General);
            (increments[k], scale * increments[k])
        });
        let scaled = scaled.into_list();
        moved.into_each(|moved| moved.substitute(&scaled))
    }

    /// q⁺ = Φ_F(q) with F = I + D: for linear actions q + D q, without cancellation. With compensated sums, the
    /// increment of q.
    pub(super) fn advance(&self) -> Vec<Expr<'g>> {
        if !self.is_compensated() {
            return self.at_increments(&self.model.action);
        }
        let inverses = self.inverses();
        self.displacements().into_each(|added| added.substitute(&inverses))
    }

    /// M⁺ = Ad*_{F⁻¹} M for a left action, Ad*_F M for a right one, with F = I + D and the momentum M of ∂_F K. With
    /// compensated sums, the increment of the momentum that was solved for. `None` where M does not change.
    pub(super) fn momentum_after(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        self.momentum_by_increments(substep).map(|momentum| self.by_scaled(momentum))
    }

    /// The same with D for c·D.
    fn momentum_by_increments(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        if self.is_compensated() {
            return self.momentum_increments(substep);
        }
        if self.small_change(substep).is_some() {
            return self.carried_on(substep).map(|carried| self.at_both_ends(&carried));
        }
        // the move is linear in M: M, which may be long, is substituted last
        let momenta = self.momenta_of_move(substep)?;
        let momenta: Vec<_> = self.symbols.momenta.iter().copied().zip(self.at_both_ends(&momenta)).into_list();
        let carried = self.carried_by_move(substep).into_iter().enumerate();
        let turned = |(k, carried)| self.turned(substep, k).unwrap_or_else(|| self.at_increments(&[carried])[0]);
        let carried = carried.map(turned).into_list();
        let carried = carried.into_each(|carried| carried.substitute(&momenta));
        let arrival = substep.coupling.as_ref().map(|coupling| self.at_both_ends(&coupling.arrival));
        Some(with_arrival(carried, arrival.as_deref()))
    }

    /// M⁺ of M = μ by chart coordinates, where that is shorter than by the increment of the group element.
    fn turned(&self, substep: &Substep<'g>, k: usize) -> Option<Expr<'g>> {
        let (factor, symbols) = (&self.model.factors[k], &self.symbols);
        if substep.unchanged[k] || substep.coupling.is_some() || self.field.is_some() || self.turns_whole() {
            return None;
        }
        let x = symbols.stacked_coordinates(k);
        let x = if factor.side == Side::Left { -x } else { x };
        symbols.charts[k].coadjoint(factor.group, x, self.weight(k), symbols.momenta[k])
    }

    /// Whether the momentum after a move is told by chart coordinates.
    pub fn turns_momenta(&self) -> bool {
        let substeps = self.substeps.iter().take(self.stepped);
        let mut turned =
            substeps.flat_map(|substep| (0..self.model.factors.len()).map(move |k| self.turned(substep, k)));
        !self.is_compensated() && turned.any(|turned| turned.is_some())
    }

    /// M⁺ of a single rotation in four dimensions in words, as its entries are long.
    pub(super) fn turned_in_four_space(&self, substep: &Substep<'g>, mu: &str, x: &str) -> Option<[String; 2]> {
        let [factor] = &self.model.factors[..] else { return None };
        let is_told = factor.group == Group::SpecialOrthogonal(4) && !self.is_compensated() && substep.rest.is_none();
        self.turned(substep, 0).filter(|_| is_told)?;
        let commuted = |momentum: &str| match factor.side {
            Side::Left => format!("[{x}, {momentum}]"),
            Side::Right => format!("[{momentum}, {x}]"),
        };
        let [first, second] = both([mu, "c"], commuted);
        Some([
            format!("{mu} + 2·(c − p·⋆c + {second})/(1 + |{x}|² + p²), c = {first}, p = Pf {x}"),
            format!(
                "{mu} + 2 (c - p \\star c + {second})/(1 + |{x}|^2 + p^2),\\quad c = {first},\\quad p = \\operatorname{{Pf}} {x}"
            ),
        ])
    }

    /// w of chart coordinates x/w.
    fn weight(&self, k: usize) -> Option<Expr<'g>> {
        let number = self.weighted().iter().position(|&other| other == k)?;
        Some(self.model.graph.symbol("w", Shape::scalar(), Role::ChartWeight(number), Property::General))
    }

    /// q⁺ = q + α x_Q(q) + β x_Q(x_Q(q)) of vectors that turn in one plane, without the matrix of the turn.
    ///
    /// For each leaf from q and the chart coordinates, or q⁺ − q with compensated sums. `None` if a leaf is no vector
    /// or does not move like that.
    ///
    /// The increments D = αZ + βZ² of the group elements are applied one Z after the other, as cross products in space.
    pub fn displaced(&self) -> Option<Vec<Expr<'g>>> {
        (0..self.model.configurations.len()).map(|leaf| self.displaced_leaf(leaf)).collect()
    }

    fn displaced_leaf(&self, leaf: usize) -> Option<Expr<'g>> {
        let (model, symbols) = (&self.model, &self.symbols);
        let (q, image) = (model.configurations[leaf].symbol, model.action[leaf]);
        if q.shape().columns != 1 {
            return None;
        }
        let mut movers = (0..model.factors.len()).filter(|&k| image.depends_on(model.factors[k].symbol));
        let Some(k) = movers.next() else { return Some(if self.is_compensated() { image - q } else { image }) };
        if movers.next().is_some() {
            return None;
        }
        let group = model.factors[k].group;
        let x = symbols.stacked_coordinates(k);
        let (alpha, beta) = symbols.charts[k].in_one_plane(&symbols.coordinates(k))?;
        let moved = |q: Expr<'g>| {
            self.generator[leaf].substitute(&[(symbols.algebra[k], x), (model.configurations[leaf].symbol, q)])
        };
        let (once, twice) = (moved(q), moved(moved(q)));
        // affine in Z and Z²: the step size and the time stand for two free numbers
        let (z, free) = (group.wedge(x), [model.step_size, model.time]);
        let element = group.identity(model.graph) + free[0] * z + free[1] * (z * z);
        let turned = image.substitute(&[(model.factors[k].symbol, element)]);
        if !identity::equal(&[turned], &[q + free[0] * once + free[1] * twice]) {
            return None;
        }
        let added = if self.is_perpendicular(k, leaf, twice) {
            alpha * once - (beta * x.norm_squared()) * q
        } else {
            alpha * once + beta * twice
        };
        Some(if self.is_compensated() { added } else { q + added })
    }

    /// Whether x_Q(x_Q(q)) = −|x|² q, because x is a multiple of a momentum J(q, p): on a sphere, turned about an axis perpendicular to q.
    fn is_perpendicular(&self, k: usize, leaf: usize, twice: Expr<'g>) -> bool {
        let (model, symbols) = (&self.model, &self.symbols);
        // forces in 𝔤*, and the momentum of a cost at rest, need not be momenta of that kind
        let is_momentum = symbols.charts[k] == Chart::Sine
            && model.isotropy == Isotropy::Fixed
            && model.force.is_none()
            && self.substeps.iter().all(|substep| substep.rest.is_none());
        let momentum = self.momentum_map[k];
        let seen = twice.substitute(&[(symbols.stacked_coordinates(k), momentum)]);
        let q = model.configurations[leaf].symbol;
        is_momentum && identity::equal(&[seen], &[-(momentum.norm_squared() * q)])
    }
}
