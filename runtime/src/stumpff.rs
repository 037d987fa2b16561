//! The functions of Stumpff, by which closed forms of exponentials are written without a case for small angles.

use crate::{Real, Scalar};

/// c_k(s) = Σ_j (−s)ʲ/(k + 2j)! for k ≤ 7: c₀ = cos √s, c₁ = sin √s/√s, and cosh, sinh for negative s.
///
/// The series is summed where |s| ≤ 1, for k ≥ 3 where |s| ≤ 16; beyond, the closed form is used, by
/// c_{k+2} = (1/k! − c_k)/s, which there loses no digits. The error measured on both sides is below 3 ε |c_k| up to |s| = 16 and
/// below 4 ε (1 + √|s|)|c_k| beyond, for that is what the rounding of √|s| does; where c₀, c₁ or c₂ crosses 0, as much of
/// the amplitude s^(−k/2) of its oscillation.
///
/// The exponential of a skew 3×3 matrix is exp x^ = I + c₁(|x|²)x^ + c₂(|x|²)x^x^, and φ(x^) = I + c₂ x^ + c₃ x^x^.
///
/// Source: Stumpff, *Himmelsmechanik* I, 1959, section V.
pub fn stumpff<T: Scalar>(k: u32, s: T) -> T {
    T::from_lanes(|lane| stumpff_of_one(k, s.lane(lane)))
}

fn stumpff_of_one<T: Real>(k: u32, s: T) -> T {
    let switch = if k < 3 { T::one() } else { T::from_f64(16.0) };
    if s.abs() <= switch { series(k, s) } else { closed(k, s) }
}

/// More terms than any precision asks for: 16⁴⁰/83! is 10⁻⁷⁶.
const TERMS: u32 = 40;

/// Terms until they, and their derivatives, cannot be seen.
pub(crate) fn series<T: Real>(k: u32, s: T) -> T {
    let mut term = inverse_factorial::<T>(k);
    let mut sum = term;
    let mut derivatives = T::DERIVATIVES;
    for j in 1..=TERMS {
        let n = i64::from(k + 2 * j);
        term = -term * s / T::from_f64((n * (n - 1)) as f64);
        sum += term;
        if term.abs() <= T::EPSILON * T::from_ratio(1, 8) * sum.abs() {
            if derivatives == 0 {
                break;
            }
            derivatives -= 1;
        }
    }
    sum
}

fn closed<T: Real>(k: u32, s: T) -> T {
    let root = s.abs().sqrt();
    let (even, odd) = if s > T::zero() { (root.cos(), root.sin() / root) } else { (root.cosh(), root.sinh() / root) };
    let (mut value, mut index) = if k.is_multiple_of(2) { (even, 0) } else { (odd, 1) };
    while index < k {
        value = (inverse_factorial::<T>(index) - value) / s;
        index += 2;
    }
    value
}

/// 1/k!
fn inverse_factorial<T: Real>(k: u32) -> T {
    T::one() / (2..=k).fold(T::one(), |product, factor| product * T::from_f64(f64::from(factor)))
}

#[cfg(test)]
mod tests {
    use super::stumpff;
    use nalgebra::{Matrix3, Vector3};

    /// c₀ to c₇, summed in 80 digits (mpmath), on both sides of the switches.
    #[rustfmt::skip]
    const EXACT: [(f64, [f64; 8]); 15] = [
        (-400.0, [242582597.70489514, 12129129.885244757, 606456.4917622379, 30322.822213111893, 1516.1399794055947, 75.80663886611306, 3.79024578184732, 0.18949576383194933]),
        (-20.0, [43.77746767480535, 9.786385124290346, 2.138873383740268, 0.43931925621451734, 0.08194366918701339, 0.013632629477392534, 0.002013850126017336, 0.00026496480720296]),
        (-16.0, [27.308232836016487, 6.822479299281938, 1.6442645522510304, 0.36390495620512114, 0.0715165345156894, 0.012327393096153404, 0.0018656167405639208, 0.0002496287351762544]),
        (-2.5, [2.5331142957652446, 1.471960330363594, 0.6132457183060979, 0.18878413214543757, 0.04529828732243915, 0.008846986191508364, 0.001452648262308993, 0.0002054611432700121]),
        (-1.0, [1.5430806348152437, 1.1752011936438014, 0.5430806348152438, 0.17520119364380146, 0.04308063481524378, 0.00853452697713479, 0.0014139681485771118, 0.00020119364380145687]),
        (-0.5, [1.2605918365213562, 1.085441641272607, 0.5211836730427123, 0.170883282545214, 0.04236734608542448, 0.008433231757094675, 0.0014013588375156225, 0.00019979684752268162]),
        (-9.313225746154785e-10, [1.0000000004656613, 1.0000000001552205, 0.5000000000388051, 0.1666666666744277, 0.04166666666796017, 0.00833333333351812, 0.0013888888889119872, 0.00019841269841526488]),
        (0.0, [1.0, 1.0, 0.5, 0.16666666666666666, 0.041666666666666664, 0.008333333333333333, 0.001388888888888889, 0.0001984126984126984]),
        (9.313225746154785e-10, [0.9999999995343387, 0.9999999998447796, 0.4999999999611949, 0.16666666665890564, 0.041666666665373164, 0.008333333333148547, 0.0013888888888657907, 0.00019841269841013194]),
        (0.5, [0.7602445970756302, 0.9187253698655684, 0.4795108058487397, 0.16254926026886313, 0.0409783883025206, 0.008234812795607085, 0.0013765567282921234, 0.00019704107545249772]),
        (1.0, [0.5403023058681398, 0.8414709848078965, 0.4596976941318603, 0.1585290151921035, 0.040302305868139716, 0.008137651474563173, 0.0013643607985269492, 0.00019568185877016]),
        (2.5, [-0.010342318905209131, 0.6324217062813904, 0.40413692756208364, 0.14703131748744386, 0.03834522897516654, 0.007854139671689124, 0.0013285750766000512, 0.0001916774646576835]),
        (16.0, [-0.6536436208636119, -0.18920062382698205, 0.10335272630397574, 0.07432503898918638, 0.024790454606001516, 0.005771351729842518, 0.001054763253791572, 0.00016012385021817597]),
        (20.0, [-0.2379483919805911, -0.2171843183512395, 0.06189741959902956, 0.06085921591756197, 0.02190512902004852, 0.005290372537455235, 0.0009880768823309072, 0.00015214803979390494]),
        (400.0, [0.40808206181339196, 0.045647262536381385, 0.0014797948454665201, 0.0023858818436590466, 0.0012463005128863338, 0.00041070196205751907, 0.00010105091538445083, 1.9806578428189535e-05]),
    ];

    #[test]
    fn values_on_both_sides_of_the_switches() {
        for (s, exact) in EXACT {
            for (k, exact) in (0..).zip(exact) {
                let (double, single) = (stumpff(k, s), stumpff(k, s as f32));
                let amplitude =
                    if s > 1.0 && k < 3 { exact.abs().max(f64::powi(s.sqrt(), -(k as i32))) } else { exact.abs() };
                let tolerance = 4.0 * (1.0 + s.abs().sqrt()) * amplitude;
                assert!((double - exact).abs() <= tolerance * f64::EPSILON, "c{k}({s}) = {exact}, not {double}");
                let error = (f64::from(single) - exact).abs();
                assert!(error <= tolerance * f64::from(f32::EPSILON), "c{k}({s}) = {exact}, not {single} in f32");
            }
        }
    }

    #[test]
    fn quarter_turns_and_broken_numbers() {
        let x = Vector3::new(0.0, 0.0, core::f64::consts::FRAC_PI_2);
        let (hat, s) = (x.cross_matrix(), x.norm_squared());
        let turn = Matrix3::identity() + hat * stumpff(1, s) + hat * hat * stumpff(2, s);
        assert!((turn - Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)).amax() < 1e-15);
        for k in 0..8 {
            assert!(stumpff(k, f64::NAN).is_nan() && !stumpff(k, f64::NEG_INFINITY).is_finite());
        }
    }
}
