//! Coefficients as people write them: a number, powers, and sums in brackets, as in `length[0]²·(mass[0] + mass[1])/2`.

use clebsch_symbolic::{Notation, Product, Rational, integer};

use super::Code;

/// A code as one product, with like terms and common factors collected; a sum is a factor of it. `atom` is the text of a factor.
pub(super) fn collected(code: &Code, atom: &dyn Fn(&Code) -> String) -> Product {
    match code {
        Code::Number(value) => Product::number(value.clone()),
        Code::Product(factors) => {
            let mut product = Product::number(integer(1));
            factors.iter().for_each(|factor| product.multiply(&collected(factor, atom)));
            product
        }
        Code::Reciprocal(x) => {
            let x = collected(x, atom);
            if x.is_zero() {
                return Product::name(atom(code));
            }
            let mut inverse = Product::number(integer(1));
            inverse.divide(&x);
            inverse
        }
        Code::Sum(..) => {
            let mut terms = Vec::new();
            each_term(&integer(1), code, atom, &mut terms);
            Product::sum(terms, Notation::Unicode, false)
        }
        _ => Product::name(atom(code)),
    }
}

/// The terms of a sum, of sums within it too.
fn each_term(weight: &Rational, code: &Code, atom: &dyn Fn(&Code) -> String, all: &mut Vec<Product>) {
    let weighted = |mut term: Product| {
        term.multiply(&Product::number(weight.clone()));
        term
    };
    match code {
        Code::Sum(constant, terms) => {
            all.push(weighted(Product::number(constant.clone())));
            terms.iter().for_each(|(own, term)| each_term(&(own * weight), term, atom, all));
        }
        term => all.push(weighted(collected(term, atom))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lower::code::Code;

    fn name(code: &Code) -> String {
        match code {
            Code::Local(0) => "a".into(),
            Code::Local(1) => "b".into(),
            Code::Local(_) => "c".into(),
            other => format!("{other:?}"),
        }
    }

    fn weighted(terms: &[(i64, i64, Code)]) -> Code {
        Code::Sum(
            integer(0),
            terms.iter().map(|(n, d, code)| (Rational::new((*n).into(), (*d).into()), code.clone())).collect(),
        )
    }

    #[test]
    fn coefficients_are_collected() {
        let [a, b, c] = [0, 1, 2].map(Code::Local);
        let quarter = weighted(&[(1, 4, a.clone()), (1, 4, b.clone())]);
        let nested = weighted(&[(2, 1, Code::Product(vec![c.clone(), quarter, c.clone()]))]);
        let below =
            Code::Product(vec![a.clone(), Code::Reciprocal(Box::new(Code::Product(vec![b.clone(), b.clone()])))]);
        let common = weighted(&[
            (-1, 1, Code::Product(vec![a.clone(), b.clone()])),
            (-3, 1, Code::Product(vec![a.clone(), c.clone()])),
        ]);
        let mixed = weighted(&[(-1, 1, a.clone()), (1, 2, b.clone())]);
        let gone = weighted(&[(1, 1, a.clone()), (-1, 1, a.clone())]);
        let whole = weighted(&[(1, 1, Code::Sum(integer(3), vec![(integer(1), a.clone())])), (1, 1, a.clone())]);
        let found =
            [nested, below, common, mixed, gone, whole].map(|code| collected(&code, &name).written(Notation::Unicode));
        let expected = ["c²·(a + b)/2", "a/b²", "−a·(b + 3·c)", "b/2 − a", "0", "2·a + 3"];
        assert_eq!(found, expected);
    }
}
