//! A paper's statement beside what a sweep came to.
//!
//! In: comparisons, each with its verdict. Out: the verdict on the whole, and a page of statements,
//! each with the rule that decided it and every comparison behind it. The rules are those of
//! [`Verdict`]; nothing is judged by eye. What a paper states is not known here.

use crate::measure::Verdict;

/// A statement of a paper.
pub struct Statement {
    /// What the paper says.
    pub text: &'static str,
    /// What is compared, and by which rule.
    pub rule: &'static str,
    /// The comparisons.
    pub parts: Vec<Part>,
}

/// One comparison behind a statement.
pub struct Part {
    /// The cases that are compared: `r = 3 mm, 109 mPa s`.
    pub place: String,
    /// What they came to.
    pub found: String,
    /// What follows by the rule.
    pub verdict: Verdict,
}

impl Statement {
    /// What becomes of it: all its parts hold, some do, or none does.
    pub fn verdict(&self) -> Verdict {
        let parts: Vec<Verdict> = self.parts.iter().map(|part| part.verdict).collect();
        Verdict::of_all(&parts)
    }
}

/// What stands over the list.
const HEAD: &str = "Each verdict follows from its rule: *more than scatter* is Welch's test at 5 %, an \
                    interval is that of 95 %. Errors are over the seeds; of one drum, its own; of \
                    one column, the relative scatter of the columns of several seeds nearest in \
                    height. *Not decided* takes more seeds or longer runs.";

/// The page of these `statements`, of which its title says more.
pub fn markdown(title: &str, statements: &[Statement]) -> String {
    let line = |part: &Part| {
        let verdict = part.verdict.word();
        format!("- {}: {} – {verdict}\n", part.place, part.found)
    };
    let section = |own: &Statement| {
        let lines: String = own.parts.iter().map(line).collect();
        format!("\n## {}\n\n{lines}", own.text)
    };
    let head = format!("# The paper's statements{title}\n\n{HEAD}\n\n");
    [head, table(statements)]
        .into_iter()
        .chain(statements.iter().map(section))
        .collect()
}

/// The verdicts on these `statements` as a table in Markdown.
pub fn table(statements: &[Statement]) -> String {
    let row = |own: &Statement| {
        let verdict = own.verdict().word();
        format!("| {} | {verdict} | {} |\n", own.text, own.rule)
    };
    let head = "| statement | verdict | rule |\n|---|---|---|\n".to_owned();
    let rows = statements.iter().map(row);
    std::iter::once(head).chain(rows).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_lists_every_statement_with_its_verdict_and_parts() {
        let part = |place: &str, verdict| Part {
            place: place.into(),
            found: "1 against 2".into(),
            verdict,
        };
        let statement = Statement {
            text: "a is larger than b",
            rule: "larger by more than scatter",
            parts: vec![
                part("here", Verdict::Holds),
                part("there", Verdict::DoesNot),
            ],
        };
        let page = markdown("", &[statement]);
        assert!(page.contains("| a is larger than b | in part | larger by more than scatter |"));
        assert!(page.contains("## a is larger than b\n\n- here: 1 against 2 – holds\n"));
        assert!(page.ends_with("- there: 1 against 2 – does not hold\n"));
    }
}
