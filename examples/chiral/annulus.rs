//! A connection on an annulus: flat on every face, with a holonomy around the hole.

use clebsch::{Clebsch, Domain, Error, Field, Mesh};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};
use std::f64::consts::TAU;

/// Rotations at the corners of triangles.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    space  = |length, W| (W - I).norm_squared() / 4,
    emit   = [connection],
)]
struct Frames;

/// Sectors and rings of squares, each of two triangles.
const SECTORS: usize = 24;
const RINGS: usize = 4;
/// Turns around the hole, in units of 2π.
const TURNS: [f64; 4] = [0.25, -0.4, 0.7, 1.0];

/// The annulus: the places of its sites, and the field on them.
type Annulus = (Vec<Vector2<f64>>, Domain<Frames, Mesh<f64>>);

fn annulus() -> Result<Annulus, Failure> {
    let place = |site: usize| {
        let (angle, radius) = (TAU * (site % SECTORS) as f64 / SECTORS as f64, 1.0 + (site / SECTORS) as f64 / 3.0);
        Vector2::new(angle.cos(), angle.sin()) * radius
    };
    let square = |k: usize| {
        let (ring, i, next) = (k / SECTORS, k % SECTORS, (k + 1) % SECTORS);
        let [a, b] = [ring * SECTORS + i, (ring + 1) * SECTORS + i];
        let [c, d] = [(ring + 1) * SECTORS + next, ring * SECTORS + next];
        [[a, b, c], [a, c, d]]
    };
    let vertices: Vec<Vector2<f64>> = (0..SECTORS * (RINGS + 1)).map(place).collect();
    let faces: Vec<[usize; 3]> = (0..SECTORS * RINGS).flat_map(square).collect();
    let domain = Frames.mesh(&vertices, &faces)?;
    Ok((vertices, domain))
}

/// Turns W = exp(α angle) about one axis, with the angle between the ends of each edge seen from the hole.
///
/// # Errors
/// Those of meshes.
pub fn around(claims: &mut Claims) -> Result<Table<4>, Failure> {
    let (vertices, domain) = annulus()?;
    let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    let ring: Vec<usize> = (SECTORS..2 * SECTORS).collect();
    let mut table = Table::new(["turns", "curvature", "holonomy − closed form", "reconstruction"]);
    let (mut curvature, mut off, mut as_expected) = (0.0, 0.0, true);
    for turns in TURNS {
        let angle = |[a, b]: [usize; 2]| {
            let (a, b) = (vertices[a], vertices[b]);
            (a.x * b.y - a.y * b.x).atan2(a.dot(&b))
        };
        let turn = |edge: [usize; 2]| Rotation3::new(axis * (turns * angle(edge))).into_inner();
        let elements: Vec<Matrix3<f64>> = domain.lattice().edges().map(turn).collect();
        let flat = domain.flatness(&elements)?;
        let expected = Rotation3::new(axis * (TAU * turns)).into_inner();
        let apart = (domain.holonomy(&elements, &ring)? - expected).amax();
        let reconstruction = match domain.reconstruct(&elements, (0, Matrix3::identity()), 1e-9) {
            Ok(_) => "a configuration".to_owned(),
            Err(clebsch::SiteError { error: Error::NotFlat { from, to, .. }, .. }) => {
                format!("refused at the edge from {from} to {to}")
            }
            Err(error) => return Err(error.into()),
        };
        // a turn by 2π is the identity
        as_expected &= (turns == 1.0) == reconstruction.starts_with('a');
        (curvature, off) = (largest([curvature, flat]), largest([off, apart]));
        table.row([turns.to_string(), format!("{flat:.1e}"), format!("{apart:.1e}"), reconstruction]);
    }
    claims.round_off("annulus: curvature of all faces", curvature, 3, 1.0);
    claims.round_off("annulus: holonomy is a turn by 2π α", off, SECTORS as u64, 1.0);
    claims.holds("annulus: only whole turns have a configuration", as_expected, "the others are refused with an edge");
    Ok(table)
}
