//! The papers that a page names, in full: the page itself names them by author and year.

use super::markup::element;

/// How a paper is cited, and what it is, as far as its text states it. Who adds one adds it to the front page of the crate
/// `orientation`, too.
const PAPERS: [[&str; 2]; 5] = [
    [
        "Burov",
        "D. A. Burov, E. I. Verzunov: Creation of Orientation Systems for Mobile Robots; its text states no year",
    ],
    [
        "MET 2018",
        "A study of azimuth errors in the dynamic scheme of north finding by a molecular-electronic (MET) angular motion \
         sensor; the text that was at hand states neither authors nor title",
    ],
    [
        "Nekrasova 2017",
        "M. Nekrasova, V. Uspenskiy: Improving the Accuracy of Determining Orientation of a Rapidly Rotating Object",
    ],
    [
        "Sokolov 2019",
        "S. Sokolov, A. Novikov, V. Ivetić: Determining the Initial Orientation for Navigation and Measurement Systems of \
         Mobile Apparatus in Reforestation, 2019",
    ],
    [
        "Szymanowski 2003",
        "J. Szymanowski, J. Grzelak, S. Popowski: Static Initial Azimuth Update Method in Land Navigation Systems, Annual \
         of Navigation 6/2003",
    ],
];

/// The papers that these parts of a page name; nothing where they name none.
pub(super) fn papers(page: &str) -> String {
    let is_named = |[cited, _]: &&[&str; 2]| page.contains(cited);
    let paper = |[cited, full]: &[&str; 2]| element("p", &format!("{cited}: {full}"));
    let all: String = PAPERS.iter().filter(is_named).map(paper).collect();
    if all.is_empty() {
        return all;
    }
    format!("<section>\n<h2>Papers</h2>\n{all}</section>\n")
}
