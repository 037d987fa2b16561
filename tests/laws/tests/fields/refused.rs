//! The errors of grids, states and steps, with their numbers and sites.

use clebsch::{Error, Field, SiteError};
use clebsch_tests::fixtures::cosserat_rod::CosseratRod;
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Matrix4, SVector, Vector3, Vector4};

#[test]
fn grids_without_sites_and_spacings_of_zero_are_refused() {
    let refused = |sizes, spacing| WaveMap.grid(sizes).spacing(spacing).stepper(0.1).unwrap_err();
    assert_eq!(refused([3, 0], [1.0, 1.0]), Error::EmptyGrid { direction: 1, sites: 0 });
    assert_eq!(refused([usize::MAX, 2], [1.0, 1.0]), Error::EmptyGrid { direction: 0, sites: usize::MAX });
    assert_eq!(refused([3, 3], [0.0, 1.0]), Error::Spacing { direction: 0, value: 0.0 });
    assert_eq!(refused([3, 3], [1.0, -0.5]), Error::Spacing { direction: 1, value: -0.5 });
    assert!(matches!(refused([3, 3], [1.0, f64::NAN]), Error::Spacing { direction: 1, .. }));
    let huge = WaveMap.grid([usize::MAX, usize::MAX]);
    assert_eq!((huge.lattice().sites(), huge.lattice().index([usize::MAX - 1, 3])), (usize::MAX, None));
    let huge = huge.various(|_| WaveMap).stepper(0.1).unwrap_err();
    assert_eq!(huge, Error::EmptyGrid { direction: 0, sites: usize::MAX });
    let step = WaveMap.grid([3, 3]).stepper(0.0).unwrap_err();
    assert_eq!(step, Error::StepSize { value: 0.0 });
}

#[test]
fn states_are_checked_site_by_site() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([2, 2]).stepper(0.1)?;
    let refused = |q: Vec<Vector3<f64>>, mu: Vec<Vector3<f64>>| stepper.state(q, mu).unwrap_err();
    let (up, zero) = (vec![Vector3::z(); 4], vec![Vector3::zeros(); 4]);
    let short = refused(up[1..].to_vec(), zero.clone());
    assert_eq!(short, SiteError { site: None, error: Error::NumberOfSites { found: 3, sites: 4 } });
    let mut long = up.clone();
    long[2].z = 1.1;
    let long = refused(long, zero.clone());
    assert_eq!(long.site, Some(2));
    assert!(matches!(long.error, Error::OffOrbit { .. }));
    let mut about = zero.clone();
    about[3].z = 0.1;
    let about = refused(up.clone(), about);
    assert_eq!(about.site, Some(3));
    assert!(matches!(about.error, Error::OutsideMomentumSpace { .. }));
    let mut nan = zero;
    nan[1].x = f64::NAN;
    assert_eq!(refused(up, nan), SiteError { site: Some(1), error: Error::NotFinite { name: "the momentum" } });
    Ok(())
}

#[test]
fn a_state_whose_step_failed_is_not_stepped_again() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([1, 3]).stepper(0.1)?;
    // sin θ = h|N| has no solution above 1
    let mut state = stepper.state([Vector3::z(); 3], [Vector3::zeros(), Vector3::x() * 11.0, Vector3::zeros()])?;
    let error = stepper.step(&mut state).unwrap_err();
    assert_eq!(error.site, Some(1));
    assert!(matches!(error.error, Error::StepTooLong { .. } | Error::Unsolvable { .. }), "{error:?}");
    assert_eq!(stepper.advance(&mut state, 5).unwrap_err(), error);
    assert_eq!(state.steps(), 0);
    Ok(())
}

#[test]
fn inputs_are_checked_before_the_step() -> Result<(), SiteError> {
    let rod = CosseratRod {
        section: Vector4::from_element(1.0),
        weight: 0.0,
        stiffness: SVector::from_element(1.0),
        reference: SVector::zeros(),
        damping: 0.0,
    };
    let stepper = rod.grid([2]).stepper(0.01)?;
    let mut state = stepper.state([Matrix4::identity(); 2], [SVector::<f64, 6>::zeros(); 2])?;
    let wrench = SVector::<f64, 6>::zeros();
    let error = stepper.step_with(&mut state, &[wrench]).unwrap_err();
    assert_eq!(error.error, Error::NumberOfSites { found: 1, sites: 2 });
    let error = stepper.step_with(&mut state, &[wrench, wrench.add_scalar(f64::INFINITY)]).unwrap_err();
    assert_eq!(error, SiteError { site: Some(1), error: Error::NotFinite { name: "the input" } });
    stepper.step_with(&mut state, &[wrench, wrench])
}
