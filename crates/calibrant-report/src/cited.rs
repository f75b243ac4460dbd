//! What pages say of the thesis (`vamvaka2021`) where they are of other experiments: nothing.

/// HTML whose texts name no figure of the thesis, and without the sentences about it.
pub(crate) fn without_thesis(html: &str) -> String {
    let of_piece = |piece: &str| match piece.split_once('>') {
        Some((tag, text)) if text.contains("thesis") => format!("{tag}>{}", of_text(text)),
        _ => piece.to_owned(),
    };
    html.split('<').map(of_piece).collect::<Vec<_>>().join("<")
}

fn of_text(text: &str) -> String {
    const OF_THESIS: &str = " of the thesis";
    let text = match text.split_once(&format!("{OF_THESIS}: ")) {
        Some((_, title)) => crate::number_format::capitalised(title),
        None => text.to_owned(),
    };
    let title = text.split_once(OF_THESIS).filter(|(before, _)| !before.contains(". "));
    if let Some((title, _)) = title.and_then(|(before, _)| before.rsplit_once([',', '('])) {
        return title.trim_end().to_owned();
    }
    let sentences = text.split_inclusive(". ").filter(|sentence| !sentence.contains("thesis"));
    sentences.collect::<String>().trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_and_sentences_name_no_thesis() {
        for (html, expected) in [
            ("<h3>Figure 8 of the thesis: initial jerk</h3>", "<h3>Initial jerk</h3>"),
            ("<h3>States and inputs (Figure 5 of the thesis)</h3>", "<h3>States and inputs</h3>"),
            ("<h3>Jerk (a), as in Figure 8 of the thesis</h3>", "<h3>Jerk (a)</h3>"),
            ("<p>One. The thesis finds this too. Three.</p>", "<p>One. Three.</p>"),
            ("<p>Log axes. The axes of the thesis are linear.</p>", "<p>Log axes.</p>"),
            ("<p>Figure 4 of a page</p>", "<p>Figure 4 of a page</p>"),
        ] {
            assert_eq!(without_thesis(html), expected);
        }
    }
}
