//! The meshes that a URDF file names.

use super::element::Element;
use std::fmt;
use std::path::{Path, PathBuf};

/// A mesh of a link.
#[derive(Debug, Clone)]
pub(super) struct Mesh {
    link: String,
    name: String,
}

impl Mesh {
    /// All meshes of a link, each once.
    pub(super) fn of(link: Element) -> Vec<Self> {
        let of = link.attribute("name").unwrap_or_default();
        let names = link.0.descendants().filter(|node| node.has_tag_name("mesh"));
        let mut names: Vec<&str> = names.filter_map(|node| Element(node).attribute("filename")).collect();
        names.sort_unstable();
        names.dedup();
        names.into_iter().map(|name| Self { link: of.to_owned(), name: name.to_owned() }).collect()
    }
}

/// A mesh that is not where it should be.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingMesh {
    /// Name of the link.
    pub link: String,
    /// The mesh as the file names it.
    pub mesh: String,
    /// Where it was looked for.
    pub places: Vec<PathBuf>,
}

impl fmt::Display for MissingMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { link, mesh, places } = self;
        match places.as_slice() {
            [] => write!(f, "link {link}: nothing says where {mesh} lies"),
            [first, ..] => write!(f, "link {link}: no mesh {mesh} (looked for {})", first.display()),
        }
    }
}

/// How far above the URDF file its packages are looked for: in ROS it lies in `PACKAGE/urdf/`, or one deeper.
const ABOVE: usize = 4;

/// Where a mesh of this name may lie: a package in one of these directories, or in one of those above the URDF file.
pub(super) fn places(name: &str, packages: &[PathBuf], beside: Option<&Path>) -> Vec<PathBuf> {
    let above = beside.into_iter().flat_map(Path::ancestors).take(ABOVE);
    match name.split_once("://") {
        Some(("package", within)) => packages
            .iter()
            .map(PathBuf::as_path)
            .chain(above)
            .map(|directory| directory.join(within))
            .collect(),
        Some(("file", path)) => vec![PathBuf::from(path)],
        _ => vec![beside.unwrap_or(Path::new("")).join(name)],
    }
}

/// The meshes that are in none of the directories.
pub(super) fn missing(meshes: &[Mesh], packages: &[PathBuf], beside: Option<&Path>) -> Vec<MissingMesh> {
    let look = |mesh: &Mesh| {
        let places = places(&mesh.name, packages, beside);
        let missing = !places.iter().any(|place| place.is_file());
        missing.then(|| MissingMesh { link: mesh.link.clone(), mesh: mesh.name.clone(), places })
    };
    meshes.iter().filter_map(look).collect()
}
