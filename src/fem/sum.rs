use sha2::{Digest, Sha256};
use std::fs::File;
use std::io;
use std::path::Path;

/// The SHA-256 of a text, as `sha256sum` writes it.
pub(super) fn sha256(text: &str) -> String {
    hex(&Sha256::digest(text))
}

/// The same of a file, of whatever size.
///
/// # Errors
/// The system's, when it cannot be read.
pub(super) fn sha256_of(path: &Path) -> io::Result<String> {
    let mut sum = Sha256::new();
    io::copy(&mut File::open(path)?, &mut sum)?;
    Ok(hex(&sum.finalize()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
