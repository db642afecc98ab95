//! The scene of formulas that a scene of bodies means.

use std::borrow::Cow;
use std::ops::Range;

use bodies::Formulas;
use symbolic::Expr;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::machine::KEYS;
use super::write::{key, quoted};

/// `table` with definitions, Lagrangian and picture of `made`, each at the place of what it follows from.
pub(super) fn with<'a>(table: &DeTable<'a>, made: &Formulas) -> DeTable<'a> {
    let mut table = table.clone();
    for definition in &made.definitions {
        set(section(&mut table, "definitions"), &definition.name, text(&definition.text, &definition.place));
    }
    if let Some(system) = section(&mut table, "system").filter(|_| !made.energies.is_empty()) {
        let own = system.iter().find(|(key, _)| key.get_ref() == "lagrangian");
        let own = own.map(|(_, value)| (value.span(), value.get_ref().as_str().map(str::to_owned)));
        let (place, own) = own.map_or((0..0, Some(String::new())), |own| own);
        if let Some(own) = own {
            let terms = (!own.is_empty()).then_some(own).into_iter().chain(made.energies.iter().cloned());
            let sum = terms.collect::<Vec<_>>().join(" + ").replace("+ -", "- ");
            set(Some(system), "lagrangian", text(&sum, &place));
        }
    }
    if !made.pictures.is_empty() {
        draw(section(&mut table, "view"), made);
    }
    table
}

/// The picture; a body that is drawn by hand is drawn as there, and touches what its contacts say.
fn draw(view: Option<&mut DeTable>, made: &Formulas) {
    let Some(view) = view else { return };
    for picture in &made.pictures {
        let touches = |at: &Range<usize>| {
            let mut touches = DeTable::new();
            for (on, place) in &picture.touches {
                set(Some(&mut touches), on, text(place, at));
            }
            Spanned::new(at.clone(), DeValue::Table(touches))
        };
        if let Some((_, drawn)) = view.iter_mut().find(|(key, _)| key.get_ref() == picture.name.as_str()) {
            if let DeValue::Table(drawn) = drawn.get_mut()
                && !picture.touches.is_empty()
                && drawn.keys().all(|key| key.get_ref() != "touches")
            {
                set(Some(drawn), "touches", touches(&picture.place));
            }
            continue;
        }
        let at = &picture.place;
        let mut body = DeTable::new();
        set(Some(&mut body), "shape", text(&picture.shape, at));
        let sizes: Vec<&str> = picture.size.iter().map(String::as_str).collect();
        set(Some(&mut body), "size", Spanned::new(at.clone(), texts(&sizes, at)));
        set(Some(&mut body), "at", text(&picture.at, at));
        if !picture.rotation.is_empty() {
            set(Some(&mut body), "rotation", text(&picture.rotation, at));
        }
        if !picture.touches.is_empty() {
            set(Some(&mut body), "touches", touches(at));
        }
        set(Some(view), &picture.name, Spanned::new(at.clone(), DeValue::Table(body)));
    }
}

/// What was found while the scene was read: constraints and forces as they are.
#[derive(Default)]
pub(super) struct Found {
    pub(super) constraints: Vec<String>,
    pub(super) forces: Vec<(String, String)>,
    /// Slips at all contacts.
    pub(super) slips: Vec<Expr>,
    /// What all constraints say, those that are written as well.
    pub(super) says: Vec<String>,
    /// Constraints that say the same as others.
    pub(super) left_out: Vec<String>,
    /// Coordinates that constraints on positions supply.
    pub(super) starts: Vec<(String, f64)>,
}

/// The text of the scene without its bodies: `table` is that of [`with`].
pub(super) fn written(table: &DeTable, found: &Found) -> String {
    let kept = table.iter().filter(|(key, _)| !KEYS.contains(&key.get_ref().as_ref()));
    let mut table: DeTable = kept.map(|(key, value)| (key.clone(), value.clone())).collect();
    if let Some(system) = section(&mut table, "system") {
        let own = system.iter().find(|(key, _)| key.get_ref() == "constraints");
        let own = own.and_then(|(_, value)| value.get_ref().as_array().cloned());
        let mut all = own.unwrap_or_else(DeArray::new);
        found.constraints.iter().for_each(|row| all.push(text(row, &(0..0))));
        if !all.is_empty() {
            set(Some(system), "constraints", Spanned::new(0..0, DeValue::Array(all)));
        }
        for (coordinate, force) in &found.forces {
            set(section(system, "forces"), coordinate, text(force, &(0..0)));
        }
    }
    // rows are rates, which supply no coordinate
    for (coordinate, start) in &found.starts {
        let Some(coordinates) = section(&mut table, "coordinates") else { continue };
        let Some(section) = section(coordinates, coordinate) else { continue };
        section.remove("guess");
        set(Some(section), "start", text(&format!("{start:?}"), &(0..0)));
    }
    let mut out = String::new();
    print(&table, "", &mut out);
    out.trim_start().to_owned()
}

/// Values first, then tables with their headers.
fn print(table: &DeTable, path: &str, out: &mut String) {
    let is_section = |name: &str, value: &DeValue| {
        let inline = matches!(value, DeValue::Table(_)) && (path == "coordinates" || name == "touches");
        matches!(value, DeValue::Table(_)) && !inline
    };
    for (name, value) in table.iter().filter(|(name, value)| !is_section(name.get_ref(), value.get_ref())) {
        *out += &format!("{} = {}\n", key(name.get_ref()), inline(value.get_ref(), true));
    }
    for (name, value) in table.iter().filter(|(name, value)| is_section(name.get_ref(), value.get_ref())) {
        let Some(inner) = value.get_ref().as_table() else { continue };
        let path = if path.is_empty() { key(name.get_ref()) } else { format!("{path}.{}", key(name.get_ref())) };
        let has_values = inner.iter().any(|(_, value)| !matches!(value.get_ref(), DeValue::Table(_)));
        if has_values || matches!(path.as_str(), "coordinates" | "system") || inner.is_empty() {
            *out += &format!("\n[{path}]\n");
        }
        print(inner, &path, out);
    }
}

fn inline(value: &DeValue, is_outer: bool) -> String {
    match value {
        DeValue::String(text) => quoted(text),
        DeValue::Integer(n) if n.radix() == 10 => n.as_str().to_owned(),
        DeValue::Integer(n) => n.to_string(),
        DeValue::Float(x) => x.as_str().to_owned(),
        DeValue::Boolean(truth) => truth.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(array) => {
            let items: Vec<String> = array.iter().map(|item| inline(item.get_ref(), false)).collect();
            let is_long = is_outer && items.iter().map(String::len).sum::<usize>() > 80;
            if is_long { format!("[\n  {},\n]", items.join(",\n  ")) } else { format!("[{}]", items.join(", ")) }
        }
        DeValue::Table(table) => {
            let entry = |(name, value): (&Spanned<Cow<str>>, &Spanned<DeValue>)| {
                format!("{} = {}", key(name.get_ref()), inline(value.get_ref(), false))
            };
            format!("{{ {} }}", table.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
    }
}

fn text<'a>(text: &str, place: &Range<usize>) -> Spanned<DeValue<'a>> {
    Spanned::new(place.clone(), DeValue::String(Cow::Owned(text.to_owned())))
}

fn texts<'a>(elements: &[&str], place: &Range<usize>) -> DeValue<'a> {
    let mut array = DeArray::new();
    elements.iter().for_each(|element| array.push(text(element, place)));
    DeValue::Array(array)
}

/// The table of that name, made where there is none; none where something else has the name.
fn section<'t, 'a>(table: &'t mut DeTable<'a>, name: &str) -> Option<&'t mut DeTable<'a>> {
    if table.keys().all(|key| key.get_ref() != name) {
        set(Some(table), name, Spanned::new(0..0, DeValue::Table(DeTable::new())));
    }
    let found = table.iter_mut().find(|(key, _)| key.get_ref() == name);
    match found.map(|(_, value)| value.get_mut()) {
        Some(DeValue::Table(section)) => Some(section),
        _ => None,
    }
}

fn set<'a>(table: Option<&mut DeTable<'a>>, name: &str, value: Spanned<DeValue<'a>>) {
    let Some(table) = table else { return };
    match table.iter_mut().find(|(key, _)| key.get_ref() == name) {
        Some((_, old)) => *old = value,
        None => {
            table.insert(Spanned::new(value.span(), Cow::Owned(name.to_owned())), value);
        }
    }
}
