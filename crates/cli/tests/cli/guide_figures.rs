//! Compares the figures of the guides "Your first hour" and "A day of operations" with the
//! program's output.

use std::fs;
use std::path::Path;
use std::process::Command;

use assert_cmd::cargo::cargo_bin;
use serde_json::{Deserializer, Value, json};

use crate::common::{folder, run, shipped};
use crate::service::Service;

fn page(name: &str) -> String {
    fs::read_to_string(shipped("docs/src/guide").join(name)).expect("it is there")
}

/// The words of a line without durations, which differ from run to run.
fn words(line: &str) -> Vec<&str> {
    let all: Vec<&str> = line.split_whitespace().collect();
    let is_unit =
        |at: usize| all.get(at).is_some_and(|word| ["ns", "µs", "ms", "s"].contains(word));
    let is_duration =
        |at: usize| is_unit(at) || (is_unit(at + 1) && all[at].parse::<f64>().is_ok());
    (0..all.len()).filter(|at| !is_duration(*at)).map(|at| all[at]).collect()
}

/// The lines of a page's block that the program does not print. `...` stands for lines or words
/// that are left out.
fn missing<'a>(block: &'a str, output: &str) -> Vec<&'a str> {
    let printed: Vec<Vec<&str>> = output.lines().map(words).collect();
    let is_printed = |line: &str| {
        let mut shown = words(line);
        let is_cut = shown.last() == Some(&"...");
        shown.truncate(shown.len() - usize::from(is_cut));
        printed.iter().any(|words| if is_cut { words.starts_with(&shown) } else { *words == shown })
    };
    // The lines under the heads of tables are as wide as the durations in them.
    let is_rule = |line: &str| line.chars().all(|mark| mark == '-');
    block.lines().filter(|line| !is_rule(line) && !is_printed(line)).collect()
}

/// The output of a command of a page, or the file of a day that it writes.
fn printed(folder: &Path, command: &str) -> String {
    let programs = cargo_bin!("vertifleet").parent().expect("a folder").to_owned();
    let path = std::env::var("PATH").expect("a path");
    let mut shell = Command::new("sh");
    shell.args(["-c", command]).current_dir(folder).env("XDG_CACHE_HOME", folder.join("kept"));
    shell.env("PATH", format!("{}:{path}", programs.display()));
    let output = shell.output().expect("a shell");
    match command.split_once("--output ") {
        Some((_, file)) => fs::read_to_string(folder.join(file)).expect("it was written"),
        None => String::from_utf8(output.stdout).expect("text"),
    }
}

#[test]
fn the_first_hour_shows_the_output_of_its_commands() {
    let (folder, page) = (folder(), page("first-hour.md"));
    let (mut commands, mut compared) = (Vec::new(), 0);
    let (_, page) = page.split_once("## Draw a day").expect("its first command");
    for section in page.split("```") {
        if let Some(block) = section.strip_prefix("text\n") {
            let outputs: Vec<String> =
                commands.drain(..).map(|command| printed(folder.path(), command)).collect();
            if let Some(output) = outputs.last() {
                assert_eq!(missing(block, output), Vec::<&str>::new(), "in {output}");
                compared += 1;
            }
        } else {
            // Plans and training take long, and depend on how fast the machine is.
            let is_quick = |command: &&str| {
                ["plan", "train", "mine", "--bound"].iter().all(|slow| !command.contains(slow))
            };
            let all = section.lines().filter_map(|line| line.strip_prefix("    "));
            commands = all.filter(is_quick).collect();
        }
    }
    assert_eq!(compared, 7, "the page still writes commands and what they print in this way");
}

/// The number that follows some words on a page, without the marks between its thousands.
fn number_after(page: &str, words: &str) -> f64 {
    let (_, rest) = page.split_once(words).unwrap_or_else(|| panic!("the page has {words}"));
    let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    let number: String =
        rest.trim_start().chars().take_while(|&c| is_part(c)).filter(|&c| c != ',').collect();
    number.trim_end_matches('.').parse().expect("a number")
}

#[test]
fn the_sentences_of_the_first_hour_agree_with_what_it_shows() {
    let page = page("first-hour.md");
    let prose = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let states = |sentence: &str| assert!(prose.contains(sentence), "{sentence}");
    let (_, page) = page.split_once("## Fly it").expect("its day");
    let (carried, profit_usd, bound_usd) = (
        number_after(page, "  passengers "),
        number_after(page, "  profit "),
        number_after(page, "  upper bound "),
    );
    let (_, rest) = page.split_once("  passengers ").expect("a ledger");
    let spilled = rest.split_whitespace().nth(1).expect("a column");
    let wanted = carried + spilled.parse::<f64>().expect("a number");
    let grouped = |number: f64| {
        let whole = format!("{number:.0}");
        let (thousands, rest) = whole.split_at(whole.len() - 3);
        format!("{thousands},{rest}")
    };
    states(&format!("carry {} of {} passengers", grouped(carried), grouped(wanted)));
    states(&format!("`greedy` earns ${}.", grouped(profit_usd)));
    let (whole, cents) = (grouped(bound_usd.floor()), format!("{bound_usd:.2}"));
    let cents = cents.rsplit('.').next().expect("cents").to_owned();
    states(&format!("No schedule of this day earns more than ${whole}.{cents}."));
    let share = 100.0 * profit_usd / bound_usd;
    states(&format!("{share:.1} % of the bound, so at most {:.1} % of it", 100.0 - share));
    let (_, prices) = page.split_once("with one more stand").expect("prices of stands");
    let dearest = prices.lines().nth(1).and_then(|line| line.split_whitespace().next());
    states(&format!("The stands of {} are the tightest limit", dearest.expect("a vertiport")));
}

#[test]
fn the_first_hour_has_the_shares_of_the_benchmarks() {
    let (page, benchmarks) =
        (page("first-hour.md"), fs::read_to_string(shipped("docs/src/benchmarks.md")));
    let prose = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let benchmarks = benchmarks.expect("it is there");
    let (_, quality) = benchmarks.split_once("## Quality").expect("a section");
    for policy in ["rolling", "prices", "greedy"] {
        let row = quality.lines().find(|line| line.starts_with(&format!("| `{policy}`")));
        let share = row.and_then(|row| row.split('|').nth(2)).expect("a share").trim();
        let is_stated = [format!("`{policy}` has {share}"), format!("`{policy}` {share}")]
            .map(|one| prose.contains(&one));
        assert!(is_stated.contains(&true), "{policy} has {share}");
    }
    let (_, planner) = benchmarks.split_once("## Planner").expect("a section");
    let row = planner.lines().find(|line| line.starts_with("| `paper`")).expect("a row");
    let gap = row.split('|').nth(4).and_then(|cell| cell.split_whitespace().next());
    assert!(prose.contains(&format!("{} % below the bound", gap.expect("a gap"))), "{gap:?}");
}

/// A whole number of dollars as the pages write it.
fn dollars(amount: &Value) -> String {
    let whole = format!("{:.0}", amount.as_f64().expect("an amount"));
    let (thousands, rest) = whole.split_at(whole.len() - 3);
    format!("{thousands},{rest} $")
}

#[test]
fn the_day_of_operations_has_the_figures_of_the_service() {
    let (folder, page) = (folder(), page("day-of-operations.md"));
    let prose = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut command = Service::command("127.0.0.1:0");
    let service = Service::start(command.current_dir(folder.path())).expect("it listens");
    let url = format!("http://{}", service.address);
    let post = |path: &str, body: &Value| -> Value {
        let body = body.to_string();
        let answer = ureq::post(format!("{url}/v1/days{path}")).send(body).expect("an answer");
        serde_json::from_reader(answer.into_body().into_reader()).expect("JSON")
    };
    let get = |path: &str| -> Value {
        let answer = ureq::get(format!("{url}/v1/days{path}")).call().expect("an answer");
        serde_json::from_reader(answer.into_body().into_reader()).expect("JSON")
    };
    let made = post("", &json!({"network": "paper", "seed": 1}));
    let day = format!("/{}", made["id"].as_str().expect("an id"));
    let decision = get(&format!("{day}/aircraft/A01/decision"));
    let (_, shown) = page.split_once("```json\n").expect("two alternatives");
    let (shown, _) = shown.split_once("```").expect("the end of a block");
    for shown in Deserializer::from_str(shown).into_iter::<Value>() {
        let shown = shown.expect("an object");
        let alternatives = decision["alternatives"].as_array().expect("a list");
        let found = alternatives.iter().find(|one| one["to"] == shown["to"]).expect("it is there");
        for (member, value) in shown.as_object().expect("an object") {
            assert_eq!(&found[member], value, "{member} of {}", shown["to"]);
        }
    }
    post(&format!("{day}/decisions"), &json!({"aircraft": "A01"}));
    let by_hand = json!({"aircraft": "A02", "to": "V1", "reason": "the crew lives there"});
    post(&format!("{day}/decisions"), &by_hand);
    post(&format!("{day}/events"), &json!({"type": "undone", "aircraft": "A02"}));
    let outlook = dollars(&get(&format!("{day}/outlook"))["totals"]["profit_usd"]);
    assert!(prose.contains(&format!("expected profit of the day: {outlook} here")), "{outlook}");
    let closed = json!({"type": "closed", "routes": {"vertiport": "V1"}, "until": "12:00:00"});
    let what_if = post(&format!("{day}/what-if"), &json!({"events": [closed]}));
    let what_if = dollars(&what_if["what_if"]["totals"]["profit_usd"]);
    assert!(prose.contains(&format!("with V1 closed until noon, {what_if}")), "{what_if}");
    let (_, operated) =
        page.split_once("    vertifleet operate http://127.0.0.1:8080").expect("a day");
    let (options, rest) = operated.split_once('\n').expect("its options");
    let output = run(folder.path(), &format!("operate {url}{options}"));
    let block: String = rest
        .lines()
        .filter_map(|line| line.strip_prefix("      "))
        .fold(String::new(), |all, line| all + line + "\n");
    assert!(block.lines().count() >= 3, "{block}");
    let output = String::from_utf8(output.stdout).expect("text");
    assert_eq!(missing(&block, &output), Vec::<&str>::new(), "in {output}");
}

#[test]
fn figures_that_are_not_printed_are_found() {
    let output = "planned in 3.1 s\n  profit   12.50 $\nrow a 5 ns x\n";
    assert_eq!(
        missing("planned in 2 s\n profit 12.50 $\nrow a ...\n...\n----", output),
        Vec::<&str>::new()
    );
    assert_eq!(
        missing("  profit   12.51 $\nrow b ...", output),
        ["  profit   12.51 $", "row b ..."]
    );
}
