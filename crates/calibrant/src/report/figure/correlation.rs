//! Correlations of the estimates as a map with the numbers in it.
//!
//! A table rather than a plot: its letters keep their size on a phone, and its numbers can be read aloud and copied.

use crate::report::html::escape;
use crate::report::number;
use crate::sensor::Parameter;
use nalgebra::DMatrix;

/// The correlations of a covariance: their lower triangle, coloured by sign and size.
pub(in crate::report) fn correlation_map(parameters: &[Parameter], covariance: &DMatrix<f64>) -> String {
    let sd = covariance.diagonal().map(f64::sqrt);
    let names: Vec<String> = parameters.iter().map(|p| escape(&p.name).replacen('.', ".<br>", 1)).collect();
    let mut rows = String::new();
    for (i, name) in names.iter().enumerate() {
        rows.push_str(&format!("<tr><th scope=\"row\">{}</th>", name.replace("<br>", "")));
        for j in 0..=i {
            rows.push_str(&cell(covariance[(i, j)] / (sd[i] * sd[j]), i == j));
        }
        rows.push_str("</tr>\n");
    }
    let head: String = names.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let map = format!(
        "<div class=\"scroll\"><table class=\"heat\"><tbody>\n{rows}</tbody><tfoot><tr><td></td>{head}</tr></tfoot></table></div>"
    );
    let stops: Vec<String> = (-4..=4).map(|i| colour(f64::from(i) / 4.0)).collect();
    let scale = format!(
        "<div class=\"scale\">−1 <span class=\"bar\" style=\"background:linear-gradient(90deg,{})\"></span> +1</div>",
        stops.join(",")
    );
    let caption = "Good: small numbers off the diagonal. Near ±1 the data hardly tell two parameters apart: only their sum or \
                   difference is well known, and a different motion or more orientations would help. Estimates of different \
                   axes are independent where nothing couples them.";
    format!(
        "<figure><h3>Correlation of the estimates</h3>{scale}{map}<figcaption>{}</figcaption></figure>",
        escape(caption)
    )
}

fn cell(r: f64, diagonal: bool) -> String {
    if !r.is_finite() {
        return format!("<td>{}</td>", number::UNKNOWN);
    }
    if diagonal {
        return "<td style=\"background:#e8ebee\">1</td>".to_string();
    }
    let ink = if r.abs() > 0.72 { "#fff" } else { "#1b1f24" };
    format!("<td style=\"background:{};color:{ink}\">{}</td>", colour(r), number::fixed(r, 2))
}

/// From blue over white to vermillion, for −1 to 1.
fn colour(r: f64) -> String {
    let end = if r < 0.0 { [0.0, 94.0, 150.0] } else { [190.0, 80.0, 0.0] };
    let share = r.abs().min(1.0);
    let [red, green, blue] = end.map(|channel| (255.0 + (channel - 255.0) * share).round());
    format!("rgb({red},{green},{blue})")
}
