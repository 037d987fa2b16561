//! Steps on several threads have the bits of those on one, however sites are shared out.

use clebsch::{Clebsch, Field, Side, Sides, SiteError};
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{UnitVector3, Vector1, Vector3};

/// Displacements whose edges are added one by one.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| self.stiffness * (1 - x.x.cos()),
    space     = [
        |dx, x, next| (next - x).norm_squared().powi(2) / dx.powi(2) + (next.x - x.x).cos(),
        |dy, x, next| (next - x).norm_squared() / (2 * dy.powi(2)),
    ],
)]
struct Sheet {
    stiffness: f64,
}

/// The same in one direction, whose row is shared out.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, W| W.norm_squared() / (2 * dx.powi(2)) + W.x.cos(),
)]
struct Line;

/// More sites than one share has.
const SIZES: [[usize; 2]; 3] = [[97, 131], [3, 4500], [4500, 3]];
const STEPS: u64 = if cfg!(feature = "heavy") { 10 } else { 2 };
const SIDES: [Sides; 2] = [Sides::Periodic, Sides::Open(Side::Free, Side::Fixed)];

#[test]
fn threads_have_the_same_bits() -> Result<(), SiteError> {
    let sheet = Sheet { stiffness: 0.3 };
    for (sizes, sides) in SIZES.into_iter().flat_map(|sizes| SIDES.map(|sides| (sizes, [sides; 2]))) {
        let sites = sizes[0] * sizes[1];
        let spin = |i: usize| Vector3::new((i as f64).sin(), (1.3 * i as f64).cos(), 2.0);
        let spins: Vec<_> = (0..sites).map(|i| UnitVector3::new_normalize(spin(i)).into_inner()).collect();
        let waves = WaveMap.grid(sizes).sides(sides).stepper(0.1)?;
        let start = waves.state(spins, vec![Vector3::zeros(); sites])?;
        let heights: Vec<_> = (0..sites).map(|i| Vector1::new((i as f64).sin())).collect();
        let alike = sheet.grid(sizes).sides(sides);
        let various = alike.clone().various(|[i, j]| Sheet { stiffness: (i + 2 * j) as f64 * 1e-4 }).stepper(0.1)?;
        let alike = alike.stepper(0.1)?;
        let sheet = alike.state(heights.clone(), vec![Vector1::zeros(); sites])?;
        let (mut one, mut two, mut three) = (start.clone(), sheet.clone(), sheet.clone());
        waves.advance(&mut one, STEPS)?;
        alike.advance(&mut two, STEPS)?;
        various.advance(&mut three, STEPS)?;
        let (mut a, mut b, mut c) = (start, sheet.clone(), sheet);
        waves.par_advance(&mut a, STEPS)?;
        alike.par_advance(&mut b, STEPS)?;
        various.par_advance(&mut c, STEPS)?;
        assert!(a == one && b == two && c == three, "{sizes:?} {sides:?}");
    }
    Ok(())
}

#[test]
fn rows_are_shared_out() -> Result<(), SiteError> {
    for sides in SIDES {
        let stepper = Line.grid([10_007]).sides([sides]).stepper(0.1)?;
        let heights: Vec<_> = (0..10_007).map(|i| Vector1::new(f64::from(i).sin())).collect();
        let mut one = stepper.state(heights, vec![Vector1::zeros(); 10_007])?;
        let mut other = one.clone();
        stepper.advance(&mut one, 10)?;
        stepper.par_advance(&mut other, 10)?;
        assert!(one == other);
    }
    Ok(())
}

/// The site of an error is the first one, as without threads.
#[test]
fn errors_name_the_first_site() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([100, 100]).stepper(0.1)?;
    let mut momenta = vec![Vector3::zeros(); 10_000];
    (momenta[9000].x, momenta[5000].x) = (11.0, 11.0);
    let mut state = stepper.state(vec![Vector3::z(); 10_000], momenta)?;
    let mut other = state.clone();
    let (one, two) = (stepper.advance(&mut state, 1), stepper.par_advance(&mut other, 1));
    assert_eq!(one, two);
    assert_eq!(one.unwrap_err().site, Some(5000));
    Ok(())
}
