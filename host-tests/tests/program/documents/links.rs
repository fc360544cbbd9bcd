//! What the pages refer to is there.

use std::path::Path;

use super::{page, place};

/// The pages, by their paths from the top.
const PAGES: [&str; 11] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/ten-minutes.md",
    "firmware/README.md",
    "firmware/BUDGET.md",
    "firmware/emulated-board/README.md",
    "firmware/protocol/README.md",
    "host-tests/README.md",
    "host-tests/ACCURACY.md",
    "host-tests/data/README.md",
    "host-tests/src/campaign/disturbed/README.md",
];

/// The anchor of a heading, as pages are shown: small letters, hyphens for blanks, no other marks.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

/// The targets of the links of a page within the project, pictures left out.
fn targets(text: &str) -> impl Iterator<Item = &str> {
    let links = text.match_indices("](").map(|(at, _)| &text[at + 2..]);
    let targets = links.filter_map(|behind| behind.split(')').next());
    let is_picture = |target: &str| Path::new(target).extension().is_some_and(|it| it == "png");
    targets.filter(move |target| !target.starts_with("http") && !is_picture(target))
}

#[test]
fn every_link_of_every_page_leads_to_a_file_and_a_heading() {
    for name in PAGES {
        let text = page(name);
        for target in targets(&text) {
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            let folder = place(name).parent().expect("a page is in a folder").to_owned();
            let path = if file.is_empty() { place(name) } else { folder.join(file) };
            assert!(path.exists(), "{name}: {target}");
            if heading.is_empty() {
                continue;
            }
            let there = std::fs::read_to_string(&path).expect("a page can be read");
            let mut anchors = there
                .lines()
                .filter(|line| line.starts_with('#'))
                .map(|line| anchor(line.trim_start_matches('#').trim()));
            assert!(anchors.any(|anchor| anchor == heading), "{name}: {target}");
        }
    }
}
