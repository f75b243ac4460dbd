//! Vicon's exports of segments (Nexus) and of objects (Tracker) as CSV.
//!
//! ```text
//! Objects
//! 100
//! ,,Global Angle one:one,,,,,,Global Angle other:other,,,,,
//! Frame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,…
//! ,,rad,rad,rad,mm,mm,mm,rad,…
//! ```
//! With `RW`, the orientation is a quaternion. Without it, the export was set to helical angles, a rotation vector, or to Euler angles, and the file does not say which.

use super::format::ReferenceFormat;
use super::log_columns::{AngleUnit, LengthUnit};
use super::orientation_form::OrientationForm;
use super::tracker_export::{Body, Export, Form, cells, named_after};
use crate::text::delimited::{Delimiter, Lines};

const COMMA: Delimiter = Delimiter::Character(b',');
const ASKED: &str = "orientation_is = \"rotation-vector\" in [machine.log.columns], where helical angles were exported; \"intrinsic-xyz\" where Euler angles were; \
    or export quaternions, where Vicon's program can";

/// Such an export; `None` where the text is none.
pub(super) fn find(text: &str) -> Option<Export<'_>> {
    let mut rest = Lines::of(text);
    let mut next = || rest.next();
    if !matches!(cells(next()?, COMMA)[..], ["Objects" | "Segments"]) {
        return None;
    }
    let [rate] = cells(next()?, COMMA)[..] else { return None };
    let rate_hz = rate.parse().ok().filter(|rate: &f64| *rate > 0.0)?;
    let (names, header, units) = (cells(next()?, COMMA), next()?, next()?);
    let (columns, units) = (cells(header, COMMA), cells(units, COMMA));
    if columns.first() != Some(&"Frame") {
        return None;
    }
    let starts: Vec<usize> = (0..columns.len()).filter(|&k| columns[k] == "RX").collect();
    let is_quaternion = columns.contains(&"RW");
    let rotation: &[&str] = if is_quaternion { &["RX", "RY", "RZ", "RW"] } else { &["RX", "RY", "RZ"] };
    let mut bodies = Vec::new();
    for (k, &start) in starts.iter().enumerate() {
        let until = starts.get(k + 1).copied().unwrap_or(columns.len());
        let name = names.get(start).copied().unwrap_or_default();
        let name = name.strip_prefix("Global Angle ").unwrap_or(name).to_owned();
        bodies.push(Body {
            name: if name.is_empty() { format!("{}", k + 1) } else { name },
            position: named_after(&columns, &["TX", "TY", "TZ"], start, until)?,
            orientation: named_after(&columns, rotation, start, until)?,
        });
    }
    let first = bodies.first()?;
    let unit = |column: usize| units.get(column).copied().unwrap_or_default();
    Some(Export {
        format: ReferenceFormat::Vicon,
        form: match is_quaternion {
            true => Form::Known(OrientationForm::QuaternionXyzw),
            false => Form::Asked(ASKED),
        },
        length: LengthUnit::parse(unit(first.position[0]))?,
        angle: AngleUnit::parse(unit(first.orientation[0])).unwrap_or(AngleUnit::Rad),
        bodies,
        time: (0, Some(rate_hz)),
        delimiter: COMMA,
        header,
        rest,
    })
}

#[cfg(test)]
mod tests {
    use super::super::options::ReferenceLogOptions;
    use super::super::orientation_form::OrientationForm;
    use super::super::read::parse_reference_log;
    use super::super::recognise::has_log;

    const FILE: &str = "Objects\n200\n,,Global Angle wand:wand,,,,,,Global Angle box:box,,,,,\nFrame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,RY,RZ,TX,TY,TZ\n\
        ,,deg,deg,deg,mm,mm,mm,deg,deg,deg,mm,mm,mm\n\
        1,0,0,0,90,100,200,300,1,2,3,4,5,6\n2,0,0,0,91,101,200,300,1,2,3,4,5,6\n3,0,,,,,,,1,2,3,4,5,6\n";

    #[test]
    fn one_body_and_what_its_angles_are_have_to_be_said() {
        let read = |options: &ReferenceLogOptions| parse_reference_log(FILE.as_bytes(), options);
        let mut options = ReferenceLogOptions::default();
        assert!(has_log(FILE, &options), "it asks, and not the reader of recordings");
        let refused = read(&options).expect_err("two").to_string();
        assert!(refused.contains("more than one body: `wand:wand`, `box:box`"), "{refused}");
        options.topic = Some("wand:wand".into());
        let refused = read(&options).expect_err("which angles?").to_string();
        assert!(refused.contains("orientation_is = \"rotation-vector\""), "{refused}");
        options.columns.orientation_is = Some(OrientationForm::RotationVector);
        let file = read(&options).expect("read");
        let log = file.poses().expect("poses");
        assert_eq!((file.format.name(), log.times_s.as_slice()), ("vicon", &[0.005, 0.01, 0.015][..]));
        assert_eq!(log.positions_m[0].map(|at| [at.x, at.y, at.z]), Some([0.1, 0.2, 0.3]));
        let turn = log.world_from_body[1].expect("seen").scaled_axis();
        assert!((turn.z.to_degrees() - 91.0).abs() < 1e-9 && log.world_from_body[2].is_none());
        options.topic = Some("cup".into());
        assert!(read(&options).expect_err("none").to_string().contains("no body `cup`"));
    }

    #[test]
    fn quaternions_need_no_answer() {
        let text = "Segments\n100\n,,a:b,,,,,,\nFrame,Sub Frame,RX,RY,RZ,RW,TX,TY,TZ\n,,,,,,mm,mm,mm\n1,0,0.6,0,0,0.8,1,2,3\n2,0,0.6,0,0,0.8,1,2,4\n";
        let file = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect("read");
        let turn = file.poses().expect("poses").world_from_body[0].expect("seen");
        assert!((turn.w - 0.8).abs() < 1e-12 && (turn.i - 0.6).abs() < 1e-12);
    }
}
