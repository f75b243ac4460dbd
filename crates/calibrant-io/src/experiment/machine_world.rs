//! `[machine.world]`: what the machine must not touch.

use super::number::Within;
use super::ranges::{BodyRadius, BoxHalf, Clearance, Coordinate, RotationComponent};
use super::refused_key::refused;
use super::remedies::remedy;
use crate::machine::{LinkInChain, LinkWithoutMesh, MachineBodies, read_named_srdf};
use calibrant_core::diagnostic::design::SrdfOfAnother;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::Result;
use calibrant_machine::chain::KinematicChain;
use calibrant_machine_design::world::{Body, BodySource, Capsule, Cuboid, Scene};
use calibrant_recording::text::similar_word::{nearest, shorten};
use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Distance that a motion keeps where none is given, m.
const CLEARANCE_M: f64 = 0.005;

/// Three coordinates, m.
type Coordinates = Vec<Within<Coordinate>>;

/// `[machine.world]`: what the machine must not touch.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorldSection {
    /// Height of the floor above the origin of the base.
    pub floor_m: Option<Within<Coordinate>>,
    /// Boxes.
    pub boxes: Option<Vec<BoxSection>>,
    /// The body of the sensor.
    pub sensor_body: Option<SensorBodySection>,
    /// Smallest distance.
    pub clearance_m: Option<Within<Clearance>>,
    /// File with the pairs of links that may touch.
    pub srdf: Option<PathBuf>,
    /// Capsules of links, in the place of their shapes in the URDF file.
    pub capsules: Option<BTreeMap<String, Capsules>>,
    /// Are the links kept apart from each other? They are without it.
    pub self_collision: Option<bool>,
}

/// A box in the axes of the base.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxSection {
    /// Its middle.
    pub center_m: Coordinates,
    /// Half of its edges.
    pub half_m: Vec<Within<BoxHalf>>,
    /// A rotation vector.
    pub rotation_deg: Option<Vec<Within<RotationComponent>>>,
}

/// The body of the sensor: a ball in the axes of the tip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorBodySection {
    /// Its middle.
    pub center_m: Coordinates,
    /// Its radius.
    pub radius_m: Within<BodyRadius>,
}

/// A capsule in the axes of its link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CapsuleSection {
    /// An end of its axis.
    pub from_m: Coordinates,
    /// The other end.
    pub to_m: Coordinates,
    /// Its radius.
    pub radius_m: Within<BodyRadius>,
}

/// One capsule, or an array of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Capsules(pub Vec<CapsuleSection>);

impl<'de> Deserialize<'de> for Capsules {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct OneOrMany;

        impl<'de> serde::de::Visitor<'de> for OneOrMany {
            type Value = Capsules;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "a table or an array\n{}", remedy("machine.world.capsules"))
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                items: A,
            ) -> std::result::Result<Capsules, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(items)).map(Capsules)
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(
                self,
                entries: A,
            ) -> std::result::Result<Capsules, A::Error> {
                let one = CapsuleSection::deserialize(MapAccessDeserializer::new(entries))?;
                Ok(Capsules(vec![one]))
            }
        }
        deserializer.deserialize_any(OneOrMany)
    }
}

/// The bodies of a machine and what stands around it, as an experiment describes them.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineWorld {
    /// Bodies, floor, boxes, and the pairs that may touch.
    pub scene: Scene,
    /// Smallest distance that a motion keeps, m.
    pub clearance_m: f64,
    /// Middle of the sensor's body in the axes of the tip, and its radius, m.
    pub sensor_body: Option<(Vector3<f64>, f64)>,
    /// Links whose mesh is not found or not read: a capsule from joint to joint stands for each.
    pub without_mesh: Vec<LinkWithoutMesh>,
    /// What is known of the links.
    pub links: LinksKnown,
    /// What a reader should know of its files.
    pub notes: Vec<Diagnostic>,
}

/// What is known of the shapes of the links.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LinksKnown {
    /// Their shapes, but for the links that lack a mesh.
    Shapes,
    /// Nothing: their capsules go from joint to joint, as wide as those of usual arms.
    Joints,
    /// Nothing, and no capsules stand for them: only the sensor's body is kept from what stands around.
    Nothing,
}

impl WorldSection {
    /// The world of a chain, with the shapes of its links.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment): no such link, a vector without three numbers, or as [`read_srdf`](crate::read_srdf).
    pub fn of(
        &self,
        chain: &KinematicChain,
        found: MachineBodies,
        up: Unit<Vector3<f64>>,
    ) -> Result<MachineWorld> {
        self.check_floor(chain, &up)?;
        let mut notes = Vec::new();
        let pairs = self.pairs(&found, &mut notes)?;
        let mut bodies = self.given(&found.links, found.bodies)?;
        let links = if bodies.is_empty() {
            LinksKnown::Nothing
        } else if bodies.iter().all(|body| body.source == BodySource::Joints) {
            LinksKnown::Joints
        } else {
            LinksKnown::Shapes
        };
        let sensor_body = self.sensor_body.as_ref().map(SensorBodySection::ball).transpose()?;
        if let Some((center_m, radius_m)) = sensor_body {
            let center_m = (chain.tip_transform * Point3::from(center_m)).coords;
            bodies.push(Body {
                name: SENSOR.into(),
                frame: chain.joints.len(),
                capsules: vec![Capsule::ball(center_m, radius_m)],
                source: BodySource::Given,
            });
        }
        let boxes = self.boxes.iter().flatten().enumerate();
        let boxes = boxes.map(|(k, of)| of.cuboid(&format!("machine.world.boxes[{k}]")));
        let scene = Scene {
            disabled: self.disabled(&bodies, pairs),
            bodies,
            floor_m: self.floor_m.map(f64::from),
            boxes: boxes.collect::<Result<_>>()?,
            up,
        };
        Ok(MachineWorld {
            scene,
            clearance_m: self.clearance_m.map_or(CLEARANCE_M, f64::from),
            sensor_body,
            without_mesh: found.without_mesh,
            links,
            notes,
        })
    }

    /// Refuses a floor that the machine stands under: no motion leads out of it.
    fn check_floor(&self, chain: &KinematicChain, up: &Vector3<f64>) -> Result<()> {
        let (Some(floor), Some(joint)) = (self.floor_m, chain.joints.first()) else { return Ok(()) };
        let height_m = joint.origin.translation.vector.dot(up);
        if floor.get() <= height_m {
            return Ok(());
        }
        let message = format!(
            "the floor, {} m above the origin of `{}`, is above the joint `{}`, at {height_m:.3} m",
            floor.get(),
            chain.base,
            joint.name
        );
        let help = "floor_m is a height along `up` from the base: 0.0 for a machine that stands on it, negative on a pedestal";
        Err(refused("machine.world.floor_m", message, help))
    }

    /// The bodies, those that are given in the place of those that were found.
    fn given(&self, links: &[LinkInChain], mut bodies: Vec<Body>) -> Result<Vec<Body>> {
        for (name, of) in self.capsules.iter().flatten() {
            let key = format!("machine.world.capsules.{name}");
            let Some(link) = links.iter().find(|link| link.name == *name) else {
                let known = || links.iter().map(|link| link.name.as_str());
                let near = nearest(name, known());
                let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
                let message = format!("no link `{}` moves with the chain", shorten(name));
                let help = format!("{hint}its links are {}", known().collect::<Vec<_>>().join(", "));
                return Err(refused(key, message, help));
            };
            let capsules: Vec<Capsule> =
                of.0.iter().map(|of| of.capsule(&key, &link.pose)).collect::<Result<_>>()?;
            bodies.retain(|body| body.name != *name);
            bodies.push(Body { name: name.clone(), frame: link.frame, capsules, source: BodySource::Given });
        }
        if self.capsules.is_some() {
            // a capsule from joint to joint stands for a link of which nothing is known
            let has_given = |frame: usize, bodies: &[Body]| {
                bodies.iter().any(|body| body.frame == frame && body.source == BodySource::Given)
            };
            let kept: Vec<bool> = bodies
                .iter()
                .map(|body| body.source != BodySource::Joints || !has_given(body.frame, &bodies))
                .collect();
            let mut kept = kept.into_iter();
            bodies.retain(|_| kept.next().unwrap_or(true));
            bodies.sort_by_key(|body| body.frame);
        }
        Ok(bodies)
    }

    /// The pairs of bodies that may touch.
    fn disabled(&self, bodies: &[Body], pairs: Vec<[String; 2]>) -> Vec<[String; 2]> {
        if self.self_collision == Some(false) {
            let names = bodies.iter().map(|body| &body.name);
            let pairs = names.clone().flat_map(|one| names.clone().map(move |other| [one, other]));
            return pairs.map(|pair| pair.map(String::clone)).collect();
        }
        pairs
    }

    /// The pairs of the SRDF file.
    fn pairs(&self, found: &MachineBodies, notes: &mut Vec<Diagnostic>) -> Result<Vec<[String; 2]>> {
        let Some(path) = &self.srdf else { return Ok(Vec::new()) };
        let (robot, pairs) = read_named_srdf(path)?;
        let known = |name: &String| found.links.iter().any(|link| link.name == *name);
        if !pairs.is_empty() && !pairs.iter().flatten().any(known) {
            let message = format!("{} names none of the links of this machine", path.display());
            let [one, other] = &pairs[0];
            let help = format!("is it the file of another? its first pair is {one} and {other}");
            return Err(refused("machine.world.srdf", message, help));
        }
        let mut why = Vec::new();
        if !robot.is_empty() && !found.machine.is_empty() && robot != found.machine {
            why.push(format!("is of the robot `{}`, the URDF file of `{}`", shorten(&robot), found.machine));
        }
        let is_there = |name: &&String| found.all_links.contains(name);
        let mut unknown: Vec<String> =
            pairs.iter().flatten().filter(|name| !is_there(name)).cloned().collect();
        unknown.sort_unstable();
        unknown.dedup();
        if !unknown.is_empty() && !found.all_links.is_empty() {
            why.push(format!("names links that the machine has not, {}", quoted(&unknown, MOST_NAMES)));
        }
        if !why.is_empty() {
            notes.push(SrdfOfAnother { why: Phrase(why.join(", and ")) }.into());
        }
        Ok(pairs)
    }
}

/// Largest number of links that a message names.
const MOST_NAMES: usize = 5;
/// Name of the sensor's body.
const SENSOR: &str = "sensor";

/// Three numbers of this key.
fn vector<R: Copy>(key: &str, numbers: &[Within<R>]) -> Result<Vector3<f64>> {
    let [x, y, z] = numbers else {
        let message = format!("this has {} numbers, not three", numbers.len());
        return Err(refused(key, message, remedy(key)));
    };
    Ok(Vector3::new(x.get(), y.get(), z.get()))
}

impl SensorBodySection {
    fn ball(&self) -> Result<(Vector3<f64>, f64)> {
        Ok((vector("machine.world.sensor_body.center_m", &self.center_m)?, self.radius_m.get()))
    }
}

impl BoxSection {
    fn cuboid(&self, key: &str) -> Result<Cuboid> {
        let center_m = vector(&format!("{key}.center_m"), &self.center_m)?;
        let turned = match &self.rotation_deg {
            Some(turned) => vector(&format!("{key}.rotation_deg"), turned)?.map(f64::to_radians),
            None => Vector3::zeros(),
        };
        Ok(Cuboid {
            pose: Isometry3::from_parts(
                Translation3::from(center_m),
                UnitQuaternion::from_scaled_axis(turned),
            ),
            half_m: vector(&format!("{key}.half_m"), &self.half_m)?,
        })
    }
}

impl CapsuleSection {
    fn capsule(&self, key: &str, link: &Isometry3<f64>) -> Result<Capsule> {
        let ends_m =
            [vector(&format!("{key}.from_m"), &self.from_m)?, vector(&format!("{key}.to_m"), &self.to_m)?];
        Ok(Capsule { ends_m, radius_m: self.radius_m.get() }.placed(link))
    }
}
