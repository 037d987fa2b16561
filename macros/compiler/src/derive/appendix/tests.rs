//! Sentences in LaTeX.

use super::in_words;

#[test]
fn sentences() {
    let table = [
        ("F in SO<3> acts from the right", r"F in $\mathrm{SO}(3)$ acts from the right"),
        (
            "the components tr(AᵀE_i); x^ for Σ x_i E_i",
            r"the components $\mathrm{tr}(A^{\mathsf T}E_{i});$ $x^{\wedge}$ for $\Sigma $ $x_{i}$ $E_{i}$",
        ),
        (
            "1/2*length[0]²*(mass[0] + mass[1]) ξ₁₁²",
            r"$1/2\,\mathrm{length}[0]^{2}\,(\mathrm{mass}[0]$ $+$ $\mathrm{mass}[1])$ $\xi _{11}^{2}$",
        ),
        ("declare `signature = indefinite`, 100 % of it", r"declare \texttt{signature = indefinite}, 100 \% of it"),
        ("Ad*_F μ in 𝔤_q^⊥", r"$\mathrm{Ad}^{*}_{F}$ $\mu $ in $\mathfrak g_{q}^{\perp}$"),
    ];
    for (sentence, latex) in table {
        assert_eq!(in_words(sentence), latex);
    }
}
