//! The rectifier, in place.

/// Computes max(0, x).
pub(crate) fn forward(entries: &mut [f32]) {
    for entry in entries {
        *entry = entry.max(0.0);
    }
}

/// Keeps the slopes where the output is above 0, and sets the others to 0.
pub(crate) fn backward(outputs: &[f32], slopes: &mut [f32]) {
    debug_assert_eq!(outputs.len(), slopes.len());
    for (slope, output) in slopes.iter_mut().zip(outputs) {
        *slope = if *output > 0.0 { *slope } else { 0.0 };
    }
}
