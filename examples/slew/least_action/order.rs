//! The order of three discretizations.

use super::declaration::{Cayley, Discretization, Exponential, FreeBody};
use super::problem::Problem;
use super::row::{converge, refine};
use super::shooting::Shot;
use clebsch::{Declared, Differentiated};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::Table;

/// Solves for the least slew with all discretizations and steps of h, h/2 and h/4; prints and claims their order.
///
/// # Errors
/// The errors of the solver.
pub fn compare(problem: &Problem, shot: &Shot, claims: &mut Claims) -> Result<(), Failure> {
    let mut table = Table::new(["discretization", "off with h", "h/2", "h/4 / rad", "order"]);
    for discretization in Discretization::ALL {
        let convergence = match discretization {
            Discretization::MoserVeselov => of::<Declared>(problem, shot)?,
            Discretization::Cayley => of::<Cayley>(problem, shot)?,
            Discretization::Exponential => of::<Exponential>(problem, shot)?,
        };
        let name = format!("{}: the order, by shooting", discretization.name());
        let Some(convergence) = convergence else {
            claims.skip(&name, "lost on the way to the target: too long a step");
            continue;
        };
        let [coarse, middle, fine] = convergence.errors;
        let slope = format!("{:.3}", (middle / fine).log2());
        let [coarse, middle, fine] = [coarse, middle, fine].map(|error| format!("{error:.3e}"));
        table.row([discretization.name().to_owned(), coarse, middle, fine, slope]);
        convergence.claim(Order::Second, &name, claims);
    }
    say(format_args!("the least slew: distance of its attitudes from the continuous ones\n"));
    say(table);
    Ok(())
}

fn of<M: Differentiated<FreeBody, 3>>(problem: &Problem, shot: &Shot) -> Result<Option<Convergence>, Failure> {
    Ok(converge(problem, shot, &refine::<M>(problem, shot)?))
}
