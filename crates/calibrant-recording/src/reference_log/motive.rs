//! Motive's (OptiTrack) export as CSV.
//!
//! ```text
//! Format Version,1.23,…,Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global
//!
//! ,Type,Rigid Body,Rigid Body,…,Rigid Body Marker,…
//! ,Name,one,one,…
//! ,ID,1,1,…
//! ,,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,…
//! Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,…
//! ```
//! Euler angles are in degrees, each about an axis of the body as the turns before left it (help.naturalpoint.com, "Changes in Motive's reported Euler angles"), in the
//! order that the rotation type names. Motive's world has y up, unless the export was set otherwise.

use super::format::ReferenceFormat;
use super::log_columns::{AngleUnit, LengthUnit};
use super::orientation_form::OrientationForm;
use super::tracker_export::{Body, Export, Form, cells};
use crate::text::delimited::{Delimiter, Lines};

const COMMA: Delimiter = Delimiter::Character(b',');
/// Lines of the head at most.
const MOST: usize = 12;
const ASKED: &str = "export with the rotation type Quaternion";

/// Such an export; `None` where the text is none.
pub(super) fn find(text: &str) -> Option<Export<'_>> {
    let mut rest = Lines::of(text);
    let first = cells(rest.next()?, COMMA);
    if first.first() != Some(&"Format Version") {
        return None;
    }
    let value =
        |key: &str| first.iter().position(|cell| *cell == key).and_then(|k| first.get(k + 1)).copied();
    let kinds = cells(
        rest.by_ref()
            .take(MOST)
            .find(|line| line.text.contains("Rigid Body") || line.text.contains("Bone"))?,
        COMMA,
    );
    let names = cells(rest.next()?, COMMA);
    let parts =
        cells(rest.by_ref().take(MOST).find(|line| cells(*line, COMMA).contains(&"Position"))?, COMMA);
    let header = rest.next()?;
    let axes = cells(header, COMMA);
    let rotation_type = value("Rotation Type").unwrap_or("Quaternion").to_lowercase();
    let (order, form) = match rotation_type.as_str() {
        "quaternion" => ("XYZW".to_owned(), Form::Known(OrientationForm::QuaternionXyzw)),
        order => match OrientationForm::parse(&format!("intrinsic-{order}")) {
            Some(form) => (order.to_uppercase(), Form::Known(form)),
            None => ("XYZ".to_owned(), Form::Asked(ASKED)),
        },
    };
    let is_body =
        |k: usize| kinds.get(k).is_some_and(|kind| ["Rigid Body", "Bone", "Rigid Body Bone"].contains(kind));
    let mut bodies: Vec<Body> = Vec::new();
    for (k, name) in names.iter().enumerate().filter(|(k, _)| is_body(*k)) {
        if bodies.last().is_some_and(|body| body.name == *name) {
            continue;
        }
        let column = |part: &str, axis: char| {
            let axis = axis.to_string();
            let is_it =
                |at: &usize| names[*at] == *name && is_body(*at) && axes.get(*at) == Some(&axis.as_str());
            (k..names.len()).find(|at| is_it(at) && parts.get(*at) == Some(&part))
        };
        let columns =
            |part: &str, order: &str| order.chars().map(|axis| column(part, axis)).collect::<Option<_>>();
        bodies.push(Body {
            name: (*name).to_owned(),
            position: columns("Position", "XYZ")?,
            orientation: columns("Rotation", &order).unwrap_or_default(),
        });
    }
    Some(Export {
        format: ReferenceFormat::Motive,
        bodies,
        form,
        // a file of version 1.0 does not say it: metres are supposed
        length: LengthUnit::parse(&value("Length Units").unwrap_or("Meters").to_lowercase())?,
        angle: AngleUnit::Deg,
        time: (1, None),
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

    const FILE: &str = "Format Version,1.23,Take Name,one,Export Frame Rate,100,Rotation Type,Quaternion,Length Units,Millimeters,Coordinate Space,Global\n\n\
        ,Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker\n\
        ,Name,imu,imu,imu,imu,imu,imu,imu,imu,imu:Marker1,imu:Marker1,imu:Marker1\n\
        ,ID,1,1,1,1,1,1,1,1,2,2,2\n\
        ,,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,Position,Position,Position\n\
        Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z\n\
        0,0.000000,0.6,0,0,0.8,100,200,300,0.1,7,8,9\n1,0.010000,0,0.6,0,0.8,101,200,300,0.1,7,8,9\n2,0.020000,,,,,,,,,7,8,9\n3,0.030000,0,0,0.6,0.8,102,200,300,0.1,7,8,9\n";

    #[test]
    fn the_rigid_body_of_motive_is_read_and_its_markers_are_not() {
        let file = parse_reference_log(FILE.as_bytes(), &ReferenceLogOptions::default()).expect("read");
        let log = file.poses().expect("poses");
        assert_eq!((file.format.name(), log.times_s.as_slice()), ("motive", &[0.0, 0.01, 0.02, 0.03][..]));
        assert_eq!(log.positions_m[0].map(|at| [at.x, at.y, at.z]), Some([0.1, 0.2, 0.3]));
        assert!((log.world_from_body[1].expect("seen").j - 0.6).abs() < 1e-12);
        assert_eq!((log.positions_m[2], log.world_from_body[2]), (None, None));
        // as of version 1.0, without names in the last line of the head
        let old = FILE
            .replace(",Type,", ",,")
            .replace(",Name,", ",,")
            .replace("Frame,Time (Seconds)", ",")
            .replace("Length Units,Millimeters,", "");
        let file = parse_reference_log(old.as_bytes(), &ReferenceLogOptions::default()).expect("read");
        assert_eq!(file.poses().expect("poses").positions_m[0].map(|at| at.x), Some(100.0), "metres");
    }

    #[test]
    fn euler_angles_of_motive_are_in_the_order_of_their_type() {
        let text = "Format Version,1.23,Rotation Type,ZYX,Length Units,Meters\n\n,Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n,Name,a,a,a,a,a,a\n\
            ,ID,1,1,1,1,1,1\n,,Rotation,Rotation,Rotation,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z,X,Y,Z\n0,0.0,10,20,30,1,2,3\n1,0.1,10,20,30,1,2,3\n";
        let file = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect("read");
        let form = OrientationForm::parse("intrinsic-zyx").expect("known");
        let (truth, _) =
            form.orientation(&[30.0, 20.0, 10.0].map(f64::to_radians)).expect("right").expect("seen");
        assert!(file.poses().expect("poses").world_from_body[0].expect("seen").angle_to(&truth) < 1e-7);
    }
}
