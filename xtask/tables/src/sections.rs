//! Groups the questions into sections of the page, with tables of the paper.

use lobe_benches::contest::{QUESTIONS, Question};

use super::paper::{self, PaperTable};
use super::rows::Row;

/// One section of the page.
#[derive(Clone, Debug)]
pub struct Section {
    /// Heading.
    pub title: &'static str,
    /// A table of the paper.
    pub paper: Option<PaperTable>,
    /// The questions measured for it.
    pub questions: Vec<Question>,
}

/// Sections with a table of the paper: heading, table, and the ids of the questions.
const OF_THE_PAPER: [(&str, PaperTable, &[&str]); 4] = [
    ("Inverse trigonometry", paper::ACOS, &["acos", "acos-paper"]),
    ("Binary search", paper::SEARCH, &["search", "search-paper"]),
    ("Isotropic evaluation", paper::ISOTROPIC, &["iso", "iso-single", "iso-paper"]),
    ("Anisotropic evaluation", paper::ANISOTROPIC, &["aniso", "aniso-single", "aniso-paper"]),
];

/// The sections with the questions that have rows.
pub fn all(rows: &[Row]) -> Vec<Section> {
    of(|question| rows.iter().any(|row| row.id == question.id))
}

/// The sections with the requested questions; those that belong to no table of the paper come last, in one section.
pub(crate) fn of(is_wanted: impl Fn(&Question) -> bool) -> Vec<Section> {
    let wanted: Vec<_> = QUESTIONS.into_iter().filter(is_wanted).collect();
    let of = |ids: &[&str]| wanted.iter().copied().filter(|question| ids.contains(&question.id)).collect();
    let mut sections: Vec<Section> = OF_THE_PAPER
        .into_iter()
        .map(|(title, paper, ids)| Section { title, paper: Some(paper), questions: of(ids) })
        .collect();
    let placed = |question: &Question| OF_THE_PAPER.iter().any(|(.., ids)| ids.contains(&question.id));
    let rest = wanted.iter().copied().filter(|question| !placed(question)).collect();
    sections.push(Section { title: "Beyond the paper", paper: None, questions: rest });
    sections.retain(|section| !section.questions.is_empty());
    sections
}
