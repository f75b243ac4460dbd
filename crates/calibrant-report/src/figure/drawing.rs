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
pub(super) fn entry(sign: &str, label: &str) -> String {
    let svg = "<svg viewBox=\"0 0 34 14\" aria-hidden=\"true\" fill=\"none\">";
    format!("<li>{svg}{sign}</svg>{}</li>", escape(label))
}

/// The sign of a filled area in a legend.
pub(super) fn filled(colour: &str) -> String {
    format!("<rect width=\"34\" height=\"14\" fill=\"{colour}\"/>")
}

/// A legend of these lines; nothing for none.
pub(super) fn legend(entries: &[String]) -> String {
    if entries.is_empty() { String::new() } else { format!("<ul class=\"legend\">{}</ul>", entries.concat()) }
}

/// A path that is not filled.
pub(super) fn stroke(path: &str, colour: &str, width: f64) -> String {
    format!("<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>")
}

/// A part of a bar: its share of the whole width, its colour, the colour of letters on it, a title that names it, and the text in it.
pub(super) struct Part {
    pub(super) share: f64,
    pub(super) colour: &'static str,
    pub(super) ink: &'static str,
    pub(super) title: String,
    pub(super) text: String,
}

/// Bars of several parts in a table, each with its name and a number. A table rather than a plot: its letters keep their size on a phone. The caption is HTML.
pub(super) fn bars(
    title: &str,
    legend: &[String],
    rows: impl IntoIterator<Item = (String, String, Vec<Part>)>,
    caption: &str,
) -> String {
    let part = |part: &Part| {
        format!(
            "<span style=\"width:{:.2}%;background:{};color:{}\" title=\"{}\">{}</span>",
            100.0 * part.share,
            part.colour,
            part.ink,
            escape(&part.title),
            escape(&part.text)
        )
    };
    let row = |(name, number, parts): (String, String, Vec<Part>)| {
        let parts: String = parts.iter().map(part).collect();
        let (name, number) = (escape(&name), escape(&number));
        format!(
            "<tr><th scope=\"row\">{name}</th><td class=\"n\">{number}</td><td><div class=\"stack\">{parts}</div></td></tr>\n"
        )
    };
    let rows: String = rows.into_iter().map(row).collect();
    format!(
        "<figure><h3>{}</h3>{}<table class=\"budget\"><tbody>\n{rows}</tbody></table><figcaption>{caption}</figcaption></figure>",
        escape(title),
        self::legend(legend)
    )
}
