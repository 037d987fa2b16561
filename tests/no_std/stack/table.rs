//! One line for each system and scalar type: the stack of its operations, next to their budgets.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// The columns, and the operations whose largest stands in them. Operations in none of them are in the last.
const COLUMNS: [(&str, &[&str]); 7] = [
    ("stepper", &["stepper", "control", "prior"]),
    ("state", &["state", "staggered", "timed", "cotangent", "project", "resume"]),
    ("step", &["step", "step_with", "step_each", "follow"]),
    ("advance", &["advance", "trajectory"]),
    ("tangent", &["step_tangent", "step_sensitivity"]),
    (
        "plan",
        &[
            "plan",
            "plan_within",
            "plan_along",
            "plan_free_time",
            "estimate",
            "slide",
            "connect",
            "connect_free",
            "connect_free_time",
            "connect_several",
        ],
    ),
    ("other", &[]),
];

const HEAD: &str = "\
# Bytes of stack that an operation may take: half more than it took when this was written, and 1024. Written by `tests/no_std/check renew`.
";

/// Bytes by system, with its scalar type, and by column.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Table(BTreeMap<String, [Option<u64>; COLUMNS.len()]>);

impl Table {
    /// Of the depths of functions `operation.system.scalar`.
    ///
    /// # Errors
    /// Where there are none.
    pub fn of(depths: impl Iterator<Item = (String, u64)>) -> Result<Self, String> {
        let mut table = Self::default();
        for (name, bytes) in depths {
            let (operation, system) = name.split_once('.').ok_or(format!("stack: {name} belongs to no system"))?;
            let column = COLUMNS.iter().position(|(_, operations)| operations.contains(&operation));
            let entry = &mut table.0.entry(system.to_owned()).or_default()[column.unwrap_or(COLUMNS.len() - 1)];
            *entry = (*entry).max(Some(bytes));
        }
        if table.0.is_empty() { Err("stack: nothing is exported".to_owned()) } else { Ok(table) }
    }

    /// Budgets as they were written.
    ///
    /// # Errors
    /// A line that was not.
    pub fn read(text: &str) -> Result<Self, String> {
        let lines = text.lines().filter(|line| !line.starts_with('#') && !line.starts_with("system "));
        let line = |line: &str| {
            let mut words = line.split_whitespace();
            let system = words.next()?.to_owned();
            let entry = |word: &str| if word == "-" { Some(None) } else { word.parse().ok().map(Some) };
            let entries: Vec<_> = words.map(entry).collect::<Option<_>>()?;
            Some((system, entries.try_into().ok()?))
        };
        lines
            .map(|text| line(text).ok_or(format!("stack: no line of budgets: {text}")))
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// The budget: half more and 1024, in multiples of 64. Inlining depends on where the crate stands, and on code that the
    /// operation does not run. It has moved set-ups from 400 bytes to 600 and from 5100 to 6700, and the step of a plan
    /// from 1792 to 2984.
    pub fn budgets(&self) -> String {
        let budget = |bytes: u64| (bytes + bytes / 2 + 1024).next_multiple_of(64);
        let lines = self.0.iter().map(|(system, entries)| (system.clone(), entries.map(|entry| entry.map(budget))));
        format!("{HEAD}{}", Self(lines.collect()))
    }

    /// The system whose step takes most.
    pub fn largest(&self) -> String {
        let of_column = |(column, (name, _)): (usize, &(&str, _))| {
            let (system, bytes) = self
                .0
                .iter()
                .filter_map(|(system, entries)| Some((system, entries[column]?)))
                .max_by_key(|(_, bytes)| *bytes)?;
            Some(format!("{name} {bytes} ({system})"))
        };
        COLUMNS.iter().enumerate().filter_map(of_column).collect::<Vec<_>>().join(", ")
    }

    /// # Errors
    /// Operations that take more than their budget, have none, or have one without being there.
    pub fn check(&self, budgets: &Self) -> Result<(), String> {
        let mut wrong: Vec<String> = Vec::new();
        for (system, entries) in &self.0 {
            let allowed = budgets.0.get(system).copied().unwrap_or_default();
            for (((name, _), entry), allowed) in COLUMNS.iter().zip(entries).zip(allowed) {
                match (entry, allowed) {
                    (Some(bytes), Some(allowed)) if *bytes > allowed => {
                        wrong.push(format!("stack: {name} of {system} takes {bytes} bytes, its budget is {allowed}"));
                    }
                    (Some(bytes), None) => {
                        wrong.push(format!("stack: {name} of {system} takes {bytes} bytes and has no budget"))
                    }
                    _ => {}
                }
            }
        }
        let gone = budgets.0.keys().filter(|system| !self.0.contains_key(*system));
        wrong.extend(gone.map(|system| format!("stack: {system} has budgets, but is not there")));
        if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let width = self.0.keys().map(String::len).max().unwrap_or(0);
        write!(f, "{:width$}", "system")?;
        COLUMNS.iter().try_for_each(|(name, _)| write!(f, " {name:>8}"))?;
        writeln!(f)?;
        for (system, entries) in &self.0 {
            write!(f, "{system:width$}")?;
            for entry in entries {
                write!(f, " {:>8}", entry.map_or("-".to_owned(), |bytes| bytes.to_string()))?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    fn table(step: u64) -> Table {
        of(&[("stepper.heavy_top.f64", 200), ("step.heavy_top.f64", step), ("step_with.heavy_top.f64", 100)])
    }

    fn of(depths: &[(&str, u64)]) -> Table {
        Table::of(depths.iter().map(|(name, bytes)| ((*name).to_owned(), *bytes))).expect("something is exported")
    }

    #[test]
    fn budgets_are_read_as_they_were_written_and_leave_half_more() {
        let budgets = Table::read(&table(1000).budgets()).expect("as written");
        assert_eq!(table(2560).check(&budgets), Ok(()));
        assert!(
            table(2561).check(&budgets).is_err_and(|error| error.contains("step of heavy_top.f64 takes 2561 bytes"))
        );
    }

    #[test]
    fn what_has_no_budget_fails_and_so_does_a_budget_of_nothing() {
        let other = of(&[("step.neumann.f64", 10)]);
        let error = table(10).check(&other).expect_err("neither is known to the other");
        assert!(error.contains("step of heavy_top.f64 takes 100 bytes and has no budget"));
        assert!(error.contains("neumann.f64 has budgets, but is not there"));
    }

    #[test]
    fn nothing_at_all_is_no_table() {
        assert!(Table::of(std::iter::empty()).is_err());
    }
}
