//! A machine as its URDF file describes it.

use super::collision::{MachineBodies, bodies};
use super::element::Place;
use super::joint::{ChainJoint, UrdfJoint};
use super::link_frames::link_frames;
use super::link_tree::LinkTree;
use super::meshes::{Mesh, MissingMesh, missing};
use super::xml;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_machine::chain::KinematicChain;
use calibrant_recording::text::decoding::{Checked, parsed, refuse};
use nalgebra::Isometry3;
use std::path::{Path, PathBuf};

/// Largest number of joints that move between base and tip: the work grows with their cube.
const MOST_JOINTS: usize = 100;

/// A machine of links and joints.
#[derive(Debug, Clone)]
pub struct Urdf {
    /// Name of the machine.
    pub name: String,
    text: String,
    file: Option<PathBuf>,
    links: Vec<(String, Place)>,
    joints: Vec<UrdfJoint>,
    tree: LinkTree,
    meshes: Vec<Mesh>,
}

impl Urdf {
    /// Reads a URDF file.
    ///
    /// # Errors
    /// [`Error::Experiment`] with line and element: see [`Self::parse`]. The file cannot be read, or is larger than 16 MiB.
    pub fn read(path: &Path) -> Result<Self> {
        let read = parsed(path, (xml::LARGEST_BYTES, "a URDF file"), read)?;
        Ok(Self { file: Some(path.to_path_buf()), ..read })
    }

    /// Reads the text of a URDF file.
    ///
    /// # Errors
    /// [`Error::Experiment`] with line and element. The text is no XML or has no `<robot>`, a number is none, a name is
    /// missing or there twice, a joint names a link that is not there, or the joints make no tree.
    ///
    /// # Examples
    /// ```
    /// use calibrant_io::{Urdf, machine_preset};
    /// let arm = Urdf::parse(machine_preset("arm").expect("known").as_bytes())?;
    /// let chain = arm.chain(None, None)?;
    /// assert_eq!((chain.base.as_str(), chain.joints.len()), ("base", 6));
    /// let error = arm.chain(None, Some("fange")).expect_err("no such link");
    /// assert!(error.to_string().contains("did you mean `flange`?"), "{error}");
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn parse(bytes: &[u8]) -> Result<Self> {
        read(bytes).map_err(Error::Experiment)
    }

    /// The joints between two links. Without a base it begins at the root. Without a tip it ends where the machine does.
    ///
    /// # Errors
    /// [`Error::Experiment`]: no such link, no joints lead from base to tip, the machine has several ends, or a joint on the way is not
    /// supported, has no limit, or a zero axis.
    pub fn chain(&self, base: Option<&str>, tip: Option<&str>) -> Result<KinematicChain> {
        self.checked_chain(base, tip).map_err(|error| self.in_file(*error))
    }

    fn in_file(&self, error: InputError) -> Error {
        Error::experiment(match &self.file {
            Some(file) if error.file.is_none() => error.in_file(file),
            _ => error,
        })
    }

    /// The shapes of the links (`<collision>`) as capsules, by the frames of [`Self::chain`] of the same base and tip.
    ///
    /// A link belongs to a frame where fixed joints join them. A link of which a mesh is not found, or is in a format that is not read, gets a capsule from its joint to the
    /// next; so do all links of a machine that turns, where no shape is known of any.
    ///
    /// # Errors
    /// As [`Self::chain`]. [`Error::Experiment`] with line and element for a shape that makes no sense, or with the file of a mesh that is broken.
    ///
    /// # Examples
    /// ```
    /// use calibrant_io::{Urdf, machine_preset};
    /// let arm = Urdf::parse(machine_preset("arm").expect("known").as_bytes())?;
    /// let found = arm.bodies(None, None, &[])?;
    /// assert_eq!((found.bodies[0].name.as_str(), found.bodies[0].frame), ("base", 0));
    /// assert!(found.without_mesh.is_empty());
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn bodies(
        &self,
        base: Option<&str>,
        tip: Option<&str>,
        packages: &[PathBuf],
    ) -> Result<MachineBodies> {
        let chain = self.chain(base, tip)?;
        let beside = self.file.as_deref().and_then(Path::parent);
        let read = || {
            let path = self.tree.path(&chain.base, &chain.tip)?;
            let frames = link_frames(&self.tree, &self.joints, &path, &chain.base);
            bodies(&self.text, frames, &chain, (packages, beside))
        };
        read().map_err(|error| self.in_file(*error))
    }

    fn checked_chain(&self, base: Option<&str>, tip: Option<&str>) -> Checked<KinematicChain> {
        let base = base.unwrap_or(self.tree.root());
        let tip = tip.map_or_else(|| self.tree.only_end(base), Ok)?;
        let (mut joints, mut fixed) = (Vec::new(), Isometry3::identity());
        for k in self.tree.path(base, tip)? {
            match self.joints[k].in_chain(&self.text)? {
                ChainJoint::Fixed(origin) => fixed *= origin,
                ChainJoint::Moving(_) if joints.len() == MOST_JOINTS => {
                    let message = format!("more than {MOST_JOINTS} joints move between `{base}` and `{tip}`");
                    return refuse(
                        Refusal::ValueOutOfRange,
                        message,
                        "give a base and a tip nearer to each other",
                    );
                }
                ChainJoint::Moving(mut joint) => {
                    joint.origin = fixed * joint.origin;
                    fixed = Isometry3::identity();
                    joints.push(joint);
                }
            }
        }
        Ok(KinematicChain { base: base.to_owned(), tip: tip.to_owned(), joints, tip_transform: fixed })
    }

    /// Names of the links, in the order of the file.
    pub fn links(&self) -> impl Iterator<Item = &str> {
        self.links.iter().map(|(name, _)| name.as_str())
    }

    /// The meshes that are not found. `package://NAME/…` lies in `NAME` under one of these directories; other names are beside the file.
    #[must_use]
    pub fn missing_meshes(&self, packages: &[PathBuf]) -> Vec<MissingMesh> {
        let beside = self.file.as_deref().and_then(Path::parent);
        missing(&self.meshes, packages, beside)
    }
}

fn read(bytes: &[u8]) -> Checked<Urdf> {
    let (text, document) = xml::parse(bytes, "URDF")?;
    let robot = xml::robot(&document, "URDF")?;
    let links: Vec<(String, Place)> = robot
        .children("link")
        .map(|link| Ok((link.need("name")?.to_owned(), link.place())))
        .collect::<Checked<_>>()?;
    if links.is_empty() {
        return Err(robot.error(Refusal::KeyMissing, "the machine has no links", "add <link name=\"…\"/>"));
    }
    let joints: Vec<UrdfJoint> = robot.children("joint").map(UrdfJoint::read).collect::<Checked<_>>()?;
    let mut names = std::collections::HashSet::new();
    if let Some(second) = joints.iter().find(|joint| !names.insert(joint.name.as_str())) {
        let message = "there are two joints of this name";
        return Err(second.place.error(text, Refusal::KeyRepeated, message, "rename one"));
    }
    let tree = LinkTree::new(text, &links, &joints)?;
    let meshes = robot.children("link").flat_map(Mesh::of).collect();
    let name = robot.attribute("name").unwrap_or_default().to_owned();
    Ok(Urdf { name, text: text.to_owned(), file: None, links, joints, tree, meshes })
}
