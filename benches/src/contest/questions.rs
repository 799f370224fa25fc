//! All questions, in the order of the report.

use super::{
    Contest, acos, drawn, evaluation, interpolation, large, representations, rgl, sampling, search, spectral, threads,
};
use crate::workload::Input;

/// A question that a contest answers.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    /// Short name, as in `report.json`.
    pub id: &'static str,
    /// A short description of what is timed.
    pub title: &'static str,
    /// The unit of one answer, as in "nanoseconds per search".
    pub unit: &'static str,
    /// The least number of queries per run, for effects that only appear in long runs.
    pub least: usize,
    build: fn(Input, usize) -> Contest,
}

/// All questions, in the order of the report.
pub const QUESTIONS: [Question; 43] = [
    Question { id: "acos", title: "Arc cosine, eight terms", unit: "value", least: 1, build: acos::eight_terms },
    Question {
        id: "acos-paper",
        title: "Arc cosine, the paper's four terms",
        unit: "value",
        least: 1,
        build: acos::four_terms,
    },
    Question {
        id: "search",
        title: "Interval search among 17 knots",
        unit: "search",
        least: 1,
        build: search::library,
    },
    Question {
        id: "search-paper",
        title: "The paper's stack search, 17 knots",
        unit: "search",
        least: 1,
        build: search::paper,
    },
    Question { id: "iso", title: "Isotropic table, batch", unit: "evaluation", least: 1, build: evaluation::iso },
    Question {
        id: "iso-single",
        title: "Isotropic table, one query per call",
        unit: "evaluation",
        least: 1,
        build: evaluation::iso_single,
    },
    Question {
        id: "iso-paper",
        title: "Isotropic table, the paper's kernel",
        unit: "evaluation",
        least: 1,
        build: evaluation::iso_paper,
    },
    Question { id: "aniso", title: "Anisotropic table, batch", unit: "evaluation", least: 1, build: evaluation::aniso },
    Question {
        id: "aniso-single",
        title: "Anisotropic table, one query per call",
        unit: "evaluation",
        least: 1,
        build: evaluation::aniso_single,
    },
    Question {
        id: "aniso-paper",
        title: "Anisotropic table, the paper's kernel",
        unit: "evaluation",
        least: 1,
        build: evaluation::aniso_paper,
    },
    Question {
        id: "search-33",
        title: "Interval search among 33 knots",
        unit: "search",
        least: 1,
        build: search::among_33,
    },
    Question {
        id: "search-65",
        title: "Interval search among 65 knots",
        unit: "search",
        least: 1,
        build: search::among_65,
    },
    Question {
        id: "iso-interpolation",
        title: "Isotropic table at known angles",
        unit: "point",
        least: 1,
        build: interpolation::iso,
    },
    Question {
        id: "aniso-interpolation",
        title: "Anisotropic table at known angles",
        unit: "point",
        least: 1,
        build: interpolation::aniso,
    },
    Question {
        id: "iso-strict",
        title: "Isotropic table, the same bits on every machine",
        unit: "evaluation",
        least: 1,
        build: evaluation::iso_strict,
    },
    Question {
        id: "spectral-31",
        title: "Isotropic table of 31 wavelengths",
        unit: "evaluation",
        least: 1,
        build: spectral::visible,
    },
    Question {
        id: "spectral-195",
        title: "Isotropic table of 195 wavelengths",
        unit: "evaluation",
        least: 1,
        build: spectral::full,
    },
    Question { id: "large", title: "Isotropic table of 17 MB", unit: "evaluation", least: 1 << 16, build: large::iso },
    Question {
        id: "large-aniso",
        title: "Anisotropic table of 67 MB",
        unit: "evaluation",
        least: 1 << 16,
        build: large::aniso,
    },
    Question { id: "rgl-eval", title: "EPFL material, values", unit: "evaluation", least: 1, build: rgl::eval },
    Question { id: "rgl-pdf", title: "EPFL material, densities", unit: "density", least: 1, build: rgl::pdf },
    Question {
        id: "rgl-sample",
        title: "EPFL material, samples with their weights",
        unit: "sample",
        least: 1,
        build: rgl::sample,
    },
    Question {
        id: "half-diff",
        title: "Half-difference grid, nearest bin",
        unit: "evaluation",
        least: 1,
        build: representations::half_difference,
    },
    Question {
        id: "half-diff-linear",
        title: "Half-difference grid, interpolated",
        unit: "evaluation",
        least: 1,
        build: representations::half_difference_linear,
    },
    Question {
        id: "spherical",
        title: "Grid of spherical coordinates",
        unit: "evaluation",
        least: 1,
        build: representations::spherical,
    },
    Question {
        id: "scattered",
        title: "Scattered samples",
        unit: "evaluation",
        least: 1,
        build: representations::scattered,
    },
    Question { id: "utia", title: "UTIA grid", unit: "evaluation", least: 1, build: representations::utia },
    Question { id: "klems", title: "Klems matrices", unit: "evaluation", least: 1, build: representations::klems },
    Question {
        id: "tensor-tree",
        title: "Tensor trees",
        unit: "evaluation",
        least: 1,
        build: representations::tensor_tree,
    },
    Question {
        id: "mueller",
        title: "Mueller matrices, five wavelengths",
        unit: "evaluation",
        least: 1,
        build: representations::mueller,
    },
    Question {
        id: "mueller-matrices",
        title: "Whole Mueller matrices, four wavelengths",
        unit: "evaluation",
        least: 1,
        build: representations::matrices,
    },
    Question {
        id: "polarised-matrices",
        title: "Whole Mueller matrices in specular coordinates, four wavelengths",
        unit: "evaluation",
        least: 1,
        build: representations::polarised,
    },
    Question {
        id: "iso-sample",
        title: "Isotropic table, samples with their weights",
        unit: "sample",
        least: 1,
        build: sampling::iso,
    },
    Question {
        id: "aniso-sample",
        title: "Anisotropic table, samples with their weights",
        unit: "sample",
        least: 1,
        build: sampling::aniso,
    },
    Question {
        id: "spherical-sample",
        title: "Grid of spherical coordinates, samples with their weights",
        unit: "sample",
        least: 1,
        build: drawn::spherical,
    },
    Question {
        id: "scattered-sample",
        title: "Scattered samples, directions with their weights",
        unit: "sample",
        least: 1,
        build: drawn::scattered,
    },
    Question {
        id: "klems-sample",
        title: "Klems matrices, samples with their weights",
        unit: "sample",
        least: 1,
        build: drawn::klems,
    },
    Question {
        id: "tensor-tree-sample",
        title: "Tensor trees, samples with their weights",
        unit: "sample",
        least: 1,
        build: drawn::tensor_tree,
    },
    Question {
        id: "half-diff-sample",
        title: "Half-difference grid, samples with their weights",
        unit: "sample",
        least: 1,
        build: drawn::half_difference,
    },
    Question {
        id: "mueller-sample",
        title: "Mueller matrices, samples with their weights",
        unit: "sample",
        least: 1,
        build: drawn::mueller,
    },
    Question {
        id: "pages",
        title: "Isotropic table, a batch of a million on huge and on small pages",
        unit: "evaluation",
        least: 1 << 20,
        build: threads::pages,
    },
    Question {
        id: "pages-4m",
        title: "Isotropic table, a batch of four million on huge and on small pages",
        unit: "evaluation",
        least: 1 << 22,
        build: threads::pages,
    },
    Question {
        id: "threads",
        title: "Isotropic table, a batch of a million",
        unit: "evaluation",
        least: 1 << 20,
        build: threads::iso,
    },
];

impl Question {
    /// The question with this id.
    pub fn named(id: &str) -> Option<Self> {
        QUESTIONS.into_iter().find(|question| question.id == id)
    }

    /// Prepares the contest on `count` queries, or on [`least`](Self::least) if that is more.
    pub fn contest(&self, input: Input, count: usize) -> Contest {
        (self.build)(input, count.max(self.least))
    }
}
