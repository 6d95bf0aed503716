//! `half-space`: no correction. The body goes on behind its end face, and the face is not seen.

use super::end::End;

pub(super) fn end() -> End {
    End::ENDLESS
}
