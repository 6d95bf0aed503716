//! Words that nobody can guess.

use crate::base::{Error, Result};
use rustix::rand::{GetRandomFlags, getrandom};

/// A word of 128 random bits, in hexadecimal.
///
/// # Errors
/// [`Error::Io`] when the system has no random numbers.
pub fn secret() -> Result<String> {
    let mut bytes = [0u8; 16];
    let failed = |e: rustix::io::Errno| Error::Io {
        action: "take random numbers from",
        path: "the system".into(),
        source: e.into(),
    };
    // As few bytes as these are never cut short.
    getrandom(&mut bytes[..], GetRandomFlags::empty()).map_err(failed)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn secrets_differ() {
        let [one, other] = [secret().unwrap(), secret().unwrap()];
        assert!(one != other && one.len() == 32 && one.bytes().all(|b| b.is_ascii_hexdigit()));
    }
}
