//! Bars of several parts, each with its name and a number.

use super::drawing::legend;
use super::files::{Drawable, FigureFiles, quoted, standalone};
use crate::html::escape;
use std::fmt::Write;

/// Width of the names, of the numbers and of the bars of a drawing, and the height of one.
const NAMES: f64 = 210.0;
const NUMBERS: f64 = 150.0;
const WIDTH: f64 = 400.0;
const LINE: f64 = 20.0;

/// A part of a bar: its share of the whole width, its colour, the colour of letters on it, a title that names it, and the text in it.
pub(super) struct Part {
    pub(super) share: f64,
    pub(super) colour: &'static str,
    pub(super) ink: &'static str,
    pub(super) title: String,
    pub(super) text: String,
}

/// Bars below each other. On a page they are a table rather than a plot: its letters keep their size on a phone.
pub(crate) struct Bars {
    pub(super) title: &'static str,
    /// Signs with their labels.
    pub(super) legend: Vec<(String, String)>,
    /// Name, number and parts.
    pub(super) rows: Vec<(String, String, Vec<Part>)>,
    /// HTML.
    pub(super) caption: &'static str,
}

impl Drawable for Bars {
    fn html(&self) -> String {
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
        let row = |(name, number, parts): &(String, String, Vec<Part>)| {
            let parts: String = parts.iter().map(part).collect();
            let (name, number) = (escape(name), escape(number));
            format!(
                "<tr><th scope=\"row\">{name}</th><td class=\"n\">{number}</td><td><div class=\"stack\">{parts}</div></td></tr>\n"
            )
        };
        let rows: String = self.rows.iter().map(row).collect();
        format!(
            "<figure><h3>{}</h3>{}<table class=\"budget\"><tbody>\n{rows}</tbody></table><figcaption>{}</figcaption></figure>",
            escape(self.title),
            legend(&self.legend),
            self.caption
        )
    }

    fn files(&self) -> FigureFiles {
        let (mut drawn, mut csv) = (String::new(), "name,number,part,share\n".to_owned());
        for (line, (name, number, parts)) in self.rows.iter().enumerate() {
            let (top, mut left) = (LINE * line as f64, NAMES + NUMBERS);
            let text = |x: f64, anchor: &str, text: &str| {
                format!(
                    "<text x=\"{x:.1}\" y=\"{}\" font-size=\"12\" text-anchor=\"{anchor}\">{}</text>",
                    top + 14.0,
                    escape(text)
                )
            };
            drawn += &(text(10.0, "start", name) + &text(left - 10.0, "end", number));
            for part in parts {
                let wide = WIDTH * part.share;
                let _ = write!(
                    drawn,
                    "<rect x=\"{left:.1}\" y=\"{}\" width=\"{wide:.1}\" height=\"15\" fill=\"{}\"/>",
                    top + 2.0,
                    part.colour
                );
                let inside = text(left + 0.5 * wide, "middle", &part.text);
                drawn += &inside.replacen("<text", &format!("<text fill=\"{}\"", part.ink), 1);
                left += wide;
                let _ = writeln!(
                    csv,
                    "{},{},{},{}",
                    quoted(name),
                    quoted(number),
                    quoted(&part.title),
                    part.share
                );
            }
        }
        let size = [NAMES + NUMBERS + WIDTH + 10.0, LINE * self.rows.len() as f64 + 8.0];
        let drawing = format!("<svg>{drawn}</svg>");
        let svg = standalone(self.title, &[(drawing, size)], &self.legend, 1);
        FigureFiles { title: self.title.to_owned(), svg, csv }
    }
}
