//! The claims of a scene, each with its measured number and its bound.

use crate::round_off;
use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;

/// The claims of a scene, in the order in which they are made.
#[derive(Default)]
pub struct Claims {
    list: Vec<Claim>,
}

/// One claim.
pub struct Claim {
    name: String,
    verdict: Verdict,
    /// The measured number and its reference.
    numbers: String,
    /// Where the bound comes from, or why the claim does not apply.
    reason: String,
}

#[derive(Clone, Copy, PartialEq)]
enum Verdict {
    Holds,
    Fails,
    Skipped,
}

impl Claims {
    /// No claims yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Claims that `measured` ≤ `bound`; `reason` says where the bound comes from. NaN fails.
    pub fn at_most(&mut self, name: &str, measured: f64, bound: f64, reason: &str) {
        self.push(name, measured <= bound, format!("{measured:.2e} ≤ {bound:.2e}"), reason);
    }

    /// Claims something that is true or false, found as `reason` says.
    pub fn holds(&mut self, name: &str, holds: bool, reason: &str) {
        self.push(name, holds, holds.to_string(), reason);
    }

    /// Claims that a defect of something conserved exactly is no more than rounding in the worst case,
    /// [`round_off::worst_case`].
    pub fn round_off(&mut self, name: &str, measured: f64, steps: u64, scale: f64) {
        let walks = round_off::in_random_walks(measured, steps, scale);
        let growth = if scale > 0.0 { format!("rounding; {walks:.2} ε√steps") } else { "rounding".to_owned() };
        self.at_most(name, measured, round_off::worst_case(steps, scale), &growth);
    }

    /// Claims that `value` lies in `interval`, ends included; `digits` are shown.
    pub fn within(&mut self, name: &str, value: f64, interval: RangeInclusive<f64>, digits: usize, reason: &str) {
        let (low, high) = (interval.start(), interval.end());
        let numbers = format!("{value:.digits$} in [{low:.digits$}, {high:.digits$}]");
        self.push(name, interval.contains(&value), numbers, reason);
    }

    /// Says that a claim does not apply to these flags, and why.
    pub fn skip(&mut self, name: &str, reason: &str) {
        let claim =
            Claim { name: name.into(), verdict: Verdict::Skipped, numbers: String::new(), reason: reason.into() };
        self.list.push(claim);
    }

    /// Those that failed.
    pub fn failed(&self) -> impl Iterator<Item = &Claim> {
        self.list.iter().filter(|claim| claim.verdict == Verdict::Fails)
    }

    fn push(&mut self, name: &str, holds: bool, numbers: String, reason: &str) {
        let verdict = if holds { Verdict::Holds } else { Verdict::Fails };
        self.list.push(Claim { name: name.into(), verdict, numbers, reason: reason.into() });
    }
}

impl Display for Claim {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({})", self.name, self.numbers, self.reason)
    }
}

impl Display for Claims {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let width = |text: fn(&Claim) -> &str| self.list.iter().map(|claim| text(claim).chars().count()).max();
        let (name, numbers) = (width(|claim| &claim.name).unwrap_or(0), width(|claim| &claim.numbers).unwrap_or(0));
        write!(f, "claims")?;
        for claim in &self.list {
            let verdict = match claim.verdict {
                Verdict::Holds => "holds",
                Verdict::Fails => "FAILS",
                Verdict::Skipped => "skipped",
            };
            write!(f, "\n  {verdict:<7}  {:<name$}  {:<numbers$}  {}", claim.name, claim.numbers, claim.reason)?;
        }
        Ok(())
    }
}

/// The largest of numbers that are not below zero; NaN where one of them is, so that no claim holds of it.
pub fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |a: f64, b: f64| if a.is_nan() || b <= a { a } else { b };
    numbers.into_iter().fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_numbers_hides_none() {
        assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
        assert_eq!(largest([]), 0.0);
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan() && largest([f64::NAN]).is_nan());
    }

    #[test]
    fn failed_claims_are_named() {
        let mut claims = Claims::new();
        claims.at_most("small", 1.0, 2.0, "by hand");
        claims.at_most("undefined", f64::NAN, 2.0, "by hand");
        claims.within("inside", 5.0, 5.35..=5.41, 2, "published");
        claims.skip("absent", "not here");
        let failed: Vec<String> = claims.failed().map(ToString::to_string).collect();
        assert_eq!(failed, ["undefined: NaN ≤ 2.00e0 (by hand)", "inside: 5.00 in [5.35, 5.41] (published)"]);
        assert!(claims.to_string().contains("skipped  absent"));
    }
}
