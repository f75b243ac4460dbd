//! What a check is, and how its one entry is written.
//!
//! An entry has everything about a check but the mathematics that decides:
//!
//! ```text
//! checks! {
//!     /// A hold is not used.                        the meaning, which is also the documentation of the type
//!     HoldLeftOut "hold-left-out" Warning {          its type, its code, how much it matters
//!         hold: HoldSpan,                            what was found: subject and numbers of the diagnostic are made of it;
//!                                                    documented here, or in `about!` where its name says what it is
//!     }
//!     decided "The accelerometer saturates in it."
//!     remedy "Look at the hold in the report."       left away where there is nothing to do
//!     says format!("{hold} is not used");            the sentence, made of references to the fields
//! }
//! ```
//!
//! A sentence starts with a small letter, since `warning:` or the name of a file stands before it.

use super::code::Code;
use super::value::Diagnostic;

/// What a check found: the fields of its type. It becomes a [`Diagnostic`].
pub trait Check {
    /// Its code.
    const CODE: Code;

    /// The diagnostic, with its subject, its numbers and its sentence.
    fn diagnostic(&self) -> Diagnostic;
}

impl<C: Check> From<C> for Diagnostic {
    fn from(found: C) -> Self {
        found.diagnostic()
    }
}

/// The entries of the checks of an area, and the list of their codes.
macro_rules! checks {
    ($(
        $(#[doc = $meaning:literal])+
        $check:ident $name:literal $severity:ident {
            $($(#[doc = $about:literal])* $field:ident: $kind:ty,)*
        }
        decided $decided:literal
        $(remedy $remedy:literal)?
        says $says:expr;
    )*) => {
        $(
            $(#[doc = $meaning])+
            #[derive(Debug, Clone, PartialEq)]
            pub struct $check {
                $(#[doc = $crate::diagnostic::check::about!($field $($about)*)] pub $field: $kind,)*
            }

            impl $crate::diagnostic::check::Check for $check {
                const CODE: $crate::diagnostic::code::Code =
                    $crate::diagnostic::code::Code::new(&$crate::diagnostic::code::CodeEntry {
                        name: $name,
                        severity: $crate::diagnostic::severity::Severity::$severity,
                        meaning: concat!($($meaning),+).trim_ascii_start(),
                        decided: $decided,
                        remedy: $crate::diagnostic::check::remedy!($($remedy)?),
                    });

                #[allow(unused_mut)]
                fn diagnostic(&self) -> $crate::diagnostic::value::Diagnostic {
                    let Self { $($field),* } = self;
                    let mut parts = $crate::diagnostic::parts::Parts::default();
                    $($crate::diagnostic::parts::Part::add_to($field, &mut parts, stringify!($field));)*
                    $crate::diagnostic::value::Diagnostic::new(Self::CODE, parts, String::from($says))
                }
            }
        )*

        /// The codes of this area.
        pub(super) const CODES: &[$crate::diagnostic::code::Code] =
            &[$(<$check as $crate::diagnostic::check::Check>::CODE),*];
    };
}
pub(super) use checks;

/// What a field is: its own documentation, or that of all fields of its name.
macro_rules! about {
    (sensor_kind) => { "The sensor." };
    (axis) => { "The axis." };
    (unit) => { "Unit of the readings." };
    (hold) => { "The hold." };
    (parameters) => { "The parameters." };
    (chi2) => { "χ²." };
    (why) => { "Why." };
    ($field:ident $($about:literal)+) => { concat!($($about, "\n"),+) };
}
pub(super) use about;

/// What to do, where an entry says it.
macro_rules! remedy {
    () => {
        "Nothing."
    };
    ($remedy:literal) => {
        $remedy
    };
}
pub(super) use remedy;
