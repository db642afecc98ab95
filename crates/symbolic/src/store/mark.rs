//! Expressions and symbols know their graph.
//!
//! A place in a table alone would mean something else in another graph, without a word. So the last bits of
//! an [`Expr`] and a [`Symbol`] are a mark of the graph that made it. A clone gets a mark of its own: what
//! was there before belongs to both, what is made later to one. Marks come round: of 63 mistakes one is
//! missed.

use std::hash::{Hash, Hasher};
use std::sync::atomic::{AtomicU32, Ordering};

/// A node of a [`crate::Graph`]. Equal expressions are the same node (hash-consing).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Expr(u32);

/// A named variable of a [`crate::Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Symbol(u32);

// Marks depend on what other threads do; the order in tables must not.
impl Hash for Expr {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u32(self.place());
    }
}

impl Hash for Symbol {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u32(self.0 >> BITS);
    }
}

const BITS: u32 = 6;
const MASK: u32 = (1 << BITS) - 1;

impl Expr {
    /// What is at this place in every graph.
    pub(crate) const fn common(place: u32) -> Self {
        Expr(place << BITS)
    }

    /// Where it stands among all of its graph.
    pub(crate) const fn place(self) -> u32 {
        self.0 >> BITS
    }
}

/// Whose the places of a table are.
#[derive(Clone)]
pub(crate) struct Marks {
    own: u32,
    /// From which place on, and whose; the first is common to all graphs, the last are the own ones.
    makers: Vec<(u32, u32)>,
}

impl Marks {
    /// Those of a new table, whose first places are common to all.
    pub(crate) fn new(common: usize, own: u32) -> Self {
        let mut marks = Marks { own: 0, makers: vec![(0, 0)] };
        marks.fork(common, own);
        marks
    }

    /// A mark for another graph.
    pub(crate) fn another() -> u32 {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        1 + COUNT.fetch_add(1, Ordering::Relaxed) % MASK
    }

    /// From the place `count` on the table is that of another graph.
    pub(crate) fn fork(&mut self, count: usize, own: u32) {
        self.own = own;
        // an empty stretch is nobody's
        self.makers.retain(|&(from, _)| from == 0 || (from as usize) < count);
        self.makers.push((count as u32, own));
    }

    pub(crate) fn expression(&self, place: usize) -> Expr {
        Expr(self.id(place))
    }

    pub(crate) fn symbol(&self, place: usize) -> Symbol {
        Symbol(self.id(place))
    }

    pub(crate) fn place_of(&self, e: Expr) -> usize {
        self.place(e.0)
    }

    pub(crate) fn place_of_symbol(&self, s: Symbol) -> usize {
        self.place(s.0)
    }

    fn id(&self, place: usize) -> u32 {
        assert!(place < 1 << (32 - BITS), "fewer than 2^26 expressions");
        ((place as u32) << BITS) | self.maker(place as u32)
    }

    fn maker(&self, place: u32) -> u32 {
        let after = self.makers.partition_point(|&(from, _)| from <= place);
        self.makers[after - 1].1
    }

    fn place(&self, id: u32) -> usize {
        let (place, mark) = (id >> BITS, id & MASK);
        if mark != self.own && mark != self.maker(place) {
            foreign();
        }
        place as usize
    }
}

#[cold]
fn foreign() -> ! {
    panic!("an expression or a symbol of another graph")
}
