//! Tables that are described by their columns.

use std::fmt::Display;

use super::{Part, Table};
use crate::output;

/// A table that grows by columns: each names itself and shows one thing of every row.
#[must_use]
pub struct Columns<'a, R> {
    rows: &'a [R],
    table: Table,
}

impl<'a, R> Columns<'a, R> {
    /// A table of these rows, without columns yet.
    pub fn of(title: &str, rows: &'a [R]) -> Self {
        let (title, cells) = (title.to_owned(), vec![Vec::new(); rows.len()]);
        Self { rows, table: Table { title, head: Vec::new(), rows: cells } }
    }

    fn filled(mut self, name: &str, cells: impl Iterator<Item = String>) -> Self {
        self.table.head.push(name.to_owned());
        self.table.rows.iter_mut().zip(cells).for_each(|(row, cell)| row.push(cell));
        self
    }

    /// The rows' numbers, from one.
    pub fn numbered(self, name: &str) -> Self {
        self.filled(name, (1..).map(|number: u32| number.to_string()))
    }

    /// Words or a whole number.
    pub fn column<C: Display>(self, name: &str, of: impl Fn(&'a R) -> C) -> Self {
        let rows = self.rows.iter();
        self.filled(name, rows.map(|row| of(row).to_string()))
    }

    /// A number with so many decimal places.
    pub fn fixed(self, name: &str, places: usize, of: impl Fn(&'a R) -> f64) -> Self {
        self.column(name, |row| output::fixed(of(row), places))
    }

    /// A number with so many decimal places, and a dash where there is none.
    pub fn found(self, name: &str, places: usize, of: impl Fn(&'a R) -> Option<f64>) -> Self {
        let dash = || "-".to_owned();
        self.column(name, |row| of(row).map_or_else(dash, |number| output::fixed(number, places)))
    }

    /// A number with an exponent and so many decimal places.
    pub fn scientific(self, name: &str, places: usize, of: impl Fn(&'a R) -> f64) -> Self {
        self.column(name, |row| format!("{:.places$e}", of(row)))
    }

    /// The table with a further row below, of what is no row of the others.
    #[must_use]
    pub fn table(self, last: Option<Vec<String>>) -> Table {
        let mut table = self.table;
        table.rows.extend(last);
        table
    }
}

impl<R> From<Columns<'_, R>> for Part {
    fn from(columns: Columns<'_, R>) -> Self {
        columns.table.into()
    }
}
