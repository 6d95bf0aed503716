//! `mirror`: the pressure is mirrored once in both end faces. No shear is left on the faces, and twice
//! the normal stress.

use super::end::End;

pub(super) fn end() -> End {
    End { image_weight: Some(1.0), freed: false, gamma: None }
}
