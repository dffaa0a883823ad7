//! Where commands may write: every refusal with its code, and no write that loses a file.

use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

use vertifleet_core::{Coded, Error, FolderKind, OutputKind, Outputs, Scenario, check_output};
use vertifleet_core::{check_folder, replace_folder};

const SMALL: &str = include_str!("../data/small.json");
const NOTES: OutputKind = OutputKind { name: "note", skipped: 0, opening: "note: " };
const NOTEBOOK: FolderKind =
    FolderKind { name: "notebook", mark: ("first", &[NOTES]), holds: |name| name != "foreign" };

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn code(outcome: Result<(), Error>) -> u16 {
    outcome.map_or_else(|error| error.code().0, |()| 0)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn only_files_of_the_kind_that_is_written_are_replaced_unasked() {
    let folder = folder();
    let path = folder.path().join("file");
    let ask = |force| code(check_output(&path, &Scenario::FILE, force));
    assert_eq!(ask(false), 0, "nothing is there");
    for (contents, expected) in [
        ("", 0),
        (SMALL, 0),
        ("{", 143),
        ("{\n  \"format\": \"vertifleet-network/1\"", 143),
        ("name = \"mine\"", 143),
        (&SMALL[1..], 143),
    ] {
        fs::write(&path, contents).expect("a file");
        assert_eq!(ask(false), expected, "{contents:.20}");
        assert_eq!(ask(true), 0);
    }
    fs::write(&path, SMALL).expect("a file");
    let mut rights = fs::metadata(&path).expect("a file").permissions();
    rights.set_readonly(true);
    fs::set_permissions(&path, rights).expect("our own file");
    assert_eq!((ask(false), ask(true)), (144, 0));
}

#[test]
fn what_no_file_can_be_written_to_is_found_beforehand() {
    let folder = folder();
    assert_eq!(code(check_output(folder.path(), &NOTES, true)), 102, "a folder is in the way");
    let nowhere = folder.path().join("none/file");
    assert_eq!(code(check_output(&nowhere, &NOTES, true)), 102, "no such folder");
}

#[test]
fn an_output_that_is_an_input_is_refused_under_any_name_and_also_by_force() {
    let folder = folder();
    let input = folder.path().join("input");
    fs::write(&input, SMALL).expect("a file");
    let mut others = vec![input.clone(), folder.path().join("./input")];
    #[cfg(unix)]
    {
        let (soft, hard) = (folder.path().join("soft"), folder.path().join("hard"));
        std::os::unix::fs::symlink(&input, &soft).expect("a free name");
        fs::hard_link(&input, &hard).expect("a free name");
        others.extend([soft, hard]);
    }
    for other in others {
        let mut outputs = Outputs::new(true);
        outputs.reads(&input);
        assert_eq!(code(outputs.writes(&other, &Scenario::FILE)), 141, "{}", other.display());
        assert_eq!(code(outputs.replaces_folder(folder.path())), 141, "the input lies in it");
    }
    assert_eq!(fs::read_to_string(&input).expect("the file"), SMALL);
}

#[test]
fn two_outputs_in_one_file_are_refused_before_either_is_there() {
    let folder = folder();
    let mut outputs = Outputs::new(true);
    outputs.writes(&folder.path().join("one"), &NOTES).expect("a free name");
    outputs.writes(&folder.path().join("two"), &NOTES).expect("a free name");
    assert_eq!(code(outputs.writes(&folder.path().join("./one"), &NOTES)), 142);
}

#[cfg(unix)]
#[test]
fn what_is_no_plain_file_may_always_be_written_to() {
    let null = Path::new("/dev/null");
    let mut outputs = Outputs::new(false);
    outputs.reads(null);
    outputs.writes(null, &NOTES).expect("nothing is lost");
    outputs.writes(null, &NOTES).expect("not even twice");
}

fn files(text: &str) -> Vec<(String, Vec<u8>)> {
    ["first", "second"].map(|name| (name.to_owned(), format!("note: {text}").into_bytes())).into()
}

#[test]
fn a_folder_is_replaced_as_a_whole_and_leaves_nothing_next_to_it() {
    let folder = folder();
    let target = folder.path().join("above/book");
    replace_folder(&target, &NOTEBOOK, false, &files("one")).expect("a free name");
    fs::write(target.join("third"), "note: of an older version").expect("a file");
    replace_folder(&target, &NOTEBOOK, false, &files("two")).expect("a notebook");
    assert_eq!(names(&target), ["first", "second"], "nothing of the former is mixed in");
    assert_eq!(fs::read_to_string(target.join("first")).expect("a file"), "note: two");
    assert_eq!(names(&folder.path().join("above")), ["book"]);
}

#[test]
fn a_folder_of_others_is_kept_even_by_force() {
    let folder = folder();
    let target = folder.path().join("book");
    fs::create_dir(&target).expect("a free name");
    fs::write(target.join("foreign"), "dear").expect("a file");
    let ask = |force| code(check_folder(&target, &NOTEBOOK, force));
    assert_eq!((ask(false), ask(true)), (143, 0));
    let kept = replace_folder(&target, &NOTEBOOK, true, &files("one")).expect("by force");
    let kept = kept.expect("a name for what was there");
    assert_eq!(fs::read_to_string(kept.join("foreign")).expect("it is there"), "dear");
    assert_eq!(names(folder.path()), ["book", "book.old"]);
    assert_eq!(names(&target), ["first", "second"]);
}

#[test]
fn a_folder_that_cannot_be_written_is_as_it_was_before() {
    let folder = folder();
    let target = folder.path().join("book");
    replace_folder(&target, &NOTEBOOK, false, &files("one")).expect("a free name");
    let mut broken = files("two");
    broken.push(("no/such/folder".to_owned(), Vec::new()));
    assert_eq!(code(replace_folder(&target, &NOTEBOOK, false, &broken).map(|_| ())), 102);
    assert_eq!(fs::read_to_string(target.join("first")).expect("a file"), "note: one");
    let above = folder.path().join("new/book");
    assert_eq!(code(replace_folder(&above, &NOTEBOOK, false, &broken).map(|_| ())), 102);
    assert_eq!(names(folder.path()), ["book"], "nothing stays behind");
}

#[test]
fn the_end_of_the_process_waits_for_a_folder_to_be_whole() {
    let folder = folder();
    let target = folder.path().join("book");
    let end = vertifleet_core::block_writes();
    let at = target.clone();
    let writer = thread::spawn(move || replace_folder(&at, &NOTEBOOK, false, &files("one")));
    thread::sleep(Duration::from_millis(50));
    assert!(!target.exists() && !writer.is_finished(), "nothing is begun");
    drop(end);
    writer.join().expect("a thread").expect("a free name");
    assert_eq!(names(&target), ["first", "second"]);
}

#[test]
fn no_folder_takes_the_place_of_a_file_or_of_where_the_program_runs() {
    let folder = folder();
    let file = folder.path().join("file");
    fs::write(&file, "note: ").expect("a file");
    assert_eq!(code(check_folder(&file, &NOTEBOOK, true)), 102);
    assert_eq!(code(check_folder(Path::new("."), &NOTEBOOK, true)), 102);
}
