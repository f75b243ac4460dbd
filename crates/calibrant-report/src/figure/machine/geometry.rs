//! Corrections of the machine, in what was expected of them, as bars in a table.

use crate::figure::colour;
use crate::html::escape;
use crate::number_format::{UNKNOWN, fixed, signed, tick};

/// Smallest end of the bars' scale, prior standard deviations.
const LEAST_END: f64 = 3.0;

/// A correction and its sd, both in prior standard deviations; `None` where it was held.
pub(crate) type Correction = Option<(f64, f64)>;

/// One row for each joint, one column for each correction.
pub(crate) fn correction_bars(columns: &[&str], joints: &[(String, Vec<Correction>)]) -> String {
    let sizes = joints.iter().flat_map(|(_, row)| row.iter().flatten()).map(|(value, _)| value.abs());
    let end = sizes.filter(|size| size.is_finite()).fold(LEAST_END, f64::max);
    let head: String =
        columns.iter().map(|name| format!("<th scope=\"col\">{}</th>", escape(name))).collect();
    let rows: String = joints
        .iter()
        .map(|(joint, row)| {
            let cells: String = row.iter().map(|correction| cell(*correction, end)).collect();
            format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", escape(joint))
        })
        .collect();
    format!(
        "<figure><h3>Corrections in prior standard deviations</h3><div class=\"scroll\"><table class=\"corrections\"><thead><tr><td></td>{head}</tr></thead>\
         <tbody>\n{rows}</tbody></table></div><figcaption>Estimate ± sd, both over the prior sd. Bars run from −{0} to +{0}. Good: most between −2 and +2. \
         A larger one means that the machine is less exact than stated, or that the correction stands in for another error. An sd near 1 means that the data say \
         little about it.</figcaption></figure>",
        tick((10.0 * end).ceil() / 10.0)
    )
}

fn cell(correction: Correction, end: f64) -> String {
    let Some((value, sd)) = correction.filter(|(value, sd)| value.is_finite() && sd.is_finite()) else {
        return format!("<td>{}</td>", UNKNOWN);
    };
    let at = |value: f64| 50.0 + 48.0 * (value / end).clamp(-1.0, 1.0);
    let (from, to) = (at(value.min(0.0)), at(value.max(0.0)));
    let fill = if value.abs() > LEAST_END { colour::VERMILLION } else { colour::SKY };
    format!(
        "<td>{} ± {}<div class=\"bar\"><i style=\"left:{from:.1}%;width:{:.1}%;background:{fill}\"></i></div></td>",
        signed(value, 2),
        fixed(sd, 2),
        to - from
    )
}
