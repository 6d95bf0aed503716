//! `mirror`: the pressure is mirrored once in both end faces. The shear stress on the faces
//! vanishes, and the normal stress doubles.

use super::end::End;

pub(super) fn end() -> End {
    End { image_weight: Some(1.0), freed: false, gamma: None }
}
