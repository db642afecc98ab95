//! The modules of one crate, and the arrows between them: one module names an item of another.
//!
//! An arrow goes from a file to the file that owns the item it names: re-exports are followed. What a module
//! says of its children by `mod` or `pub use` is no arrow: it names them without need; nor are tests.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::Visit;
use syn::{Attribute, Item, ItemMod, ItemUse, Macro, UseTree, Visibility};

/// A module: its own file, or a part of the file that it stands in.
#[derive(Default)]
struct Module {
    /// How its file is called: the names from the root of the crate on, `lib` or `main` for the root itself.
    file: String,
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    uses: Vec<Use>,
    /// Paths that stand anywhere in its code.
    paths: BTreeSet<Vec<String>>,
}

/// `use path as name`.
struct Use {
    path: Vec<String>,
    /// `None`: everything there.
    name: Option<String>,
    private: bool,
}

/// What a path names.
enum Named {
    Module(usize),
    /// An item of that module.
    Item(usize),
}

/// The modules of a crate.
#[derive(Default)]
pub struct Modules(Vec<Module>);

/// A file as `read` finds it.
pub type Read<'a> = &'a dyn Fn(&Path) -> Option<String>;

impl Modules {
    /// From the root file of a crate on.
    pub fn of(root: &Path, read: Read) -> Self {
        let mut modules = Modules::default();
        let name = root.file_stem().expect("a file").to_string_lossy().into_owned();
        let folder = root.parent().expect("a folder").to_owned();
        modules.add_file(None, name, root, &folder, read);
        modules
    }

    fn add(&mut self, parent: Option<usize>, file: String) -> usize {
        self.0.push(Module { file, parent, ..Module::default() });
        self.0.len() - 1
    }

    fn add_file(&mut self, parent: Option<usize>, name: String, path: &Path, folder: &Path, read: Read) -> usize {
        let text = read(path).unwrap_or_else(|| panic!("{} cannot be read", path.display()));
        let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let module = self.add(parent, name);
        self.fill(module, &syntax.items, folder, read);
        module
    }

    /// Reads the items of a module, whose children stand in `folder`.
    fn fill(&mut self, module: usize, items: &[Item], folder: &Path, read: Read) {
        for item in items {
            match item {
                Item::Mod(child) if is_test(&child.attrs) => {}
                Item::Use(item) if is_test(&item.attrs) => {}
                Item::Mod(child) => self.add_child(module, child, folder, read),
                other => {
                    self.0[module].items.extend(name_of(other));
                    Names(&mut self.0[module]).visit_item(other);
                }
            }
        }
    }

    fn add_child(&mut self, parent: usize, child: &ItemMod, folder: &Path, read: Read) {
        let name = child.ident.to_string();
        let inside = folder.join(&name);
        let index = match &child.content {
            Some((_, items)) => {
                let file = self.0[parent].file.clone();
                let index = self.add(Some(parent), file);
                self.fill(index, items, &inside, read);
                index
            }
            None => {
                let candidates: [PathBuf; 2] = [folder.join(format!("{name}.rs")), inside.join("mod.rs")];
                let path = candidates.iter().find(|path| read(path).is_some());
                let path = path.unwrap_or_else(|| panic!("no file for module {name} in {}", folder.display()));
                let above =
                    if self.0[parent].parent.is_none() { String::new() } else { format!("{}/", self.0[parent].file) };
                self.add_file(Some(parent), above + &name, path, &inside, read)
            }
        };
        self.0[parent].children.insert(name, index);
    }

    /// What `path` names in the code of `module`; `None` where that is not in this crate.
    fn resolve(&self, module: usize, path: &[String], depth: usize) -> Option<Named> {
        let (mut at, mut rest) = (module, path);
        while let Some((first, others)) = rest.split_first() {
            at = match &first[..] {
                "crate" => 0,
                "self" => at,
                "super" => self.0[at].parent?,
                _ => break,
            };
            rest = others;
        }
        for (i, name) in rest.iter().enumerate() {
            match self.look_up(at, name, i + 1 == rest.len(), depth)? {
                Named::Module(index) => at = index,
                Named::Item(owner) => return Some(Named::Item(owner)),
            }
        }
        Some(Named::Module(at))
    }

    /// A name in a module. Where it is both an item and a module, the `last` part of a path is the item.
    fn look_up(&self, module: usize, name: &str, last: bool, depth: usize) -> Option<Named> {
        if depth > 20 {
            return None; // `use` in a ring
        }
        let here = &self.0[module];
        let child = || here.children.get(name).map(|&index| Named::Module(index));
        let item = || here.items.contains(name).then_some(Named::Item(module));
        let of_use = |u: &Use| self.resolve(module, &u.path, depth + 1);
        let named = || here.uses.iter().filter(|u| u.name.as_deref() == Some(name)).find_map(of_use);
        let everything = || {
            here.uses.iter().filter(|u| u.name.is_none()).find_map(|u| match of_use(u)? {
                Named::Module(there) if there != module => self.look_up(there, name, last, depth + 1),
                _ => None,
            })
        };
        if last {
            item().or_else(named).or_else(child).or_else(everything)
        } else {
            child().or_else(named).or_else(item).or_else(everything)
        }
    }

    /// From each file to those whose items it names.
    pub fn arrows(&self) -> BTreeMap<String, BTreeSet<String>> {
        let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (index, module) in self.0.iter().enumerate() {
            let used = module.uses.iter().filter(|u| u.private).filter_map(|u| {
                let named = self.resolve(index, &u.path, 0)?;
                matches!((&named, &u.name), (Named::Item(_), _) | (_, None)).then_some(named)
            });
            let mentioned = module.paths.iter().filter_map(|path| {
                // a lone name may be that of a variable, but for what a re-export brings in
                let known = path.len() > 1 || module.uses.iter().any(|u| !u.private && u.name.as_ref() == path.first());
                self.resolve(index, path, 0).filter(|named| known && matches!(named, Named::Item(_)))
            });
            let targets = used.chain(mentioned).map(|(Named::Module(to) | Named::Item(to))| self.0[to].file.clone());
            let targets: BTreeSet<String> = targets.filter(|file| *file != module.file).collect();
            arrows.entry(module.file.clone()).or_default().extend(targets);
        }
        arrows
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    let is_test =
        |a: &Attribute| a.path().is_ident("cfg") && a.parse_args::<syn::Path>().is_ok_and(|p| p.is_ident("test"));
    attributes.iter().any(is_test)
}

fn name_of(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}

/// Collects what the code of a module names.
struct Names<'a>(&'a mut Module);

impl Visit<'_> for Names<'_> {
    fn visit_item_use(&mut self, item: &ItemUse) {
        let private = matches!(item.vis, Visibility::Inherited);
        leaves(&item.tree, &mut Vec::new(), &mut |path, name| self.0.uses.push(Use { path, name, private }));
    }

    fn visit_path(&mut self, path: &syn::Path) {
        self.0.paths.insert(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        syn::visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &Macro) {
        paths_in(call.tokens.clone(), &mut |path| {
            self.0.paths.insert(path);
        });
    }
}

fn leaves(tree: &UseTree, above: &mut Vec<String>, leaf: &mut dyn FnMut(Vec<String>, Option<String>)) {
    let ending = |last: String| match &last[..] {
        "self" => above.clone(),
        _ => above.iter().cloned().chain([last]).collect(),
    };
    match tree {
        UseTree::Path(path) => {
            above.push(path.ident.to_string());
            leaves(&path.tree, above, leaf);
            above.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, above, leaf)),
        UseTree::Name(name) => {
            let path = ending(name.ident.to_string());
            let name = path.last().cloned();
            leaf(path, name);
        }
        UseTree::Rename(rename) => leaf(ending(rename.ident.to_string()), Some(rename.rename.to_string())),
        UseTree::Glob(_) => leaf(above.clone(), None),
    }
}

/// Names joined by `::` in what a macro is given, which need not be code.
fn paths_in(tokens: TokenStream, found: &mut dyn FnMut(Vec<String>)) {
    let (mut path, mut colons) = (Vec::new(), 0);
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                if colons != 2 && !path.is_empty() {
                    found(std::mem::take(&mut path));
                }
                path.push(name.to_string());
                colons = 0;
            }
            TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
            other => {
                if !path.is_empty() {
                    found(std::mem::take(&mut path));
                }
                colons = 0;
                if let TokenTree::Group(group) = other {
                    paths_in(group.stream(), found);
                }
            }
        }
    }
    if !path.is_empty() {
        found(path);
    }
}
