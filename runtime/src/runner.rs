//! `proptest!` as in the library, but all properties have one runner. The library compiles another for each.
//!
//! The unit tests of this crate include it, and the test `properties` of `clebsch-laws`.

use proptest::prelude::*;
use proptest::test_runner::{TestCaseResult, TestRunner, contextualize_config};
use std::boxed::Box;
use std::fmt::Debug;

/// A property of drawn values, whatever their types.
trait Case: Debug {
    fn holds(self: Box<Self>) -> TestCaseResult;
}

/// The values, with their names and their property. A failure shows the first two.
struct Drawn<T> {
    names: &'static str,
    values: T,
    property: fn(T) -> TestCaseResult,
}

impl<T: Debug> Debug for Drawn<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} = ", self.names)?;
        self.values.fmt(f)
    }
}

impl<T: Debug> Case for Drawn<T> {
    fn holds(self: Box<Self>) -> TestCaseResult {
        (self.property)(self.values)
    }
}

/// Whether loops that are no property are long too: where the variable `PROPTEST_CASES` asks for 256 cases or more.
#[allow(dead_code)]
pub(crate) fn is_long() -> bool {
    std::env::var("PROPTEST_CASES").is_ok_and(|cases| cases.parse().is_ok_and(|cases: u32| cases >= 256))
}

/// Draws cases until one fails, and panics with the smallest of those that do.
#[track_caller]
pub(crate) fn check<S>(
    config: ProptestConfig,
    names: &'static str,
    strategy: S,
    property: fn(S::Value) -> TestCaseResult,
) where
    S: Strategy<Value: 'static> + 'static,
{
    let cases = strategy.prop_map(move |values| Box::new(Drawn { names, values, property }) as Box<dyn Case>);
    run(config, &cases.boxed());
}

#[track_caller]
fn run(config: ProptestConfig, cases: &BoxedStrategy<Box<dyn Case>>) {
    // variables of the environment go before the numbers of a test, as in the library
    let mut runner = TestRunner::new(contextualize_config(config));
    if let Err(error) = runner.run(cases, |case| case.holds()) {
        panic!("{error}\n{runner}");
    }
}

/// Properties as tests, with the syntax of the library.
macro_rules! proptest {
    (#![proptest_config($config:expr)] $(
        $(#[$meta:meta])*
        fn $name:ident($($value:pat in $strategy:expr),+ $(,)?) $body:block
    )*) => { $(
        $(#[$meta])*
        fn $name() {
            let config = ProptestConfig {
                source_file: Some(file!()),
                test_name: Some(concat!(module_path!(), "::", stringify!($name))),
                ..$config
            };
            let names = stringify!($($value),+);
            $crate::runner::check(config, names, ($($strategy,)+), |($($value,)+)| {
                let (): () = $body;
                Ok(())
            });
        }
    )* };
    ($($properties:tt)*) => {
        $crate::runner::proptest! { #![proptest_config(ProptestConfig::default())] $($properties)* }
    };
}

pub(crate) use proptest;
