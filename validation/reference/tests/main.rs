//! Double-double arithmetic and series in it, against numbers of 300 bits and against values.

mod double_double;
mod series;
