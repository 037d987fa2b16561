//! The part of an iteration that is computed once per solve, in matrix code.

use clebsch_symbolic::{Elements, IntoList, Role, Shape};

use crate::lower::{Code, Kernel};

/// A kernel of an iteration as two. The outputs of the first are terms that depend neither on the coordinates nor on a
/// direction of them, if other terms need them. The second has all other terms.
pub(in crate::lower) fn hoisted(kernel: Kernel) -> (Kernel, Kernel) {
    let depends = kernel.depends_on(|role| matches!(role, Role::Chart(_) | Role::Direction(_)));
    let moving = kernel.locals.iter().zip(&depends).filter(|(_, depends)| **depends).map(|(code, _)| code);
    let mut terms: Vec<usize> =
        moving.chain(kernel.entries()).flat_map(Code::locals).filter(|&index| !depends[index]).into_list();
    terms.sort_unstable();
    terms.dedup();
    // the numbers of terms among those of their kind
    let number = |index: usize| depends[..index].iter().filter(|&&other| other == depends[index]).count();
    let before = |index: usize| Code::Local(number(index));
    let after = |index: usize| match terms.iter().position(|&term| term == index) {
        Some(term) => Code::Term(term),
        None => Code::Local(number(index)),
    };
    let shape = |index: usize| match &kernel.locals[index] {
        Code::Whole(whole) => whole.shape,
        _ => Shape::scalar(),
    };
    let (mut prepare, mut rest) = (Kernel::default(), Kernel::default());
    for (code, depends) in kernel.locals.iter().zip(&depends) {
        if *depends {
            rest.locals.push(code.with_locals(&after));
        } else {
            prepare.locals.push(code.with_locals(&before));
        }
    }
    prepare.outputs = terms.each(|&index| (shape(index), vec![before(index)]));
    rest.outputs = kernel.outputs_by(|entry| entry.with_locals(&after));
    (prepare, rest)
}
