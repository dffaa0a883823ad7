//! Writes the reference of commands from their help, and compares the page of the book with it.

use std::fmt::Write as _;
use std::fs;

use clap::{Arg, Command, CommandFactory as _};
use vertifleet_sim::check::Rule;

use super::Arguments;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/reference/commands.md");
const WRITES: &str = "a string can be written to";

#[test]
#[cfg_attr(not(feature = "service"), ignore = "the page contains the dispatch service")]
fn the_page_of_commands_is_made_of_the_help() {
    let mut program = Arguments::command();
    program.build();
    let page = fs::read_to_string(PAGE).expect("a page of the book");
    let (head, _) = page.split_once("\n## ").expect("a page that begins by hand");
    let mut made = format!("{head}\n## Every command\n\n{}", table(arguments(&program)));
    for command in commands(&program) {
        describe(command, "##", &mut made);
    }
    if std::env::var_os("VERTIFLEET_UPDATE").is_some() {
        fs::write(PAGE, &made).expect("a page that can be written");
        return;
    }
    assert!(page == made, "{PAGE} is not made of the help: run this test with VERTIFLEET_UPDATE=1");
}

/// The commands below this one.
fn commands(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|inner| inner.get_name() != "help" && !inner.is_hide_set())
}

/// Arguments of a command, without those of the commands above it.
fn arguments(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|argument| !argument.is_hide_set())
}

/// Adds the section of a command, and of those below it.
fn describe(command: &Command, level: &str, page: &mut String) {
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").lines().map(str::trim).collect::<Vec<_>>();
    let name = command.get_bin_name().expect("a built command");
    let about = command.get_long_about().or(command.get_about()).expect("help of each command");
    let usage = usage.join("\n    ");
    let mut about = marked(&about.to_string()).replacen("\n\n", ".\n\n", 1);
    if !about.ends_with('.') {
        about.push('.');
    }
    write!(page, "\n{level} {name}\n\n{about}\n\n    {usage}\n").expect(WRITES);
    let own = arguments(command).filter(|argument| {
        let is_of_the_program =
            matches!(argument.get_id().as_str(), "threads" | "help" | "version");
        !is_of_the_program && (level == "##" || !argument.is_global_set())
    });
    let table = table(own);
    if !table.is_empty() {
        write!(page, "\n{table}").expect(WRITES);
    }
    if name == "vertifleet check" {
        page.push_str("\n| rule | meaning |\n|---|---|\n");
        for rule in Rule::ALL {
            writeln!(page, "| `{rule}` | {} |", rule.meaning()).expect(WRITES);
        }
    }
    for inner in commands(command) {
        describe(inner, "###", page);
    }
}

/// A table of arguments, or nothing if there are none.
fn table<'a>(arguments: impl Iterator<Item = &'a Arg>) -> String {
    let rows =
        arguments.map(|argument| format!("| {} | {} |\n", names(argument), meaning(argument)));
    let rows: String = rows.collect();
    if rows.is_empty() { rows } else { format!("| argument | meaning |\n|---|---|\n{rows}") }
}

/// The argument as users write it: `` `-o`, `--output FILE` ``.
fn names(argument: &Arg) -> String {
    let takes_values = argument.get_action().takes_values();
    let values = argument.get_value_names().filter(|_| takes_values).unwrap_or_default().join(" ");
    let values = values.replace('|', "\\|");
    let short = argument.get_short().map(|short| format!("`-{short}`, ")).unwrap_or_default();
    match argument.get_long() {
        Some(long) => format!("{short}`{}`", format!("--{long} {values}").trim_end()),
        None => format!("`{values}`"),
    }
}

fn meaning(argument: &Arg) -> String {
    let help = argument.get_long_help().or(argument.get_help()).expect("help of each argument");
    let mut meaning = marked(&help.to_string()).replace("\n\n", ". ").replace(['\n', '|'], " ");
    let described = argument.get_possible_values().into_iter().filter_map(|value| {
        let help = marked(&value.get_help()?.to_string());
        Some(format!("<br>`{}`: {help}", value.get_name()))
    });
    meaning.extend(described);
    let defaults = argument.get_default_values().iter().filter_map(|value| value.to_str());
    let defaults = defaults.collect::<Vec<_>>().join(",");
    if argument.get_action().takes_values() && !defaults.is_empty() {
        write!(&mut meaning, " [default: {defaults}]").expect(WRITES);
    }
    meaning
}

/// A text of help in Markdown: words with characters that Markdown would interpret become code.
fn marked(text: &str) -> String {
    let word = |word: &str| {
        let inner = word.trim_matches(['(', ')', ',', ';', ':', '.']);
        let inner = if inner.contains('[') { inner } else { inner.trim_end_matches(']') };
        let is_code =
            inner.len() > 1 && (inner.starts_with("--") || inner.contains(['=', '*', '_']));
        if is_code || inner == "*" {
            word.replace(inner, &format!("`{inner}`"))
        } else {
            word.into()
        }
    };
    let paragraph = |text: &str| text.split(' ').map(word).collect::<Vec<String>>().join(" ");
    text.split("\n\n").map(paragraph).collect::<Vec<_>>().join("\n\n")
}
