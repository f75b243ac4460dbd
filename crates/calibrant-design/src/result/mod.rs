//! What a design gives: motions, covariances, the certificate in words, and the assessment of a motion of the user.

pub(crate) mod certificate_words;
pub(crate) mod design;
pub(crate) mod evaluate;
pub(crate) mod motion_assessment;
