//! Links and joints as a tree.

use super::element::Place;
use super::joint::UrdfJoint;
use calibrant_core::error::{InputError, Refusal};
use calibrant_recording::text::decoding::{Checked, refuse};
use calibrant_recording::text::similar_word::{nearest, shorten};
use std::collections::HashMap;

/// Largest number of links that a message lists.
const MOST_NAMES: usize = 20;

/// Which joint leads to each link, and which links are ends.
#[derive(Debug, Clone)]
pub(super) struct LinkTree {
    names: Vec<String>,
    /// For each link the joint whose child it is.
    joint_to: Vec<Option<usize>>,
    /// For each joint the link that is its parent.
    parent: Vec<usize>,
    index: HashMap<String, usize>,
    root: usize,
}

impl LinkTree {
    /// Checks that the joints make one tree of the links.
    pub(super) fn new(text: &str, links: &[(String, Place)], joints: &[UrdfJoint]) -> Checked<Self> {
        let mut index = HashMap::new();
        for (k, (name, place)) in links.iter().enumerate() {
            if index.insert(name.clone(), k).is_some() {
                return Err(place.error(
                    text,
                    Refusal::KeyRepeated,
                    "there are two links of this name",
                    "rename one",
                ));
            }
        }
        let names: Vec<String> = links.iter().map(|(name, _)| name.clone()).collect();
        let link = |name: &str, place: &Place| {
            index.get(name).copied().ok_or_else(|| {
                let message = format!("there is no link `{}`", shorten(name));
                place.error(text, Refusal::KeyUnknown, message, suggestion(name, &names))
            })
        };
        let mut joint_to: Vec<Option<usize>> = vec![None; names.len()];
        let mut parent = Vec::with_capacity(joints.len());
        for (k, joint) in joints.iter().enumerate() {
            parent.push(link(&joint.parent, &joint.parent_place)?);
            let child = link(&joint.child, &joint.child_place)?;
            if let Some(first) = joint_to[child].replace(k) {
                let message = format!(
                    "the link `{}` is already the child of joint `{}`",
                    joint.child, joints[first].name
                );
                let help = "a link has one parent; closed kinematic loops cannot be written in URDF";
                return Err(joint.child_place.error(text, Refusal::MachineInvalid, message, help));
            }
        }
        let unknown_root = 0;
        let mut tree = Self { names, joint_to, parent, index, root: unknown_root };
        tree.find_loop(text, joints)?;
        let mut roots = (0..tree.names.len()).filter(|&link| tree.joint_to[link].is_none());
        tree.root = roots.next().unwrap_or(unknown_root);
        if let Some(second) = roots.next() {
            let message = format!(
                "no joint leads to this link, and none to link `{}`: the machine is in two pieces",
                tree.names[tree.root]
            );
            let help = "join them with a fixed joint";
            return Err(links[second].1.error(text, Refusal::MachineInvalid, message, help));
        }
        Ok(tree)
    }

    fn find_loop(&self, text: &str, joints: &[UrdfJoint]) -> Checked<()> {
        // the link from which a walk towards the root first came by each link
        let mut walk = vec![None; self.names.len()];
        for start in 0..self.names.len() {
            let mut link = start;
            while walk[link].is_none() {
                walk[link] = Some(start);
                let Some(joint) = self.joint_to[link] else { break };
                link = self.parent[joint];
                if walk[link] == Some(start) {
                    let message = format!("the joints lead from link `{}` back to itself", self.names[link]);
                    let help = "one of the links on this loop must not be the child of a joint";
                    return Err(joints[joint].place.error(text, Refusal::MachineInvalid, message, help));
                }
            }
        }
        Ok(())
    }

    /// Name of the link that no joint leads to.
    pub(super) fn root(&self) -> &str {
        &self.names[self.root]
    }

    /// Number of links.
    pub(super) fn links(&self) -> usize {
        self.names.len()
    }

    /// Name of a link.
    pub(super) fn name(&self, link: usize) -> &str {
        &self.names[link]
    }

    /// Place of a link that is there.
    pub(super) fn place(&self, name: &str) -> usize {
        self.index.get(name).copied().unwrap_or(self.root)
    }

    /// The joints whose parent a link is, and their children.
    pub(super) fn joints_behind(&self, link: usize) -> impl Iterator<Item = (usize, usize)> {
        let children = self.joint_to.iter().enumerate();
        children.filter_map(move |(child, joint)| {
            joint.filter(|of| self.parent[*of] == link).map(|of| (of, child))
        })
    }

    /// The joint whose child a link is, and its parent.
    pub(super) fn joint_before(&self, link: usize) -> Option<(usize, usize)> {
        self.joint_to[link].map(|joint| (joint, self.parent[joint]))
    }

    /// The joints from a link to another, in this order.
    pub(super) fn path(&self, base: &str, tip: &str) -> Checked<Vec<usize>> {
        let (base, tip) = (self.link(base)?, self.link(tip)?);
        self.joints_between(base, tip).ok_or_else(|| {
            let [from, to] = [base, tip].map(|link| &self.names[link]);
            let help = if self.joints_between(tip, base).is_some() {
                "exchange base and tip".to_owned()
            } else {
                format!("both are behind link `{}`: take it as the base", self.root())
            };
            InputError::new(
                Refusal::ChainUnknown,
                format!("no joints lead from link `{from}` to link `{to}`"),
                help,
            )
            .into()
        })
    }

    fn joints_between(&self, base: usize, tip: usize) -> Option<Vec<usize>> {
        let (mut link, mut joints) = (tip, Vec::new());
        while link != base {
            let joint = self.joint_to[link]?;
            joints.push(joint);
            link = self.parent[joint];
        }
        joints.reverse();
        Some(joints)
    }

    /// The only link behind this one that carries no other.
    pub(super) fn only_end(&self, base: &str) -> Checked<&str> {
        let base = self.link(base)?;
        let mut carries = vec![false; self.names.len()];
        self.parent.iter().for_each(|&link| carries[link] = true);
        let mut behind = vec![None; self.names.len()];
        behind[base] = Some(true);
        let is_end = |&link: &usize| !carries[link];
        let ends: Vec<usize> =
            (0..self.names.len()).filter(is_end).filter(|&link| self.is_behind(link, &mut behind)).collect();
        match ends.as_slice() {
            [one] => Ok(&self.names[*one]),
            many => {
                let names: Vec<&str> = many.iter().map(|&link| self.names[link].as_str()).collect();
                let message = format!("the machine has {} ends: {}", many.len(), listed(&names));
                let help = "name the one that carries the sensor as the tip";
                refuse(Refusal::ChainUnknown, message, help)
            }
        }
    }

    /// Whether a link is behind the base. `known` keeps the answers, so that each link is visited once.
    fn is_behind(&self, link: usize, known: &mut [Option<bool>]) -> bool {
        let (mut at, mut way) = (link, Vec::new());
        let answer = loop {
            if let Some(answer) = known[at] {
                break answer;
            }
            way.push(at);
            match self.joint_to[at] {
                Some(joint) => at = self.parent[joint],
                None => break false,
            }
        };
        way.into_iter().for_each(|link| known[link] = Some(answer));
        answer
    }

    fn link(&self, name: &str) -> Checked<usize> {
        self.index.get(name).copied().ok_or_else(|| {
            let message = format!("the machine has no link `{}`", shorten(name));
            InputError::new(Refusal::KeyUnknown, message, suggestion(name, &self.names)).into()
        })
    }
}

/// The link that may have been meant.
fn suggestion(name: &str, names: &[String]) -> String {
    let names = || names.iter().map(String::as_str);
    match nearest(name, names()) {
        Some(near) => format!("did you mean `{}`?", shorten(near)),
        None => format!("the links are {}", listed(&names().collect::<Vec<_>>())),
    }
}

/// The names in a sentence, the first of them where there are many.
fn listed(names: &[&str]) -> String {
    let shown: Vec<String> = names.iter().take(MOST_NAMES).map(|name| shorten(name)).collect();
    let more = if names.len() > MOST_NAMES { " …" } else { "" };
    shown.join(", ") + more
}
