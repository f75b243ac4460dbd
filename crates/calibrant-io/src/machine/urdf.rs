//! A machine as its URDF file describes it.

use super::element::{Element, Place};
use super::joint::{ChainJoint, UrdfJoint};
use super::link_tree::LinkTree;
use super::meshes::{Mesh, MissingMesh, missing};
use crate::experiment::shorten;
use crate::text::decoding::{Checked, as_text, parsed, refuse, too_large};
use crate::text::excerpt::error_at;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_machine::chain::KinematicChain;
use nalgebra::Isometry3;
use roxmltree::{Document, ParsingOptions};
use std::path::{Path, PathBuf};

/// Largest file, bytes.
const LARGEST_BYTES: u64 = 16 << 20;
/// Largest number of elements, attributes and texts.
const MOST_NODES: u32 = 1 << 20;
/// Largest number of attributes of an element: XML compares each with all others.
const MOST_ATTRIBUTES: usize = 1000;
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
        let read = parsed(path, (LARGEST_BYTES, "a URDF file"), read)?;
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
        self.checked_chain(base, tip).map_err(|error| {
            Error::experiment(match &self.file {
                Some(file) => error.in_file(file),
                None => *error,
            })
        })
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
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err(too_large("a URDF file", LARGEST_BYTES).into());
    }
    let text = as_text(bytes)?;
    // no attribute has this sign in its value
    let attributes = |element: &str| element.bytes().filter(|byte| *byte == b'=').count();
    if text.split('<').any(|element| !element.starts_with('!') && attributes(element) > MOST_ATTRIBUTES) {
        let message = format!("an element has more than {MOST_ATTRIBUTES} attributes");
        return refuse(Refusal::FileUnreadable, message, "this is hardly the file that you mean");
    }
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| syntax(text, &error))?;
    let robot = robot(&document)?;
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

/// The `<robot>` of a URDF file. Other files of robots are named.
fn robot<'a>(document: &'a Document<'a>) -> Checked<Element<'a>> {
    let root = Element(document.root_element());
    let name = root.0.tag_name().name();
    if name != "robot" {
        let (message, help) = match name {
            "sdf" => ("this is an SDF file, not URDF", "convert it, or take the URDF that it was made from"),
            "mujoco" => ("this is a MuJoCo model, not URDF", "take the URDF that it was made from"),
            _ => ("this is no URDF file: its first element is not <robot>", "give the URDF of the machine"),
        };
        return Err(root.error(Refusal::FormatUnknown, message, help));
    }
    let of_xacro =
        |node: &roxmltree::Node| node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"));
    if let Some(node) = document.descendants().find(of_xacro) {
        return Err(Element(node).error(
            Refusal::FormatUnsupported,
            "this is a xacro file, not URDF",
            XACRO_HELP,
        ));
    }
    Ok(root)
}

const XACRO_HELP: &str = "expand it first: `xacro FILE > machine.urdf`";

fn syntax(text: &str, error: &roxmltree::Error) -> Box<InputError> {
    let (code, message, help) = match error {
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "xacro" => {
            (Refusal::FormatUnsupported, "this is a xacro file, not URDF".to_owned(), XACRO_HELP)
        }
        roxmltree::Error::NodesLimitReached => {
            let message = format!("the file has more than {MOST_NODES} elements");
            (Refusal::FileUnreadable, message, "this is hardly the file that you mean")
        }
        roxmltree::Error::DtdDetected => (
            Refusal::FormatUnsupported,
            "the file declares a document type (DTD)".to_owned(),
            "remove <!DOCTYPE …>",
        ),
        _ => {
            let words = error.to_string();
            // the place is said before the message
            let words = words.split(" at ").next().unwrap_or(&words);
            (Refusal::SyntaxInvalid, format!("not valid XML: {}", shorten(words)), "correct it at this place")
        }
    };
    use roxmltree::Error::{UnclosedRootNode, UnexpectedEndOfStream};
    let at = match error {
        // they know no place
        UnclosedRootNode | UnexpectedEndOfStream => text.trim_end().len(),
        _ => {
            let position = error.pos();
            let before = |count: u32| count.saturating_sub(1) as usize;
            let line: usize = text.split_inclusive('\n').take(before(position.row)).map(str::len).sum();
            line + text[line..].chars().take(before(position.col)).map(char::len_utf8).sum::<usize>()
        }
    };
    error_at(text, at..at + 1, InputError::new(code, message, help)).into()
}
