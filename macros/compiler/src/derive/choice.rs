//! What the kernels of a choice of inputs compute: matrices of derivatives over the motions of a configuration and the entries of the input.

use clebsch_symbolic::{Expr, Shape};

use super::matrices::Inserted;
use super::{Bend, Endpoint, InputStep, MatrixForm, MechanicsFormulas, SteeredFormulas, Steering, SystemFormulas};

/// Makes the matrices of a choice.
pub struct Choice<'a, 'g> {
    /// The formulas of the system.
    pub formulas: &'a SystemFormulas<'g>,
    at: Inserted<'g>,
    /// What the inputs are chosen with.
    pub steering: &'a Steering<'g>,
    /// What the inputs do.
    pub step: StepOfChoice<'a, 'g>,
}

/// What inputs do in a step.
#[derive(Copy, Clone)]
pub enum StepOfChoice<'a, 'g> {
    /// They move the configuration by themselves.
    Steered(&'a InputStep<'g>),
    /// They are those of forces, which act at both ends of an edge.
    Forced(&'a Bend<'g>),
}

/// An entry of a symmetric matrix of which the lower triangle is known.
fn symmetric<'g>(lower: &[Vec<Expr<'g>>], i: usize, j: usize) -> Expr<'g> {
    if i >= j { lower[i][j] } else { lower[j][i] }
}

impl<'g> SteeredFormulas<'g> {
    /// What the choice of inputs needs.
    pub fn choice(&self) -> Option<Choice<'_, 'g>> {
        Choice::of(self, StepOfChoice::Steered(&self.step))
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// What a choice of inputs needs, where there is one.
    pub fn choice(&self) -> Option<Choice<'_, 'g>> {
        let bend = self.substeps.first()?.variation.as_ref()?.bend.as_ref()?;
        Choice::of(self, StepOfChoice::Forced(bend))
    }
}

impl<'g> SystemFormulas<'g> {
    /// φ, ∂φ/∂t, ∂φ/∂η, ∂²φ/∂η².
    pub fn endpoint_expanded(&self, endpoint: &Endpoint<'g>) -> Vec<MatrixForm<'g>> {
        let (at, jet, m) = (Inserted::of(self), &endpoint.price, self.model.dimension());
        vec![
            MatrixForm::Whole(jet.value),
            MatrixForm::Whole(endpoint.by_time),
            at.entries(Shape::vector(m), |i, _| jet.slope[i]),
            at.entries(Shape::square(m), |i, j| symmetric(&jet.curvature, i, j)),
        ]
    }
}

impl<'a, 'g> Choice<'a, 'g> {
    fn of(formulas: &'a SystemFormulas<'g>, step: StepOfChoice<'a, 'g>) -> Option<Choice<'a, 'g>> {
        Some(Choice { at: Inserted::of(formulas), steering: formulas.steering.as_ref()?, formulas, step })
    }

    /// The number of motions, and of inputs.
    fn counts(&self) -> (usize, usize) {
        let inputs = self.formulas.model.inputs.iter().map(|leaf| leaf.shape.len());
        (self.formulas.model.dimension(), inputs.sum())
    }

    /// The three blocks of a symmetric matrix over motions and inputs.
    fn curvature(&self, entry: impl Fn(usize, usize) -> Expr<'g>) -> [MatrixForm<'g>; 3] {
        let (m, u) = self.counts();
        [
            self.at.entries(Shape::square(m), &entry),
            self.at.entries(Shape::new(u, m), |i, j| entry(m + i, j)),
            self.at.entries(Shape::square(u), |i, j| entry(m + i, m + j)),
        ]
    }

    /// ℓ, ∂ℓ/∂η, ∂ℓ/∂u.
    fn price_and_slopes(&self) -> [MatrixForm<'g>; 3] {
        let ((m, u), price) = (self.counts(), &self.steering.price);
        [
            MatrixForm::Whole(price.value),
            self.at.entries(Shape::vector(m), |i, _| price.slope[i]),
            self.at.entries(Shape::vector(u), |i, _| price.slope[m + i]),
        ]
    }

    /// ℓ, its slopes and its second derivatives.
    pub fn price_expanded(&self) -> Vec<MatrixForm<'g>> {
        let curvature = self.curvature(|i, j| symmetric(&self.steering.price.curvature, i, j));
        self.price_and_slopes().into_iter().chain(curvature).collect()
    }

    /// A, B, ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives of ℓ + λ·η′.
    pub fn step_expanded(&self, step: &InputStep<'g>) -> Vec<MatrixForm<'g>> {
        let price = &self.steering.price.curvature;
        let curvature = self.curvature(|i, j| symmetric(price, i, j) + symmetric(&step.curvature, i, j));
        let slopes = [&step.by_place, &step.by_input].map(|columns| self.at.columns(columns));
        slopes.into_iter().chain(self.price_and_slopes()).chain(curvature).collect()
    }

    /// ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u.
    pub fn by_input(&self, bend: &Bend<'g>) -> Vec<MatrixForm<'g>> {
        [&bend.before_by_input, &bend.after_by_input].map(|columns| self.at.columns(columns)).to_vec()
    }

    /// The second derivatives of β·F⁺ℓd + κ·F⁻ℓd along both motions of an edge and the inputs.
    pub fn bend_curvature(&self, bend: &Bend<'g>) -> MatrixForm<'g> {
        let (m, u) = self.counts();
        self.at.entries(Shape::square(2 * m + u), |i, j| symmetric(&bend.curvature, i, j))
    }

    /// ± ½ μ·[E_i, E_j].
    pub fn bracket(&self, bend: &Bend<'g>) -> MatrixForm<'g> {
        self.at.entries(Shape::square(self.counts().0), |i, j| bend.bracket[i][j])
    }

    /// ∂/∂h and ∂/∂t of ℓ with what the costate or the multipliers of the step add.
    pub fn price_of_time(&self) -> MatrixForm<'g> {
        let of_step = match self.step {
            StepOfChoice::Steered(step) => step.by_time,
            StepOfChoice::Forced(bend) => bend.by_time,
        };
        self.at.entries(Shape::vector(2), |i, _| self.steering.price_of_time[i] + of_step[i])
    }

    /// a, ∂a/∂η, ∂a/∂u and the second derivatives of z·a.
    pub fn bounds_expanded(&self) -> Vec<MatrixForm<'g>> {
        let ((m, u), bounds, weights) = (self.counts(), &self.steering.bounds, self.steering.weights);
        let c = bounds.len();
        let curvature = self.curvature(|i, j| {
            let bounds = bounds.iter().enumerate();
            let weighted = bounds.map(|(k, bound)| weights.entry(k, 0) * symmetric(&bound.curvature, i, j));
            self.formulas.model.graph.total(Shape::scalar(), weighted)
        });
        let values = [
            self.at.entries(Shape::vector(c), |i, _| bounds[i].value),
            self.at.entries(Shape::new(c, m), |i, j| bounds[i].slope[j]),
            self.at.entries(Shape::new(c, u), |i, j| bounds[i].slope[m + j]),
        ];
        values.into_iter().chain(curvature).collect()
    }
}
