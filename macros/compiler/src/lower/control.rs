//! The kernels of a choice of inputs: the step that inputs make, price, bounds and the price of the end, each with its derivatives.

use clebsch_symbolic::{Expr, Shape};

use super::kernel::kernel;
use super::variation::{columns, elements, orbit_metric};
use super::{Hoisting, Kernel, Scalar, Scalars, grids, plain};
use crate::derive::{Bend, Formulas, InputStep, Jet, Steering, increments};

/// The kernels of a choice of inputs.
pub struct ControlKernels {
    /// The step that inputs make by themselves; `None` where they are those of forces.
    pub step: Option<StepOfInputs>,
    /// What choosing the inputs of forces needs of an edge.
    pub bend: Option<BendKernels>,
    /// GᵀG of G: ξ ↦ ξ_Q(q).
    pub orbit_metric: Kernel,
    /// J(q, q⁺ − q).
    pub approach: Kernel,
    /// ℓ.
    pub price: Kernel,
    /// Where forces take the inputs: ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives.
    pub price_expanded: Option<Kernel>,
    /// What price and step gain with h and with t.
    pub price_of_time: Kernel,
    /// a.
    pub bounds: Kernel,
    /// a, ∂a/∂η, ∂a/∂u and the second derivatives of z·a.
    pub bounds_expanded: Kernel,
}

/// The kernels of the price of the end.
pub struct EndpointKernels {
    /// φ.
    pub price: Kernel,
    /// φ, ∂φ/∂t, ∂φ/∂η, ∂²φ/∂η².
    pub expanded: Kernel,
}

/// The kernels of F(t, h, q, u).
pub struct StepOfInputs {
    /// F − I.
    pub increment: Kernel,
    /// Φ_F(q).
    pub advance: Kernel,
    /// A, B, ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives of ℓ + λ·η′.
    pub expand: Kernel,
}

/// The kernels of an edge with forces.
pub struct BendKernels {
    /// ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u.
    pub by_input: Kernel,
    /// The second derivatives of β·F⁺ℓd + κ·F⁻ℓd along the motions that leave F as it is, those of q⁺ alone, and the inputs.
    pub curvature: Kernel,
    /// ± ½ μ·[E_i, E_j].
    pub bracket: Kernel,
}

/// The kernels of a choice, where there is one.
pub(super) fn control(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<ControlKernels> {
    let steering = formulas.steering.as_ref()?;
    let mut lowering = Lowered { formulas, elements: elements(formulas), scalars };
    let bend = formulas.substeps.first().and_then(|substep| substep.variation.as_ref()?.bend.as_ref());
    let values: Vec<Expr<'_>> = steering.bounds.iter().map(|bound| bound.value).collect();
    Some(ControlKernels {
        step: steering.step.as_ref().map(|step| lowering.step(step, steering)),
        bend: bend.map(|bend| lowering.bend(bend)),
        orbit_metric: orbit_metric(formulas, lowering.scalars),
        approach: super::stack(lowering.scalars, &steering.approach),
        price: plain(lowering.scalars, &[steering.price.value]),
        price_expanded: bend.map(|_| {
            let outputs = lowering.jet(&steering.price);
            kernel(lowering.scalars, &outputs, Hoisting::Nothing)
        }),
        price_of_time: lowering.price_of_time(steering, bend),
        bounds: super::stack(lowering.scalars, &values),
        bounds_expanded: lowering.bounds(steering),
    })
}

/// The kernels of the price of the end, where there is one.
pub(super) fn endpoint(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<EndpointKernels> {
    let endpoint = formulas.endpoint.as_ref()?;
    let (jet, m) = (&endpoint.price, formulas.model.dimension());
    let mut lowering = Lowered { formulas, elements: elements(formulas), scalars };
    let mut outputs = grids(lowering.scalars, &[jet.value, endpoint.by_time]);
    outputs.push(lowering.block(Shape::vector(m), |i, _| jet.slope[i]));
    outputs.push(lowering.block(Shape::square(m), |i, j| symmetric(&jet.curvature, i, j)));
    Some(EndpointKernels {
        price: plain(lowering.scalars, &[jet.value]),
        expanded: kernel(lowering.scalars, &outputs, Hoisting::Nothing),
    })
}

/// An entry of a symmetric matrix of which the lower triangle is known.
fn symmetric<'g>(lower: &[Vec<Expr<'g>>], i: usize, j: usize) -> Expr<'g> {
    if i >= j { lower[i][j] } else { lower[j][i] }
}

/// What kernels are made with.
struct Lowered<'a, 'g> {
    formulas: &'a Formulas<'g>,
    elements: Vec<(Expr<'g>, Expr<'g>)>,
    scalars: &'a mut Scalars,
}

impl<'g> Lowered<'_, 'g> {
    fn motions(&self) -> usize {
        self.formulas.model.dimension()
    }

    fn inputs(&self) -> usize {
        self.formulas.model.inputs.iter().map(|leaf| leaf.shape.len()).sum()
    }

    /// A matrix of scalar expressions.
    fn block(&mut self, shape: Shape, entry: impl Fn(usize, usize) -> Expr<'g>) -> (Shape, Vec<Scalar>) {
        let entries: Vec<_> = shape.positions().map(|(i, j)| entry(i, j).substitute(&self.elements)).collect();
        (shape, grids(self.scalars, &entries).into_iter().flat_map(|(_, entries)| entries).collect())
    }

    /// The three blocks of a symmetric matrix over motions and inputs.
    fn curvature(&mut self, entry: impl Fn(usize, usize) -> Expr<'g>) -> [(Shape, Vec<Scalar>); 3] {
        let (m, u) = (self.motions(), self.inputs());
        [
            self.block(Shape::square(m), &entry),
            self.block(Shape::new(u, m), |i, j| entry(m + i, j)),
            self.block(Shape::square(u), |i, j| entry(m + i, m + j)),
        ]
    }

    /// ℓ, its slopes and its second derivatives.
    fn jet(&mut self, jet: &Jet<'g>) -> Vec<(Shape, Vec<Scalar>)> {
        let (m, u) = (self.motions(), self.inputs());
        let mut outputs = grids(self.scalars, &[jet.value]);
        outputs.push(self.block(Shape::vector(m), |i, _| jet.slope[i]));
        outputs.push(self.block(Shape::vector(u), |i, _| jet.slope[m + i]));
        outputs.extend(self.curvature(|i, j| symmetric(&jet.curvature, i, j)));
        outputs
    }

    fn step(&mut self, step: &InputStep<'g>, steering: &Steering<'g>) -> StepOfInputs {
        let (m, u, price) = (self.motions(), self.inputs(), &steering.price);
        let elements = increments(self.formulas);
        let images: Vec<_> =
            self.formulas.model.action.iter().map(|image| image.substitute(&elements).expand()).collect();
        let mut outputs = vec![
            columns(&step.by_place, &self.elements, self.scalars),
            columns(&step.by_input, &self.elements, self.scalars),
        ];
        outputs.extend(grids(self.scalars, &[price.value]));
        outputs.push(self.block(Shape::vector(m), |i, _| price.slope[i]));
        outputs.push(self.block(Shape::vector(u), |i, _| price.slope[m + i]));
        outputs.extend(self.curvature(|i, j| symmetric(&price.curvature, i, j) + symmetric(&step.curvature, i, j)));
        StepOfInputs {
            increment: plain(self.scalars, &step.increment),
            advance: plain(self.scalars, &images),
            expand: kernel(self.scalars, &outputs, Hoisting::Nothing),
        }
    }

    fn bend(&mut self, bend: &Bend<'g>) -> BendKernels {
        let whole = 2 * self.motions() + self.inputs();
        let by_input = [&bend.before_by_input, &bend.after_by_input];
        let by_input = by_input.map(|block| columns(block, &self.elements, self.scalars));
        let curvature = self.block(Shape::square(whole), |i, j| symmetric(&bend.curvature, i, j));
        let bracket = self.block(Shape::square(self.motions()), |i, j| bend.bracket[i][j]);
        BendKernels {
            bracket: kernel(self.scalars, &[bracket], Hoisting::Nothing),
            by_input: kernel(self.scalars, &by_input, Hoisting::Nothing),
            curvature: kernel(self.scalars, &[curvature], Hoisting::Nothing),
        }
    }

    /// ∂/∂h and ∂/∂t of ℓ with what the costate or the multipliers of the step add.
    fn price_of_time(&mut self, steering: &Steering<'g>, bend: Option<&Bend<'g>>) -> Kernel {
        let of_step = steering.step.as_ref().map(|step| step.by_time).or(bend.map(|bend| bend.by_time));
        let zero = self.formulas.model.graph.integer(0);
        let of_step = of_step.unwrap_or([zero; 2]);
        let output = self.block(Shape::vector(2), |i, _| steering.price_of_time[i] + of_step[i]);
        kernel(self.scalars, &[output], Hoisting::Nothing)
    }

    fn bounds(&mut self, steering: &Steering<'g>) -> Kernel {
        let (m, u, c) = (self.motions(), self.inputs(), steering.bounds.len());
        let bounds = &steering.bounds;
        let mut outputs = vec![
            self.block(Shape::vector(c), |i, _| bounds[i].value),
            self.block(Shape::new(c, m), |i, j| bounds[i].slope[j]),
            self.block(Shape::new(c, u), |i, j| bounds[i].slope[m + j]),
        ];
        let zero = self.formulas.model.graph.integer(0);
        outputs.extend(self.curvature(|i, j| {
            let weighted = bounds.iter().enumerate();
            let weighted = weighted.map(|(k, bound)| steering.weights.entry(k, 0) * symmetric(&bound.curvature, i, j));
            weighted.fold(zero, |sum, term| sum + term)
        }));
        kernel(self.scalars, &outputs, Hoisting::Nothing)
    }
}
