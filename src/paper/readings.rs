//! What becomes of a paper's statements under each reading of it: the tables.
//!
//! In: readings, each with the statements judged by its runs. Out: tables in Markdown: the readings,
//! the verdict on every statement under each, and a score for each.
//!
//! The score counts a statement that holds as 1 and one that holds in part as 1/2. What is not decided
//! may be either: so a score is a range, which narrows with more seeds.

use super::markdown::{head, line};
use super::plan::PaperTable;
use crate::measure::{Verdict, numeral::NOTHING};
use crate::sweep::{Ensemble, Statement};

/// The reading of all other tables.
pub(super) const AS_PRINTED: &str = "as-printed";

/// A reading, and the statements judged by what was run of it.
pub(super) struct Judged {
    /// Its number in the tables.
    pub number: usize,
    /// What it is called.
    pub name: String,
    /// What it reads otherwise.
    pub text: String,
    /// From how many runs.
    pub runs: usize,
    /// The statements for which these are cases.
    pub statements: Vec<Statement>,
}

impl Judged {
    /// The verdict on the statement `text`, where there is something to judge it by.
    pub(super) fn verdict(&self, text: &str) -> Option<Verdict> {
        let found = self.statements.iter().find(|own| own.text == text);
        found.map(Statement::verdict)
    }

    /// How many statements have this verdict.
    pub(super) fn count(&self, verdict: Verdict) -> usize {
        let of = |own: &&Statement| own.verdict() == verdict;
        self.statements.iter().filter(of).count()
    }

    /// The least and the most that it can score.
    pub(super) fn score(&self) -> [f64; 2] {
        let least = self.count(Verdict::Holds) as f64 + 0.5 * self.count(Verdict::InPart) as f64;
        [least, least + self.count(Verdict::NotDecided) as f64]
    }
}

/// Of these ensembles those, by the values of a range of their keys, with which every reading among
/// them was run, and as wholly as anywhere: by the values of the keys behind those. What is judged by
/// coarse grains alone is set beside coarse grains.
pub(super) fn compared<'a>(
    ensembles: &[&'a Ensemble<'a>],
    keys: std::ops::Range<usize>,
) -> Vec<&'a Ensemble<'a>> {
    let is_also_there = |one: &Ensemble, case: &[String]| {
        let mut all = ensembles.iter();
        all.any(|own| {
            own.values[0] == one.values[0]
                && own.values[keys.clone()] == *case
                && own.values[keys.end..] == one.values[keys.end..]
        })
    };
    let is_of_all = |own: &&&Ensemble| {
        let mut all = ensembles.iter();
        all.all(|other| is_also_there(other, &own.values[keys.clone()]))
    };
    ensembles.iter().filter(is_of_all).copied().collect()
}

/// The tables of all readings that were `run`, and of those of them that are `judged`; with the one
/// of `numbers` that is the paper's own.
pub(super) fn tables_of(run: &[&Judged], judged: &[&Judged], numbers: String) -> Vec<PaperTable> {
    let table = |name, title, text| PaperTable { name, title, text };
    vec![
        table("readings", "Readings", readings_table(run)),
        table("numbers", "What each comes to", numbers),
        table(
            "verdicts",
            "The paper's statements under each",
            verdicts_table(judged),
        ),
        table("scores", "Scores", scores_table(judged)),
    ]
}

fn readings_table(run: &[&Judged]) -> String {
    let heads = ["", "reading", "what it reads otherwise", "runs"];
    let mut text = head(&heads.map(str::to_owned));
    for own in run {
        let cells = [
            own.number.to_string(),
            own.name.clone(),
            own.text.clone(),
            own.runs.to_string(),
        ];
        text += &line(&cells);
    }
    text
}

/// The mark of a verdict.
fn mark(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Holds) => "✓",
        Some(Verdict::InPart) => "½",
        Some(Verdict::NotDecided) => "?",
        Some(Verdict::DoesNot) => "✗",
        None => NOTHING,
    }
}

/// A row for each statement, a column for each reading.
fn verdicts_table(judged: &[&Judged]) -> String {
    let numbers = judged.iter().map(|own| own.number.to_string());
    let heads = std::iter::once("statement".to_owned()).chain(numbers);
    let mut table = head(&heads.collect::<Vec<_>>());
    for statement in statements(judged) {
        let marks = judged
            .iter()
            .map(|own| mark(own.verdict(statement)).to_owned());
        let cells = std::iter::once(statement.to_owned()).chain(marks);
        table += &line(&cells.collect::<Vec<_>>());
    }
    table
        + "\n✓ holds, ½ in part, ? not decided, ✗ does not hold, by the rules of each statement.\n"
}

/// All statements that some reading is judged by, in the paper's order.
fn statements(judged: &[&Judged]) -> Vec<&'static str> {
    let mut known: Vec<&str> = Vec::new();
    for own in judged.iter().flat_map(|own| &own.statements) {
        if !known.contains(&own.text) {
            known.push(own.text);
        }
    }
    known
}

/// A row for each reading, and which statements none of them reaches.
pub(super) fn scores_table(judged: &[&Judged]) -> String {
    let heads = [
        "",
        "reading",
        "score",
        "of",
        "holds",
        "in part",
        "not decided",
        "does not hold",
    ];
    let mut text = head(&heads.map(str::to_owned));
    for own in judged {
        let [least, most] = own.score();
        let counts = [
            Verdict::Holds,
            Verdict::InPart,
            Verdict::NotDecided,
            Verdict::DoesNot,
        ];
        let first = [
            own.number.to_string(),
            own.name.clone(),
            range(least, most),
            own.statements.len().to_string(),
        ];
        let counts = counts.map(|verdict| own.count(verdict).to_string());
        text += &line(&first.into_iter().chain(counts).collect::<Vec<_>>());
    }
    text + &unreached(judged)
}

/// `6`, or `6 to 8.5`.
fn range(least: f64, most: f64) -> String {
    if least == most {
        least.to_string()
    } else {
        format!("{least} to {most}")
    }
}

/// Which statements hold under no reading, and of these the ones that may yet.
fn unreached(judged: &[&Judged]) -> String {
    let verdicts = |text: &str| {
        let all: Vec<Verdict> = judged.iter().filter_map(|own| own.verdict(text)).collect();
        all
    };
    let never = |text: &&str| {
        verdicts(text)
            .iter()
            .all(|own| matches!(own, Verdict::DoesNot | Verdict::InPart))
    };
    let open = |text: &&str| {
        let all = verdicts(text);
        !all.contains(&Verdict::Holds) && all.contains(&Verdict::NotDecided)
    };
    let list = |head: &str, texts: Vec<&str>| match texts.as_slice() {
        [] => String::new(),
        texts => format!("\n{head}: {}.\n", texts.join("; ")),
    };
    let all = statements(judged);
    let of = |is: &dyn Fn(&&str) -> bool| all.iter().copied().filter(|text| is(text)).collect();
    list("No reading reaches", of(&never))
        + &list("Not decided under any reading that might", of(&open))
}
