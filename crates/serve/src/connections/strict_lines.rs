//! Requires CR LF at the end of lines. The HTTP parser also accepts a bare LF (RFC 9112, 2.2,
//! permits it), which a proxy may interpret differently, so that one request could hide in another.
//! Here a bare LF in a head becomes a NUL, which the parser refuses with 400.

use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

/// Bytes of a header line that are inspected to find the length of the body.
const INSPECTED: usize = 256;

/// A connection whose heads have strict lines.
#[derive(Debug)]
pub(super) struct StrictLines<S> {
    stream: S,
    part: Part,
}

/// The part of a request that comes next.
#[derive(Debug)]
enum Part {
    Head(Head),
    /// The remaining bytes of a body, or of a chunk with the end of its line.
    Bytes {
        left: u64,
        is_chunk: bool,
    },
    /// The line before a chunk, with the size so far.
    ChunkSize {
        size: u64,
        is_read: bool,
        latest: u8,
    },
    /// Lines after the last chunk.
    Trailer {
        is_empty: bool,
        latest: u8,
    },
}

/// The lines of a head so far.
#[derive(Debug, Default)]
struct Head {
    line: Vec<u8>,
    latest: u8,
    has_begun: bool,
    length: u64,
    is_chunked: bool,
}

impl Head {
    /// Processes the next byte. Returns the part after the head once it ends.
    fn take(&mut self, byte: &mut u8) -> Option<Part> {
        if *byte != b'\n' {
            self.latest = *byte;
            if *byte != b'\r' && self.line.len() < INSPECTED {
                self.line.push(*byte);
            }
            return None;
        }
        if std::mem::take(&mut self.latest) != b'\r' {
            *byte = 0;
            return None;
        }
        if self.line.is_empty() {
            // Empty lines before a request are not a part of it.
            return self.has_begun.then(|| self.body());
        }
        self.has_begun = true;
        if !self.note_header() {
            *byte = 0;
        }
        self.line.clear();
        None
    }

    /// Records the length of the body if a header contains it. Returns false if the value is
    /// invalid or too long to inspect; the parser must then refuse the request.
    fn note_header(&mut self) -> bool {
        let Some(colon) = self.line.iter().position(|byte| *byte == b':') else { return true };
        let (name, value) = (&self.line[..colon], self.line[colon + 1..].trim_ascii());
        let is_whole = self.line.len() < INSPECTED;
        if name.eq_ignore_ascii_case(b"content-length") {
            // `parse` accepts a sign, which the parser refuses.
            let length = std::str::from_utf8(value).ok().and_then(|digits| digits.parse().ok());
            self.length = length.unwrap_or_default();
            return is_whole && length.is_some();
        }
        if name.eq_ignore_ascii_case(b"transfer-encoding") {
            self.is_chunked = value.to_ascii_lowercase().ends_with(b"chunked");
            return is_whole;
        }
        true
    }

    fn body(&self) -> Part {
        match (self.is_chunked, self.length) {
            (true, _) => Part::CHUNK,
            (false, 0) => Part::head(),
            (false, left) => Part::Bytes { left, is_chunk: false },
        }
    }
}

impl Part {
    const CHUNK: Self = Self::ChunkSize { size: 0, is_read: false, latest: 0 };

    fn head() -> Self {
        Self::Head(Head::default())
    }

    /// Processes bytes from the front. Returns their number.
    fn take(&mut self, bytes: &mut [u8]) -> usize {
        let next = match self {
            Self::Head(head) => head.take(&mut bytes[0]),
            Self::Bytes { left, is_chunk } => {
                let taken = bytes.len().min(usize::try_from(*left).unwrap_or(usize::MAX));
                *left -= taken as u64;
                if *left == 0 {
                    *self = if *is_chunk { Self::CHUNK } else { Self::head() };
                }
                return taken;
            }
            Self::ChunkSize { latest, .. } | Self::Trailer { latest, .. }
                if bytes[0] == b'\n' && *latest != b'\r' =>
            {
                bytes[0] = 0;
                None
            }
            Self::ChunkSize { size: 0, .. } if bytes[0] == b'\n' => {
                Some(Self::Trailer { is_empty: true, latest: 0 })
            }
            Self::ChunkSize { size, .. } if bytes[0] == b'\n' => {
                Some(Self::Bytes { left: size.saturating_add(2), is_chunk: true })
            }
            Self::ChunkSize { size, is_read, latest } => {
                *latest = bytes[0];
                match char::from(bytes[0]).to_digit(16) {
                    Some(digit) if !*is_read => {
                        *size = size.saturating_mul(16).saturating_add(digit.into());
                    }
                    // Extensions follow the size.
                    _ => *is_read = true,
                }
                None
            }
            Self::Trailer { is_empty: true, .. } if bytes[0] == b'\n' => Some(Self::head()),
            Self::Trailer { is_empty, latest } => {
                *latest = bytes[0];
                *is_empty = bytes[0] == b'\n' || (*is_empty && bytes[0] == b'\r');
                None
            }
        };
        if let Some(next) = next {
            *self = next;
        }
        1
    }
}

impl<S> StrictLines<S> {
    pub(super) fn new(stream: S) -> Self {
        Self { stream, part: Part::head() }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for StrictLines<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        ready!(Pin::new(&mut self.stream).poll_read(context, buffer))?;
        let mut fresh = &mut buffer.filled_mut()[before..];
        while !fresh.is_empty() {
            let taken = self.part.take(fresh);
            fresh = &mut fresh[taken..];
        }
        Poll::Ready(Ok(()))
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for StrictLines<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        pieces: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write_vectored(context, pieces)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::AsyncReadExt as _;

    use super::StrictLines;

    /// The parser's input if bytes arrive in pieces of a length.
    async fn read(bytes: &[u8], piece: usize) -> Vec<u8> {
        let mut stream = StrictLines::new(bytes);
        let (mut read, mut buffer) = (Vec::new(), vec![0; piece]);
        loop {
            let length = stream.read(&mut buffer).await.expect("it is in memory");
            if length == 0 {
                return read;
            }
            read.extend_from_slice(&buffer[..length]);
        }
    }

    #[tokio::test]
    async fn bare_lines_in_heads_become_nul_and_bodies_stay_as_they_are() {
        let sized = "POST /a HTTP/1.1\r\nContent-Length: 6\r\n\r\na\nb\n\r\n";
        let chunked = "POST /b HTTP/1.1\r\ntransfer-encoding: gzip, Chunked\r\n\r\n3;x=1\r\n\n\n\n\r\nA\r\n0123\n56789\r\n0\r\nX: 1\r\n\r\n";
        let plain = "\r\nGET /c HTTP/1.1\r\nHost: a\r\n\r\n";
        let good = [sized, chunked, plain, sized, plain, chunked, plain].concat();
        let bare = "GET /d HTTP/1.1\nHost: a\r\nX: 1\n\r\n\n";
        for piece in [1, 2, 3, 7, 1_000] {
            assert_eq!(read(good.as_bytes(), piece).await, good.as_bytes(), "pieces of {piece}");
            let sent = good.clone() + bare;
            let refused = good.clone() + &bare.replace("1\n", "1\0").replace("\r\n\n", "\r\n\0");
            assert_eq!(read(sent.as_bytes(), piece).await, refused.as_bytes(), "pieces of {piece}");
        }
    }

    #[tokio::test]
    async fn a_length_that_the_parser_could_read_otherwise_is_spoilt() {
        let blanks = " ".repeat(300);
        for length in [
            format!("Content-Length:{blanks}6"),
            "Content-Length: +6".to_owned(),
            format!("Transfer-Encoding:{blanks}chunked"),
        ] {
            let sent = format!("POST / HTTP/1.1\r\n{length}\r\n\r\n");
            let spoilt = sent.replace(&format!("{length}\r\n"), &format!("{length}\r\0"));
            if length.contains('+') {
                // The parser also refuses it.
                assert_eq!(read(sent.as_bytes(), 9).await, sent.as_bytes());
            } else {
                assert_eq!(read(sent.as_bytes(), 9).await, spoilt.as_bytes());
            }
        }
        let trailer = "POST / HTTP/1.1\r\ntransfer-encoding: chunked\r\n\r\n0\r\nX: 1\n\r\nA: b\r\n\r\nGET / HTTP/1.1\n";
        let spoilt = trailer.replace("1\n\r\nA", "1\0\r\nA").replace("1.1\n", "1.1\0");
        assert_eq!(read(trailer.as_bytes(), 5).await, spoilt.as_bytes());
    }
}
