//! Residuals and Jacobians of all implicit equations, and the formulas that replace them.

use clebsch_compiler::Graph;
use clebsch_compiler::derive::{Id, MomentumEquation, Solution};
use clebsch_compiler::lower::{MechanicsProgram, Solve};
use clebsch_symbolic::Expr;
use clebsch_tests::oracle::random::Random;

use crate::assert_three;
use crate::program::{Values, program};

/// ρ and Dρ of every fixture: the formulas, the kernels that they were lowered to (generated code hides them), and differences.
/// Half of the fixtures.
#[test]
fn jacobians_of_all_implicit_equations() {
    check(0);
}

/// The other half.
#[test]
fn jacobians_of_all_implicit_equations_too() {
    check(1);
}

fn check(remainder: usize) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/accept");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("fixtures").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    assert!(files.len() >= 17, "only {} fixtures", files.len());
    let (mut implicit, mut explicit) = (0, 0);
    for file in files.into_iter().skip(remainder).step_by(2) {
        // each fixture has its own numbers, whatever other fixtures there are
        let random = &mut Random::new(105);
        let graph = Graph::new();
        let text = std::fs::read_to_string(&file).expect("a readable file");
        let Some(program) = program(&graph, &text) else { continue };
        // these kernels return matrices; by Newton's method too they are the unrolled ones
        // (`clebsch-laws --test forms`)
        if program.form.keeps_matrices() {
            continue;
        }
        let symbols = &program.formulas.symbols;
        for (substep, kernels) in program.formulas.substeps.iter().zip(&program.steps) {
            for (equation, solve) in substep.equations.iter().zip(&kernels.solves) {
                // the runtime's, against power series and Newton's method in its own tests
                if matches!(equation.solution, Solution::FreeRotation | Solution::Rotation(_)) {
                    continue;
                }
                let mut values = Values::random(&program, random);
                let constants: Vec<f64> = values.run(program.kernel(Id::Constants), &[], &[]).concat();
                let terms: Vec<f64> = values.run(program.kernel(solve.id(Id::Preparation)), &constants, &[]).concat();
                if matches!(equation.solution, Solution::Explicit | Solution::ClosedForm) {
                    assert_solved(&program, &mut values, equation, solve);
                    explicit += 1;
                    continue;
                }
                let mut code = values.run(program.linearization(solve), &constants, &terms);
                implicit += 1;
                let residual = values.evaluate(equation.residual).entries;
                let unknowns: Vec<(usize, usize)> =
                    equation.components.iter().map(|&component| place(&program, component)).collect();
                if equation.solution == Solution::Linear {
                    // ρ(x) = A x − b
                    let x: Vec<f64> =
                        unknowns.iter().map(|&(k, i)| values.get(symbols.blocks[k].coordinates)[i]).collect();
                    let row =
                        |i: usize| (0..x.len()).map(|j| code[1][i * x.len() + j] * x[j]).sum::<f64>() - code[0][i];
                    code[0] = (0..x.len()).map(row).collect();
                }
                for (column, &(k, i)) in unknowns.iter().enumerate() {
                    // the direction that is one in this unknown and zero in all others
                    for (block, other) in symbols.blocks.iter().zip(0..) {
                        let unit = |j| f64::from(u8::from((other, j) == (k, i)));
                        values.set(block.direction, &(0..block.dimension()).map(unit).collect::<Vec<_>>());
                    }
                    let formula = values.evaluate(equation.directional).entries;
                    let rows = 0..solve.dimension;
                    let entries: Vec<f64> = rows.clone().map(|row| code[1][row * solve.dimension + column]).collect();
                    let mut at = |e: f64| moved(&mut values, equation, symbols.blocks[k].coordinates, i, e);
                    // of sixth order: the inverses of charts have large derivatives
                    let pairs: Vec<_> = [3e-4, 6e-4, 9e-4].map(|e| (at(e), at(-e))).into();
                    let slope = |r: usize, k: usize| pairs[k].0[r] - pairs[k].1[r];
                    let difference: Vec<f64> =
                        rows.map(|r| (45.0 * slope(r, 0) - 9.0 * slope(r, 1) + slope(r, 2)) / 18e-3).collect();
                    assert_three(&formula, &entries, &difference, &format!("Dρ of {}", file.display()));
                }
                assert_three(&residual, &code[0], &residual, "ρ");
            }
        }
    }
    println!("{implicit} implicit equations, {explicit} solved by a formula");
    assert!(implicit >= 8 && explicit >= 8);
}

/// The chart block of a component, and its row there.
fn place(program: &MechanicsProgram<'_>, component: usize) -> (usize, usize) {
    let blocks = &program.formulas.symbols.blocks;
    let k = blocks.iter().position(|block| block.components().contains(&component)).expect("a component");
    (k, component - blocks[k].offset)
}

/// ρ where component `i` of a chart has moved by `e`.
fn moved<'g>(values: &mut Values, equation: &MomentumEquation<'g>, chart: Expr<'g>, i: usize, e: f64) -> Vec<f64> {
    let here = values.get(chart).to_vec();
    let mut there = here.clone();
    there[i] += e;
    values.set(chart, &there);
    let residual = values.evaluate(equation.residual).entries;
    values.set(chart, &here);
    residual
}

/// Where there is a formula for the solution, it solves the equation, for momenta that motions have.
fn assert_solved<'g>(
    program: &MechanicsProgram<'g>,
    values: &mut Values,
    equation: &MomentumEquation<'g>,
    solve: &Solve,
) {
    let formulas = &program.formulas;
    for (k, mu) in formulas.symbols.momenta.iter().enumerate() {
        // p small enough for sin θ < 1
        let momentum: Vec<f64> = values.evaluate(formulas.momentum_map[k]).entries.iter().map(|m| m / 2.0).collect();
        values.set(*mu, &momentum);
    }
    let constants: Vec<f64> = values.run(program.kernel(Id::Constants), &[], &[]).concat();
    let terms: Vec<f64> = values.run(program.kernel(solve.id(Id::Preparation)), &constants, &[]).concat();
    let is_closed = solve.solution == Solution::ClosedForm;
    let predict = program.find(solve.id(if is_closed { Id::ClosedForm } else { Id::Explicit }));
    let predict = predict.expect("a formula for the solution");
    let solution = values.run(predict, &constants, &terms).concat();
    for (&component, value) in equation.components.iter().zip(solution) {
        let (k, i) = place(program, component);
        let mut coordinates = values.get(formulas.symbols.blocks[k].coordinates).to_vec();
        coordinates[i] = value;
        values.set(formulas.symbols.blocks[k].coordinates, &coordinates);
    }
    let residual = values.evaluate(equation.residual).entries;
    assert!(residual.iter().all(|entry| entry.abs() < 1e-13), "{residual:?}");
}
