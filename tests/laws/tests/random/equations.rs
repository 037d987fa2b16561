//! Random equations of constraints.

use clebsch_tests::oracle::precise::matrix::Matrix;

use crate::formula::{Formula, Place};
use crate::generator::Generator;
use crate::problem::{Equation, Equations};

impl Generator<'_> {
    /// Equations of the velocity, of the configuration, or of both; mostly fewer than components of the velocity.
    pub fn constraint(&mut self) {
        let components: usize = self.made.factors.iter().map(|factor| factor.group.group.basis.len()).sum();
        let most = match self.pick(10) {
            0 => components,
            _ => components.saturating_sub(1).clamp(1, 3),
        };
        let (of_velocity, of_places) = [(1, 0), (1, 0), (0, 1), (1, 1)][self.pick(4)];
        let mut left = most;
        for (count, is_of_velocity) in [(of_places, false), (of_velocity, true)] {
            let mut all = Vec::new();
            for _ in 0..count * (1 + self.pick(2)) {
                if left == 0 {
                    break;
                }
                let equation = if is_of_velocity { self.of_velocity(left) } else { self.of_places() };
                left = left.saturating_sub(self.height(&equation));
                all.push(equation);
            }
            if !all.is_empty() {
                self.made.constraint.push(Equations { of_velocity: is_of_velocity, all });
            }
        }
        // either kind may come first
        if self.pick(2) == 0 {
            self.made.constraint.reverse();
        }
    }

    /// How many scalar equations it is.
    fn height(&self, equation: &Equation) -> usize {
        if equation.each {
            return self.made.factors.len();
        }
        let is_pair = |part: &Formula| matches!(part, Formula::Field(k) if self.made.fields[*k].value.shape().0 == 2);
        if equation.sides[0].mentions(&is_pair) { 2 } else { 1 }
    }

    fn of_velocity(&mut self, most: usize) -> Equation {
        let dimension = self.made.factors[0].group.group.basis.len();
        // the same for both factors of an array
        if self.made.array && most > 1 && self.pick(2) == 0 {
            let coefficient = self.number_but_zero() + self.variable_of(0) * Formula::Number(0.25);
            let left = coefficient * self.component(0) + self.component(0) * self.number();
            return Equation { sides: [left, Formula::Number(0.0)], each: true };
        }
        // two rows at once
        if most > 1 && dimension > 2 && self.pick(5) == 0 {
            let rows = self.matrix(2, dimension);
            let left = self.field("", rows) * Formula::Velocity(0);
            let value = self.matrix(2, 1) * 0.25;
            let value = self.field("", value);
            let scale = self.variable();
            return Equation { sides: [left, value * scale], each: false };
        }
        let mut left: Option<Formula> = None;
        for at in 0..1 + self.pick(3) {
            let factor = self.pick(self.made.factors.len());
            let (coefficient, component) = (self.coefficient(at == 0), self.component(factor));
            let term = coefficient * component;
            left = Some(match left {
                Some(left) => left + term,
                None => term,
            });
        }
        let right = match self.pick(6) {
            0..=2 => Formula::Number(0.0),
            3 => self.number() * Formula::Number(0.25),
            4 => self.variable() * Formula::Number(0.25),
            _ => self.variable() * Formula::Time * Formula::Number(0.5),
        };
        Equation { sides: [left.expect("a term"), right], each: false }
    }

    /// A component of the velocity of a factor.
    fn component(&mut self, factor: usize) -> Formula {
        let dimension = self.made.factors[factor].group.group.basis.len();
        let (v, at) = (Box::new(Formula::Velocity(factor)), self.pick(dimension));
        if dimension <= 4 { Formula::Coordinate(v, at) } else { Formula::Entry(v, at, 0) }
    }

    /// A function of time and configuration. The first of a row is not zero at the start, in most cases.
    fn coefficient(&mut self, is_first: bool) -> Formula {
        let number = self.number_but_zero();
        match self.pick(8) {
            0..=2 => number,
            3 => number + self.variable() * Formula::Number(0.5),
            4 => number + self.variable() * self.variable(),
            5 => number + Formula::Time * Formula::Number(0.5),
            6 => number / (Formula::Number(2.0) + self.variable().power(2)),
            _ if is_first => number + self.variable().power(2),
            _ => self.variable(),
        }
    }

    fn number_but_zero(&mut self) -> Formula {
        Formula::Number((1.0 + self.pick(8) as f64) / 8.0)
    }

    /// An entry of one leaf.
    fn variable_of(&mut self, leaf: usize) -> Formula {
        loop {
            let variable = self.variable();
            let is_own = |part: &Formula| matches!(part, Formula::Point(k) if *k == leaf);
            if variable.mentions(&is_own) {
                return variable;
            }
        }
    }

    /// A function of the configuration with its value at the start, which may grow in time.
    fn of_places(&mut self) -> Equation {
        let mut place = self.number_but_zero() * self.variable();
        for _ in 0..self.pick(3) {
            let more = match self.pick(3) {
                0 => self.variable().power(2) * self.number(),
                1 => self.variable() * self.variable(),
                _ => self.number() * self.variable(),
            };
            place = place + more;
        }
        let fields: Vec<Matrix<f64>> = self.made.fields.iter().map(|field| field.value.clone()).collect();
        let q: Vec<Matrix<f64>> = self.made.leaves.iter().map(|leaf| leaf.start.clone()).collect();
        let value = place.value(&Place { fields: &fields, t: 0.0, h: 0.0, q: &q, f: &[], xi: &[] });
        let mut right = self.field("", value);
        if self.pick(4) == 0 {
            right = right + Formula::Time * Formula::Number(0.25);
        }
        Equation { sides: [place, right], each: false }
    }
}
