//! Slabs that exchange their rows have the bits of the grid: configurations, momenta, energies and conserved momenta.

use clebsch::{
    Clebsch, Conserved, Conserves, Domain, Error, Field, Grid, MovingField, Population, Side, Sides, SiteError,
};
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Matrix3, Rotation3, UnitVector3, Vector1, Vector2, Vector3};
use std::ops::Range;
use std::sync::{Barrier, Mutex};

/// Displacements whose edges are added one by one.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<2>, x: Vector2| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |t, x| self.stiffness * (1 - x.x.cos()) * (1 + t),
    space     = [
        |dx, x, next| self.stiffness * (next - x).norm_squared().powi(2) / dx.powi(2) + (next.x - x.x).cos(),
        |dy, x, next| (next - x).norm_squared() / (2 * dy.powi(2)),
    ],
    order     = 4,
)]
struct Sheet {
    mass: f64,
    stiffness: f64,
}

/// Rotations along a line, of order 6.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |ds, W| (W - I).norm_squared() / (4 * ds),
    order  = 6,
)]
struct Ribbon;

/// Displacements in three directions of space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = [
        |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)) + (next.x - x.x).cos(),
        |dy, x, next| (next - x).norm_squared() / (2 * dy.powi(2)),
        |dz, x, next| (next - x).norm_squared() / (2 * dz.powi(2)),
    ],
)]
struct Block;

const STEPS: u64 = 7;

/// Every pair of sides.
const SIDES: [Sides; 5] = [
    Sides::Periodic,
    Sides::Open(Side::Free, Side::Free),
    Sides::Open(Side::Fixed, Side::Free),
    Sides::Open(Side::Free, Side::Fixed),
    Sides::Open(Side::Fixed, Side::Fixed),
];

type Point<S> = <S as Clebsch>::Configuration;
type Start<'a, S> = &'a (dyn Fn(usize) -> (Point<S>, <S as Clebsch>::Momentum) + Sync);

/// A field after some steps: configurations, momenta, the energy, and the momenta that it conserves.
type Outcome<S, const K: usize> = (Vec<Point<S>>, Vec<<S as Clebsch>::Momentum>, f64, [f64; K]);

/// The rows where slabs begin and end: uneven ones, the first of one row.
fn cuts(rows: usize, parts: usize) -> Vec<Range<usize>> {
    let end = |part: usize| if part == 1 && parts > 1 { 1 } else { part * rows / parts };
    (0..parts).map(|part| end(part)..end(part + 1)).collect()
}

/// The steps of a grid.
fn whole<S, P, const D: usize, const K: usize>(
    domain: &Domain<S, Grid<f64, D>, P>,
    (h, start): (f64, Start<'_, S>),
) -> Result<Outcome<S, K>, SiteError>
where
    S: Field<D> + MovingField + Clebsch<Scalar = f64> + Conserves<Conserved = Conserved<f64, K>> + Clone,
    P: Population,
{
    let (q, mu): (Vec<_>, Vec<_>) = (0..domain.lattice().sites()).map(start).unzip();
    let stepper = domain.clone().stepper(h)?;
    let mut state = stepper.state(q, mu)?;
    stepper.advance(&mut state, STEPS)?;
    let (energy, momenta) = (stepper.energy(&state)?, stepper.conserved(&state)?);
    let (q, mu) = state.into_storage();
    Ok((q, mu, energy, core::array::from_fn(|k| momenta[k])))
}

/// The steps of slabs that hand their rows to each other, each on a thread of its own.
fn by_slabs<S, P, const D: usize, const K: usize>(
    domain: &Domain<S, Grid<f64, D>, P>,
    parts: usize,
    (h, start): (f64, Start<'_, S>),
    exchanges: bool,
) -> Result<Outcome<S, K>, SiteError>
where
    S: Field<D> + MovingField + Clebsch<Scalar = f64> + Conserves<Conserved = Conserved<f64, K>> + Clone + Sync,
    Point<S>: Send,
    S::Momentum: Send,
    P: Population,
    P::Of<S>: Sync,
{
    let grid = *domain.lattice();
    let board = Mutex::new((0..grid.sites()).map(|site| start(site).0).collect::<Vec<_>>());
    let barrier = Barrier::new(parts);
    let run = |rows: Range<usize>| {
        let part = domain.slab(rows)?;
        let slab = part.lattice().clone();
        let index = |site| slab.place(site).and_then(|place| grid.index(place)).expect("a site");
        let (q, mu): (Vec<_>, Vec<_>) = (0..slab.sites()).map(|site| start(index(site))).unzip();
        let stepper = part.stepper(h)?;
        let mut state = stepper.state(q, mu)?;
        stepper.advance_exchanging(&mut state, STEPS, |q, result| {
            if exchanges {
                slab.own().for_each(|site| board.lock().expect("a board")[index(site)] = q[site]);
                barrier.wait();
                for row in slab.rows_before().chain(slab.rows_after()) {
                    slab.row(row)
                        .expect("a row")
                        .for_each(|site| q[site] = board.lock().expect("a board")[index(site)]);
                }
                barrier.wait();
            }
            result
        })?;
        let energies: Vec<f64> = stepper.energy_of_rows(&state)?.collect();
        let momenta: Vec<Conserved<f64, K>> = stepper.conserved_of_rows(&state)?.collect();
        let (q, mu) = state.into_storage();
        Ok((q[slab.own()].to_vec(), mu[slab.own()].to_vec(), energies, momenta))
    };
    let outcomes: Result<Vec<_>, SiteError> = std::thread::scope(|scope| {
        let cuts = cuts(grid.sizes()[0], parts).into_iter();
        let threads: Vec<_> = cuts.map(|rows| scope.spawn(|| run(rows))).collect();
        threads.into_iter().map(|thread| thread.join().expect("a slab")).collect()
    });
    let (mut q, mut mu, mut energies, mut momenta) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for part in outcomes? {
        q.extend(part.0);
        mu.extend(part.1);
        energies.extend(part.2);
        momenta.extend(part.3);
    }
    let stepper = domain.clone().stepper(h)?;
    let conserved = core::array::from_fn(|k| stepper.total(momenta.iter().map(|momenta| momenta[k])));
    Ok((q, mu, stepper.total(energies), conserved))
}

/// Slabs agree with the grid, bit for bit, for every number of them.
fn agree<S, P, const D: usize, const K: usize>(
    domain: &Domain<S, Grid<f64, D>, P>,
    start: Start<'_, S>,
) -> Result<(), SiteError>
where
    S: Field<D> + MovingField + Clebsch<Scalar = f64> + Conserves<Conserved = Conserved<f64, K>> + Clone + Sync,
    Point<S>: Send,
    S::Momentum: Send,
    P: Population,
    P::Of<S>: Sync,
{
    let rows = domain.lattice().sizes()[0];
    let expected: Outcome<S, K> = whole(domain, (0.05, start))?;
    for parts in (1..=rows).filter(|parts| *parts < 4 || *parts == rows) {
        let found = by_slabs(domain, parts, (0.05, start), true)?;
        assert!(found == expected, "{parts} slabs of {:?}", domain.lattice());
    }
    Ok(())
}

fn spin(site: usize) -> (Vector3<f64>, Vector3<f64>) {
    let x = site as f64;
    let q = UnitVector3::new_normalize(Vector3::new(x.sin(), (1.3 * x).cos(), 2.0)).into_inner();
    (q, q.cross(&Vector3::new((0.7 * x).cos(), 0.2, (2.0 * x).sin())) * 0.1)
}

fn height(site: usize) -> (Vector1<f64>, Vector1<f64>) {
    (Vector1::new((1.7 * site as f64).sin()), Vector1::new((0.9 * site as f64).cos() * 0.3))
}

fn shift(site: usize) -> (Vector2<f64>, Vector2<f64>) {
    let x = site as f64;
    (Vector2::new((1.7 * x).sin(), (2.3 * x).cos()), Vector2::new((0.9 * x).cos() * 0.3, 0.1))
}

fn turn(site: usize) -> (Matrix3<f64>, Vector3<f64>) {
    let x = site as f64;
    let axis = Vector3::new(x.sin(), 0.5 * x.cos(), 0.3);
    (Rotation3::new(axis).into_inner(), Vector3::new(0.1, (0.6 * x).sin() * 0.2, -0.1))
}

#[test]
fn slabs_of_sheets_are_the_sheet() -> Result<(), SiteError> {
    for (sizes, first) in [[2, 5], [3, 1], [8, 7]].into_iter().flat_map(|sizes| SIDES.map(|sides| (sizes, sides))) {
        for second in [Sides::Periodic, Sides::Open(Side::Fixed, Side::Free)] {
            // forces of all edges of a site at once
            agree(&WaveMap.grid(sizes).spacing([0.3, 0.4]).sides([first, second]), &spin)?;
            // forces edge by edge, with parameters that are alike and that are not, and with steps of order 4
            let sheet = Sheet { mass: 0.7, stiffness: 0.4 }.grid(sizes).spacing([0.8, 0.9]).sides([first, second]);
            agree(&sheet, &shift)?;
            let own =
                |[i, j]: [usize; 2]| Sheet { mass: 1.0 + i as f64 * 0.1, stiffness: 0.3 + 0.01 * (i + 2 * j) as f64 };
            agree(&sheet.various(own), &shift)?;
        }
    }
    Ok(())
}

#[test]
fn slabs_of_lines_and_blocks_are_the_whole() -> Result<(), SiteError> {
    for sides in SIDES {
        for sites in [2, 3, 9] {
            agree(&Ribbon.grid([sites]).spacing([0.5]).sides([sides]), &turn)?;
        }
        agree(&Block.grid([5, 3, 4]).sides([sides, Sides::Periodic, Sides::Open(Side::Free, Side::Fixed)]), &height)?;
    }
    // more rows than are added in one run
    agree(&Ribbon.grid([700]).spacing([0.5]).periodic(), &turn)
}

/// Without an exchange the bits are others. After few steps they are so near the cuts alone.
#[test]
fn slabs_without_exchange_are_not_the_whole() -> Result<(), SiteError> {
    let sheet = WaveMap.grid([40, 3]).spacing([0.3, 0.4]).periodic();
    let expected: Outcome<WaveMap, 3> = whole(&sheet, (0.05, &spin))?;
    let found: Outcome<WaveMap, 3> = by_slabs(&sheet, 2, (0.05, &spin), false)?;
    let differs = |row: usize| (3 * row..3 * row + 3).any(|site| found.0[site] != expected.0[site]);
    // slabs of row 0 and of rows 1 to 39: an error travels by a row in each step
    assert!(differs(0) && differs(1) && differs(39));
    assert!((8..=31).all(|row| !differs(row)));
    Ok(())
}

/// A slab by itself has the rows of its neighbours as a fixed side has them.
#[test]
fn rows_of_neighbours_do_not_move() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([9, 4]).slab(3..6)?.stepper(0.05)?;
    let (q, mu): (Vec<_>, Vec<_>) = (0..20).map(spin).unzip();
    let mut state = stepper.state(q.clone(), mu.clone())?;
    stepper.advance(&mut state, 10)?;
    let alone = WaveMap.grid([5, 4]).sides([SIDES[4], SIDES[1]]).stepper(0.05)?;
    let mut expected = alone.state(q.clone(), mu.clone())?;
    alone.advance(&mut expected, 10)?;
    assert_eq!((state.configuration(), state.momentum()), (expected.configuration(), expected.momentum()));
    let mut by_threads = stepper.state(q.clone(), mu)?;
    stepper.par_advance(&mut by_threads, 10)?;
    assert_eq!(by_threads, state);
    assert!(state.configuration()[..4] == q[..4] && state.configuration()[16..] == q[16..]);
    Ok(())
}

#[test]
fn rows_that_are_not_there_are_refused() {
    let refused = |rows: Range<usize>| WaveMap.grid([9, 4]).slab(rows).map(|part| part.lattice().rows()).unwrap_err();
    assert_eq!(refused(3..3), Error::Rows { first: 3, end: 3, rows: 9 });
    assert_eq!(refused(8..10), Error::Rows { first: 8, end: 10, rows: 9 });
    #[allow(clippy::reversed_empty_ranges, reason = "what is refused")]
    let turned = refused(5..2);
    assert_eq!(turned, Error::Rows { first: 5, end: 2, rows: 9 });
    assert_eq!(refused(usize::MAX - 1..usize::MAX), Error::Rows { first: usize::MAX - 1, end: usize::MAX, rows: 9 });
    let empty = WaveMap.grid([9, 0]).slab(0..1).map(|part| part.lattice().rows()).unwrap_err();
    assert_eq!(empty, Error::EmptyGrid { direction: 1, sites: 0 });
}
