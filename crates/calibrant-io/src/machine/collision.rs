//! `<collision>`: the shapes of links, as capsules in the frames of a chain.

use super::element::Element;
use super::joint::origin;
use super::link_frames::LinkInChain;
use super::meshes::places;
use super::stl::read_stl;
use super::xml;
use calibrant_core::error::Refusal;
use calibrant_machine::chain::KinematicChain;
use calibrant_machine_design::world::{Body, BodySource, Capsule, Shape, bodies_of_joints, capsule_around};
use calibrant_recording::text::decoding::Checked;
use calibrant_recording::text::similar_word::shorten;
use nalgebra::{Isometry3, Vector3};
use std::path::{Path, PathBuf};

/// The shapes of a machine's links.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineBodies {
    /// One for each link whose shape is known, or for which a capsule from joint to joint stands.
    pub bodies: Vec<Body>,
    /// Links whose mesh is not found or not read, and why: a capsule from joint to joint stands for each.
    pub without_mesh: Vec<LinkWithoutMesh>,
    /// The links that move with the chain, by their frames.
    pub links: Vec<LinkInChain>,
    /// Name of the machine; empty where no file says it.
    pub machine: String,
    /// Names of all of its links; none where no file says them.
    pub all_links: Vec<String>,
}

impl MachineBodies {
    /// Bodies of a machine of whose links nothing is known: capsules from joint to joint. None where a joint slides: then nothing says how wide the machine is.
    #[must_use]
    pub fn of_joints(chain: &KinematicChain) -> Self {
        let turns = chain.joints.iter().all(|joint| joint.kind.turns());
        let bodies = if turns { bodies_of_joints(chain) } else { Vec::new() };
        let bodies = bodies.into_iter().filter(|body| body.capsules[0].radius_m > 0.0).collect();
        let (without_mesh, links, all_links) = (Vec::new(), Vec::new(), Vec::new());
        Self { bodies, without_mesh, links, machine: String::new(), all_links }
    }
}

/// A link whose mesh cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkWithoutMesh {
    /// The link.
    pub link: String,
    /// The mesh as the file names it.
    pub mesh: String,
    /// Where it was looked for; empty where it is there and its format is not read.
    pub places: Vec<PathBuf>,
}

/// The bodies of the links in these frames.
pub(super) fn bodies(
    text: &str,
    in_chain: Vec<LinkInChain>,
    chain: &KinematicChain,
    (packages, beside): (&[PathBuf], Option<&Path>),
) -> Checked<MachineBodies> {
    let (_, document) = xml::parse(text.as_bytes(), "URDF")?;
    let robot = xml::robot(&document, "URDF")?;
    let links: Vec<Element> = robot.children("link").collect();
    let of_joints = bodies_of_joints(chain);
    let (mut bodies, mut without_mesh) = (Vec::new(), Vec::new());
    for LinkInChain { name, frame, pose } in &in_chain {
        let Some(link) = links.iter().find(|link| link.attribute("name") == Some(name)) else { continue };
        let (mut capsules, mut source) = (Vec::new(), BodySource::Primitive);
        for collision in link.children("collision") {
            let pose = pose * collision.child("origin")?.map_or(Ok(Isometry3::identity()), origin)?;
            let geometry = collision.need_child("geometry")?;
            let Some(mesh) = geometry.child("mesh")? else {
                capsules.extend(primitive(geometry)?.capsule(&pose));
                continue;
            };
            let filename = mesh.need("filename")?;
            match vertices(mesh, &places(filename, packages, beside))? {
                Ok(points) => {
                    capsules.extend(capsule_around(&Shape::Points(points), &pose));
                    source = BodySource::Mesh;
                }
                Err(places) => {
                    let (link, mesh) = (name.clone(), filename.to_owned());
                    without_mesh.push(LinkWithoutMesh { link, mesh, places });
                    capsules.extend(of_joints[*frame].capsules.iter().copied());
                    source = BodySource::Joints;
                }
            }
        }
        if !capsules.is_empty() {
            bodies.push(Body { name: name.clone(), frame: *frame, capsules, source });
        }
    }
    if bodies.is_empty() {
        bodies = MachineBodies::of_joints(chain).bodies;
    }
    let machine = robot.attribute("name").unwrap_or_default().to_owned();
    let all_links = links.iter().filter_map(|link| link.attribute("name")).map(str::to_owned).collect();
    Ok(MachineBodies { bodies, without_mesh, links: in_chain, machine, all_links })
}

/// A shape of URDF, or the capsule that newer files have.
enum Primitive {
    Shape(Shape),
    Capsule(Capsule),
}

impl Primitive {
    fn capsule(&self, pose: &Isometry3<f64>) -> Option<Capsule> {
        match self {
            Self::Shape(shape) => capsule_around(shape, pose),
            Self::Capsule(capsule) => Some(capsule.placed(pose)),
        }
    }
}

fn primitive(geometry: Element) -> Checked<Primitive> {
    let positive = |of: Element, key: &str| -> Checked<f64> {
        of.need(key)?;
        let [value] = of.numbers(key)?.unwrap_or_default();
        if value > 0.0 {
            return Ok(value);
        }
        Err(of.error(Refusal::ValueInvalid, format!("`{key}` is not above 0: {value}"), "write it in m"))
    };
    if let Some(of) = geometry.child("box")? {
        of.need("size")?;
        let size = Vector3::from(of.numbers("size")?.unwrap_or_default());
        if size.min() <= 0.0 {
            return Err(of.error(
                Refusal::ValueInvalid,
                "`size` has a number that is not above 0",
                "three edges, m",
            ));
        }
        return Ok(Primitive::Shape(Shape::Box { half_m: size / 2.0 }));
    }
    if let Some(of) = geometry.child("cylinder")? {
        let (radius_m, length_m) = (positive(of, "radius")?, positive(of, "length")?);
        return Ok(Primitive::Shape(Shape::Cylinder { radius_m, length_m }));
    }
    if let Some(of) = geometry.child("capsule")? {
        let (radius_m, length_m) = (positive(of, "radius")?, positive(of, "length")?);
        let end = Vector3::new(0.0, 0.0, length_m / 2.0);
        return Ok(Primitive::Capsule(Capsule { ends_m: [-end, end], radius_m }));
    }
    if let Some(of) = geometry.child("sphere")? {
        return Ok(Primitive::Shape(Shape::Sphere { radius_m: positive(of, "radius")? }));
    }
    let help = "box, cylinder, capsule, sphere and mesh are read";
    Err(geometry.error(Refusal::KeyMissing, "there is no shape that is known", help))
}

/// The scaled vertices of a mesh; the places where it is not, or none where its format is not read.
fn vertices(mesh: Element, places: &[PathBuf]) -> Checked<Result<Vec<Vector3<f64>>, Vec<PathBuf>>> {
    let scale = Vector3::from(mesh.numbers("scale")?.unwrap_or([1.0; 3]));
    let Some(path) = places.iter().find(|place| place.is_file()) else { return Ok(Err(places.to_vec())) };
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("stl")) {
        return Ok(Err(Vec::new()));
    }
    let points: Vec<Vector3<f64>> =
        read_stl(path)?.into_iter().map(|vertex| vertex.component_mul(&scale)).collect();
    let farthest = points.iter().map(Vector3::amax).fold(0.0, f64::max);
    if farthest > LARGEST_M {
        let message =
            format!("`{}` reaches {farthest:.0} m from its origin", shorten(&path.display().to_string()));
        let help = "is it in mm? then write scale=\"0.001 0.001 0.001\"";
        return Err(mesh.error(Refusal::ValueOutOfRange, message, help));
    }
    Ok(Ok(points))
}

/// No link of a machine that carries a sensor reaches so far. One that does is in mm.
const LARGEST_M: f64 = 20.0;
