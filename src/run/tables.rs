//! What the columns of tables hold, for programs that read them.
//!
//! In: the tables of a folder and where they come from. Out: `csv-metadata.json` as the W3C's *CSV
//! on the Web* has it, so that the tables themselves begin with their header for every reader. Units
//! stand as schema.org's `unitText`.

use super::Provenance;
use crate::measure::Quantity;
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// The file beside tables that says where they came from and what their columns hold.
pub const TABLES_METADATA: &str = "csv-metadata.json";

/// A table as readers should know it.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Its file's name.
    pub name: String,
    /// Its columns in their order.
    pub columns: Vec<Column>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it holds, without the unit.
    pub key: String,
    /// What its cells are.
    pub cells: Cells,
    /// How it is taken, empty where the key says it all.
    pub description: String,
}

/// What the cells of a column are; one without a value is empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// Numbers in an SI unit, `1` for pure ones.
    Numbers(&'static str),
    /// Whole numbers.
    Counts,
    /// Words.
    Words,
}

impl Table {
    /// The table called `name` with these `columns`.
    pub fn new(name: &str, columns: impl IntoIterator<Item = Column>) -> Self {
        Self {
            name: name.into(),
            columns: columns.into_iter().collect(),
        }
    }

    /// The heads of its columns.
    pub fn heads(&self) -> Vec<String> {
        self.columns.iter().map(Column::head).collect()
    }
}

impl Column {
    /// The column of a `quantity` as samples have it.
    pub fn of(quantity: &Quantity) -> Self {
        Self::numbers(quantity.key, quantity.unit.si).described(quantity.explanation())
    }

    /// The column `key` of numbers in `unit`.
    pub fn numbers(key: impl Into<String>, unit: &'static str) -> Self {
        Self::new(key, Cells::Numbers(unit))
    }

    /// The column `key` of such `cells`.
    pub fn new(key: impl Into<String>, cells: Cells) -> Self {
        Self {
            key: key.into(),
            cells,
            description: String::new(),
        }
    }

    /// The same with what is to say of it.
    #[must_use]
    pub fn described(self, description: impl Into<String>) -> Self {
        Self {
            description: description.into(),
            ..self
        }
    }

    /// What stands in the table's first line: `surface angle [rad]`.
    pub fn head(&self) -> String {
        match self.cells {
            Cells::Numbers(unit) => format!("{} [{unit}]", self.key),
            Cells::Counts => format!("{} [1]", self.key),
            Cells::Words => self.key.clone(),
        }
    }

    fn metadata(&self) -> Value {
        let (datatype, unit) = match self.cells {
            Cells::Numbers(unit) => ("double", Some(unit)),
            Cells::Counts => ("integer", Some("1")),
            Cells::Words => ("string", None),
        };
        let mut column = Map::new();
        column.insert("titles".into(), self.head().into());
        column.insert("datatype".into(), datatype.into());
        if let Some(unit) = unit {
            column.insert("schema:unitText".into(), unit.into());
        }
        if !self.description.is_empty() {
            column.insert("dc:description".into(), self.description.clone().into());
        }
        column.into()
    }
}

/// Writes to `file` what the `tables` beside it hold and that they come `from` there.
///
/// # Errors
/// When the file cannot be written.
pub fn write_metadata(tables: &[Table], from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    let tables = tables.iter().map(|table| {
        let columns: Vec<Value> = table.columns.iter().map(Column::metadata).collect();
        json!({ "url": table.name, "tableSchema": { "columns": columns } })
    });
    let notes = from.entries().into_iter();
    let notes: Map<String, Value> = notes
        .map(|(name, value)| (name.to_lowercase(), value.into()))
        .collect();
    let metadata = json!({
        "@context": "http://www.w3.org/ns/csvw",
        "dc:title": from.title(),
        "dc:source": from.to_string(),
        "tables": tables.collect::<Vec<_>>(),
        "notes": [notes],
    });
    serde_json::to_writer_pretty(&mut *file, &metadata)?;
    file.write_all(b"\n")
}
