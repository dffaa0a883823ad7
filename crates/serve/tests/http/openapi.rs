//! The description of the API in the book equals the one that the service returns.
//!
//! `VERTIFLEET_UPDATE=1 cargo t -p vertifleet-serve --test http openapi` writes it again.

use std::path::Path;

#[test]
fn the_book_has_the_description_that_the_service_gives() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/reference/openapi.json");
    let given = vertifleet_serve::openapi();
    if std::env::var_os("VERTIFLEET_UPDATE").is_some() {
        std::fs::write(&path, &given).expect("the book can be written");
    }
    let written = std::fs::read_to_string(&path).expect("the book has it");
    assert!(
        given == written,
        "openapi.json differs; the first lines of this test give the command that writes it"
    );
}
