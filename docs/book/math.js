// Code blocks of the language `math` become displayed formulas. Without a network their TeX source stays.
for (const code of document.querySelectorAll("code.language-math")) {
    const formula = document.createElement("div");
    formula.textContent = "\\[" + code.textContent + "\\]";
    code.parentElement.replaceWith(formula);
}
