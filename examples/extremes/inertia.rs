//! Shapes of bodies: needles, discs, nearly and exactly symmetric ones, and such that no mass distribution has.

use crate::declarations::bodies;
use crate::map::{Map, SCALARS, outcome, size};
use crate::probe::Dial;
use crate::setup::Setup;
use crate::step_sizes::heading;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use nalgebra::Vector3;

const SECTION: &str = "inertia";
/// h|ω|
const ANGLE: f64 = 0.05;
/// Principal moments.
const SHAPES: [(&str, [f64; 3]); 17] = [
    ("sphere", [1.0, 1.0, 1.0]),
    ("axisymmetric, oblate", [1.0, 1.0, 1.5]),
    ("axisymmetric, prolate", [1.0, 1.0, 0.25]),
    ("off symmetry by 1e-15", [1.0, 1.0 + 1e-15, 1.5]),
    ("off symmetry by 1e-8", [1.0, 1.0 + 1e-8, 1.5]),
    ("off the sphere by 1e-15", [1.0, 1.0 + 1e-15, 1.0 - 1e-15]),
    ("tumbling", [1.0, 1.5, 2.0]),
    ("disc", [1.0, 1.0, 2.0]),
    ("needle, 1e-3", [1e-3, 1.0, 1.0]),
    ("needle, 1e-6", [1e-6, 1.0, 1.0]),
    ("needle, 1e-9", [1e-9, 1.0, 1.0]),
    ("needle, 1e-12", [1e-12, 1.0, 1.0]),
    ("needle of three moments, 1e-6", [1e-6, 1.0, 1.0 + 1e-6]),
    ("no body: 1, 1, 3", [1.0, 1.0, 3.0]),
    ("no body: 1, 2, 100", [1.0, 2.0, 100.0]),
    ("no body: 1, 1e3, 1e6", [1.0, 1e3, 1e6]),
    ("no body: 1, 1e6, 1e12", [1.0, 1e6, 1e12]),
];

/// A table for each scalar type.
pub fn explore(map: &mut Map<'_>, claims: &mut Claims, steps: u64) -> Result<(), Failure> {
    let dials: Vec<Dial> = bodies().into_iter().filter(|dial| dial.name != "compensated").collect();
    for (scalar, name) in SCALARS.into_iter().enumerate() {
        say(format_args!(
            "Inertia: free body, {name}, {steps} steps of h|ω| = {ANGLE}, ω of equal size along all axes. Most iterations, and the largest difference from the same steps in 31 digits.\n"
        ));
        let (mut rows, mut errors, mut momenta) = (vec![heading("moments", &dials)], Vec::new(), Vec::new());
        for (shape, moments) in SHAPES {
            let mut row = vec![shape.to_owned()];
            for dial in &dials {
                let setup = Setup { moments, ..Setup::ordinary() }.with_velocity(Vector3::repeat(1.0));
                let h = ANGLE / setup.velocity().norm();
                let cell = dial.run(scalar, &Setup { h, ..setup }, steps, true);
                map.add(SECTION, dial, scalar, shape, &cell)?;
                row.push(match cell.outcome {
                    Ok(()) => format!("{} it, {}", cell.iterations, size(cell.precise)),
                    Err(_) => outcome(&cell),
                });
                if cell.outcome.is_ok() {
                    momenta.push(cell.momentum);
                    errors.push(cell.constraint);
                }
            }
            rows.push(row);
        }
        say(aligned(rows.iter()));
        let epsilon = [f64::EPSILON, f64::from(f32::EPSILON)][scalar];
        let steps = steps as f64;
        claims.at_most(
            &format!("inertia, {name}: spatial momentum"),
            largest(momenta),
            4.0 * steps * epsilon,
            "4 ε a step, whatever the shape",
        );
        claims.at_most(
            &format!("inertia, {name}: RᵀR − I"),
            largest(errors),
            64.0 * epsilon,
            "64 ε, whatever the shape and the dial",
        );
    }
    Ok(())
}
