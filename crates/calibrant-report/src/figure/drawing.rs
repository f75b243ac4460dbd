//! Parts of the drawings and legends that figures make by themselves.

use crate::html::escape;

/// Fonts of the letters, the first available one.
pub(super) const FONT: &str = "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', Arial, sans-serif";

/// The beginning of a drawing with this view box, named for screen readers, with further attributes, each after a space.
pub(super) fn opened([left, top, width, height]: [f64; 4], name: &str, attributes: &str) -> String {
    format!(
        "<svg viewBox=\"{left} {top} {width} {height}\" role=\"img\" aria-label=\"{}\" font-family=\"{FONT}\"{attributes}>",
        escape(name)
    )
}

/// A line of a legend: its sign, as drawn on 34 × 14 units, and its label.
fn entry(sign: &str, label: &str) -> String {
    let svg = "<svg viewBox=\"0 0 34 14\" aria-hidden=\"true\" fill=\"none\">";
    format!("<li>{svg}{sign}</svg>{}</li>", escape(label))
}

/// The sign of a filled area in a legend.
pub(super) fn filled(colour: &str) -> String {
    format!("<rect width=\"34\" height=\"14\" fill=\"{colour}\"/>")
}

/// A legend of these signs with their labels; nothing for none.
pub(super) fn legend(signs: &[(String, String)]) -> String {
    let entries: String = signs.iter().map(|(sign, label)| entry(sign, label)).collect();
    if entries.is_empty() { entries } else { format!("<ul class=\"legend\">{entries}</ul>") }
}

/// A path that is not filled.
pub(super) fn stroke(path: &str, colour: &str, width: f64) -> String {
    format!("<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>")
}
