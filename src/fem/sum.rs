use sha2::{Digest, Sha256};

/// The SHA-256 of a text, as `sha256sum` writes it.
pub(super) fn sha256(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}
