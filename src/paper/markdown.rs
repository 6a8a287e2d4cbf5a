//! Rows of tables in Markdown.

/// The row of these `cells`.
pub fn line(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// The row of these `heads`, and the rule below it.
pub fn head(heads: &[String]) -> String {
    line(heads) + &line(&vec!["---".to_owned(); heads.len()])
}
