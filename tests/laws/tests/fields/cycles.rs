//! Cycles of multigrid, whose number does not grow. The sizes of the grids are those of the crate: small ones in `clebsch-laws`, large
//! ones in `clebsch-tests`.

use super::squares::waved;
use clebsch::{Clebsch, Field, FieldSite, Grid, Population, Side, Sides, SiteError, StaticField};
use clebsch_tests::fixtures::harmonic_map::HarmonicMap;
use nalgebra::{Matrix3, Rotation3, SVector, Vector1, Vector3};

/// Multigrid ends where over-relaxation does, in as many cycles whatever the size.
#[test]
fn cycles_do_not_grow_with_the_grid() -> Result<(), SiteError> {
    for n in crate::SQUARES {
        let square = HarmonicMap.grid([n, n]).fixed();
        let mut q = waved(n);
        let found = square.relax().multigrid().solve(&mut q)?;
        assert!(found.sweeps() <= 4 * 10, "{n}: {} sweeps", found.sweeps());
        assert!(found.residual() < 1e-10, "{n}: {}", found.residual());
        if n < 60 {
            let mut expected = waved(n);
            square.relax().tolerance(1e-13).solve(&mut expected)?;
            let farthest = q.iter().zip(&expected).map(|(q, expected)| (q - expected).amax()).fold(0.0, f64::max);
            assert!(farthest < 1e-9, "{n}: {farthest}");
        }
    }
    Ok(())
}

/// Films whose energies count lengths in three ways: for each length, for each site, and not at all. And one in three directions.
#[test]
fn cycles_do_not_grow_with_dimensions_sides_and_spacings() -> Result<(), SiteError> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |a: Translation<1>, x: Vector1| x + a,
        potential = |x| self.stiffness * x.norm_squared() / 2 - self.load * x.x,
        space     = [|dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)), |dy, x, next| (next - x).norm_squared() / (2 * dy.powi(2))],
    )]
    struct Density {
        stiffness: f64,
        load: f64,
    }

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, space = |dx, x, next| (next - x).norm_squared() / (2 * dx))]
    struct Integral;

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action = |a: Translation<1>, x: Vector1| x + a,
        space  = [
            |dx, x, next| (next - x).norm_squared() / 2,
            |dy, x, next| (next - x).norm_squared() / 2,
            |dz, x, next| (next - x).norm_squared() / 2,
        ],
    )]
    struct Block;

    let noise = |sites: usize| -> Vec<Vector1<f64>> {
        (0..sites).map(|site| Vector1::new(((site as f64 * 12.9898).sin() * 43758.5).fract())).collect()
    };
    fn count<S, const D: usize, P: Population, const M: usize>(
        domain: &clebsch::Domain<S, Grid<f64, D>, P>,
        mut q: Vec<S::Configuration>,
    ) -> Result<u64, SiteError>
    where
        S: StaticField<Scalar = f64, Momentum = SVector<f64, M>> + Field<D> + FieldSite + Clone,
    {
        let found = domain.relax().multigrid().solve(&mut q)?;
        assert!(found.residual() < 1e-9, "{}", found.residual());
        Ok(found.sweeps() / 4)
    }
    let open = |first, last| Sides::Open(first, last);
    for n in crate::FILMS {
        for sides in [
            [Sides::Periodic; 2],
            [open(Side::Free, Side::Fixed), Sides::Periodic],
            [open(Side::Fixed, Side::Fixed), open(Side::Free, Side::Free)],
        ] {
            for spacing in [[1.0, 1.0], [0.1, 0.03], [0.1, 1.0]] {
                let stiffness = 0.02;
                let domain = Density { stiffness, load: 0.3 }.grid([n, n + 3]).sides(sides).spacing(spacing);
                let cycles = count(&domain, noise(n * (n + 3)))?;
                assert!(cycles <= 13, "{n}, {sides:?}, {spacing:?}: {cycles} cycles");
            }
        }
        // sites that differ by 4 to 1
        let soft = |[i, j]: [usize; 2]| Density {
            stiffness: 0.02 * if (i / 8 + j / 8) % 2 == 0 { 1.0 } else { 4.0 },
            load: 1.0,
        };
        let cycles = count(&Density { stiffness: 0.0, load: 0.0 }.grid([n, n]).fixed().various(soft), noise(n * n))?;
        assert!(cycles <= 13, "{n}: {cycles} cycles with various sites");
        let cycles = count(&Integral.grid([16 * n]).spacing([0.1]).fixed(), noise(16 * n))?;
        assert!(cycles <= 10, "{n}: {cycles} cycles of a string");
        let cycles = count(&Block.grid([n / 2, n / 2, n / 2 + 1]).fixed(), noise(n / 2 * (n / 2) * (n / 2 + 1)))?;
        assert!(cycles <= 13, "{n}: {cycles} cycles of a block");
    }
    Ok(())
}

/// Rotations in a square: the coarser grids move bodies, each in its own frame.
#[test]
fn cycles_turn_bodies() -> Result<(), SiteError> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action = |F: SO<3>, R: SO<3>| R * F,
        space  = [
            |dx, W| {
                let x = W.cayley() / dx;
                x.dot(&(self.stiffness.component_mul(&x))) / 2
            },
            |dy, W| {
                let x = W.cayley() / dy;
                x.dot(&x) / 2
            },
        ],
    )]
    struct Crystal {
        stiffness: Vector3<f64>,
    }

    for n in crate::CRYSTALS {
        let crystal = Crystal { stiffness: Vector3::new(1.0, 2.0, 0.5) }.grid([n, n]).spacing([0.1, 0.1]).fixed();
        let turn = |site: usize| {
            let (x, y) = ((site / n) as f64 / n as f64, (site % n) as f64 / n as f64);
            Rotation3::new(Vector3::new(x.sin(), 1.5 * x * y, y.cos())).into_inner()
        };
        let inside = |site: usize| !crystal.lattice().is_fixed(site);
        let start: Vec<Matrix3<f64>> = (0..n * n).map(|site| if inside(site) { turn(0) } else { turn(site) }).collect();
        let (mut q, mut expected) = (start.clone(), start);
        let found = crystal.relax().multigrid().solve(&mut q)?;
        assert!(found.sweeps() <= 4 * 15, "{n}: {} sweeps", found.sweeps());
        crystal.relax().tolerance(1e-13).solve(&mut expected)?;
        let farthest = q.iter().zip(&expected).map(|(q, expected)| (q - expected).amax()).fold(0.0, f64::max);
        assert!(farthest < 1e-9, "{n}: {farthest}");
    }
    Ok(())
}
