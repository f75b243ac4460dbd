//! A diagnostic's subject (`gyroscope axis x`) and its named numbers, made of the fields of its check. Each type of a field implements [`Part`].

use super::numbers::Numbers;
use crate::sensor::{Axis, NonlinearTerm, ReadingUnit, SensorKind};
use nalgebra::Vector3;
use std::fmt::Display;

/// Subject and numbers of a diagnostic.
#[derive(Default)]
pub(super) struct Parts {
    pub(super) subject: Vec<String>,
    pub(super) numbers: Numbers,
}

/// Words that whoever finds something has for it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Phrase(pub String);

/// A field of a diagnostic, which adds to its subject or to its numbers.
pub(super) trait Part {
    /// Adds itself. `key`: the name of the field.
    fn add_to(&self, parts: &mut Parts, key: &'static str);
}

impl Part for f64 {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        parts.numbers.push((key, *self));
    }
}

impl Part for usize {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        parts.numbers.push((key, *self as f64));
    }
}

impl<T: Part> Part for Option<T> {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        self.iter().for_each(|part| part.add_to(parts, key));
    }
}

impl<T: Part> Part for Vec<T> {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        let mut own = Parts::default();
        self.iter().for_each(|part| part.add_to(&mut own, key));
        // a list has no single number
        if !own.subject.is_empty() {
            parts.subject.push(own.subject.join(", "));
        }
    }
}

impl Part for SensorKind {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.name().to_owned());
    }
}

impl Part for Axis {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(format!("axis {self}"));
    }
}

impl Part for NonlinearTerm {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.name().to_owned());
    }
}

/// A number for each axis: `x_shift_mps2`.
impl Part for Vector3<f64> {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        parts.numbers.extend(Axis::ALL.map(|axis| (format!("{axis}_{key}"), self[axis.index()])));
    }
}

/// Names of parameters.
impl Part for String {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.clone());
    }
}

/// Implements [`Part`] for types that add nothing.
macro_rules! neither {
    ($($kind:ty),*) => {
        $(impl $crate::diagnostic::parts::Part for $kind {
            fn add_to(&self, _: &mut $crate::diagnostic::parts::Parts, _: &'static str) {}
        })*
    };
}
pub(super) use neither;

neither!(bool, ReadingUnit, &'static str, [String; 3], Phrase);

/// The items in words, with this between them.
pub(super) fn listed(items: &[impl Display], between: &str) -> String {
    items.iter().map(ToString::to_string).collect::<Vec<_>>().join(between)
}
