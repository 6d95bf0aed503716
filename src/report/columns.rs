//! Tables of results column by column: numbers stay numbers until a file or another program takes
//! them.

/// A table; its columns are equally long.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// Its name, and that of its file.
    pub name: &'static str,
    /// The columns by their names, in their order.
    pub columns: Vec<(String, Values)>,
}

/// The values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; NaN is a missing one.
    Numbers(Vec<f64>),
    /// Texts; an empty one is a missing one.
    Texts(Vec<String>),
}

/// One value of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number; NaN is a missing one.
    Number(f64),
    /// A text; an empty one is a missing one.
    Text(String),
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Values::Numbers(values) => values.len(),
            Values::Texts(values) => values.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Columns {
    /// The table with these rows, each the columns' names with their values; a table of no row has
    /// no column. All rows have the columns of the first one.
    pub fn of_rows(
        name: &'static str,
        rows: impl IntoIterator<Item = Vec<(String, Value)>>,
    ) -> Self {
        let mut columns: Vec<(String, Values)> = Vec::new();
        for (i, row) in rows.into_iter().enumerate() {
            for (j, (name, value)) in row.into_iter().enumerate() {
                match (columns.get_mut(j).map(|(_, values)| values), value) {
                    (Some(Values::Numbers(values)), Value::Number(value)) => values.push(value),
                    (Some(Values::Texts(values)), Value::Text(value)) => values.push(value),
                    (None, Value::Number(value)) if i == 0 => {
                        columns.push((name, Values::Numbers(vec![value])));
                    }
                    (None, Value::Text(value)) if i == 0 => {
                        columns.push((name, Values::Texts(vec![value])));
                    }
                    _ => unreachable!("a row has the columns of the first one"),
                }
            }
        }
        Self { name, columns }
    }

    /// The same columns without rows.
    #[must_use]
    pub fn without_rows(mut self) -> Self {
        for (_, values) in &mut self.columns {
            match values {
                Values::Numbers(numbers) => numbers.clear(),
                Values::Texts(texts) => texts.clear(),
            }
        }
        self
    }

    /// The table as CSV; the numbers have as many digits as it takes to read them back exactly, and
    /// a missing one is an empty cell. Texts are names and need no quotes.
    pub fn to_csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = names.join(",") + "\n";
        let mut digits = zmij::Buffer::new();
        // The place in the text of each column's last number: along a line most coordinates repeat.
        let mut written = vec![0..0; self.columns.len()];
        for row in 0..self.columns.first().map_or(0, |(_, values)| values.len()) {
            for (i, ((_, values), written)) in self.columns.iter().zip(&mut written).enumerate() {
                if i > 0 {
                    text.push(',');
                }
                let from = text.len();
                match values {
                    Values::Texts(values) => text.push_str(&values[row]),
                    Values::Numbers(values) if values[row].is_nan() => {}
                    // Many stresses vanish by symmetry.
                    Values::Numbers(values) if values[row] == 0.0 => text.push('0'),
                    Values::Numbers(values) if row > 0 && values[row] == values[row - 1] => {
                        text.extend_from_within(written.clone());
                    }
                    Values::Numbers(values) => {
                        let number = digits.format(values[row]);
                        text.push_str(number.strip_suffix(".0").unwrap_or(number));
                    }
                }
                *written = from..text.len();
            }
            text.push('\n');
        }
        text
    }
}
