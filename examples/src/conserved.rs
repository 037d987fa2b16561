//! Numbers that every step keeps: how far rounding moves them.

use crate::claims::Claims;

/// A number that is conserved exactly but for rounding.
#[derive(Clone, Copy, Debug)]
pub struct Conserved {
    name: &'static str,
    /// By how much a relative error of one moves it.
    scale: f64,
    start: Option<f64>,
    defect: f64,
}

impl Conserved {
    /// Not observed yet. `scale` is the change of it by relative errors of size one in its inputs.
    pub fn new(name: &'static str, scale: f64) -> Self {
        Self { name, scale, start: None, defect: 0.0 }
    }

    /// Takes the next value; returns its change since the first over the scale.
    pub fn observe(&mut self, value: f64) -> f64 {
        let change = value - *self.start.get_or_insert(value);
        self.defect = self.defect.max(change.abs());
        if self.scale > 0.0 { change / self.scale } else { 0.0 }
    }

    /// Claims that it has moved by no more than rounding, [`Claims::round_off`].
    pub fn claim(&self, steps: u64, claims: &mut Claims) {
        claims.round_off(self.name, self.defect, steps, self.scale);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_further_than_rounding_fails() {
        let failed = |moved: f64| {
            let mut number = Conserved::new("a number", 2.0);
            assert_eq!(number.observe(1.0), 0.0);
            assert_eq!(number.observe(1.0 + moved), moved / 2.0);
            number.observe(1.0);
            let mut claims = Claims::new();
            number.claim(10, &mut claims);
            claims.failed().count()
        };
        assert_eq!(failed(0.0), 0);
        assert_eq!(failed(-f64::EPSILON), 0);
        assert_eq!(failed(2.0_f64.powi(-30)), 1);
    }
}
