//! Every fixture fits its folder: the accepted ones compile, the rejected ones have errors with the text to write.

use std::fs;
use std::path::{Path, PathBuf};

use clebsch_compiler::lower::Program;
use clebsch_compiler::{Graph, WORK, compile, expand};
use clebsch_symbolic::{identity, work};
use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use quote::ToTokens;

/// The files of a folder of fixtures, in order.
fn fixtures(folder: &str) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(folder);
    let entries = fs::read_dir(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "rs"));
    files.sort();
    files
}

/// The answer of the compiler about the item of a file: nothing, or its errors.
fn errors(file: &Path) -> Option<String> {
    compile(&Graph::new(), item(file)).err().map(|errors| errors.to_string())
}

/// The item of a file that carries the derive.
fn item(file: &Path) -> TokenStream {
    let text = fs::read_to_string(file).expect("a readable file");
    let items = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display())).items;
    let declared = |item: &syn::Item| {
        let attributes = match item {
            syn::Item::Struct(item) => &item.attrs,
            syn::Item::Enum(item) => &item.attrs,
            _ => return false,
        };
        attributes.iter().any(|attribute| attribute.path().is_ident("derive"))
    };
    let item = items.into_iter().find(declared).unwrap_or_else(|| panic!("{} derives nothing", file.display()));
    item.to_token_stream()
}

/// Dρ(x)·δ, which the tangent of a chart may have given, is the derivative of ρ, for all numbers. Returns the equations, and those
/// whose derivative has another form.
fn jacobians_are_derivatives(file: &Path, program: &Program<'_>) -> (usize, usize) {
    let Program::Mechanics(program) = program else { return (0, 0) };
    let (mut count, mut other_forms) = (0, 0);
    let symbols = &program.formulas.symbols;
    for equation in program.formulas.substeps.iter().flat_map(|substep| &substep.equations) {
        let own = symbols.blocks_of(&equation.components).into_iter().map(|i| symbols.blocks[i]);
        let directions: Vec<_> = own.map(|block| (block.coordinates, block.direction)).collect();
        let derivative = equation.residual.differential(&directions);
        (count, other_forms) = (count + 1, other_forms + usize::from(equation.directional != derivative));
        assert!(identity::equal(&[equation.directional], &[derivative]), "{}", file.display());
    }
    (count, other_forms)
}

#[test]
fn rejected_fixtures_have_errors_that_help() {
    let files = fixtures("reject");
    assert!(files.len() >= 32, "only {} fixtures", files.len());
    for file in files {
        let text = errors(&file).unwrap_or_else(|| panic!("{} is accepted", file.display()));
        for error in text.split("\n\n") {
            let (first, rest) = error.split_once('\n').unwrap_or((error, ""));
            assert!(first.starts_with("error: ") && !first.ends_with('.'), "{}: {first}", file.display());
            assert!(rest.contains("help: ") || rest.contains("note: "), "{} only says: {first}", file.display());
        }
    }
}

/// `a + -b`, `a * (-b)`, `(-a) * b`: how often one sign follows another, or stands before a factor.
fn double_signs(tokens: TokenStream) -> usize {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    let is_operator = |tree: Option<&TokenTree>| match tree {
        Some(TokenTree::Punct(punct)) => "+-*/".contains(punct.as_char()),
        _ => false,
    };
    let begins_with_sign = |tree: &TokenTree| match tree {
        TokenTree::Punct(punct) => punct.as_char() == '-' && punct.spacing() == Spacing::Alone,
        TokenTree::Literal(literal) => literal.to_string().starts_with('-'),
        _ => false,
    };
    let is_negative = |tree: &TokenTree| match tree {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis => {
            group.stream().into_iter().next().is_some_and(|first| begins_with_sign(&first))
        }
        tree => begins_with_sign(tree),
    };
    let mut count = 0;
    for (position, tree) in trees.iter().enumerate() {
        let before = position.checked_sub(1).and_then(|before| trees.get(before));
        let is_factor = matches!(tree, TokenTree::Group(_)) && is_operator(trees.get(position + 1));
        // a group behind a name has the arguments of a function
        let is_called = matches!(before, Some(TokenTree::Ident(_)));
        count += usize::from(is_negative(tree) && !is_called && (is_operator(before) || is_factor));
        if let TokenTree::Group(group) = tree {
            count += double_signs(group.stream());
        }
    }
    count
}

#[test]
fn double_signs_are_found() {
    let (doubled, single) = ("a * (-b) - (-c) + -d - -1.0 + (-e) * f", "-a - b * (c - d) - f(-e) + [-g, h][0]");
    let count = |text: &str| double_signs(text.parse().expect("tokens"));
    assert_eq!((count(doubled), count(single)), (5, 0));
}

/// In generated code no sign stands before a factor or behind another. Declarations of people are far from the limit: no
/// fixture takes a third of the budget.
#[test]
fn accepted_fixtures_expand_without_double_signs_and_far_within_the_budget() {
    let mut most = (0, String::new());
    for file in fixtures("accept") {
        let before = work::spent();
        let generated = expand(item(&file));
        most = most.max((work::spent() - before, file.display().to_string()));
        assert_eq!(double_signs(generated), 0, "{}", file.display());
    }
    println!("{} of {WORK}: {}", most.0, most.1);
    assert!(most.0 > WORK / 1000 && most.0 < WORK / 3, "{} of {WORK}: {}", most.0, most.1);
}

/// The terms of a printed sum with their signs.
fn signed_terms(text: &str) -> Vec<(bool, String)> {
    let mut terms = vec![(false, String::new())];
    let mut depth = 0;
    for word in text.split(' ') {
        match word {
            "+" | "-" if depth == 0 => terms.push((word == "-", String::new())),
            _ => {
                let last = terms.len() - 1;
                terms[last].1 += word;
            }
        }
        depth += word.matches('(').count() as i64 - word.matches(')').count() as i64;
    }
    for (is_negative, term) in &mut terms {
        if let Some(rest) = term.strip_prefix('-') {
            (*is_negative, *term) = (!*is_negative, rest.to_string());
        }
    }
    terms.sort();
    terms
}

/// Names and values of the constants of a program, as it prints them.
fn constants(program: &Program<'_>) -> Vec<(String, String)> {
    let text = program.to_string();
    let lines = text.lines().skip_while(|line| !line.starts_with("constants:")).skip(1);
    let lines = lines.take_while(|line| line.starts_with(' ')).filter_map(|line| line.trim().split_once(" = "));
    let shared: Vec<(String, String)> = lines.map(|(name, value)| (name.to_string(), value.to_string())).collect();
    let names = names_of_constants(program);
    shared.into_iter().filter(|(name, _)| names.contains(name)).collect()
}

/// A configuration that inputs move has no constants.
fn names_of_constants<'p>(program: &'p Program<'_>) -> &'p [String] {
    program.mechanics().map_or(&[], |program| &program.constant_names)
}

/// Fails where a constant is the negative of another one. Returns how many there are.
fn no_constant_is_the_negative_of_another(file: &Path, program: &Program<'_>) -> usize {
    let constants = constants(program);
    let values: Vec<_> = constants.iter().map(|(_, value)| signed_terms(value)).collect();
    for (position, value) in values.iter().enumerate() {
        let mut negative: Vec<_> = value.iter().map(|(sign, term)| (!sign, term.clone())).collect();
        negative.sort();
        let other = values[position + 1..].iter().position(|other| *other == negative);
        let other = other.map(|other| &constants[position + 1 + other]);
        assert_eq!(other, None, "{}: {:?}", file.display(), constants[position]);
    }
    constants.len()
}

/// The names of constants that have no short formula, as `k7`. Fails where two constants have one name.
fn numbered_constants(file: &Path, program: &Program<'_>) -> Vec<String> {
    let is_numbered = |name: &str| name.strip_prefix('k').is_some_and(|rest| rest.parse::<usize>().is_ok());
    let names = names_of_constants(program);
    let distinct: std::collections::BTreeSet<&String> = names.iter().collect();
    assert_eq!(distinct.len(), names.len(), "{}: {names:?}", file.display());
    names.iter().filter(|name| is_numbered(name)).cloned().collect()
}

/// Their constants are named by their formulas too.
#[test]
fn accepted_fixtures_compile_to_derivatives_of_their_equations() {
    assert_eq!(signed_terms("a*(b + c) - d"), [(false, "a*(b+c)".to_string()), (true, "d".to_string())]);
    let files = fixtures("accept");
    assert!(files.len() >= 14, "only {} fixtures", files.len());
    let (mut seen, mut numbered) = (0, Vec::new());
    let (mut count, mut other_forms) = (0, 0);
    for file in files {
        let graph = Graph::new();
        let program = compile(&graph, item(&file)).unwrap_or_else(|errors| panic!("{}: {errors}", file.display()));
        seen += no_constant_is_the_negative_of_another(&file, &program);
        numbered.extend(numbered_constants(&file, &program).into_iter().map(|name| (file.clone(), name)));
        let (equations, others) = jacobians_are_derivatives(&file, &program);
        (count, other_forms) = (count + equations, other_forms + others);
    }
    assert!(count > 60 && other_forms > 3, "{other_forms} of {count} equations");
    assert!(seen > 300, "{seen} constants");
    assert!(numbered.len() <= 33, "{numbered:?}");
}
