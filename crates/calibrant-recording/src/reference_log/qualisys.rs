//! Qualisys Track Manager's export of rigid bodies, `…_6D.tsv`.
//!
//! ```text
//! NO_OF_FRAMES  22245
//! …
//! DATA_INCLUDED  6D
//! BODY_NAMES  one  other
//! Frame  Time  one X  Y  Z  Roll  Pitch  Yaw  Residual  Rot[0]  …  Rot[8]  other X  …
//! ```
//! Lengths are in mm, angles in degrees. The matrix stands column by column: in published files, `Rot[1]` has the sign of a turn about z, and roll, pitch and yaw about the
//! axes of the body (docs.qualisys.com, "Rotation angles in QTM") make the same matrix. It is taken, since another definition of the angles can be set.

use super::format::ReferenceFormat;
use super::log_columns::{AngleUnit, LengthUnit};
use super::orientation_form::OrientationForm;
use super::tracker_export::{Body, Export, Form, cells, named_after};
use crate::text::delimited::{Delimiter, Lines};

const TAB: Delimiter = Delimiter::Character(b'\t');
/// Lines that are looked at for the header.
const MOST: usize = 200;
const MATRIX: [&str; 9] =
    ["Rot[0]", "Rot[1]", "Rot[2]", "Rot[3]", "Rot[4]", "Rot[5]", "Rot[6]", "Rot[7]", "Rot[8]"];
const ASKED: &str = "orientation_is = \"intrinsic-xyz\" in [machine.log.columns], where QTM's own roll, pitch and yaw were exported; or export the matrix, too";

/// Such an export; `None` where the text is none.
pub(super) fn find(text: &str) -> Option<Export<'_>> {
    let mut rest = Lines::of(text);
    let (mut is_6d, mut rate_hz) = (false, None);
    if !["NO_OF_FRAMES\t", "FILE_VERSION\t"].iter().any(|first| text.starts_with(first)) {
        return None;
    }
    let header = rest.by_ref().take(MOST).find(|line| {
        let cells = cells(*line, TAB);
        is_6d |= cells == ["DATA_INCLUDED", "6D"];
        if let ["FREQUENCY", rate] = cells[..] {
            rate_hz = rate.parse().ok().filter(|rate: &f64| *rate > 0.0);
        }
        ["Frame", "Time"].contains(&cells.first().copied().unwrap_or_default())
    })?;
    let cells = cells(header, TAB);
    let time = match cells.iter().position(|cell| *cell == "Time") {
        Some(time) => (time, None),
        None => (0, Some(rate_hz?)),
    };
    let starts: Vec<usize> = (0..cells.len()).filter(|&k| cells[k].ends_with(" X")).collect();
    let is_matrix = cells.contains(&"Rot[0]");
    let body = |(k, &start): (usize, &usize)| {
        let until = starts.get(k + 1).copied().unwrap_or(cells.len());
        let names: &[&str] = if is_matrix { &MATRIX } else { &["Roll", "Pitch", "Yaw"] };
        Body {
            name: cells[start].trim_end_matches(" X").to_owned(),
            position: (start..start + 3).collect(),
            orientation: named_after(&cells, names, start, until).unwrap_or_default(),
        }
    };
    Some(Export {
        format: ReferenceFormat::Qualisys,
        bodies: starts.iter().enumerate().map(body).collect(),
        form: if is_matrix { Form::Known(OrientationForm::MatrixColumns) } else { Form::Asked(ASKED) },
        length: LengthUnit::Mm,
        angle: AngleUnit::Deg,
        time,
        delimiter: TAB,
        header,
        rest,
    })
    .filter(|_| is_6d)
}

#[cfg(test)]
mod tests {
    use super::super::options::ReferenceLogOptions;
    use super::super::orientation_form::OrientationForm;
    use super::super::read::parse_reference_log;
    use super::super::recognise::has_log;

    /// The first rows of a published file, shortened.
    const FILE: &str = "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t4\nNO_OF_BODIES\t1\nFREQUENCY\t100\nDATA_INCLUDED\t6D\nBODY_NAMES\tPSVH\n\
        Frame\tTime\tPSVH X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\tRot[1]\tRot[2]\tRot[3]\tRot[4]\tRot[5]\tRot[6]\tRot[7]\tRot[8]\t\n\
        1\t0.00000\t-194.91974\t2.24150\t0.99661\t-0.65630\t0.09391\t0.05772\t4.98536\t1.00000\t0.00099\t-0.00165\t-0.00101\t0.99993\t-0.01145\t0.00164\t0.01145\t0.99993\t\n\
        2\t0.01000\t-195.64748\t1.62077\t0.72224\t-0.78772\t0.05832\t0.12055\t4.77517\t1.00000\t0.00209\t-0.00105\t-0.00210\t0.99990\t-0.01375\t0.00102\t0.01375\t0.99990\t\n\
        3\t0.02000\t0\t0\t0\t0\t0\t0\t-1\t0\t0\t0\t0\t0\t0\t0\t0\t0\t\n";

    #[test]
    fn the_matrix_of_qualisys_is_that_of_its_angles() {
        let file = parse_reference_log(FILE.as_bytes(), &ReferenceLogOptions::default()).expect("read");
        let log = file.poses().expect("poses");
        assert_eq!((file.format.name(), log.times_s.as_slice()), ("qualisys", &[0.0, 0.01, 0.02][..]));
        assert_eq!(log.positions_m[0].map(|at| at.x), Some(-194.91974e-3));
        let form = OrientationForm::parse("intrinsic-xyz").expect("known");
        let (angles, _) = form
            .orientation(&[-0.78772, 0.05832, 0.12055].map(f64::to_radians))
            .expect("right")
            .expect("seen");
        assert!(log.world_from_body[1].expect("seen").angle_to(&angles) < 2e-5);
        assert_eq!((log.positions_m[2], log.world_from_body[2]), (None, None));
        assert!(has_log(FILE, &ReferenceLogOptions::default()));
    }

    #[test]
    fn angles_alone_are_asked_for() {
        let cut = |line: &str| line.split('\t').take(9).collect::<Vec<_>>().join("\t") + "\n";
        let text: String = FILE.lines().map(cut).collect();
        let refused =
            parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect_err("which?");
        assert!(refused.to_string().contains("line 7: the file does not say"), "{refused}");
        let mut options = ReferenceLogOptions::default();
        options.columns.orientation_is = OrientationForm::parse("intrinsic-xyz");
        let file = parse_reference_log(text.as_bytes(), &options).expect("said");
        let angle = file.poses().expect("poses").world_from_body[0].expect("seen").angle();
        assert!((angle.to_degrees() - 0.6655).abs() < 1e-3, "{angle}");
    }
}
