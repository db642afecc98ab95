//! Entries that use each other, in an order in which each comes after what it uses.

use std::collections::HashMap;

use super::names::{Names, Role};
use super::section::{Entry, Source, Value};
use crate::SceneErrorKind;

/// An entry and what it says.
pub(super) type Written<'a> = (Entry<'a>, Value);

/// `entries` in such an order, otherwise in that of the file. Those in a circle are noted and left out; their
/// names are faulty.
pub(super) fn in_order<'a>(
    source: Source,
    entries: Vec<Written<'a>>,
    role: Role,
    names: &mut Names,
) -> Vec<Written<'a>> {
    let places: HashMap<&str, usize> = entries.iter().enumerate().map(|(i, (entry, _))| (entry.key, i)).collect();
    let uses = |(_, value): &Written| match value {
        Value::Number(_) => Vec::new(),
        Value::Expression(text) => {
            let names = symbolic::names_in(&text.text);
            names.into_iter().filter_map(|(name, _)| places.get(name).copied()).collect::<Vec<usize>>()
        }
    };
    let uses: Vec<Vec<usize>> = entries.iter().map(uses).collect();
    let mut walk = Walk { uses: &uses, seen: vec![Seen::Not; entries.len()], path: Vec::new(), order: Vec::new() };
    let mut circles = Vec::new();
    for start in 0..entries.len() {
        walk.visit(start, &mut circles);
    }
    let order = walk.order;
    let mut out: Vec<bool> = vec![false; entries.len()];
    for circle in circles {
        let last = &entries[circle[circle.len() - 1]].0;
        let names = circle.iter().chain(&circle[..1]).map(|&i| entries[i].0.key.to_string()).collect();
        source.note::<()>(Err(last.error(SceneErrorKind::Circle { names })));
        circle.iter().for_each(|&i| out[i] = true);
    }
    for (i, _) in out.iter().enumerate().filter(|(_, out)| **out) {
        names.insert_faulty(entries[i].0.key, role);
    }
    let mut entries: Vec<Option<Written>> = entries.into_iter().map(Some).collect();
    order.into_iter().filter(|&i| !out[i]).filter_map(|i| entries[i].take()).collect()
}

#[derive(Clone, Copy, PartialEq)]
enum Seen {
    Not,
    OnPath,
    Done,
}

struct Walk<'a> {
    uses: &'a [Vec<usize>],
    seen: Vec<Seen>,
    path: Vec<usize>,
    order: Vec<usize>,
}

impl Walk<'_> {
    /// Depth first, without recursion: a file may have a chain of any length.
    fn visit(&mut self, start: usize, circles: &mut Vec<Vec<usize>>) {
        let mut stack = vec![(start, 0)];
        while let Some((i, next)) = stack.pop() {
            if next == 0 {
                if self.seen[i] != Seen::Not {
                    continue;
                }
                self.seen[i] = Seen::OnPath;
                self.path.push(i);
            }
            match self.uses[i].get(next) {
                Some(&used) => {
                    stack.push((i, next + 1));
                    match self.seen[used] {
                        Seen::Not => stack.push((used, 0)),
                        Seen::OnPath => {
                            let from = self.path.iter().position(|&p| p == used).unwrap_or(0);
                            circles.push(self.path[from..].to_vec());
                        }
                        Seen::Done => {}
                    }
                }
                None => {
                    self.seen[i] = Seen::Done;
                    self.path.pop();
                    self.order.push(i);
                }
            }
        }
    }
}
