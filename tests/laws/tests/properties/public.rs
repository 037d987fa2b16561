//! The public functions of the runtime, read from its sources: those of exported types and traits, and those that generated code names.

use crate::mentions::words;
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syn::{ImplItem, Item, ItemImpl, ItemMacro, Signature, TraitItem, Type, UseTree, Visibility};

/// A module, or an item in one, by the names on the way to it; `[]` is the crate.
type Place = Vec<String>;

#[derive(Default)]
struct Module {
    items: Vec<Item>,
    /// The names of its `use` declarations, and their places.
    imports: BTreeMap<String, Place>,
    /// Its re-exports.
    exports: Vec<Place>,
}

/// The modules of a crate, but for those of tests.
#[derive(Default)]
struct Sources(BTreeMap<Place, Module>);

/// The public functions of the crate in this folder: `function`, `Type::method`, `Trait::method`, and `macro!::method`
/// for a method that a macro writes.
pub fn functions(folder: &Path) -> BTreeSet<String> {
    let mut sources = Sources::default();
    sources.read(&folder.join("lib.rs"), folder, vec![]);
    let reachable = sources.reachable();
    sources.0.keys().flat_map(|place| sources.functions_of(place, &reachable)).collect()
}

impl Sources {
    /// Reads a module from its file, and those within it from their folder.
    fn read(&mut self, file: &Path, folder: &Path, place: Place) {
        let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let items = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display())).items;
        for name in items.iter().filter_map(name_of_module) {
            self.read(&folder.join(format!("{name}.rs")), &folder.join(&name), within(&place, &name));
        }
        let mut module = Module::default();
        for item in &items {
            if let Item::Use(used) = item {
                let is_public = matches!(used.vis, Visibility::Public(_));
                self.import(&used.tree, &place, vec![], is_public, &mut module);
            }
        }
        module.items = items;
        self.0.insert(place, module);
    }

    fn import(&self, tree: &UseTree, place: &Place, path: Place, is_public: bool, module: &mut Module) {
        let (name, last) = match tree {
            UseTree::Path(next) => {
                return self.import(&next.tree, place, within(&path, &next.ident.to_string()), is_public, module);
            }
            UseTree::Group(group) => {
                let each = |tree| self.import(tree, place, path.clone(), is_public, module);
                return group.items.iter().for_each(each);
            }
            UseTree::Glob(_) => return,
            UseTree::Name(name) => (&name.ident, &name.ident),
            UseTree::Rename(renamed) => (&renamed.rename, &renamed.ident),
        };
        let target = self.absolute(place, within(&path, &last.to_string()));
        module.imports.insert(name.to_string(), target.clone());
        module.exports.extend(is_public.then_some(target));
    }

    fn absolute(&self, place: &Place, path: Place) -> Place {
        let (first, rest) = path.split_first().expect("a path has a name");
        match first.as_str() {
            "crate" => rest.to_vec(),
            "self" => [place, rest].concat(),
            "super" => self.absolute(&place[..place.len() - 1].to_vec(), rest.to_vec()),
            _ => match [place.as_slice(), &path].concat() {
                local if self.0.contains_key(&within(place, first)) => local,
                _ => path,
            },
        }
    }

    /// The place of the declaration behind a name in a module.
    fn origin(&self, path: &Place) -> Place {
        let Some((name, place)) = path.split_last() else { return vec![] };
        match self.0.get(place).and_then(|module| module.imports.get(name)) {
            // external crates are called by their own names
            Some(next) if next != path => self.origin(next),
            _ => path.clone(),
        }
    }

    /// The types, traits and functions that a caller can reach: the exported ones, and those that their signatures name
    /// in turn.
    fn reachable(&self) -> BTreeSet<Place> {
        let mut reachable = self.exported();
        loop {
            let known = reachable.len();
            let named: Vec<Place> = self.0.keys().flat_map(|place| self.named_by(place, &reachable)).collect();
            reachable.extend(named);
            if reachable.len() == known {
                return reachable;
            }
        }
    }

    /// The declarations and re-exports of the crate and its public modules.
    fn exported(&self) -> BTreeSet<Place> {
        let declared = self.0[&vec![]].items.iter().filter(|item| is_public_module(item)).filter_map(name_of_module);
        let mut exported = BTreeSet::new();
        for place in declared.map(|name| vec![name]).chain([vec![]]) {
            let module = &self.0[&place];
            exported.extend(module.items.iter().filter_map(public_name).map(|name| within(&place, &name)));
            exported.extend(module.exports.iter().map(|path| self.origin(path)));
        }
        exported
    }

    /// The public types and traits in the signatures of the reachable items in a module.
    fn named_by(&self, place: &Place, reachable: &BTreeSet<Place>) -> Vec<Place> {
        let signatures = self.reachable_in(place, reachable).flat_map(signatures);
        let types = signatures.flat_map(|signature| words(signature.to_token_stream()));
        let types = types.filter(|word| word.starts_with(char::is_uppercase));
        types.map(|word| self.origin(&within(place, &word))).filter(|path| self.declares(path)).collect()
    }

    fn declares(&self, path: &Place) -> bool {
        let Some((name, place)) = path.split_last() else { return false };
        let module = self.0.get(place);
        module.is_some_and(|module| module.items.iter().filter_map(public_name).any(|own| own == *name))
    }

    fn reachable_in<'a>(&'a self, place: &'a Place, reachable: &'a BTreeSet<Place>) -> impl Iterator<Item = &'a Item> {
        let is_reachable = |name: &str| reachable.contains(&self.origin(&within(place, name)));
        self.0[place].items.iter().filter(move |item| match item {
            Item::Fn(function) => is_reachable(&function.sig.ident.to_string()),
            Item::Trait(item) => is_reachable(&item.ident.to_string()),
            Item::Impl(block) => is_reachable(&name_of_type(block)),
            item => matches!(item, Item::Macro(_)),
        })
    }

    fn functions_of(&self, place: &Place, reachable: &BTreeSet<Place>) -> Vec<String> {
        let names = self.reachable_in(place, reachable).flat_map(|item| {
            let methods = signatures(item).into_iter().map(|signature| signature.ident.to_string());
            match item {
                Item::Macro(written) => methods_of_macro(written),
                Item::Trait(item) => methods.map(|method| format!("{}::{method}", item.ident)).collect(),
                Item::Impl(block) => {
                    let name = name_of_type(block);
                    methods.chain(getters(block)).map(|method| format!("{name}::{method}")).collect()
                }
                _ => methods.collect(),
            }
        });
        names.collect()
    }
}

/// The signature of a function, those of the methods of a trait, or of the public ones of a type.
fn signatures(item: &Item) -> Vec<&Signature> {
    match item {
        Item::Fn(function) => vec![&function.sig],
        Item::Trait(item) => {
            let methods = item.items.iter().filter_map(|inner| match inner {
                TraitItem::Fn(method) => Some(&method.sig),
                _ => None,
            });
            methods.collect()
        }
        Item::Impl(block) => {
            let methods = block.items.iter().filter_map(|inner| match inner {
                ImplItem::Fn(method) if matches!(method.vis, Visibility::Public(_)) => Some(&method.sig),
                _ => None,
            });
            methods.collect()
        }
        _ => vec![],
    }
}

fn within(place: &[String], name: &str) -> Place {
    [place, &[name.to_string()]].concat()
}

/// The name of a module with a file of its own.
fn name_of_module(item: &Item) -> Option<String> {
    match item {
        Item::Mod(module) if module.content.is_none() && module.ident != "tests" => Some(module.ident.to_string()),
        _ => None,
    }
}

fn is_public_module(item: &Item) -> bool {
    matches!(item, Item::Mod(module) if matches!(module.vis, Visibility::Public(_)))
}

/// The name of a function, a type or a trait that is public.
fn public_name(item: &Item) -> Option<String> {
    let (visibility, name) = match item {
        Item::Fn(function) => (&function.vis, &function.sig.ident),
        Item::Struct(item) => (&item.vis, &item.ident),
        Item::Enum(item) => (&item.vis, &item.ident),
        Item::Trait(item) => (&item.vis, &item.ident),
        _ => return None,
    };
    matches!(visibility, Visibility::Public(_)).then(|| name.to_string())
}

/// The last name of the type that has these methods; `""` for those of a trait.
fn name_of_type(block: &ItemImpl) -> String {
    match &*block.self_ty {
        Type::Path(path) if block.trait_.is_none() => {
            path.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default()
        }
        _ => String::new(),
    }
}

/// The methods of a type that `getters!` writes: the names after `copy` or `ref`.
fn getters(block: &ItemImpl) -> Vec<String> {
    let written = block.items.iter().filter_map(|inner| match inner {
        ImplItem::Macro(written) if written.mac.path.is_ident("getters") => Some(words(written.mac.tokens.clone())),
        _ => None,
    });
    let named = |words: Vec<String>| {
        let pairs = words.windows(2).filter(|pair| pair[0] == "copy" || pair[0] == "ref");
        pairs.map(|pair| pair[1].clone()).collect::<Vec<_>>()
    };
    written.flat_map(named).collect()
}

/// The names after `pub fn` or `pub const fn` in the tokens of a macro.
fn methods_of_macro(written: &ItemMacro) -> Vec<String> {
    // the methods that `getters!` writes are named where it is used
    let Some(name) = written.ident.as_ref().filter(|name| *name != "getters") else { return vec![] };
    let tokens = words(written.mac.tokens.clone());
    let starts = tokens.windows(4).filter_map(|four| match four {
        [first, second, method, _] if first == "pub" && second == "fn" => Some(method),
        [first, second, third, method] if first == "pub" && second == "const" && third == "fn" => Some(method),
        _ => None,
    });
    starts.map(|method| format!("{name}!::{method}")).collect()
}
