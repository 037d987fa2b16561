//! Left sides in LaTeX.

use super::left_side;

#[test]
fn left_sides() {
    let table = [
        ("J(q, p)", "J(q, p)"),
        ("Φ_F(Gamma)", "\\Phi _{F}(\\mathrm{Gamma})"),
        ("Ad*_(F, G) μ", "\\mathrm{Ad}^*_{(F, G)} \\mu "),
        ("(TΦ_F)^-* p at R⁺", "(T\\Phi _{F})^{-*} p \\text{ at } R^+"),
        ("∂V_12/∂q[i % N]", "\\partial V_{12}/\\partial q[i \\% N]"),
        ("F⁻ℓd(q, attitude_b)", "F^-\\ell d(q, \\mathrm{attitude\\_b})"),
    ];
    for (symbol, latex) in table {
        assert_eq!(left_side(symbol), latex);
    }
}
