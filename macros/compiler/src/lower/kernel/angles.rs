//! Angles whose sine and cosine a kernel takes both: one call finds them together.

use clebsch_symbolic::{Function, Interner, Shape, work};

use super::{Builder, Operation};
use crate::lower::entries::Grid;
use crate::lower::scalar::Output;
use crate::lower::{Callee, Scalar, ScalarNode};

impl Builder<'_, '_> {
    /// The angles whose sine and cosine the outputs need both. Values that are taken out are made elsewhere.
    pub(super) fn angles_of(&self, outputs: &[Grid]) -> Vec<Scalar> {
        let mut angles = self.scalars.angles.clone();
        if angles.is_empty() {
            return angles;
        }
        let (mut sines, mut cosines) = (Vec::new(), Vec::new());
        let mut met: Interner<Scalar> = Interner::default();
        let mut waiting: Vec<Scalar> = outputs.iter().flat_map(|grid| &grid.entries).copied().collect();
        while let Some(scalar) = waiting.pop() {
            work::spend(1);
            if self.is_hoisted(scalar) || !met.intern(scalar).1 {
                continue;
            }
            match self.scalars.node(scalar) {
                ScalarNode::Function(Function::Sin, angle) => sines.push(*angle),
                ScalarNode::Function(Function::Cos, angle) => cosines.push(*angle),
                _ => {}
            }
            self.scalars.each_part(scalar, |part| waiting.push(part));
        }
        angles.retain(|angle| sines.contains(angle) && cosines.contains(angle));
        angles
    }

    /// The sine or the cosine of such an angle.
    pub(super) fn sine_or_cosine(&mut self, function: Function, angle: Scalar) -> Operation {
        let argument = (Shape::scalar(), vec![self.convert(angle)]);
        let both = self.intern(Operation::Call(Callee::SineAndCosine, vec![argument]));
        let row = usize::from(function == Function::Cos);
        Operation::Output(both, Callee::SineAndCosine, Output { leaf: 0, row, column: 0, shape: Shape::new(2, 1) })
    }
}
