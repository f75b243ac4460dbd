//! Correlations of the estimates as a map with the numbers in it.
//!
//! A table rather than a plot: its letters keep their size on a phone, and its numbers can be read aloud and copied.

use crate::html::escape;
use crate::number_format::{UNKNOWN, fixed};
use nalgebra::DMatrix;

/// Beyond this number of parameters, columns bear numbers in place of names.
const NARROW: usize = 14;

/// The correlations of a covariance of parameters of these names: their lower triangle, coloured by sign and size. Many of them are numbered, so that the
/// map stays narrow.
pub(crate) fn correlation_map<'a>(
    names: impl IntoIterator<Item = &'a str>,
    covariance: &DMatrix<f64>,
) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let names = names.as_slice();
    let sd = covariance.diagonal().map(f64::sqrt);
    let numbered = names.len() > NARROW;
    let mut rows = String::new();
    for (i, name) in names.iter().enumerate() {
        let number = if numbered { format!("<b>{}</b>", i + 1) } else { String::new() };
        rows.push_str(&format!("<tr><th scope=\"row\">{}{number}</th>", escape(name)));
        for j in 0..=i {
            rows.push_str(&cell(covariance[(i, j)] / (sd[i] * sd[j]), i == j, numbered));
        }
        rows.push_str("</tr>\n");
    }
    let shared = shared_sensor(names).len();
    let column = |(i, name): (usize, &&str)| match numbered {
        true => format!("<th scope=\"col\" title=\"{}\">{}</th>", escape(name), i + 1),
        false => format!("<th scope=\"col\">{}</th>", escape(&name[shared..]).replacen('.', ".<br>", 1)),
    };
    let head: String = names.iter().enumerate().map(column).collect();
    let class = if numbered { "heat narrow" } else { "heat" };
    let map = format!(
        "<div class=\"scroll\"><table class=\"{class}\"><tbody>\n{rows}</tbody><tfoot><tr><td></td>{head}</tr></tfoot></table></div>"
    );
    let stops: Vec<String> = (-4..=4).map(|i| colour(f64::from(i) / 4.0)).collect();
    let scale = format!(
        "<div class=\"scale\">−1 <span class=\"bar\" style=\"background:linear-gradient(90deg,{})\"></span> +1</div>",
        stops.join(",")
    );
    let mut caption =
        "Good: small numbers off the diagonal. Near ±1 the data hardly separate two parameters: only their sum or \
                   difference is well known. A different motion or more orientations would help. Estimates of different \
                   axes are independent unless the model couples them."
            .to_string();
    if numbered {
        caption.push_str(" Numbers below 0.1 are not shown. Columns have the numbers of the rows.");
    }
    format!(
        "<figure><h3>Correlation of the estimates</h3>{scale}{map}<figcaption>{}</figcaption></figure>",
        escape(&caption)
    )
}

/// The name of the sensor that all parameters begin with, with its point: columns without it stay narrow.
fn shared_sensor<'a>(names: &[&'a str]) -> &'a str {
    let first = names.first().and_then(|name| name.split_inclusive('.').next()).unwrap_or("");
    if names.iter().all(|name| name.starts_with(first) && name.len() > first.len()) { first } else { "" }
}

fn cell(r: f64, diagonal: bool, short: bool) -> String {
    if !r.is_finite() {
        return format!("<td>{}</td>", UNKNOWN);
    }
    if diagonal {
        return "<td style=\"background:#e8ebee\">1</td>".to_string();
    }
    let text = match fixed(r, if short { 1 } else { 2 }) {
        text if short && r.abs() < 0.95 => text.replacen("0.", ".", 1),
        text => text,
    };
    let text = if short && r.abs() < 0.1 { String::new() } else { text };
    let ink = if r.abs() > 0.72 { "#fff" } else { "#1b1f24" };
    format!("<td style=\"background:{};color:{ink}\">{text}</td>", colour(r))
}

/// From blue over white to vermillion, for −1 to 1.
fn colour(r: f64) -> String {
    let end = if r < 0.0 { [0.0, 94.0, 150.0] } else { [190.0, 80.0, 0.0] };
    let share = r.abs().min(1.0);
    let [red, green, blue] = end.map(|channel| (255.0 + (channel - 255.0) * share).round());
    format!("rgb({red},{green},{blue})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_leave_out_the_sensor_that_all_rows_name() {
        let map = correlation_map(["gyroscope.bias.x", "gyroscope.scale.x"], &DMatrix::identity(2, 2));
        assert!(map.contains("<th scope=\"col\">bias.<br>x</th><th scope=\"col\">scale.<br>x</th>"), "{map}");
        assert!(map.contains("<th scope=\"row\">gyroscope.bias.x</th>"));
        let map = correlation_map(["bias.x", "scale.x"], &DMatrix::identity(2, 2));
        assert!(map.contains("<th scope=\"col\">bias.<br>x</th>"), "{map}");
        assert_eq!(shared_sensor(&["g"]), "");
    }
}
