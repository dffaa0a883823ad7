//! The common format of weight files and checkpoints: safetensors with one JSON header and tensors
//! of 32-bit numbers.

use std::collections::HashMap;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::Serialize;
use serde_json::{Map, Value};

/// The name of the header among the file's metadata.
const HEADER: &str = "vertifleet";

/// The bytes of a file with this header and these tensors, each given by name, shape and entries.
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

/// The header of a file's bytes.
pub(crate) fn header(bytes: &[u8]) -> Result<Map<String, Value>, String> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).map_err(|error| error.to_string())?;
    let text = metadata.metadata().as_ref().and_then(|info| info.get(HEADER));
    let text = text.ok_or_else(|| format!("the file has no {HEADER:?} header"))?;
    serde_json::from_str(text).map_err(|error| format!("header: {error}"))
}

/// The entries of a tensor of 32-bit numbers.
pub(crate) fn entries<'a>(view: &TensorView<'a>) -> impl Iterator<Item = f32> + use<'a> {
    let chunks = view.data().chunks_exact(4);
    chunks.map(|bytes| f32::from_le_bytes(bytes.try_into().expect("chunks of four")))
}
