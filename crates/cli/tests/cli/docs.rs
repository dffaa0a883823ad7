//! Compares the documentation with the code and the folders: the error index, the links, the
//! architecture page and the commands in the pages.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::{EvolutionSettings, ImitationSettings, TrainingSettings};

type Names = BTreeSet<String>;

fn root() -> PathBuf {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("crates/cli is in a folder");
    crates.parent().expect("crates is in a folder").to_owned()
}

fn text(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All files below a folder with names that end in `ending`.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of the project") {
        let path = entry.expect("an entry of a folder").path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.to_string_lossy().ends_with(ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The pages of the book, and the pages at the root of the project.
fn pages() -> Vec<PathBuf> {
    let mut pages = files(&root().join("docs/src"), ".md");
    pages.extend(
        ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "AGENTS.md"].map(|page| root().join(page)),
    );
    pages
}

/// The page without its fenced code blocks.
fn prose(page: &str) -> String {
    page.split("```").step_by(2).collect()
}

fn headings(page: &str) -> impl Iterator<Item = &str> {
    page.lines()
        .filter_map(|line| line.strip_prefix('#'))
        .map(|line| line.trim_start_matches('#').trim())
}

/// The three digits that `text` begins with, if there are exactly three.
fn code(text: &str) -> Option<&str> {
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    (digits == 3).then(|| &text[..3])
}

/// The codes directly after each occurrence of `before`.
fn codes_behind(text: &str, before: &str) -> Vec<String> {
    text.split(before).skip(1).filter_map(code).map(|digits| format!("V{digits}")).collect()
}

/// The entry of an error in the page of errors, from a comment `V104 title. Cause.`, an empty line
/// and `Fix: ...`.
fn entry(comment: &str) -> (String, String) {
    let complain =
        || panic!("not of the form `V104 title. Cause.`, empty line, `Fix: ...`: {comment}");
    let (cause, fix) = comment.split_once("\n\nFix: ").unwrap_or_else(complain);
    let (heading, cause) = cause.split_once(['.']).unwrap_or_else(complain);
    let heading = heading.replace('\n', " ");
    let mut fix = fix.trim_end().to_owned();
    fix[..1].make_ascii_uppercase();
    let cause = cause.trim_start();
    (heading[..4].to_owned(), format!("## {heading}\n\n**Cause.** {cause}\n\n**Fix.** {fix}\n"))
}

#[test]
fn the_page_of_errors_is_made_of_the_comments_in_the_code() {
    let (mut used, mut entries) = (Names::new(), BTreeMap::new());
    let folders = ["crates", "python/src"].map(|folder| root().join(folder));
    for source in folders.iter().flat_map(|folder| files(folder, ".rs")) {
        if source.components().all(|part| part.as_os_str() != "src") {
            continue;
        }
        let source = text(source);
        used.extend(codes_behind(&source, "Code("));
        for arms in source.split("Code(match").skip(1).filter_map(|rest| rest.split("})").next()) {
            used.extend(codes_behind(arms, "=> "));
        }
        let lines = source.lines().map(|line| line.trim_start().strip_prefix("///"));
        for comment in lines.collect::<Vec<_>>().split(Option::is_none) {
            let lines = comment.iter().flatten().map(|line| line.strip_prefix(' ').unwrap_or(line));
            let comment = lines.collect::<Vec<_>>().join("\n");
            if comment.strip_prefix('V').and_then(code).is_some() {
                let (code, entry) = entry(&comment);
                assert!(entries.insert(code.clone(), entry).is_none(), "two comments of {code}");
            }
        }
    }
    assert!(used.len() > 100, "the sources still write their codes in a way that this test finds");
    assert_eq!(
        used,
        entries.keys().cloned().collect(),
        "each code has a comment, and each comment a code"
    );
    let path = "docs/src/reference/errors.md";
    let page = text(path);
    let (head, _) = page.split_once("\n## V").expect("a page that begins by hand");
    let entries: Vec<&str> = entries.values().map(String::as_str).collect();
    let made = format!("{head}\n{}", entries.join("\n"));
    if std::env::var_os("VERTIFLEET_UPDATE").is_some() {
        fs::write(root().join(path), &made).expect("a page that can be written");
    }
    assert!(
        page == made,
        "{path} is not made of the comments: run this test with VERTIFLEET_UPDATE=1"
    );
}

#[test]
fn every_link_leads_somewhere() {
    let book = root().join("docs/src").canonicalize().expect("the folder of the book");
    for page in pages() {
        let folder = page.parent().expect("a page is in a folder");
        for target in prose(&text(&page)).split("](").skip(1) {
            let target = target.split(')').next().expect("split gives at least one part");
            if target.starts_with("https://") {
                continue;
            }
            let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
            let file = if path.is_empty() { page.clone() } else { folder.join(path) };
            assert!(file.exists(), "{}: nothing at {target}", page.display());
            let file = file.canonicalize().expect("a file that exists");
            let leaves_the_book = page.starts_with(&book) && !file.starts_with(&book);
            assert!(!leaves_the_book, "{}: leaves the book: {target}", page.display());
            let leads =
                anchor.is_empty() || headings(&text(&file)).any(|heading| slug(heading) == anchor);
            assert!(leads, "{}: no such heading: {target}", page.display());
        }
    }
}

/// The anchor that mdBook gives a heading.
fn slug(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

#[test]
fn the_summary_lists_every_page() {
    let book = root().join("docs/src");
    let summary = text("docs/src/SUMMARY.md");
    let listed = summary.split("](").skip(1).filter_map(|target| target.split(')').next());
    let listed: Names = listed.map(str::to_owned).collect();
    let pages = files(&book, ".md").into_iter().map(|page| {
        page.strip_prefix(&book).expect("a page of the book").to_string_lossy().replace('\\', "/")
    });
    assert_eq!(listed, pages.filter(|page| page != "SUMMARY.md").collect());
}

#[test]
fn the_architecture_page_names_every_crate_and_every_dependency() {
    let page = text("docs/src/architecture.md");
    for entry in fs::read_dir(root().join("crates")).expect("the folder of crates") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        assert!(page.contains(&format!("| `crates/{name}` |")), "crates/{name} has no row");
    }
    let (_, tables) = page.split_once("## Dependencies").expect("a section on dependencies");
    let tables = tables.split("\n## ").next().expect("the section");
    let rows = tables.lines().filter(|line| line.starts_with("| `"));
    let named: Names = rows
        .flat_map(|row| row.split('|').nth(1).expect("a first cell").split('`').skip(1).step_by(2))
        .map(str::to_owned)
        .collect();
    let manifest = text("Cargo.toml");
    let (_, section) = manifest.split_once("[workspace.dependencies]").expect("a section");
    let lines = section.lines().take_while(|line| !line.starts_with('['));
    let asked = lines.filter_map(|line| line.split_once(" = ")).map(|(name, _)| name.to_owned());
    assert_eq!(named, asked.filter(|name| !name.starts_with('#')).collect());
}

#[test]
fn the_architecture_page_names_every_package_of_the_console() {
    let page = text("docs/src/architecture.md");
    let (_, section) = page.split_once("## The console").expect("a section on the console");
    let section = section.split("\n## ").next().expect("the section");
    let tables = section.split("| package |").skip(1);
    let rows = tables.flat_map(str::lines).filter(|line| line.starts_with("| `"));
    let named: Names = rows
        .flat_map(|row| row.split('|').nth(1).expect("a first cell").split('`').skip(1).step_by(2))
        .map(str::to_owned)
        .collect();
    let manifest: serde_json::Value =
        serde_json::from_str(&text("web/package.json")).expect("a manifest");
    let kinds = ["dependencies", "devDependencies"].map(|kind| manifest[kind].as_object());
    let asked = kinds.into_iter().flat_map(|kind| kind.expect("an object").keys().cloned());
    assert_eq!(named, asked.collect());
}

/// The long flags in a text, which are the words that begin with two dashes.
fn long_flags(text: &str) -> Names {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
    words.filter(|word| word.len() > 2 && word.starts_with("--")).map(str::to_owned).collect()
}

/// The commands of the reference with their flags, the longest names first.
fn commands() -> Vec<(String, Names)> {
    let page = text("docs/src/reference/commands.md");
    let (_, sections) = page.split_once("\n## Every command\n").expect("a section of that name");
    let (everywhere, sections) = sections.split_once("\n## ").expect("sections of commands");
    let everywhere = flags_in_section(everywhere);
    let mut commands = Vec::new();
    for section in sections.split("\n## ") {
        // The flags of `serve` that its inner commands take too are listed once.
        let outer = &flags_in_section(section.split("\n### ").next().unwrap_or("")) | &everywhere;
        for section in section.split("\n### ") {
            let (command, section) = section.split_once('\n').expect("a heading");
            commands.push((format!("{command} "), &flags_in_section(section) | &outer));
        }
    }
    commands.sort_by_key(|(command, _)| std::cmp::Reverse(command.len()));
    commands
}

/// The flags that a section's table lists.
fn flags_in_section(section: &str) -> Names {
    let rows = section.lines().filter(|line| line.starts_with("| `-"));
    rows.flat_map(|row| long_flags(row.split('|').nth(1).expect("a first cell"))).collect()
}

#[test]
fn commands_in_the_pages_use_flags_that_exist() {
    let commands = commands();
    for page in pages() {
        let page_text = text(&page).replace("\\\n", " ");
        for line in page_text.lines().filter(|line| !line.starts_with('|')) {
            let used = commands.iter().find_map(|(command, known)| {
                line.split_once(command.as_str()).map(|(_, rest)| (long_flags(rest), known))
            });
            if let Some((used, known)) = used {
                assert!(used.is_subset(known), "{}: {line}", page.display());
            }
        }
    }
}

/// Whether a table cell of the training page states the value of a setting.
fn says(cell: &str, value: &Value) -> bool {
    match (value.as_f64(), cell.trim().replace(',', "").parse::<f64>()) {
        (Some(value), Ok(written)) => (value - written).abs() <= 1e-6 * written.abs(),
        _ => value.as_str().is_some_and(|word| cell.trim() == format!("`{word}`")),
    }
}

#[test]
fn the_training_page_lists_every_setting_of_both_presets() {
    let policy = Architecture::named("gcaps").expect("a policy with sizes");
    let preset = |name| {
        let settings = TrainingSettings::preset(&policy, name).expect("a preset");
        serde_json::to_value(settings).expect("plain data")
    };
    let (paper, default) = (preset("paper"), preset("default"));
    let page = text("docs/src/concepts/training.md");
    for (name, value) in paper.as_object().expect("settings have names") {
        let row = page.lines().find(|line| line.starts_with(&format!("| `{name}` | ")));
        let cells: Vec<&str> =
            row.unwrap_or_else(|| panic!("{name} is not listed")).split('|').collect();
        assert!(says(cells[2], value), "{name} of paper is {value}");
        assert!(says(cells[3], &default[name]), "{name} of default is {}", default[name]);
    }
}

#[test]
fn the_training_page_lists_every_setting_of_gcaps_x() {
    a_section_lists_every_setting("gcaps-x", &ImitationSettings::default());
}

#[test]
fn the_training_page_lists_every_setting_of_evolution() {
    a_section_lists_every_setting("Evolution", &EvolutionSettings::default());
}

fn a_section_lists_every_setting(title: &str, settings: &impl serde::Serialize) {
    let settings = serde_json::to_value(settings).expect("plain data");
    let page = text("docs/src/concepts/training.md");
    let (_, section) = page.split_once(&format!("\n## {title}\n")).expect("a section on it");
    for (name, value) in settings.as_object().expect("settings have names") {
        let row = section.lines().find(|line| line.starts_with(&format!("| `{name}` | ")));
        let cells: Vec<&str> =
            row.unwrap_or_else(|| panic!("{name} is not listed")).split('|').collect();
        assert!(says(cells[2], value), "{name} is {value}");
    }
}
