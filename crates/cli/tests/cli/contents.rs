//! The contents of a folder, to be compared before and after.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// All entries of a folder and the targets of its links; of a subfolder only its name.
pub(crate) fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.insert(path.clone(), Vec::new());
            found.extend(contents(&path));
        } else {
            // For a dangling link, its target.
            let bytes = fs::read(&path).or_else(|_| {
                fs::read_link(&path).map(|to| to.into_os_string().into_encoded_bytes())
            });
            let bytes = bytes.expect("a file or a link");
            found.insert(path, bytes);
        }
    }
    found
}
