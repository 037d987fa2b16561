//! What generated code names of the runtime; the other side of this file is the runtime's module `__private`.

use clebsch_symbolic::Shape;
use proc_macro2::TokenStream;
use quote::quote;

use super::names::Names;
use crate::model::{Item, ScalarType};

/// The paths of the runtime for one expansion.
pub struct Paths {
    /// The runtime crate.
    pub krate: TokenStream,
    /// Its module for generated code.
    pub private: TokenStream,
    /// The scalar type.
    pub scalar: TokenStream,
}

impl Paths {
    /// The paths for an item.
    pub fn new(item: &Item) -> Paths {
        let krate = &item.krate;
        let scalar = match &item.scalar {
            ScalarType::F32 => quote!(::core::primitive::f32),
            ScalarType::F64 => quote!(::core::primitive::f64),
            ScalarType::Parameter(ident) => quote!(#ident),
        };
        Paths { krate: quote!(#krate), private: quote!(#krate::__private), scalar }
    }

    /// The same in an expansion that gives the module and the scalar names of its own.
    pub fn named(&self, item: &Item, names: &Names) -> Paths {
        let (runtime, scalar) = (&names.runtime, &names.scalar);
        let scalar = match &item.scalar {
            ScalarType::Parameter(_) => self.scalar.clone(),
            ScalarType::F32 | ScalarType::F64 => quote!(#scalar),
        };
        Paths { krate: self.krate.clone(), private: quote!(#runtime), scalar }
    }

    /// The type of an array of this shape, or of a quaternion.
    pub fn leaf(&self, shape: Shape, is_quaternion: bool) -> TokenStream {
        let (private, scalar) = (&self.private, &self.scalar);
        if is_quaternion { quote!(#private::Quaternion<#scalar>) } else { self.matrix(shape.rows, shape.columns) }
    }

    /// `SMatrix<T, r, c>`, or `SVector<T, r>`.
    pub fn matrix(&self, rows: usize, columns: usize) -> TokenStream {
        let (private, scalar) = (&self.private, &self.scalar);
        let literal = proc_macro2::Literal::usize_unsuffixed;
        match (literal(rows), literal(columns), columns) {
            (rows, _, 1) => quote!(#private::SVector<#scalar, #rows>),
            (rows, columns, _) => quote!(#private::SMatrix<#scalar, #rows, #columns>),
        }
    }
}
