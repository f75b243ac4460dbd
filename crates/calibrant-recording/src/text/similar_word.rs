//! The word that somebody meant.

/// The word most like this one, if any is.
#[must_use]
pub fn nearest<'w>(unknown: &str, words: impl Iterator<Item = &'w str>) -> Option<&'w str> {
    const ALIKE: f64 = 0.75; // least Jaro–Winkler similarity: 1 is equal, 0 nothing in common
    let unknown = shorten(unknown).to_lowercase();
    words
        .map(|word| (strsim::jaro_winkler(&word.to_lowercase(), &unknown), word))
        .filter(|(alike, _)| *alike >= ALIKE)
        .max_by(|one, other| one.0.total_cmp(&other.0))
        .map(|(_, word)| word)
}

/// The beginning of a text that may be very long.
pub fn shorten(text: &str) -> String {
    /// Longest shortened text, characters.
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    text.chars().take(LONGEST).chain(['…']).collect()
}
