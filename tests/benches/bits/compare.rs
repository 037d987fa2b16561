//! Which lines differ, and by how much.

use std::collections::BTreeMap;

/// A line by its parts.
struct Line<'a> {
    hashes: [&'a str; 2],
    numbers: [Vec<f64>; 2],
    notes: &'a str,
}

/// Lines by system and quantity.
fn lines<'a>(text: impl Iterator<Item = &'a str>) -> BTreeMap<[&'a str; 2], Line<'a>> {
    let numbers = |list: &str| {
        let list = list.trim_matches(['[', ']']).split(',').filter(|number| !number.is_empty());
        list.map(|number| number.parse().expect("a number")).collect()
    };
    let line = |line: &'a str| {
        let mut words = line.split(' ');
        let mut word = || words.next().unwrap_or_default();
        let key = [word(), word()];
        let hashes = [word(), word()];
        let numbers = [numbers(word()), numbers(word())];
        (key, Line { hashes, numbers, notes: word() })
    };
    // lines that cargo and other programs print
    text.filter(|line| line.contains(" [")).map(line).collect()
}

/// The largest difference of some numbers over the largest of them.
fn apart(before: &[f64], after: &[f64]) -> f64 {
    let size = before.iter().fold(f64::MIN_POSITIVE, |size, x| x.abs().max(size));
    let apart = before.iter().zip(after).fold(0.0, |most, (a, b)| (a - b).abs().max(most));
    apart / size
}

/// Prints the differences; whether there are none.
pub fn print(before: &str, after: &[String]) -> bool {
    let before = lines(before.lines());
    let after = lines(after.iter().map(String::as_str));
    let [mut same, mut zeros, mut changed, mut missing] = [0; 4];
    for (key @ [name, quantity], old) in &before {
        let Some(new) = after.get(key) else {
            println!("gone     {name} {quantity}");
            missing += 1;
            continue;
        };
        if old.hashes == new.hashes {
            same += 1;
            continue;
        }
        if old.hashes[1] == new.hashes[1] {
            println!("zeros    {name} {quantity}");
            zeros += 1;
            continue;
        }
        changed += 1;
        let [first, last] = [0, 1].map(|k| apart(&old.numbers[k], &new.numbers[k]));
        print!("CHANGED  {name} {quantity}: first by {first:.1e}, last by {last:.1e}");
        println!("{}", if old.notes == new.notes { "" } else { ", and what is said" });
    }
    let new = after.keys().filter(|key| !before.contains_key(*key)).count();
    println!("{same} the same, {zeros} but for signs of zeros, {changed} changed, {missing} gone, {new} new");
    zeros + changed + missing == 0
}
