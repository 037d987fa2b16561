//! Lists made of other lists.
//!
//! Programs build the macro without optimisation, where an iterator that is mapped and collected is ten functions.

/// A list whose elements are mapped.
pub trait Elements<A> {
    /// f(a) of each element a, in order.
    fn each<'a, B>(&'a self, f: impl FnMut(&'a A) -> B) -> Vec<B>
    where
        A: 'a;
}

impl<A> Elements<A> for [A] {
    fn each<'a, B>(&'a self, mut f: impl FnMut(&'a A) -> B) -> Vec<B>
    where
        A: 'a,
    {
        mapped(self, &mut f)
    }
}

/// A list that is consumed while its elements are mapped.
pub trait IntoElements<A> {
    /// f(a) of each element a, in order.
    fn into_each<B>(self, f: impl FnMut(A) -> B) -> Vec<B>;
}

impl<A> IntoElements<A> for Vec<A> {
    fn into_each<B>(self, mut f: impl FnMut(A) -> B) -> Vec<B> {
        consumed(self, &mut f)
    }
}

/// An iterator that ends in a list.
pub trait IntoList: Iterator {
    /// Everything that is left of it, in order.
    fn into_list(self) -> Vec<Self::Item>;
}

impl<I: Iterator> IntoList for I {
    fn into_list(self) -> Vec<I::Item> {
        let mut list = Vec::new();
        for element in self {
            list.push(element);
        }
        list
    }
}

/// f(0), f(1), …, as many as there are said to be.
pub fn indexed<B>(count: usize, mut f: impl FnMut(usize) -> B) -> Vec<B> {
    counted(count, &mut f)
}

/// f(a) and f(b).
pub fn both<A, B>([a, b]: [A; 2], mut f: impl FnMut(A) -> B) -> [B; 2] {
    [f(a), f(b)]
}

fn mapped<'a, A, B>(list: &'a [A], f: &mut dyn FnMut(&'a A) -> B) -> Vec<B> {
    let mut values = Vec::with_capacity(list.len());
    for element in list {
        values.push(f(element));
    }
    values
}

fn consumed<A, B>(list: Vec<A>, f: &mut dyn FnMut(A) -> B) -> Vec<B> {
    let mut values = Vec::with_capacity(list.len());
    for element in list {
        values.push(f(element));
    }
    values
}

fn counted<B>(count: usize, f: &mut dyn FnMut(usize) -> B) -> Vec<B> {
    let mut values = Vec::with_capacity(count);
    let mut k = 0;
    while k < count {
        values.push(f(k));
        k += 1;
    }
    values
}
