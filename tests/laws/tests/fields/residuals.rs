//! The local law of momentum, site by site.

use clebsch::{Clebsch, Error, Field, SiteError};
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::Vector3;

/// Waves of unit vectors in steps of order 4.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
    order  = 4,
)]
struct WavesOfOrderFour;

fn place(i: usize) -> Vector3<f64> {
    let x = 0.7 * i as f64;
    Vector3::new(x.sin(), 0.3 * x.cos(), 1.0).normalize()
}

/// With the momenta that flow over each edge by hand: q × next h/dx², once before the step and once after it.
#[test]
fn what_a_site_gains_flows_in() -> Result<(), SiteError> {
    let (h, spacing) = (0.05, [0.1, 0.2]);
    let stepper = WaveMap.grid([4, 5]).spacing(spacing).periodic().stepper(h)?;
    let mut state = stepper.state((0..20).map(place).collect::<Vec<_>>(), vec![Vector3::zeros(); 20])?;
    stepper.advance(&mut state, 5)?;
    let before = state.clone();
    let mut residuals = vec![[1.0; 3]; 20];
    stepper.step_with_residuals(&mut state, &mut residuals)?;
    assert!(residuals.iter().flatten().all(|residual| residual.abs() < 1e-13), "{residuals:?}");
    for site in 0..20 {
        let (i, j) = (site / 5, site % 5);
        let neighbours =
            [((i + 1) % 4 * 5 + j, 0), ((i + 3) % 4 * 5 + j, 0), (i * 5 + (j + 1) % 5, 1), (i * 5 + (j + 4) % 5, 1)];
        let mut gained = Vector3::zeros();
        for state in [&before, &state] {
            let q = state.configuration();
            for (neighbour, d) in neighbours {
                gained += q[site].cross(&q[neighbour]) * (0.5 * h / (spacing[d] * spacing[d]));
            }
        }
        let found = state.momentum()[site] - before.momentum()[site];
        assert!((found - gained).amax() < 1e-13, "site {site}");
        assert!(gained.amax() > 1e-3 || site > 0);
    }
    // the step is the same
    let mut other = before.clone();
    stepper.step(&mut other)?;
    assert_eq!(other, state);
    Ok(())
}

/// In each stage of a composition, and next to sides: free ones pass nothing, and momentum leaves over fixed ones.
#[test]
fn the_law_holds_in_stages_and_at_sides() -> Result<(), SiteError> {
    for domain in [WavesOfOrderFour.grid([7]).free(), WavesOfOrderFour.grid([7]).fixed()] {
        let stepper = domain.spacing([0.3]).stepper(0.1)?;
        let mut state = stepper.state((0..7).map(place).collect::<Vec<_>>(), vec![Vector3::zeros(); 7])?;
        let mut residuals = [[1.0; 3]; 7];
        for _ in 0..5 {
            stepper.step_with_residuals(&mut state, &mut residuals)?;
            assert!(residuals.iter().flatten().all(|residual| residual.abs() < 1e-13), "{residuals:?}");
        }
        let fewer = stepper.step_with_residuals(&mut state, &mut [[0.0; 3]; 6]);
        assert_eq!(fewer, Err(Error::NumberOfSites { found: 6, sites: 7 }.into()));
    }
    Ok(())
}
