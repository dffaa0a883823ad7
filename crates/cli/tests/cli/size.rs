//! Tests that the program stays small enough for a quick download.

/// Without the symbols that a release strips, the program takes some 10 MB less.
const MOST_BYTES: u64 = 80_000_000;

#[test]
fn the_program_is_not_larger_than_promised() {
    let program = std::fs::metadata(env!("CARGO_BIN_EXE_vertifleet")).expect("a file");
    assert!(program.len() <= MOST_BYTES, "{} bytes", program.len());
}
