//! The parameters of a batch by their sensor: each sensor has a figure of its own.

use crate::batch::Batch;
use crate::number_format::capitalised;

pub(super) struct Group<'a> {
    /// Its name with a capital letter: `Accelerometer`.
    pub(super) name: String,
    prefix: &'a str,
    /// Places in the parameters of the batch.
    pub(super) members: Vec<usize>,
}

/// The sensors in the order of the parameters. Parameters that no sensor of the batch has are left out.
pub(super) fn groups(batch: &Batch) -> Vec<Group<'_>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for (place, parameter) in batch.parameters.iter().enumerate() {
        if batch.sensors.iter().all(|sensor| sensor.estimate(place).is_none()) {
            continue;
        }
        let prefix = parameter.name.split_once('.').map_or("", |(prefix, _)| prefix);
        match groups.iter_mut().find(|group| group.prefix == prefix) {
            Some(group) => group.members.push(place),
            None => {
                let name = capitalised(prefix);
                groups.push(Group { name, prefix, members: vec![place] });
            }
        }
    }
    groups
}
