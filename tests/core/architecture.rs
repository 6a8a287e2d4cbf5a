//! The arrows between files: which module may name which, and no circles among neighbours.
//!
//! In: the source files as text, and the tables of modules in `src/lib.rs` and `app/src/lib.rs`. Out: a sentence for
//! every arrow that runs against the table, and for every circle of files or folders that stand
//! side by side. An arrow is a `use` or a path that begins with `crate`, `super`, `self` or a child
//! module; a name that a `mod.rs` only hands on counts as taken from the file that defines it.
//! Tests inside the files are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Columns by which code in braces is indented.
const INDENT: usize = 4;

/// A module's path below the crate: `["ui", "dock"]`; empty for the crate itself.
type ModulePath = Vec<String>;

/// Files that name each other: from, to, and the name that is taken.
type Arrow = (ModulePath, ModulePath, String);

/// A `use` of one name.
struct Import {
    /// What it is called in the file; `*` for all that is there.
    name: String,
    path: ModulePath,
    /// Whether it is handed on to others.
    is_export: bool,
}

#[derive(Default)]
struct File {
    imports: Vec<Import>,
    /// Paths in the code outside `use`.
    inline: Vec<ModulePath>,
    defined: BTreeSet<String>,
    is_folder: bool,
}

struct Tree(BTreeMap<ModulePath, File>);

impl Tree {
    /// The tree of these files, given by their paths below `src` and their text.
    fn of(files: &[(String, String)]) -> Self {
        let mut code: BTreeMap<ModulePath, (bool, String)> = BTreeMap::new();
        let mut for_tests = BTreeSet::new();
        for (path, text) in files.iter().filter(|(path, _)| path != "main.rs") {
            let module = module_of(path);
            let (kept, tests) = without_tests(text);
            for_tests.extend(tests.into_iter().map(|name| child(&module, &name)));
            code.insert(module, (path.ends_with("mod.rs"), kept));
        }
        code.retain(|module, _| !for_tests.contains(module));
        let modules: BTreeSet<ModulePath> = code.keys().cloned().collect();
        let read = |(module, (is_folder, code)): (ModulePath, (bool, String))| {
            let file = File {
                is_folder,
                ..File::read(&module, &code, &modules)
            };
            (module, file)
        };
        Self(code.into_iter().map(read).collect())
    }

    /// The file that defines what `path` names: what a module only hands on is looked up where it
    /// comes from.
    fn home(&self, path: &[String], hops: usize) -> ModulePath {
        let is_module = |length: &usize| self.0.contains_key(&path[..*length]);
        let length = (0..=path.len()).rev().find(is_module).unwrap_or(0);
        let module = path[..length].to_vec();
        let (Some(file), Some(name)) = (self.0.get(&module), path.get(length)) else {
            return module;
        };
        if hops == 0 || file.defined.contains(name) {
            return module;
        }
        let named = file.imports.iter().find(|import| import.name == *name);
        if let Some(import) = named {
            return self.home(&import.path, hops - 1);
        }
        let all = file.imports.iter().filter(|import| import.name == "*");
        let mut homes = all.map(|import| self.home(&child(&import.path, name), hops - 1));
        let defines = |home: &ModulePath| self.0[home].defined.contains(name);
        homes.find(defines).unwrap_or(module)
    }

    /// All arrows. Where a folder only hands on what stands in it, that is none, unless
    /// `with_exports`.
    fn arrows(&self, with_exports: bool) -> Vec<Arrow> {
        let mut arrows = Vec::new();
        for (module, file) in &self.0 {
            let counts = |import: &&Import| with_exports || !(import.is_export && file.is_folder);
            let imports = file.imports.iter().filter(counts);
            let paths = imports.map(|import| &import.path).chain(&file.inline);
            for path in paths {
                let home = self.home(path, 8);
                let name = path.last().cloned().unwrap_or_default();
                if home != *module && !home.is_empty() {
                    arrows.push((module.clone(), home, name));
                }
            }
        }
        arrows
    }
}

impl File {
    fn read(module: &[String], code: &str, modules: &BTreeSet<ModulePath>) -> Self {
        let mut file = Self::default();
        let mut statement: Option<(bool, String)> = None;
        // A module inside the file is one step further from what `super` means.
        let mut place = module.to_vec();
        for line in code.lines() {
            let trimmed = line.trim_start();
            let bare = without_visibility(trimmed);
            let indent = (line.len() - trimmed.len()) / INDENT;
            if let Some(name) = bare
                .strip_prefix("mod ")
                .and_then(|rest| rest.strip_suffix(" {"))
            {
                place.push(name.to_owned());
            } else if trimmed == "}" && module.len() + indent < place.len() {
                place.pop();
            }
            if statement.is_none() && bare.starts_with("use ") {
                let is_export = bare.len() < trimmed.len();
                statement = Some((is_export, bare["use ".len()..].to_owned()));
            } else if let Some((_, text)) = &mut statement {
                text.push_str(trimmed);
            } else {
                file.defined.extend(defined_name(bare));
                file.inline.extend(inline_paths(&place, line, modules));
            }
            if let Some((is_export, text)) = statement.take_if(|(_, text)| text.ends_with(';')) {
                file.add_uses(&place, &text, is_export, modules);
            }
        }
        file
    }

    fn add_uses(
        &mut self,
        module: &[String],
        text: &str,
        is_export: bool,
        modules: &BTreeSet<ModulePath>,
    ) {
        for leaf in leaves(text.trim_end_matches(';')) {
            let (path, alias) = match leaf.split_once(" as ") {
                Some((path, alias)) => (path.trim(), Some(alias.trim())),
                None => (leaf.as_str(), None),
            };
            let path = path.trim_end_matches("::self");
            let segments: Vec<&str> = path.split("::").map(str::trim).collect();
            let Some(mut path) = absolute(module, &segments, modules) else {
                continue;
            };
            let last = path.last().cloned().unwrap_or_default();
            if last == "*" {
                path.pop();
            }
            self.imports.push(Import {
                name: alias.map_or(last, str::to_owned),
                path,
                is_export,
            });
        }
    }
}

/// `["ui", "dock"]` for `ui/dock.rs`, `["ui"]` for `ui/mod.rs`.
fn module_of(path: &str) -> ModulePath {
    let bare = path.trim_end_matches(".rs");
    let segments = bare
        .split('/')
        .filter(|part| !["mod", "lib"].contains(part));
    segments.map(str::to_owned).collect()
}

fn child(module: &[String], name: &str) -> ModulePath {
    let mut path = module.to_vec();
    path.push(name.to_owned());
    path
}

/// `text` without comments and without what is compiled for tests only, and the modules among the
/// latter that are files.
fn without_tests(text: &str) -> (String, Vec<String>) {
    let (mut kept, mut modules) = (String::new(), Vec::new());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line == "#[cfg(test)]" {
            let mut next = lines.next().unwrap_or_default();
            let name = without_visibility(next).strip_prefix("mod ");
            modules.extend(
                name.and_then(|name| name.strip_suffix(';'))
                    .map(str::to_owned),
            );
            while !(next.ends_with(';') && !next.starts_with(' ') || next == "}") {
                let Some(following) = lines.next() else { break };
                next = following;
            }
            continue;
        }
        let code = line.split_once("//").map_or(line, |(code, comment)| {
            let is_address = code.ends_with(':') && !comment.starts_with('/');
            if is_address { line } else { code }
        });
        kept.push_str(code.trim_end());
        kept.push('\n');
    }
    (kept, modules)
}

/// `line` without `pub` or `pub(…)` at its start.
fn without_visibility(line: &str) -> &str {
    let Some(rest) = line.strip_prefix("pub") else {
        return line;
    };
    let rest = match rest.strip_prefix('(') {
        Some(inside) => inside.split_once(')').map_or(rest, |(_, rest)| rest),
        None => rest,
    };
    rest.strip_prefix(' ').unwrap_or(line)
}

/// The name that `line` defines, if it begins an item.
fn defined_name(line: &str) -> Option<String> {
    let mut words = line.split_whitespace().peekable();
    while matches!(words.peek(), Some(&"unsafe" | &"async")) {
        words.next();
    }
    let kind = words.next()?;
    let mut name = words.next()?;
    if kind == "const" && name == "fn" {
        name = words.next()?;
    }
    let kinds = [
        "fn",
        "struct",
        "enum",
        "trait",
        "type",
        "const",
        "static",
        "macro_rules!",
    ];
    let end = name
        .find(|letter: char| !is_of_name(letter))
        .unwrap_or(name.len());
    (kinds.contains(&kind) && end > 0).then(|| name[..end].to_owned())
}

fn is_of_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// The single paths of a `use`: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn leaves(tree: &str) -> Vec<String> {
    let Some((prefix, rest)) = tree.split_once('{') else {
        return vec![tree.trim().to_owned()];
    };
    let inside = rest.trim_end().strip_suffix('}').unwrap_or(rest);
    let mut depth = 0;
    let parts = inside.split(|letter| {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        letter == ',' && depth == 0
    });
    let whole = |part: &str| leaves(&format!("{}{}", prefix.trim(), part.trim()));
    let parts = parts.filter(|part| !part.trim().is_empty());
    parts.flat_map(whole).collect()
}

/// The path below the crate that `segments` mean in `module`; none where they lead out of the
/// crate.
fn absolute(
    module: &[String],
    segments: &[&str],
    modules: &BTreeSet<ModulePath>,
) -> Option<ModulePath> {
    let mut base = module.to_vec();
    let mut rest = segments;
    match *rest.first()? {
        "crate" => base.clear(),
        "self" => {}
        "super" => {
            while let Some((&"super", after)) = rest.split_first() {
                base.pop();
                rest = after;
            }
            base.extend(rest.iter().map(|&segment| segment.to_owned()));
            return Some(base);
        }
        first if modules.contains(&child(module, first)) => {
            base.extend(rest.iter().map(|&segment| segment.to_owned()));
            return Some(base);
        }
        _ => return None,
    }
    base.extend(rest[1..].iter().map(|&segment| segment.to_owned()));
    Some(base)
}

/// The paths in `code` that lead to a file of the crate.
fn inline_paths(module: &[String], code: &str, modules: &BTreeSet<ModulePath>) -> Vec<ModulePath> {
    let is_of_path = |letter: char| is_of_name(letter) || letter == ':';
    let words = code.split(|letter| !is_of_path(letter));
    let paths = words.filter_map(|word| {
        let word = word.trim_end_matches(':');
        let segments: Vec<&str> = word.split("::").collect();
        let is_declared = segments.len() == 1;
        (!is_declared).then(|| absolute(module, &segments, modules))?
    });
    paths.collect()
}

/// The modules in the rows of a table in a file's documentation, from the first row on.
fn table(text: &str) -> Vec<Vec<String>> {
    let rows = text.lines().filter_map(|line| line.strip_prefix("//! | "));
    let cells = rows.map(|row| row.split('|').next().unwrap_or_default());
    let names = cells.map(|cell| {
        cell.split('`')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect()
    });
    names
        .filter(|names: &Vec<String>| !names.is_empty())
        .collect()
}

/// The modules of the table in a `lib.rs`, from the lowest up.
fn rows_of_table(lib: &str) -> Vec<String> {
    table(lib).concat()
}

/// A sentence for every arrow that runs against the table, and for every module that is in no row.
fn against_the_table(tree: &Tree, rows: &[String]) -> BTreeSet<String> {
    let row = |module: &[String]| rows.iter().position(|name| Some(name) == module.first());
    let missing = tree
        .0
        .keys()
        .filter(|module| !module.is_empty() && row(module).is_none());
    let missing = missing.map(|module| format!("`{}` is in no row of the table.", module[0]));
    let mut said: BTreeSet<String> = missing.collect();
    for (from, to, name) in tree.arrows(true) {
        if let (Some(own), Some(other)) = (row(&from), row(&to))
            && other > own
        {
            said.insert(format!(
                "`{}` takes `{name}` from `{}`, which stands below `{}` in the table: a module names only modules above it.",
                from.join("::"),
                to.join("::"),
                from[0]
            ));
        }
    }
    said
}

/// Who names whom among those that stand side by side in one folder, with the names taken.
type Neighbours = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// The arrows among neighbours, folder by folder.
fn neighbours(tree: &Tree) -> BTreeMap<String, Neighbours> {
    let mut folders: BTreeMap<String, Neighbours> = BTreeMap::new();
    for (from, to, name) in tree.arrows(false) {
        let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
        if shared == 0 {
            continue;
        }
        let place = |module: &[String]| module.get(shared).map_or("mod", String::as_str).to_owned();
        let folder = folders
            .entry(format!("src/{}", from[..shared].join("/")))
            .or_default();
        let names = folder.entry(place(&from)).or_default();
        names.entry(place(&to)).or_default().insert(name);
    }
    folders
}

/// What the documentation of a folder says where its table has an order.
const HAS_ORDER: &str = "uses only rows below it";

/// A sentence for every arrow in a folder that runs up in the table of its `mod.rs`, where that
/// table has an order.
fn against_own_tables(tree: &Tree, files: &[(String, String)]) -> Vec<String> {
    let mut said = Vec::new();
    let folders = neighbours(tree);
    for (path, text) in files.iter().filter(|(_, text)| text.contains(HAS_ORDER)) {
        let rows = table(text);
        let row = |name: &String| rows.iter().position(|names| names.contains(name));
        let folder = format!("src/{}", path.trim_end_matches("/mod.rs"));
        for (from, arrows) in folders.get(&folder).into_iter().flatten() {
            for (to, names) in arrows {
                match (row(from), row(to)) {
                    (Some(own), Some(other)) if other < own => {
                        let names: Vec<&str> = names.iter().map(String::as_str).collect();
                        let names = names.join(", ");
                        said.push(format!(
                            "In {folder} {from} uses {names} of {to}, a row above it."
                        ));
                    }
                    (Some(_), Some(_)) => {}
                    _ => said.push(format!(
                        "In {folder} {from} or {to} is in no row of its table."
                    )),
                }
            }
        }
    }
    said
}

/// All that can be reached from `start`.
fn reached(arrows: &Neighbours, start: &str) -> BTreeSet<String> {
    let (mut found, mut open) = (BTreeSet::new(), vec![start.to_owned()]);
    while let Some(place) = open.pop() {
        let next = arrows.get(&place).into_iter().flat_map(BTreeMap::keys);
        open.extend(next.filter(|place| found.insert((*place).clone())).cloned());
    }
    found
}

/// The circles of a folder: sets of neighbours each of which reaches every other.
fn circles(arrows: &Neighbours) -> BTreeSet<BTreeSet<String>> {
    let reach: BTreeMap<&String, _> = arrows
        .keys()
        .map(|from| (from, reached(arrows, from)))
        .collect();
    let in_circle = reach
        .iter()
        .filter(|(from, reached)| reached.contains(**from));
    let circle = |(from, reached): (&&String, &BTreeSet<String>)| {
        let mutual = |to: &&String| reach.get(to).is_some_and(|back| back.contains(*from));
        reached.iter().filter(mutual).cloned().collect()
    };
    in_circle.map(circle).collect()
}

/// A sentence for every circle in folders other than those `left`.
fn circles_in_words(tree: &Tree) -> Vec<String> {
    let mut said = Vec::new();
    for (folder, arrows) in neighbours(tree) {
        for circle in circles(&arrows) {
            let mut text = format!("In {folder} these name each other in a circle:");
            for (from, to) in circle
                .iter()
                .flat_map(|a| circle.iter().map(move |b| (a, b)))
            {
                if let Some(names) = arrows.get(from).and_then(|from| from.get(to)) {
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    let _ = write!(text, " {from} → {to} ({});", names.join(", "));
                }
            }
            said.push(text + " what they share wants a file below them.");
        }
    }
    said
}

/// Every source file below `folder`, by its path there.
fn read_sources(folder: &Path, below: &str, files: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{below}{name}");
        if entry.path().is_dir() {
            read_sources(&entry.path(), &format!("{path}/"), files);
        } else if entry
            .path()
            .extension()
            .is_some_and(|ending| ending == "rs")
        {
            files.push((path, fs::read_to_string(entry.path()).unwrap()));
        }
    }
}

/// The files of the library and those of the program.
fn packages() -> [Vec<(String, String)>; 2] {
    ["src", "app/src"].map(|folder| {
        let mut files = Vec::new();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        read_sources(&folder, "", &mut files);
        files
    })
}

#[test]
fn modules_name_only_modules_above_them_in_the_table() {
    for files in packages() {
        let lib = files.iter().find(|(path, _)| path == "lib.rs").unwrap();
        let said = against_the_table(&Tree::of(&files), &rows_of_table(&lib.1));
        let text: Vec<String> = said.into_iter().collect();
        assert!(text.is_empty(), "{}", text.join("\n"));
    }
}

#[test]
fn folders_keep_the_order_that_their_own_tables_state() {
    let packages = packages();
    let ordered = packages.iter().flatten();
    let ordered = ordered.filter(|(_, text)| text.contains(HAS_ORDER));
    assert!(
        ordered.count() >= 2,
        "the panels and the view have such tables"
    );
    for files in packages {
        let said = against_own_tables(&Tree::of(&files), &files);
        assert!(said.is_empty(), "{}", said.join("\n"));
    }
}

#[test]
fn neighbours_never_name_each_other_in_a_circle() {
    for files in packages() {
        let said = circles_in_words(&Tree::of(&files));
        assert!(said.is_empty(), "{}", said.join("\n"));
    }
}

/// A small crate whose files hold this.
fn crate_of(files: &[(&str, &str)]) -> Tree {
    let owned = |(path, text): &(&str, &str)| ((*path).to_owned(), (*text).to_owned());
    Tree::of(&files.iter().map(owned).collect::<Vec<_>>())
}

#[test]
fn a_circle_through_what_a_folder_hands_on_is_found() {
    let files = [
        ("lib.rs", "pub mod ui;"),
        (
            "ui/mod.rs",
            "mod dock;\nmod menu;\npub use menu::Menu;\npub use dock::*;",
        ),
        ("ui/dock.rs", "use super::Menu;\npub struct Dock;"),
        ("ui/menu.rs", "pub struct Menu(Option<Box<super::Dock>>);"),
    ];
    let said = circles_in_words(&crate_of(&files));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("dock → menu (Menu)"), "{said:?}");
    assert!(said[0].contains("menu → dock (Dock)"), "{said:?}");
}

#[test]
fn tests_comments_and_faces_make_no_circle() {
    let files = [
        ("lib.rs", "pub mod ui;"),
        (
            "ui/mod.rs",
            "mod dock;\npub mod words;\npub use dock::Dock;",
        ),
        (
            "ui/words.rs",
            "//! See super::Dock.\npub fn short() {}\n#[cfg(test)]\nmod tests {\n    use super::super::Dock;\n}",
        ),
        (
            "ui/dock.rs",
            "use crate::ui::words::{self, short};\npub struct Dock;",
        ),
    ];
    assert_eq!(circles_in_words(&crate_of(&files)), [""; 0]);
}

#[test]
fn an_arrow_against_the_table_is_found_also_inside_a_path() {
    let files = [
        (
            "lib.rs",
            "//! | [`world`] | state |\n//! | `view`, `ui` | picture |",
        ),
        ("world/mod.rs", "fn f() { crate::ui::draw(); }"),
        ("ui.rs", "use crate::{world, view::Eye};"),
        ("view.rs", "pub struct Eye;"),
        ("stray.rs", ""),
    ];
    let rows = rows_of_table(files[0].1);
    assert_eq!(rows, ["world", "view", "ui"]);
    let said: Vec<String> = against_the_table(&crate_of(&files), &rows)
        .into_iter()
        .collect();
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].contains("`stray` is in no row"), "{said:?}");
    assert!(
        said[1].contains("`world` takes `draw` from `ui`"),
        "{said:?}"
    );
}

#[test]
fn an_arrow_up_in_the_table_of_a_folder_is_found() {
    let face = "//! Each row of the table uses only rows below it.\n//! | `menu`, `dock` | top |\n//! | `words` | text |";
    let files = [
        ("lib.rs", "pub mod ui;"),
        ("ui/mod.rs", face),
        ("ui/dock.rs", "use super::words::short;\npub struct Dock;"),
        ("ui/words.rs", "pub fn short(dock: super::dock::Dock) {}"),
        ("ui/stray.rs", "use super::dock::Dock;"),
    ];
    let owned = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let said = against_own_tables(&Tree::of(&owned), &owned);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].contains("stray or dock is in no row"), "{said:?}");
    assert!(
        said[1].contains("words uses Dock of dock, a row above"),
        "{said:?}"
    );
}
