//! Curves of millions of points with as many as a picture can show.

/// Parts of a curve; each is narrower than a pixel of a wide picture.
const PARTS: usize = 1500;

/// The same curve to the eye: of each part along x the first, the lowest, the highest and the last point.
///
/// Source: Jugel, Jerzak, Hackenbroich and Markl, *M4: a visualization-oriented time series data aggregation*, 2014.
pub(crate) fn thin(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) else { return points };
    if points.len() <= 4 * PARTS {
        return points;
    }
    let pace = last.0 / PARTS as f64 - first.0 / PARTS as f64;
    let part = |point: &(f64, f64)| ((point.0 - first.0) / pace).floor();
    let mut thinned = Vec::new();
    for run in points.chunk_by(|a, b| part(a).total_cmp(&part(b)).is_eq()) {
        let mut seen: Vec<usize> = vec![0, run.len() - 1];
        let by_height = |i: &usize, j: &usize| run[*i].1.total_cmp(&run[*j].1);
        seen.extend((0..run.len()).min_by(by_height));
        seen.extend((0..run.len()).max_by(by_height));
        seen.sort_unstable();
        seen.dedup();
        thinned.extend(seen.into_iter().map(|index| run[index]));
    }
    thinned
}

#[cfg(test)]
mod tests {
    use super::{PARTS, thin};

    #[test]
    fn long_curves_have_their_ends_and_their_peaks() {
        let mut points: Vec<(f64, f64)> = (0..1_000_000).map(|i| (f64::from(i), (f64::from(i) / 1e3).sin())).collect();
        points[123_456].1 = 7.0;
        points[654_321].1 = -7.0;
        let thinned = thin(points.clone());
        assert!(thinned.len() <= 4 * (PARTS + 1), "{}", thinned.len());
        for index in [0, 123_456, 654_321, 999_999] {
            assert!(thinned.contains(&points[index]));
        }
        assert!(thinned.iter().all(|point| points[point.0 as usize] == *point));
        assert!(thinned.is_sorted_by(|a, b| a.0 < b.0));
        // times that stand still are one part
        assert!(thin(vec![(1.0, 2.0); 10_000]).len() <= 4);
        assert!(thin(Vec::new()).is_empty());
    }
}
