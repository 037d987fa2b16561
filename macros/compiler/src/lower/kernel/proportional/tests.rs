use clebsch_symbolic::{Rational, Role, Shape, integer, rational};

use crate::lower::entries::Grid;
use crate::lower::kernel::{Hoisted, Hoisting, kernel};
use crate::lower::{Code, Input, Kernel, Scalar, ScalarNode, Scalars};

/// Numbers that look like random ones, the same each time.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % n
    }

    fn one_of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }
}

/// Three entries of an input.
fn entries(scalars: &mut Scalars, name: &str, role: Role) -> [Scalar; 3] {
    let entry = |row| Input { role, name: name.to_string(), row, column: 0, shape: Shape::vector(3) };
    [0, 1, 2].map(|row| scalars.input(entry(row)))
}

fn of_input(input: &Input) -> f64 {
    let letter = f64::from(input.name.as_bytes()[0]);
    1.0 + (letter * 0.7 + input.row as f64 * 1.3).sin() / 2.0
}

/// The value of a scalar, as it is written.
fn of_scalar(scalars: &Scalars, scalar: Scalar) -> f64 {
    let of = |scalar: &Scalar| of_scalar(scalars, *scalar);
    match scalars.node(scalar) {
        ScalarNode::Input(input) => of_input(input),
        ScalarNode::Sum(constant, terms) => {
            constant.to_f64() + terms.iter().map(|(term, weight)| weight.to_f64() * of(term)).sum::<f64>()
        }
        ScalarNode::Product(factors) => factors.iter().map(|(base, power)| of(base).powi(*power as i32)).product(),
        ScalarNode::Reciprocal(x) => 1.0 / of(x),
        other => panic!("{other:?}"),
    }
}

/// The values of the outputs of a kernel.
fn of_kernel(kernel: &Kernel, constants: &[f64]) -> Vec<f64> {
    fn of(code: &Code, locals: &[f64], constants: &[f64]) -> f64 {
        let of = |code: &Code| of(code, locals, constants);
        match code {
            Code::Read(input) => of_input(input),
            Code::Number(number) => number.to_f64(),
            Code::Constant(place) => constants[*place],
            Code::Local(place) => locals[*place],
            Code::Sum(constant, terms) => {
                constant.to_f64() + terms.iter().map(|(weight, term)| weight.to_f64() * of(term)).sum::<f64>()
            }
            Code::Product(factors) => factors.iter().map(of).product(),
            Code::Reciprocal(x) => 1.0 / of(x),
            other => panic!("{other:?}"),
        }
    }
    let mut locals = Vec::new();
    for code in &kernel.locals {
        let value = of(code, &locals, constants);
        locals.push(value);
    }
    kernel.entries().map(|code| of(code, &locals, constants)).collect()
}

/// The kernel of outputs, whose values are those of the scalars, with constants taken out or not.
fn checked(scalars: &mut Scalars, outputs: &[Scalar], takes_out: bool) -> Kernel {
    let mut hoisted = Hoisted::default();
    let hoisting = if takes_out { Hoisting::Constants(&mut hoisted) } else { Hoisting::Nothing };
    let kernel = kernel(scalars, &[Grid::vector(outputs.to_vec())], hoisting);
    let signed =
        |(scalar, is_negative): (Scalar, bool)| of_scalar(scalars, scalar) * if is_negative { -1.0 } else { 1.0 };
    let constants: Vec<f64> = hoisted.kept().map(signed).collect();
    for (found, output) in of_kernel(&kernel, &constants).into_iter().zip(outputs) {
        let expected = of_scalar(scalars, *output);
        assert!((found - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{found} for {expected}");
    }
    kernel
}

fn scalars() -> Scalars {
    let mut scalars = Scalars::default();
    scalars.searches = 10_000_000;
    scalars
}

/// Σ number · constants · changing.
fn sum(scalars: &mut Scalars, terms: &[(Rational, &[Scalar])]) -> Scalar {
    let terms: Vec<_> =
        terms.iter().map(|(number, factors)| (scalars.product(factors.iter().copied()), number.clone())).collect();
    scalars.sum(integer(0), terms)
}

/// s = k₀ x₀ + k₁ x₁, −2 k₂ s and 3 s are four multiplications. The other output, x₁ x₂/x₀, has one, and takes longer.
#[test]
fn multiples_of_a_sum_take_one_multiplication_each() {
    let mut scalars = scalars();
    let [k, x] =
        [("k", Role::Parameter(0)), ("x", Role::Momentum(0))].map(|(name, role)| entries(&mut scalars, name, role));
    let plain = sum(&mut scalars, &[(integer(1), &[k[0], x[0]]), (integer(1), &[k[1], x[1]])]);
    let scaled = sum(&mut scalars, &[(integer(-2), &[k[0], k[2], x[0]]), (integer(-2), &[k[1], k[2], x[1]])]);
    let tripled = sum(&mut scalars, &[(integer(3), &[k[0], x[0]]), (integer(3), &[k[1], x[1]])]);
    let inverse = scalars.reciprocal(x[0]);
    let longest = scalars.product([inverse, x[1], x[2]]);
    let cost = checked(&mut scalars, &[plain, scaled, tripled, longest], true).cost();
    assert_eq!((cost.additions, cost.multiplications), (1, 5));
}

/// Where sums are asked for as they are written, they are no multiples.
#[test]
fn sums_stay_as_they_are_written_where_that_is_asked_for() {
    let mut scalars = scalars();
    scalars.keeps_sums = true;
    let [k, x] =
        [("k", Role::Parameter(0)), ("x", Role::Momentum(0))].map(|(name, role)| entries(&mut scalars, name, role));
    let plain = sum(&mut scalars, &[(integer(1), &[k[0], x[0]]), (integer(1), &[k[1], x[1]])]);
    let scaled = sum(&mut scalars, &[(integer(1), &[k[0], k[2], x[0]]), (integer(1), &[k[1], k[2], x[1]])]);
    let cost = checked(&mut scalars, &[plain, scaled], true).cost();
    assert_eq!((cost.additions, cost.multiplications), (2, 4));
}

/// (k₀ + k₁) x₀ − k₀ x₀ − k₁ x₀ + …: constants that cancel are no divisor.
#[test]
fn constants_that_cancel_have_no_ratio() {
    let mut scalars = scalars();
    let [k, x] =
        [("k", Role::Parameter(0)), ("x", Role::Momentum(0))].map(|(name, role)| entries(&mut scalars, name, role));
    let both = scalars.sum(integer(0), [(k[0], integer(1)), (k[1], integer(1))]);
    let rest = [(integer(1), &[x[1]] as &[_]), (integer(1), &[x[2]])];
    let cancelling = [(integer(1), &[both, x[0]] as &[_]), (integer(-1), &[k[0], x[0]]), (integer(-1), &[k[1], x[0]])];
    let first = sum(&mut scalars, &[cancelling.as_slice(), &rest].concat());
    let [second, third] =
        [2, -3].map(|n| sum(&mut scalars, &[&[(integer(n), &[k[2]] as &[_])], rest.as_slice()].concat()));
    checked(&mut scalars, &[first, second, third], true);
}

/// Sums with common factors, with constants among them and in each other: the code has their values.
#[test]
fn code_has_the_values_of_random_sums() {
    let numbers = [integer(1), integer(1), integer(-1), integer(2), integer(-2), integer(3), rational(1, 2)];
    for seed in 1..400 {
        let mut random = Random(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed));
        let mut scalars = scalars();
        scalars.keeps_sums = random.below(8) == 0;
        let constants = entries(&mut scalars, "k", Role::Parameter(0));
        let mut pool = entries(&mut scalars, "x", Role::Momentum(0)).to_vec();
        pool.push(scalars.reciprocal(pool[0]));
        let (mut outputs, mut lists): (Vec<Scalar>, Vec<Vec<Scalar>>) = (Vec::new(), Vec::new());
        for _ in 0..3 + random.below(12) {
            // the changing factors of a sum are often those of another one
            let changing = if lists.is_empty() || random.below(3) == 0 {
                (0..2 + random.below(3)).map(|_| random.one_of(&pool)).collect()
            } else {
                random.one_of(&lists)
            };
            let (common, number) = (random.one_of(&constants), random.one_of(&numbers));
            let is_multiple = random.below(2) == 0;
            let mut term = |(place, factor): (usize, &Scalar)| {
                let own = if is_multiple { constants[place % 3] } else { random.one_of(&constants) };
                let number = if is_multiple { number.clone() } else { random.one_of(&numbers) };
                (scalars.product([*factor, common, own]), number)
            };
            let terms: Vec<_> = changing.iter().enumerate().map(&mut term).collect();
            let constant = integer(i64::from(random.below(5) == 0));
            let made = scalars.sum(constant, terms);
            let made = if random.below(3) == 0 { scalars.product([made, random.one_of(&pool)]) } else { made };
            lists.push(changing);
            outputs.push(made);
            if random.below(2) == 0 {
                pool.push(made);
            }
        }
        checked(&mut scalars, &outputs, seed % 2 == 0);
    }
}
