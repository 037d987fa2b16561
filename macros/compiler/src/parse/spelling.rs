//! Expressions as the user would type them: messages quote these, so they must not depend on how tokens were spaced.

use clebsch_symbolic::IntoList;
use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Expr, RangeLimits, Stmt, Type};

/// Parts within parts that are spelled: messages are read by people, and chains of operators are deeper than a stack.
const LEVELS: usize = 100;

/// The texts of several things, separated by commas.
pub(crate) fn joined<T: ToString>(items: impl IntoIterator<Item = T>) -> String {
    let mut texts = Vec::new();
    for item in items {
        texts.push(item.to_string());
    }
    texts.join(", ")
}

/// The names of several things in backticks, separated by commas.
pub(crate) fn listed<T: std::fmt::Display>(items: impl IntoIterator<Item = T>) -> String {
    joined(items.into_iter().map(|item| format!("`{item}`")))
}

/// The text of an expression, short enough for the first line of a message.
pub(crate) fn shortened(expr: &Expr) -> String {
    const LIMIT: usize = 80;
    let text = spell(expr);
    if text.chars().count() <= LIMIT {
        return text;
    }
    text.chars().take(LIMIT - 1).chain(['…']).collect()
}

/// The expression that gives a body its value.
pub(crate) fn tail(body: &Expr) -> &Expr {
    match body {
        Expr::Block(block) => match block.block.stmts.last() {
            Some(Stmt::Expr(value, None)) => tail(value),
            _ => body,
        },
        Expr::Paren(inner) => tail(&inner.expr),
        Expr::Group(inner) => tail(&inner.expr),
        _ => body,
    }
}

/// The text of an expression; parts that are deeper than any message needs are left out.
pub fn spell(expr: &Expr) -> String {
    spell_within(expr, LEVELS)
}

fn spell_within(expr: &Expr, levels: usize) -> String {
    let Some(levels) = levels.checked_sub(1) else { return "…".into() };
    let spell = |expr: &Expr| spell_within(expr, levels);
    match expr {
        Expr::Array(array) => format!("[{}]", list(&array.elems, levels)),
        Expr::Binary(binary) => {
            format!("{} {} {}", spell(&binary.left), tokens(&binary.op).trim(), spell(&binary.right))
        }
        Expr::Block(block) => {
            let statements = block.block.stmts.iter().map(|statement| spell_statement(statement, levels));
            format!("{{ {} }}", statements.into_list().join(" "))
        }
        Expr::Call(call) => format!("{}({})", spell(&call.func), list(&call.args, levels)),
        Expr::Cast(cast) => format!("{} as {}", spell(&cast.expr), spell_type(&cast.ty)),
        Expr::Closure(closure) => {
            format!("|{}| {}", joined(closure.inputs.iter().map(tokens)), spell(&closure.body))
        }
        Expr::Field(field) => format!("{}.{}", spell(&field.base), tokens(&field.member)),
        Expr::Group(group) => spell(&group.expr),
        Expr::Index(index) => format!("{}[{}]", spell(&index.expr), spell(&index.index)),

        Expr::MethodCall(call) => {
            let turbofish = call.turbofish.as_ref().map(tokens).unwrap_or_default();
            format!("{}.{}{turbofish}({})", spell(&call.receiver), call.method, list(&call.args, levels))
        }
        Expr::Paren(inner) => format!("({})", spell(&inner.expr)),
        Expr::Range(range) => {
            let end = |end: &Option<Box<Expr>>| end.as_ref().map(|end| spell(end)).unwrap_or_default();
            let dots = if matches!(range.limits, RangeLimits::Closed(_)) { "..=" } else { ".." };
            format!("{}{dots}{}", end(&range.start), end(&range.end))
        }
        Expr::Reference(reference) => format!("&{}", spell(&reference.expr)),
        Expr::Repeat(repeat) => format!("[{}; {}]", spell(&repeat.expr), spell(&repeat.len)),
        Expr::Tuple(tuple) if tuple.elems.len() == 1 => format!("({},)", list(&tuple.elems, levels)),
        Expr::Tuple(tuple) => format!("({})", list(&tuple.elems, levels)),
        Expr::Unary(unary) => format!("{}{}", tokens(&unary.op), spell(&unary.expr)),
        other => tokens(other),
    }
}

fn list<'a>(items: impl IntoIterator<Item = &'a Expr>, levels: usize) -> String {
    joined(items.into_iter().map(|item| spell_within(item, levels)))
}

fn spell_statement(statement: &Stmt, levels: usize) -> String {
    let spell = |expr: &Expr| spell_within(expr, levels);
    match statement {
        Stmt::Local(local) => match &local.init {
            Some(init) => format!("let {} = {};", tokens(&local.pat), spell(&init.expr)),
            None => format!("let {};", tokens(&local.pat)),
        },
        Stmt::Expr(expr, semicolon) => format!("{}{}", spell(expr), if semicolon.is_some() { ";" } else { "" }),
        other => tokens(other),
    }
}

/// The text of an operand, in parentheses where a method needs them.
pub(crate) fn parenthesized(syntax: &Expr) -> String {
    match syntax {
        Expr::Binary(_) | Expr::Unary(_) | Expr::Reference(_) | Expr::Range(_) => format!("({})", spell(syntax)),
        _ => spell(syntax),
    }
}

/// The text of a type.
pub fn spell_type(ty: &Type) -> String {
    match ty {
        Type::Array(array) => format!("[{}; {}]", spell_type(&array.elem), spell(&array.len)),
        Type::Tuple(tuple) => format!("({})", joined(tuple.elems.iter().map(spell_type))),
        Type::Group(group) => spell_type(&group.elem),
        other => tokens(other),
    }
}

/// The text of any tokens, spaced as rustfmt would where that is known.
pub(crate) fn tokens(tree: &impl ToTokens) -> String {
    let mut text = String::new();
    write(tree.to_token_stream(), &mut text);
    text
}

fn write(stream: TokenStream, text: &mut String) {
    let mut glued = true;
    for token in stream {
        match token {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Brace => ("{ ", " }"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                if !glued && group.delimiter() == Delimiter::Brace {
                    text.push(' ');
                }
                text.push_str(open);
                write(group.stream(), text);
                text.push_str(close);
                glued = false;
            }
            TokenTree::Punct(punct) => {
                // a colon that is no half of a path separator
                let single = punct.as_char() == ':' && punct.spacing() == Spacing::Alone && !text.ends_with(':');
                let (before, after) = if single { (false, true) } else { spaces(punct.as_char()) };
                if before && !glued {
                    text.push(' ');
                }
                text.push(punct.as_char());
                glued = punct.spacing() == Spacing::Joint || !after;
                if after && punct.spacing() == Spacing::Alone {
                    text.push(' ');
                    glued = true;
                }
            }
            word => {
                if !glued {
                    text.push(' ');
                }
                text.push_str(&word.to_string());
                glued = false;
            }
        }
    }
    if text.ends_with(' ') && text.trim_end().ends_with([',', ';']) {
        text.truncate(text.trim_end().len());
    }
}

/// Whether there is a space before and after a punctuation mark.
fn spaces(mark: char) -> (bool, bool) {
    let is_operator = "+*/%=".contains(mark);
    (is_operator, is_operator || ",;".contains(mark))
}
