//! `quarter-space`: both end faces free of traction, by Hetenyi's process in closed matrix form.

use super::end::End;

pub(super) fn end() -> End {
    End { image_weight: Some(1.0), freed: true, gamma: None }
}
