//! With which frame of a chain each link moves.

use super::joint::UrdfJoint;
use super::link_tree::LinkTree;
use nalgebra::Isometry3;

/// A link that moves with a chain.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkInChain {
    /// Its name.
    pub name: String,
    /// Its frame: 0 the base, k the one behind joint k of the chain.
    pub frame: usize,
    /// Its pose in that frame, m.
    pub pose: Isometry3<f64>,
}

/// The links that move with the chain `path` from `base`, by name. Fixed joints join links to a frame, above the base, too; a joint that moves and is not on
/// the path ends the walk, since nobody knows its position.
pub(super) fn link_frames(
    tree: &LinkTree,
    joints: &[UrdfJoint],
    path: &[usize],
    base: &str,
) -> Vec<LinkInChain> {
    let moving = path.iter().filter(|joint| joints[**joint].fixed().is_none());
    let frame_behind = |joint: usize| moving.clone().position(|of| *of == joint).map(|k| k + 1);
    let mut waiting = vec![(tree.place(base), (0, Isometry3::identity()))];
    let mut found = Vec::new();
    let mut seen = vec![false; tree.links()];
    while let Some((link, (frame, pose))) = waiting.pop() {
        if std::mem::replace(&mut seen[link], true) {
            continue;
        }
        found.push((link, (frame, pose)));
        for (joint, child) in tree.joints_behind(link) {
            match (joints[joint].fixed(), frame_behind(joint)) {
                (Some(origin), _) => waiting.push((child, (frame, pose * origin))),
                (None, Some(behind)) => waiting.push((child, (behind, Isometry3::identity()))),
                (None, None) => {}
            }
        }
        if let Some((joint, parent)) = tree.joint_before(link)
            && let Some(origin) = joints[joint].fixed()
        {
            waiting.push((parent, (frame, pose * origin.inverse())));
        }
    }
    found.sort_by_key(|(link, (frame, _))| (*frame, *link));
    let named = |(link, (frame, pose))| LinkInChain { name: tree.name(link).to_owned(), frame, pose };
    found.into_iter().map(named).collect()
}
