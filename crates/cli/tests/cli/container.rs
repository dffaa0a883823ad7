//! Checks that the container image copies every file of this tree that the build needs.

use std::fs;
use std::path::Path;

/// The source files of a folder and its subfolders, except files of tests.
fn files(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs")
            && !path.ends_with("tests.rs")
        {
            found.push(fs::read_to_string(&path).expect("a source file"));
        }
    }
}

#[test]
fn the_container_is_built_from_all_that_the_program_has_within_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let recipe = fs::read_to_string(root.join("packaging/service/Containerfile")).expect("a file");
    let copied: Vec<&str> = recipe
        .lines()
        .filter_map(|line| line.strip_prefix("COPY ")?.rsplit_once(' '))
        .flat_map(|(from, _)| from.split(' '))
        .collect();
    let mut sources = Vec::new();
    for package in fs::read_dir(root.join("crates")).expect("the crates") {
        files(&package.expect("an entry").path().join("src"), &mut sources);
    }
    // Files that are compiled in are named relative to the source file, by paths that lead out of
    // the crate into a folder here.
    let without_tests = sources.iter().filter_map(|source| source.split("#[cfg(test)]").next());
    let paths = without_tests.flat_map(|source| source.split('"').skip(1).step_by(2));
    let paths = paths.filter(|path| path.starts_with("../")).map(|path| path.replace("../", ""));
    let outside: Vec<String> = paths.filter(|path| root.join(path).exists()).collect();
    assert!(outside.iter().any(|path| path == "web/dist/replay.html"), "{outside:?}");
    for path in outside {
        let is_copied = copied.iter().any(|from| Path::new(&path).starts_with(from));
        assert!(is_copied, "{path} is not copied into the image");
    }
}
