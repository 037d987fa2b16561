//! Flags that every scene takes, and parsers whose errors name the mistake in a number.

use crate::scene::Failure;
use clap::{Args, Parser, ValueEnum};
use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// The differences between the scenes in the flags that all of them take.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// The name of the example.
    pub name: &'static str,
    /// Default of `--step-size`.
    pub step_size: &'static str,
    /// Unit of `--step-size` and of the column `time`.
    pub time_unit: &'static str,
    /// Default of `--steps`.
    pub steps: &'static str,
    /// Default of `--order`.
    pub order: &'static str,
    /// The meaning of `--order` here.
    pub order_note: &'static str,
    /// The columns of `--csv` after `step,time`, with units.
    pub columns_note: &'static str,
}

/// The flags that every scene takes.
#[derive(Args, Clone, Debug)]
pub struct Run {
    /// Length of a step
    #[arg(long, value_name = "H", value_parser = positive, allow_hyphen_values = true, default_value = "0.01")]
    pub step_size: f64,
    /// Number of steps
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true, default_value = "1000")]
    pub steps: u64,
    /// Order of accuracy
    #[arg(long, value_name = "ORDER", default_value = "2")]
    pub order: Order,
    /// Write the trajectory to FILE
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write only every K-th step to the CSV file
    #[arg(long, value_name = "K", value_parser = count, allow_hyphen_values = true, default_value = "1")]
    pub every: u64,
    /// Draw the figure to FILE, as SVG [default: `figures` under cargo's target folder]
    #[arg(long, value_name = "FILE")]
    pub figure: Option<PathBuf>,
}

impl Run {
    /// The time of a step; all steps have the same length, so nothing accumulates.
    pub fn time(&self, step: u64) -> f64 {
        step as f64 * self.step_size
    }

    /// The time of the last step.
    pub fn duration(&self) -> f64 {
        self.time(self.steps)
    }

    /// For scenes of a system without steps of order 1.
    ///
    /// # Errors
    /// [`Failure::Flags`] for `--order 1`.
    pub fn refuse_first_order(&self, scene: &Scene) -> Result<(), Failure> {
        if self.order == Order::First {
            return Err(Failure::Flags(format!("--order 1: {}", scene.order_note)));
        }
        Ok(())
    }

    /// The same time in steps of a part 1/`part`.
    #[must_use]
    pub fn refined(&self, part: u64) -> Self {
        Self { step_size: self.step_size / part as f64, steps: self.steps * part, ..self.clone() }
    }

    /// Whether `step` is written to the CSV file.
    pub fn writes(&self, step: u64) -> bool {
        self.csv.is_some() && step.is_multiple_of(self.every)
    }

    /// Whether `step` is one of about `count` evenly spaced ones, the first and the last among them.
    pub fn samples(&self, step: u64, count: u64) -> bool {
        step == self.steps || step.is_multiple_of(self.steps.div_ceil(count.max(1)))
    }
}

/// Order of accuracy. It is a dial of the declaration, so a scene that offers both has two types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Order {
    /// ℓd = K − hV(Φ_F q): drift, then kick.
    #[value(name = "1", help = None)]
    First,
    /// Half of the potential at each end of a step: time-symmetric.
    #[value(name = "2", help = None)]
    Second,
}

impl Display for Order {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Self::First { "1" } else { "2" })
    }
}

/// Reads the command line; on `--help` or on a mistake it prints and exits.
pub fn parse<F: Parser>(scene: &Scene) -> F {
    let step_size = format!("Length of a step, {}", scene.time_unit);
    let order = format!("Order of accuracy: {}", scene.order_note);
    let csv = format!("Write the trajectory to FILE: step, time ({}), {}", scene.time_unit, scene.columns_note);
    let command = F::command()
        .name(scene.name)
        .mut_arg("step_size", |arg| arg.default_value(scene.step_size).help(step_size))
        .mut_arg("steps", |arg| arg.default_value(scene.steps))
        .mut_arg("order", |arg| arg.default_value(scene.order).help(order))
        .mut_arg("csv", |arg| arg.help(csv));
    F::from_arg_matches(&command.get_matches()).unwrap_or_else(|error| error.exit())
}

/// A finite number.
pub fn finite(text: &str) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| format!("`{}` is not a number", text.trim()))?;
    if number.is_finite() { Ok(number) } else { Err(format!("`{}` is not finite", text.trim())) }
}

/// A finite number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number > 0.0 { Ok(number) } else { Err(format!("`{}` is not above zero", text.trim())) }
}

/// A whole number above zero.
pub fn count(text: &str) -> Result<u64, String> {
    match text.trim().parse() {
        Ok(0) => Err("at least 1 is needed".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err(format!("`{}` is not a whole number above zero", text.trim())),
    }
}

/// A whole number in a range, ends included.
pub fn count_within(text: &str, range: RangeInclusive<usize>) -> Result<usize, String> {
    let number = count(text)?;
    let within = usize::try_from(number).ok().filter(|number| range.contains(number));
    within.ok_or_else(|| format!("`{number}` is not from {} to {}", range.start(), range.end()))
}

/// `N` finite numbers, as in `1,-2.5,3e-2`.
pub fn finite_list<const N: usize>(text: &str) -> Result<[f64; N], String> {
    list(text, finite)
}

/// `N` finite numbers above zero.
pub fn positive_list<const N: usize>(text: &str) -> Result<[f64; N], String> {
    list(text, positive)
}

/// Any number of finite numbers.
pub fn finite_numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(finite).collect()
}

/// Principal moments of inertia of a body that can exist: above zero, none larger than the sum of the other two.
pub fn moments_of_inertia(text: &str) -> Result<[f64; 3], String> {
    let moments = positive_list::<3>(text)?;
    let sum: f64 = moments.iter().sum();
    match moments.iter().find(|&&moment| moment > sum - moment) {
        Some(largest) => Err(format!("no body has these moments: {largest} is more than the sum of the other two")),
        None => Ok(moments),
    }
}

fn list<const N: usize>(text: &str, parse: fn(&str) -> Result<f64, String>) -> Result<[f64; N], String> {
    let numbers = text.split(',').map(parse).collect::<Result<Vec<f64>, String>>()?;
    let found = numbers.len();
    numbers.try_into().map_err(|_| format!("{N} numbers separated by commas are needed, {found} were given"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_read_and_mistakes_named() {
        assert_eq!(finite_list::<3>("1, -2.5,3e-2"), Ok([1.0, -2.5, 0.03]));
        assert_eq!(finite_list::<3>("1,2").unwrap_err(), "3 numbers separated by commas are needed, 2 were given");
        assert_eq!(finite_list::<2>("1,x").unwrap_err(), "`x` is not a number");
        assert_eq!(finite_list::<2>("1,nan").unwrap_err(), "`nan` is not finite");
        assert_eq!(positive_list::<2>("1,-1").unwrap_err(), "`-1` is not above zero");
        assert_eq!(count("0").unwrap_err(), "at least 1 is needed");
        assert!(moments_of_inertia("1,2,3").is_ok(), "a flat body exists");
        assert!(moments_of_inertia("1,2,4").unwrap_err().contains("4 is more than"));
    }
}
