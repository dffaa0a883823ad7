//! What weight files and checkpoints have in common: safetensors with one JSON header and tensors of 32-bit numbers.

use std::collections::HashMap;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The header's name among the file's metadata.
const HEADER: &str = "vertifleet";

/// The bytes of a file with this header and these tensors: name, shape, entries.
pub(crate) fn to_bytes<'a>(
    header: &impl Serialize,
    tensors: impl IntoIterator<Item = (&'a str, Vec<usize>, &'a [f32])>,
) -> Vec<u8> {
    let header = serde_json::to_string(header).expect("a header is plain data");
    let tensors = tensors.into_iter().map(|(name, shape, entries)| {
        let view = TensorView::new(Dtype::F32, shape, bytemuck::cast_slice(entries))
            .expect("a shape agrees with its entries");
        (name, view)
    });
    let info = HashMap::from([(HEADER.to_owned(), header)]);
    safetensors::serialize(tensors, Some(info)).expect("named tensors of numbers are valid")
}

/// The format that a file's header states, if it has a header that states any.
pub(crate) fn format(bytes: &[u8]) -> Option<String> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).ok()?;
    let text = metadata.metadata().as_ref()?.get(HEADER)?;
    let header: serde_json::Value = serde_json::from_str(text).ok()?;
    Some(header.get("format")?.as_str()?.to_owned())
}

/// The header of a file's bytes, which must be of `format`; `format_of` says what a header states.
pub(crate) fn header<H: DeserializeOwned>(
    bytes: &[u8],
    format: &str,
    format_of: impl Fn(&H) -> &str,
) -> Result<H, String> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).map_err(|error| error.to_string())?;
    let text = metadata.metadata().as_ref().and_then(|info| info.get(HEADER));
    let text = text.ok_or_else(|| format!("the file has no {HEADER:?} header"))?;
    let header: H = serde_json::from_str(text).map_err(|error| format!("header: {error}"))?;
    let found = format_of(&header);
    if found != format {
        return Err(format!("format must be {format:?}, found {found:?}"));
    }
    Ok(header)
}

/// The entries of a tensor of 32-bit numbers.
pub(crate) fn entries<'a>(view: &TensorView<'a>) -> impl Iterator<Item = f32> + use<'a> {
    let chunks = view.data().chunks_exact(4);
    chunks.map(|bytes| f32::from_le_bytes(bytes.try_into().expect("chunks of four")))
}
