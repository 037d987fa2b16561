//! Plans whose start is unknown: estimates, against the Kalman filter, dense least squares, Wahba's problem, differences and statistics.

use super::long;
use clebsch::{Clebsch, Control, Controlled, Ended, Error, Limits, Prior, Stage, Target};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix1, Matrix2, Matrix3, Matrix6, Rotation3, SMatrix, Vector1, Vector2, Vector3, Vector6};

const H: f64 = 0.1;

/// A linear system that noise w moves. One number of it is seen at each step and at the end.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |x: Vector3, w: Vector2| self.carry * x + self.enter * w,
    cost     = |x, w, seen: Vector1| (w.norm_squared() / self.noise + (self.look.dot(&x) - seen.x).powi(2) / self.error) / 2,
    endpoint = |x, last: Vector1| (self.look.dot(&x) - last.x).powi(2) / self.error / 2,
)]
struct Linear {
    carry: Matrix3<f64>,
    enter: SMatrix<f64, 3, 2>,
    look: Vector3<f64>,
    /// Variances.
    noise: f64,
    error: f64,
}

impl Linear {
    fn new(random: &mut Random) -> Self {
        Self {
            carry: Matrix3::identity() + 0.3 * random.matrix::<3, 3>(),
            enter: random.matrix(),
            look: random.vector(),
            noise: random.between(0.1, 1.0),
            error: random.between(0.01, 0.1),
        }
    }

    /// The mean and the covariance of a Kalman filter, after it has seen this.
    fn seen(&self, (mean, covariance): (Vector3<f64>, Matrix3<f64>), seen: f64) -> (Vector3<f64>, Matrix3<f64>) {
        let along = covariance * self.look;
        let gain = along / (self.look.dot(&along) + self.error);
        (mean + gain * (seen - self.look.dot(&mean)), covariance - gain * along.transpose())
    }

    /// The same a step later.
    fn carried(&self, (mean, covariance): (Vector3<f64>, Matrix3<f64>)) -> (Vector3<f64>, Matrix3<f64>) {
        let noise = self.noise * self.enter * self.enter.transpose();
        (self.carry * mean, self.carry * covariance * self.carry.transpose() + noise)
    }
}

/// A body that torques of noise turn. Its attitude is seen, and the rate of each step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |R, omega, torque, (stars, gyros): (Matrix3, Vector3)| {
        (torque.norm_squared() * self.calm + (R - stars).norm_squared() * self.stars + (omega - gyros).norm_squared() * self.gyros) / 2
    },
)]
struct Tumbling {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    /// 1/variance of torques, half of that of attitudes, and that of rates.
    calm: f64,
    stars: f64,
    gyros: f64,
}

type Attitude = (Matrix3<f64>, Vector3<f64>);
type Seen = (Matrix3<f64>, Vector3<f64>);

/// The velocity of the step between two attitudes, by the inverse of Cayley's map.
fn rate(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Vector3<f64> {
    let turn = from.transpose() * to;
    let twist = turn - turn.transpose();
    Vector3::new(twist[(2, 1)], twist[(0, 2)], twist[(1, 0)]) * 2.0 / ((1.0 + turn.trace()) * H)
}

fn turned(by: Vector3<f64>) -> Matrix3<f64> {
    Rotation3::new(by).into_inner()
}

/// Numbers with a normal distribution.
fn normal<const M: usize>(random: &mut Random) -> SMatrix<f64, M, 1> {
    SMatrix::from_fn(|_, _| (0..12).map(|_| random.between(0.0, 1.0)).sum::<f64>() - 6.0)
}

impl Tumbling {
    fn new(random: &mut Random) -> Self {
        Self { inertia: random.inertia(), calm: 25.0, stars: 5000.0, gyros: 400.0 }
    }

    /// A motion from `start` with torques of noise: its states, and measurements of them.
    fn motion(&self, start: Attitude, steps: usize, random: &mut Random) -> Result<(Vec<Attitude>, Vec<Seen>), Error> {
        let control = self.clone().control(H)?;
        let (mut states, mut all) = (vec![start], Vec::new());
        for k in 0..steps {
            let torque = normal::<3>(random) / self.calm.sqrt();
            let next = control.follow(&states[k], &torque)?;
            let attitude = states[k].0 * turned(normal::<3>(random) / (2.0 * self.stars).sqrt());
            all.push((attitude, rate(&states[k].0, &next.0) + normal::<3>(random) / self.gyros.sqrt()));
            states.push(next);
        }
        Ok((states, all))
    }

    fn random_state(&self, random: &mut Random) -> Attitude {
        (random.attitude::<3>(), self.inertia * random.vector::<3>() * 2.0)
    }
}

#[test]
fn linear_estimates_are_those_of_a_kalman_filter() -> Result<(), Error> {
    let random = &mut Random::new(4501);
    for _ in 0..10 {
        let system = Linear::new(random);
        let mean = random.vector::<3>();
        let root = random.matrix::<3, 3>() + Matrix3::identity();
        let covariance = root * root.transpose() + Matrix3::identity() * 0.1;
        let prior = Prior::new(mean, covariance.try_inverse().unwrap());
        let seen: Vec<f64> = (0..13).map(|_| 2.0 * random.number()).collect();
        let control = system.clone().control(H)?.with_prior(prior)?.with_end_reference(Vector1::new(seen[12]))?;
        let guess = random.vector();
        let mut plan = [control.stage(&guess); 12];
        control.refer(&mut plan, |k, _| Vector1::new(seen[k]));
        let estimate = control.solve(&guess, Target::Free, &mut plan)?;
        assert!(estimate.iterations() <= 3 && estimate.is_minimum(), "{estimate:?}");
        let end = *estimate.end();
        let mut filter = (mean, covariance);
        for seen in &seen[..12] {
            filter = system.carried(system.seen(filter, *seen));
        }
        let ahead = control.arrival_cost(&plan, 12)?.covariance().unwrap();
        assert!((ahead - filter.1).norm() < 1e-10 * filter.1.norm(), "{ahead} {}", filter.1);
        filter = system.seen(filter, seen[12]);
        let known = control.end_information(&plan)?.try_inverse().unwrap();
        assert!((end - filter.0).norm() < 1e-9, "{end} {}", filter.0);
        assert!((known - filter.1).norm() < 1e-9 * filter.1.norm(), "{known} {}", filter.1);
    }
    Ok(())
}

/// With arrival costs a short window says as much of the end as all that was ever seen.
#[test]
fn sliding_windows_of_linear_systems_lose_nothing() -> Result<(), Error> {
    let random = &mut Random::new(4502);
    for steps in [1, 2, 3] {
        let system = Linear::new(random);
        let seen: Vec<f64> = (0..31).map(|_| 2.0 * random.number()).collect();
        let (mean, covariance) = (random.vector::<3>(), Matrix3::identity() * 0.5);
        let information = covariance.try_inverse().unwrap();
        let mut control = system.clone().control(H)?.with_prior(Prior::new(mean, information))?;
        let mut plan = [control.stage(&mean); 4];
        let mut filter = (mean, covariance);
        (0..4).for_each(|k| filter = system.carried(system.seen(filter, seen[k])));
        let mut first = 0;
        while first + 4 + steps <= 30 {
            control.refer(&mut plan, |k, _| Vector1::new(seen[first + k]));
            let control_at_end = control.clone().with_end_reference(Vector1::new(seen[first + 4]))?;
            let guess = *control.prior().place();
            let end = *control_at_end.solve(&guess, Target::Free, &mut plan)?.end();
            let known = control_at_end.end_information(&plan)?.try_inverse().unwrap();
            let expected = system.seen(filter, seen[first + 4]);
            assert!((end - expected.0).norm() < 1e-8, "{first}: {end} {}", expected.0);
            assert!((known - expected.1).norm() < 1e-8 * expected.1.norm(), "{first}: {known} {}", expected.1);
            (0..steps).for_each(|k| filter = system.carried(system.seen(filter, seen[first + 4 + k])));
            control.slide(&mut plan, steps)?;
            first += steps;
        }
        assert!(first > 20, "{first}");
    }
    Ok(())
}

/// Directions that are seen say which attitude it is. Wahba's problem has a closed form, by singular values.
#[test]
fn an_attitude_from_directions_is_that_of_wahba() -> Result<(), Error> {
    /// An attitude that nothing turns, with three directions of the body and of space.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action   = |F: SO<3>, R: SO<3>| R * F,
        controls = |u: Vector3| u,
        cost     = |R, u, (space, body): (Matrix3, Matrix3)| (u.norm_squared() + (space - R * body).norm_squared()) / 2,
    )]
    struct Still {}

    let random = &mut Random::new(4503);
    let mut apart: f64 = 0.0;
    for _ in 0..20 {
        let (truth, body) = (random.attitude::<3>(), random.matrix::<3, 3>());
        let space = truth * body + 0.1 * random.matrix::<3, 3>();
        let svd = (space * body.transpose()).svd(true, true);
        let (u, v) = (svd.u.unwrap(), svd.v_t.unwrap());
        let sign = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v).determinant().signum()));
        // singular values are sorted, so that the last direction is the one to mirror
        let expected = u * sign * v;
        let guess = random.attitude::<3>();
        let control = Still {}.control(H)?.with_prior(Prior::unknown(guess))?;
        let mut plan = [control.stage(&guess).with_reference((space, body))];
        let estimate = control.solve(&guess, Target::Free, &mut plan)?;
        let found = estimate.stages()[0].place();
        let cost = |attitude: &Matrix3<f64>| (space - attitude * body).norm_squared() / 2.0;
        assert!((estimate.price() - cost(found)).abs() < 1e-12, "{estimate:?}");
        if (found - expected).norm() > 1e-7 {
            // another minimum
            assert!(estimate.is_minimum() && cost(found) > cost(&expected), "{found} {expected} {estimate:?}");
            apart += 1.0;
        }
    }
    assert!(apart <= 2.0, "{apart}");
    Ok(())
}

/// The price of an estimate, by a roll-out.
fn price(
    control: &Control<Tumbling, 6, 3, 0>,
    prior: &Prior<Attitude, f64, 6>,
    plan: &[Stage<Tumbling, 6, 3, 0>],
    start: Attitude,
    inputs: &[Vector3<f64>],
) -> Result<f64, Error> {
    let system = control.system();
    let change: Vector6<f64> = system.displacement(prior.place(), &start);
    let mut price = prior.slope().dot(&change) + change.dot(&(prior.information() * change)) / 2.0;
    let mut x = start;
    for (stage, input) in plan.iter().zip(inputs) {
        let next = control.follow(&x, input)?;
        let (stars, gyros) = stage.reference();
        price += (input.norm_squared() * system.calm
            + (x.0 - stars).norm_squared() * system.stars
            + (rate(&x.0, &next.0) - gyros).norm_squared() * system.gyros)
            / 2.0;
        x = next;
    }
    Ok(price)
}

#[test]
fn estimates_of_a_body_are_stationary_in_start_and_inputs() -> Result<(), Error> {
    let random = &mut Random::new(4504);
    for _ in 0..5 {
        let system = Tumbling::new(random);
        let (states, seen) = system.motion(system.random_state(random), 8, random)?;
        let root = random.matrix::<6, 6>();
        let near = (states[0].0 * turned(0.3 * random.vector()), states[0].1 + random.vector());
        let slope = random.vector::<6>() * 20.0;
        let prior = Prior::new(near, root * root.transpose() * 30.0).with_slope(slope);
        let known = system.clone().control(H)?;
        let control = known.clone().with_prior(prior)?;
        let guess = system.random_state(random);
        let mut plan = [control.stage(&guess); 8];
        control.refer(&mut plan, |k, _| seen[k]);
        let estimate = control.solve(&guess, Target::Free, &mut plan)?;
        assert!(estimate.is_minimum(), "{estimate:?}");
        let found = estimate.price();
        let start = *plan[0].place();
        let inputs: Vec<_> = plan.iter().map(|stage| *stage.input()).collect();
        let expected = price(&known, &prior, &plan, start, &inputs)?;
        assert!((found - expected).abs() < 1e-11 * expected, "{found} {expected}");
        let part = 1e-5;
        for direction in 0..6 {
            let by = |size: f64| {
                let change = Vector6::from_fn(|i, _| if i == direction { size } else { 0.0 });
                price(&known, &prior, &plan, known.system().moved(&start, &change), &inputs)
            };
            let [above, below] = [by(part)?, by(-part)?];
            assert!((above - below).abs() / (2.0 * part) < 1e-5 * (1.0 + expected), "{direction}: {above} {below}");
            assert!(above > expected && below > expected, "{direction}");
        }
        for k in [0, 3, 7] {
            let by = |size: f64| {
                let mut inputs = inputs.clone();
                inputs[k].y += size;
                price(&known, &prior, &plan, start, &inputs)
            };
            let [above, below] = [by(part)?, by(-part)?];
            assert!((above - below).abs() / (2.0 * part) < 1e-5 * (1.0 + expected), "input {k}: {above} {below}");
        }
    }
    Ok(())
}

/// Nothing is known of the start, and guesses are anywhere. Without noise the truth is found.
#[test]
fn a_motion_without_noise_is_found_from_far_guesses() -> Result<(), Error> {
    let random = &mut Random::new(4505);
    let (mut work, mut found) = (Vec::new(), 0);
    let cases = long(40);
    for _ in 0..cases {
        let system = Tumbling { calm: 1e18, stars: 1e18, gyros: 1e18, ..Tumbling::new(random) };
        let start = system.random_state(random);
        let (states, seen) = system.motion(start, 12, random)?;
        let system = Tumbling { calm: 25.0, stars: 5000.0, gyros: 400.0, ..system };
        let guess = system.random_state(random);
        let control = system.control(H)?.with_prior(Prior::unknown(guess))?;
        let mut plan = [control.stage(&guess); 12];
        control.refer(&mut plan, |k, _| seen[k]);
        let estimate = control.solve(&guess, Target::Free, &mut plan)?;
        work.push(estimate.iterations());
        let (end, begun) = (estimate.end(), estimate.stages()[0].place());
        let apart = (end.0 - states[12].0).norm() + (begun.0 - start.0).norm() + (begun.1 - start.1).norm();
        found += usize::from(apart < 1e-6);
    }
    work.sort_unstable();
    assert!(found == cases && work[cases / 2] <= 15 && work[cases - 1] <= 40, "{found} {work:?}");
    Ok(())
}

/// The estimate is as far from the truth as its covariance says, and a sliding window is as good as a plan of all steps.
#[test]
fn errors_of_sliding_estimates_have_the_covariance_that_they_say() -> Result<(), Error> {
    let random = &mut Random::new(4506);
    let (mut squares, mut count, mut apart) = (0.0, 0.0, 0.0_f64);
    for _ in 0..long(20) {
        let system = Tumbling::new(random);
        let (states, seen) = system.motion(system.random_state(random), 24, random)?;
        let information = Matrix6::from_diagonal(&Vector6::new(100.0, 100.0, 100.0, 4.0, 4.0, 4.0));
        let off = normal::<6>(random);
        let mean = (states[0].0 * turned(off.fixed_rows::<3>(0) / 10.0), states[0].1 + off.fixed_rows::<3>(3) / 2.0);
        let prior = Prior::new(mean, information);
        let mut control = system.control(H)?.with_prior(prior)?;
        let batch = control.clone();
        let mut all: Vec<Stage<Tumbling, 6, 3, 0>> = Vec::new();
        let mut plan = [control.stage(&mean); 8];
        control.refer(&mut plan, |k, _| seen[k]);
        for last in 8..=24 {
            let guess = *control.prior().place();
            let end = *control.solve(&guess, Target::Free, &mut plan)?.end();
            let information = control.end_information(&plan)?;
            if last % 8 == 0 {
                let error: Vector6<f64> = control.system().displacement(&end, &states[last]);
                squares += error.dot(&(information * error));
                count += 1.0;
                let begun = all.first().map_or(mean, |stage| *stage.place());
                all.resize(last, batch.stage(&mean));
                batch.refer(&mut all, |k, _| seen[k]);
                let full = *batch.solve(&begun, Target::Free, &mut all)?.end();
                let error: Vector6<f64> = control.system().displacement(&full, &end);
                apart = apart.max(error.dot(&(information * error)));
            }
            if last < 24 {
                control.slide(&mut plan, 1)?;
                plan[7] = plan[7].with_reference(seen[last]);
            }
        }
    }
    let mean = squares / count;
    // Six degrees of freedom, within four standard deviations of the mean of so many cases.
    assert!((mean - 6.0).abs() < 4.0 * f64::sqrt(12.0 / count), "{mean} of {count}");
    // In units of the covariance, a window says the same as a plan of all steps.
    assert!(apart < 1e-9, "{apart}");
    Ok(())
}

/// A cart may start anywhere near x = 0, at a price, and has to reach a place. Weighted least squares have a closed form.
#[test]
fn a_target_chooses_the_start() -> Result<(), Error> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
        cost     = |h, u| h * u.norm_squared() / 2,
    )]
    struct Cart {}

    let random = &mut Random::new(4507);
    for _ in 0..10 {
        let root = random.matrix::<2, 2>() + Matrix2::identity();
        let information = root * root.transpose() + Matrix2::identity() * 0.1;
        let (mean, goal) = (random.vector::<2>(), random.vector::<2>());
        let control = Cart {}.control(H)?.with_prior(Prior::new(mean, information))?;
        let mut plan = [control.stage(&mean); 10];
        let found = control.solve(&mean, Target::Place(goal), &mut plan)?;
        assert!(found.gap() < 1e-12 && found.is_minimum(), "{found:?}");
        // x_N = Aᴺx₀ + Σ Aᴺ⁻¹⁻ᵏ B u_k
        let (carry, enter) = (Matrix2::new(1.0, H, 0.0, 1.0), Vector2::new(0.0, H));
        let (mut power, mut gramian) = (Matrix2::identity(), Matrix2::zeros());
        for _ in 0..10 {
            let reach = power * enter;
            gramian += reach * reach.transpose() / H;
            power *= carry;
        }
        let inverse = information.try_inverse().unwrap();
        let all = gramian + power * inverse * power.transpose();
        let multipliers = all.try_inverse().unwrap() * (goal - power * mean);
        let start = mean + inverse * power.transpose() * multipliers;
        let price = multipliers.dot(&(all * multipliers)) / 2.0;
        assert!((found.price() - price).abs() < 1e-10 * (1.0 + price), "{} {price}", found.price());
        assert!((plan[0].place() - start).norm() < 1e-9, "{} {start}", plan[0].place());
    }
    Ok(())
}

/// A mass that is known to be above a floor: its estimate is the mean of the measurements, or the floor.
#[test]
fn bounds_hold_for_estimates() -> Result<(), Error> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        dynamics = |x: Vector1, w: Vector1| x + w,
        cost     = |x, w, seen: Vector1| (1e8 * w.norm_squared() + (x - seen).norm_squared()) / 2,
        bounds   = |x| [self.floor <= x.x],
    )]
    struct Mass {
        floor: f64,
    }

    let random = &mut Random::new(4508);
    for _ in 0..10 {
        let floor = random.number();
        let seen: Vec<f64> = (0..5).map(|_| random.number()).collect();
        let control = Mass { floor }.control(H)?.with_prior(Prior::new(Vector1::new(0.5), Matrix1::new(2.0)))?;
        let guess = Vector1::new(floor + 0.1);
        let mut plan = [control.stage(&guess); 5];
        control.refer(&mut plan, |k, _| Vector1::new(seen[k]));
        let found = control.solve(&guess, Target::Free, &mut plan)?;
        assert!(found.is_minimum(), "{found:?}");
        let expected = ((seen.iter().sum::<f64>() + 1.0) / 7.0).max(floor);
        let start = plan[0].place().x;
        assert!((start - expected).abs() < 1e-6 && start >= floor, "{start} {expected}");
    }
    Ok(())
}

/// A rate and a bias whose sum a gyro measures, and one direction that is seen while it turns slowly. Far from the truth, the price
/// of the sum has to stay one of the sum. Otherwise the bias seems to be known, and corrections creep.
#[test]
fn prices_of_sums_of_place_and_input_let_both_move() -> Result<(), Error> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action   = |(F, s): (SO<3>, Translation<3>), (R, b): (SO<3>, Vector3)| (R * F, b + s),
        controls = |u: Vector3| (u, vector![0, 0, 0]),
        cost     = |R, b, u, (gyro, known, seen): (Vector3, Vector3, Vector3)| {
            ((u + b - gyro).norm_squared() / self.noise + (R.transpose() * known - seen).norm_squared()) / 2
        },
    )]
    struct Gyro {
        noise: f64,
    }

    let random = &mut Random::new(4510);
    let mut work = Vec::new();
    for _ in 0..10 {
        let truth = (random.attitude::<3>(), 0.01 * random.vector::<3>());
        let axis = random.unit::<3>();
        let (mut attitude, mut seen) = (truth.0, Vec::new());
        for k in 0..18 {
            let known = turned(axis * 0.01 * f64::from(k)) * Vector3::new(300.0, -200.0, 100.0);
            let body = attitude.transpose() * known + normal::<3>(random);
            let rate = Vector3::new(0.01, -0.02, 0.015);
            seen.push((rate + truth.1 + 1e-5 * normal::<3>(random), known, body));
            attitude *= turned(rate * H);
        }
        let guess = (truth.0 * turned(3.0 * random.unit::<3>()), Vector3::zeros());
        let mut information = Matrix6::zeros();
        (3..6).for_each(|i| information[(i, i)] = 1e4);
        let control = Gyro { noise: 1e-10 }.control(H)?.with_prior(Prior::new(guess, information))?;
        let mut plan = [control.stage(&guess); 18];
        control.refer(&mut plan, |k, _| seen[k]);
        plan = plan.map(|stage| stage.with_input(stage.reference().0));
        let mut start = guess;
        for steps in [6, 12, 18] {
            let estimate = control.solve(&start, Target::Free, &mut plan[..steps])?;
            assert!(estimate.is_minimum(), "{estimate:?}");
            work.push(estimate.iterations());
            start = *plan[0].place();
        }
    }
    work.sort_unstable();
    assert!(work[15] <= 8 && work[29] <= 40, "{work:?}");
    Ok(())
}

/// One correction a tick follows a motion as well as converged estimates do.
#[test]
fn one_correction_a_tick_follows_a_motion() -> Result<(), Error> {
    let random = &mut Random::new(4509);
    let system = Tumbling::new(random);
    let (states, seen) = system.motion(system.random_state(random), 30, random)?;
    let prior = Prior::new(states[0], Matrix6::identity() * 100.0);
    let mut control = system.control(H)?.with_prior(prior)?;
    let mut plan = [control.stage(&states[0]); 8];
    control.refer(&mut plan, |k, _| seen[k]);
    let mut worst: f64 = 0.0;
    for next in &seen[8..] {
        let guess = *control.prior().place();
        let mut converged = plan;
        let expected = *control.solve(&guess, Target::Free, &mut converged)?.end();
        let found = control.solve_within(&guess, Target::Free, Limits { sweeps: 1 }, &mut plan)?;
        assert!(found.ended() == Ended::AtLimit || found.ended() == Ended::Converged);
        let end = *found.end();
        let error: Vector6<f64> = control.system().displacement(&expected, &end);
        worst = worst.max(error.dot(&(control.end_information(&converged)? * error)));
        control.slide(&mut plan, 1)?;
        plan[7] = plan[7].with_reference(*next);
    }
    assert!(worst < 0.05, "{worst}");
    Ok(())
}

#[test]
fn priors_that_say_nothing_possible_are_refused() -> Result<(), Error> {
    let system = Tumbling { inertia: Matrix3::identity(), calm: 1.0, stars: 1.0, gyros: 1.0 };
    let place = (Matrix3::identity(), Vector3::zeros());
    let refused = |prior| system.clone().control(H).and_then(|control| control.with_prior(prior)).map(|_| ());
    let mut information = Matrix6::identity();
    information[(5, 5)] = -0.5;
    assert_eq!(refused(Prior::new(place, information)), Err(Error::NegativeInformation { eigenvalue: -0.5 }));
    information[(5, 5)] = f64::NAN;
    let name = "the information of the prior";
    assert_eq!(refused(Prior::new(place, information)), Err(Error::NotFinite { name }));
    information[(5, 5)] = 1.0;
    information[(0, 1)] = 0.5;
    assert!(matches!(refused(Prior::new(place, information)), Err(Error::NotSymmetric { .. })));
    let slope = Vector6::from_element(f64::INFINITY);
    let name = "the slope of the prior";
    assert_eq!(refused(Prior::unknown(place).with_slope(slope)), Err(Error::NotFinite { name }));
    assert!(matches!(refused(Prior::unknown((Matrix3::identity() * 2.0, place.1))), Err(Error::OffOrbit { .. })));
    let mut control = system.control(H)?.with_prior(Prior::unknown(place))?;
    let mut plan = [control.stage(&place); 3];
    assert_eq!(control.slide(&mut plan, 4), Err(Error::PlanTooShort { steps: 3, wanted: 4 }));
    Ok(())
}
