//! The declared sites of a field: one for all places, or one for each.

/// Whether all sites of a field have the same parameters.
///
/// ```
/// use clebsch::{Alike, Population};
///
/// let doubled = Alike::each(&[1.5], |_, value| Ok::<_, ()>(2.0 * value));
/// assert_eq!((doubled, Alike::number(7)), (Ok([3.0]), 0));
/// ```
pub trait Population {
    /// A value of each site.
    type Of<V: Clone>: AsRef<[V]> + Clone;

    /// Whether they have.
    const ARE_ALIKE: bool;

    /// The number of the value that a site has.
    fn number(site: usize) -> usize;

    /// A value for each of some others.
    ///
    /// # Errors
    /// The first one of `make`, with the site.
    fn each<V: Clone, W: Clone, E>(
        values: &Self::Of<V>,
        make: impl FnMut(usize, &V) -> Result<W, E>,
    ) -> Result<Self::Of<W>, E>;

    /// The values of some of the sites.
    #[doc(hidden)]
    fn some<V: Clone>(values: &Self::Of<V>, sites: impl Iterator<Item = usize>) -> Self::Of<V>;
}

/// All sites of a field have the same parameters.
///
/// ```
/// # use clebsch::{Alike, Clebsch, Field, FieldStepper, Grid};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let alike: FieldStepper<Strand, Grid<f64, 1>, Alike> = Strand.grid([100]).stepper(0.1)?;
/// assert!(alike.system(99).is_some());
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Alike;

impl Population for Alike {
    type Of<V: Clone> = [V; 1];

    const ARE_ALIKE: bool = true;

    #[inline(always)]
    fn number(_: usize) -> usize {
        0
    }

    fn each<V: Clone, W: Clone, E>(
        [value]: &[V; 1],
        mut make: impl FnMut(usize, &V) -> Result<W, E>,
    ) -> Result<[W; 1], E> {
        Ok([make(0, value)?])
    }

    fn some<V: Clone>(value: &[V; 1], _: impl Iterator<Item = usize>) -> [V; 1] {
        value.clone()
    }
}

/// Each site of a field has parameters of its own.
///
/// ```
/// # use clebsch::{Clebsch, Field, FieldStepper, Grid, Various};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let own: FieldStepper<Strand, Grid<f64, 1>, Various> = Strand.grid([9]).various(|_| Strand).stepper(0.1)?;
/// assert!(own.system(9).is_none());
/// # Ok::<(), clebsch::Error>(())
/// ```
#[cfg(feature = "alloc")]
#[derive(Clone, Copy, Debug)]
pub struct Various;

#[cfg(feature = "alloc")]
impl Population for Various {
    type Of<V: Clone> = alloc::vec::Vec<V>;

    const ARE_ALIKE: bool = false;

    #[inline(always)]
    fn number(site: usize) -> usize {
        site
    }

    fn each<V: Clone, W: Clone, E>(
        values: &alloc::vec::Vec<V>,
        mut make: impl FnMut(usize, &V) -> Result<W, E>,
    ) -> Result<alloc::vec::Vec<W>, E> {
        values.iter().enumerate().map(|(site, value)| make(site, value)).collect()
    }

    fn some<V: Clone>(values: &alloc::vec::Vec<V>, sites: impl Iterator<Item = usize>) -> alloc::vec::Vec<V> {
        sites.filter_map(|site| values.get(site).cloned()).collect()
    }
}
