//! Where the formulas come from: typed citations with their full text.

use std::fmt;

/// A published source.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Reference {
    /// The two theorems that every step is an instance of.
    ClebschOptimalControl,
    /// Discrete Legendre transforms and discrete Noether theorem.
    DiscreteMechanics,
    /// Hessians, momentum maps, coadjoint actions and their conventions.
    MechanicsAndSymmetry,
    /// The Cayley map as a chart, with the derivative used here.
    LieGroupMethods,
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Reference::ClebschOptimalControl => "N. Nordkvist, P. E. Crouch, A. M. Bloch, Discrete Clebsch Optimal Control, theorems 1 and 2",
            Reference::DiscreteMechanics => {
                "J. E. Marsden, M. West, Discrete mechanics and variational integrators, Acta Numerica 10 (2001) 357-514"
            }
            Reference::MechanicsAndSymmetry => "J. E. Marsden, T. S. Ratiu, Introduction to Mechanics and Symmetry, 2nd edition, Springer 1999",
            Reference::LieGroupMethods => {
                "A. Iserles, H. Z. Munthe-Kaas, S. P. Norsett, A. Zanna, Lie-group methods, Acta Numerica 9 (2000) 215-365"
            }
        })
    }
}
