//! `half-space`: no correction. The body continues beyond its end face, which has no effect.

use super::end::End;

pub(super) fn end() -> End {
    End::ENDLESS
}
