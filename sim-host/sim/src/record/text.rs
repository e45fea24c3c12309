//! From bytes to numbered lines.

use super::error::RecordError;

/// Control-Z, which old editors put at the end of a text file.
const DOS_END_OF_FILE: u8 = 0x1a;

/// The text of a file: UTF-8 as it is, anything else taken as Latin-1, which some agencies use in headers.
///
/// # Errors
///
/// [`RecordError::Binary`] for control bytes that no text has, NUL among them (so UTF-16 is refused as well).
pub(super) fn decode(name: &str, bytes: &[u8]) -> Result<String, RecordError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = bytes.iter().rposition(|byte| *byte != DOS_END_OF_FILE).map_or(0, |last| last + 1);
    let bytes = &bytes[..end];
    let control = |byte: u8| byte < 0x20 && !matches!(byte, b'\t' | b'\n' | b'\r' | 0x0c);
    if let Some(at) = bytes.iter().position(|byte| control(*byte)) {
        let line = 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count();
        return Err(RecordError::Binary { file: name.to_owned(), line, byte: bytes[at] });
    }
    Ok(match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    })
}

/// What stands behind the marks of a comment, if the line is one.
pub(super) fn comment(line: &str) -> Option<&str> {
    let plain = line.trim_start();
    let text = plain.trim_start_matches(['#', '%', '!', '*', '/', '|']);
    (text.len() < plain.len()).then_some(text)
}

/// The lines of a text without their ends: `\n`, `\r\n`, or `\r` as of old machines, also where a file has several kinds.
pub(super) fn lines(text: &str) -> Vec<&str> {
    text.split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_every_kind_is_decoded() {
        assert_eq!(decode("f", b"\xef\xbb\xbf1\n2\x1a").unwrap(), "1\n2");
        assert_eq!(decode("f", b"D\xfczce").unwrap(), "Düzce");
        assert_eq!(decode("f", "Düzce".as_bytes()).unwrap(), "Düzce");
        assert_eq!(lines("a\r\nb\n"), ["a", "b", ""]);
        assert_eq!(lines("a\rb"), ["a", "b"]);
        assert_eq!(lines("a\rb\r\nc\r\r\nd\ne"), ["a", "b", "c", "d", "e"]);
    }

    #[test]
    fn binary_is_refused_with_its_line() {
        let message = decode("f", b"1\n2\x003").unwrap_err().to_string();
        assert_eq!(message, "f: line 2: byte 0x00 is not text; records are read from plain text (ASCII, UTF-8 or Latin-1)");
    }
}
