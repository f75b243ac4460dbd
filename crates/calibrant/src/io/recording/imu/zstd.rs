//! Zstandard for the chunks of MCAP containers, without a C compiler.

use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use mcap::{McapError, McapResult};
use ruzstd::decoding::FrameDecoder;

/// A decoder of chunks.
#[derive(Default)]
pub(super) struct Zstd {
    decoder: FrameDecoder,
}

impl Decompressor for Zstd {
    fn next_read_size(&self) -> usize {
        0
    }

    fn decompress(&mut self, src: &[u8], dst: &mut [u8]) -> McapResult<DecompressResult> {
        let failed = |error: ruzstd::decoding::errors::FrameDecoderError| {
            McapError::DecompressionError(format!("zstd: {error}"))
        };
        let (consumed, wrote) = self.decoder.decode_from_to(src, dst).map_err(failed)?;
        Ok(DecompressResult { consumed, wrote })
    }

    fn reset(&mut self) -> McapResult<()> {
        self.decoder = FrameDecoder::default();
        Ok(())
    }

    fn name(&self) -> &'static str {
        "zstd"
    }
}
