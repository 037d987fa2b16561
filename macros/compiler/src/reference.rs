//! The reference of the derive macro, `macros/reference.md`, and the texts for editors: printed from the tables by which declarations are read.
//!
//! Marks such as `ANCHOR: keys` name the sections that pages of the book include.

#[cfg(test)]
mod tests;

use crate::{model, parse};
/// The page, with a declaration and the code that it expands to.
pub fn reference(declaration: &str, expansion: &str) -> String {
    let keys = parse::keys_as_markdown(model::arguments_of, model::refused_with);
    let dials = parse::dials_of_method();
    let groups = model::groups_as_markdown();
    let promises = parse::promises_as_markdown();
    let functions = model::functions_as_markdown();
    let refused = model::features_as_markdown();
    let expansion = shortened(expansion);
    format!(
        "Derives the integrator of a mechanical system from the closures in `#[clebsch(…)]`.

The struct gets the trait `Clebsch`, whose methods are the derived formulas.
`stepper(h)` checks the parameters and gives a `Stepper`, which makes the steps.
With `controls`, `dynamics` or `effort`, `control(h)` gives a `Control`, which chooses the inputs.
The constant `DERIVATION` is the derivation in words and formulas.

<!-- printed by `cargo run -p clebsch-compiler --example reference > macros/reference.md`; a test compares the two -->

# Example

```rust
{declaration}
let stepper = FreeParticle {{ mass: 2.0 }}.into_stepper(0.5)?;
let start = stepper.state([0.0].into(), [6.0].into())?;
assert_eq!(stepper.step(&start)?.configuration().x, 1.5); // 6 kg·m/s move 2 kg by 1.5 m in 0.5 s
# Ok::<(), clebsch::Error>(())
```

The section Expansion at the end shows the code that this declaration gives.

# Keys
<!-- ANCHOR: keys -->
Items `key = value` stand in `#[clebsch(…)]`, separated by commas. Several attributes are read as one.
Each key occurs once, but for `group` and `method`.

{keys}
## `group`

`group NAME = |F: Matrix4| a == b` declares the group of all matrices that satisfy an equation of literals.
`group NAME = basis([A, B])` declares the group of a Lie algebra by its basis.
`F: NAME` in the action then names it.

## `method`

`method NAME = (dial = value, …)` declares a further way to step the same system. `NAME` is a unit struct of yours.
The dials of a method are {dials}. A dial that it does not name has its default.
`emit = [tangent]` and `emit = [boundary]` serve every method whose steps can be differentiated.
`effort` belongs to steps with the declared dials.
<!-- ANCHOR_END: keys -->

# Groups
<!-- ANCHOR: groups -->
A group is the type of the first argument of the action. Tuples and arrays are products.
The module `group` of this crate has the basis and the momenta of each.

{groups}
A configuration, the second argument, is typed as one of these:

| space | points |
|---|---|
| `VectorN`, `MatrixN`, `MatrixRxC`, `SVector<n>`, `SMatrix<r, c>` | all vectors or matrices of this shape |
| `Quaternion` | all quaternions |
| `Unit<VectorN>` | vectors of length one |
| `Symmetric<MatrixN>` | symmetric matrices |
| `Projector<MatrixN, K>` | orthogonal projectors of rank K, Pᵀ = P = P² and tr P = K, as points of a Grassmann manifold |
| `Orthonormal<MatrixNxK>` | matrices of K < N orthonormal columns, XᵀX = I, as points of a Stiefel manifold |
| a group | the elements of the group |
| a tuple or an array | products of these |

`[…; N]` with a const generic `N` on both arguments makes N equal sites, which are stepped in loops.
<!-- ANCHOR_END: groups -->

# Fields
<!-- ANCHOR: fields -->
A field that a closure reads is a parameter: a scalar, a vector, a matrix, or an array of these. Other fields have any type.

| type | value in a closure |
|---|---|
| `f64`, `f32`, or a type parameter `T: Scalar` | a scalar |
| `VectorN`, `RowVectorN`, `SVector<T, n>` | a vector |
| `MatrixN`, `MatrixRxC`, `SMatrix<T, r, c>` | a matrix |
| `[…; n]` | an array, `self.masses[0]` |
| `[…; N]` with the const generic of the sites | one entry for each site |

All parameters have one scalar type, which is the scalar of the system. An attribute on a field promises a property of its values.
The stepper checks the promise, and formulas use it.

{promises}
<!-- ANCHOR_END: fields -->

# Closures
<!-- ANCHOR: closures -->
A closure is one formula, in the syntax of Rust and the names of nalgebra. The macro differentiates it and never runs it.

| written | meaning |
|---|---|
| `1 / 2`, `0.1` | exact rational numbers |
| `h`, `t` | the step and the time, where they are arguments |
| `I` | the identity matrix of the size that fits |
| `PI`, `GRAVITY`, `path::G` | π, and constants of your crate: floats and integers |
| `self.name` | a field |
| `a + b`, `a - b`, `-a`, `a * b`, `a / b` | sums and products of matrices; only scalars divide |
| `v.x`, `v[0]`, `m[(0, 1)]` | entries, counted from 0 |
| `pair.0`, `array[1]` | parts of a tuple and of an array |
| `(a, b)`, `[a, b]`, `[a; 3]` | tuples and arrays |
| `a..b`, `i % n` | ranges and remainders of integers, for indices |
| `let x = …;` | a name for a value, in a block |
| `q * v` | a unit quaternion turns a vector of three components |

{functions}
<!-- ANCHOR_END: closures -->

# Conflicts
<!-- ANCHOR: together -->
Most keys can be combined. These combinations are refused, and the error stands at the feature of the first column.
Where a cell has several features, each of the first column is refused with each of the second.
A power is a product `[…; N]` whose length `N` is a const generic.

{refused}<!-- ANCHOR_END: together -->

# Expansion
<!-- ANCHOR: expansion -->
The example expands to this code, shortened where `…` stands. With `emit = [generated]` the constant `GENERATED` is the text for a struct of yours.

```rust,ignore
{expansion}```
<!-- ANCHOR_END: expansion -->
"
    )
}

/// The file `keys.rs` of the runtime, whose items editors show for the keys and words of a declaration.
pub fn keys_for_editors() -> String {
    format!(
        "//! The keys of `#[clebsch(…)]` and their words, for editors: a derive names them where they are written.
//!
//! Printed by `cargo run -p clebsch-compiler --example reference hints > runtime/src/__private/keys.rs`; a test compares the two.
{}",
        parse::keys_as_rust()
    )
}

/// The code without the text of the derivation and without citations, which make long lines.
fn shortened(expansion: &str) -> String {
    let line = |line: &str| {
        if let Some((before, _)) = line.split_once("str = \"")
            && before.contains("DERIVATION")
        {
            return format!("{before}str = \"…\";\n");
        }
        let (text, _) = line.split_once(" Source: ").unwrap_or((line, ""));
        format!("{text}\n")
    };
    expansion.lines().map(line).collect()
}
