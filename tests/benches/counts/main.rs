//! Steps of one system, to count their instructions: the difference of those that `-- NAME 1000` and `-- NAME 2000` take, by `valgrind --tool=callgrind`, is that of
//! 1000 steps. Without arguments it prints the names of all systems, which are those of the benchmark `bits`.

#[path = "../bits/combinations.rs"]
mod combinations;
#[path = "../bits/fixtures.rs"]
mod fixtures;
#[path = "../../laws/tests/lanes/lift.rs"]
mod lift;
#[path = "../bits/run.rs"]
mod run;

use clebsch::{Clebsch, Method, Scalar, State, Stepper};
use clebsch_tests::oracle::bits::Bits;
use run::{Start, Task, stepped};

fn main() {
    // cargo adds `--bench`
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let steps = match &arguments[..] {
        [] => Steps { name: None, steps: 0 },
        [name, steps] => Steps { name: Some(name.clone()), steps: steps.parse().expect("a number of steps") },
        _ => panic!("usage: [NAME STEPS]"),
    };
    fixtures::all(&steps);
    combinations::all(&steps);
}

/// Steps of one system.
struct Steps {
    /// The system; none for a list of all names.
    name: Option<String>,
    /// How many.
    steps: usize,
}

impl Task for Steps {
    fn fixture<S>(
        &self,
        name: &str,
        system: S,
        q: S::Configuration,
        h: S::Scalar,
        _conserved: impl Fn(&Stepper<S>, &State<S>) -> String,
    ) where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
    {
        self.combination(name, system, q, h);
    }

    fn combination_by<S, M>(&self, name: &str, system: S, q: S::Configuration, h: S::Scalar)
    where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
        M: Method<S>,
    {
        let Some(wanted) = &self.name else { return println!("{name}") };
        if wanted != name {
            return;
        }
        let start = Start::<S, M>::new(system, q, h);
        if std::hint::black_box(stepped(&start.stepper, start.state(), self.steps)).is_err() {
            eprintln!("{name}: a step fails");
        }
    }
}
