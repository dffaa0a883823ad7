//! Runs the commands of the guide "Plan a city in an hour", and compares what the guide states of
//! their output.
//!
//! On all days and designs of the guide its studies take minutes. So they usually run on fewer, and
//! only what the other commands print is compared with `bay/figures.json` and the pictures, which
//! hold what a whole run prints. `make soak` runs the whole guide and compares all of it.
//! `VERTIFLEET_UPDATE=1` writes them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use assert_cmd::cargo::cargo_bin;
use serde_json::{Value, json};

/// Arguments of less work than those of the guide, to save time.
const SMALLER: [(&str, &str); 5] = [
    ("--days 5", "--days 2"),
    ("--days 3", "--days 1"),
    ("--designs 16", "--designs 2"),
    ("--policies prices", "--policies greedy"),
    ("--policy prices", "--policy greedy"),
];

/// The pictures of the guide that commands without [`SMALLER`] arguments write, and their files.
const QUICK_PICTURES: [(&str, &str); 2] =
    [("plan-bay.png", "bay.png"), ("plan-day.svg", "day.svg")];
/// Those that its studies write.
const PICTURES: [(&str, &str); 3] = [
    ("plan-fleet.svg", "fleet/figure-heat-map.svg"),
    ("plan-size.svg", "best/figure-designs.svg"),
    ("plan-fare.svg", "fare/figure-response-curves.svg"),
];

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src")
}

fn page() -> String {
    fs::read_to_string(docs().join("guide/plan-a-city.md")).expect("it is there")
}

fn commands(page: &str) -> Vec<&str> {
    page.lines().filter_map(|line| line.strip_prefix("    ")).collect()
}

/// A folder with the tables of the guide.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for table in ["vertiports.csv", "demand.csv"] {
        let from = docs().join("guide/bay").join(table);
        fs::copy(from, folder.path().join(table)).expect("it is there");
    }
    folder
}

/// The output of a command.
fn run(folder: &Path, command: &str) -> String {
    let programs = cargo_bin!("vertifleet").parent().expect("a folder").to_owned();
    let path = std::env::var("PATH").expect("a path");
    let output = Command::new("sh")
        .args(["-c", command])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", programs.display()))
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command}: {said}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn every_command_of_the_guide_runs() {
    let (folder, page) = (folder(), page());
    let commands = commands(&page);
    assert!(
        commands.len() > 12,
        "the guide still writes its commands in a way that this test finds"
    );
    for (of_the_guide, _) in SMALLER {
        assert!(page.contains(of_the_guide), "the guide no longer has {of_the_guide}");
    }
    let smaller = commands.into_iter().map(|command| {
        SMALLER.iter().fold(command.to_owned(), |command, (of_the_guide, smaller)| {
            command.replace(of_the_guide, smaller)
        })
    });
    let explained = run_all(folder.path(), smaller);
    let figures = figures();
    let kept = figures["statements"].as_array().expect("statements");
    for one in quick_statements(folder.path(), &explained) {
        assert!(kept.contains(&json!(one)), "{one}: run with VERTIFLEET_UPDATE=1");
    }
    for (name, file) in QUICK_PICTURES {
        assert_is_picture(name, &folder.path().join(file));
    }
    for file in [
        "day.html",
        "best/best.toml",
        "stands/cells.csv",
        "chargers/cells.csv",
        "flights.geojson",
        "feed.zip",
        "flights.parquet",
    ] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
    for (_, file) in PICTURES {
        assert!(folder.path().join(file).exists(), "{file}");
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Dollars to the nearest thousand.
fn thousands(usd: f64) -> String {
    format!("{:.0},000 $", usd / 1_000.0)
}

fn summary(folder: &Path, of: &str) -> Value {
    let text = fs::read_to_string(folder.join(of).join("summary.json")).expect("it was written");
    serde_json::from_str(&text).expect("JSON")
}

/// The mean profits of a sweep by its settings.
fn profits(sweep: &Value) -> Vec<(Vec<Value>, f64)> {
    let cells = sweep["cells"].as_array().expect("cells").iter();
    let cell = |cell: &Value| {
        let settings = cell["settings"].as_array().expect("settings").clone();
        (settings, number(&cell["results"][0]["profit_usd"]["mean"]))
    };
    cells.map(cell).collect()
}

/// The least and the most of some dollars, rounded.
fn range(usd: &[f64]) -> String {
    let rounded: Vec<String> = usd.iter().map(|&usd| thousands(usd)).collect();
    let (least, most) = (
        usd.iter().copied().fold(f64::INFINITY, f64::min),
        usd.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    );
    if rounded.iter().all(|one| *one == rounded[0]) {
        return format!("about {}", rounded[0]);
    }
    format!("{} to {}", thousands(least).replace(" $", ""), thousands(most))
}

/// Runs commands of the guide, and returns what is explained.
fn run_all(folder: &Path, commands: impl Iterator<Item = String>) -> Value {
    let mut explained = Value::Null;
    for command in commands {
        if command.starts_with("vertifleet explain") {
            let output = run(folder, &format!("{command} --json"));
            explained = serde_json::from_str(&output).expect("JSON");
        } else {
            run(folder, &command);
        }
    }
    explained
}

/// The statements of a whole run of the guide, as kept.
fn figures() -> Value {
    let file = fs::read_to_string(docs().join("guide/bay/figures.json")).expect("it is there");
    serde_json::from_str(&file).expect("JSON")
}

fn assert_is_picture(name: &str, file: &Path) {
    let kept = fs::read(docs().join("images").join(name)).expect("it is there");
    assert!(fs::read(file).expect("a picture") == kept, "{name} is another picture");
}

/// What the guide states of the output of the commands without [`SMALLER`] arguments, in its words.
fn quick_statements(folder: &Path, explained: &Value) -> [String; 2] {
    let show = |network: &str| -> Value {
        let text = run(folder, &format!("vertifleet network show {network} --json"));
        serde_json::from_str(&text).expect("JSON")
    };
    let (bay, new_york) = (show("bay.toml"), show("new-york"));
    let worth = explained["worth"].as_array().expect("changes").iter();
    let stands = worth.filter_map(|one| {
        let at = one["change"].as_str()?.strip_prefix("one more stand at ")?;
        Some((at, number(&one["bound_usd"])))
    });
    let (most, _) = stands.max_by(|one, other| one.1.total_cmp(&other.1)).expect("stands");
    [
        format!(
            "That fleet of {} is too large for {} stands",
            new_york["size"]["aircraft"], bay["size"]["stands"]
        ),
        format!("one more stand at {most} raises the bound most"),
    ]
}

/// What the guide states of the output of its studies, in its words.
fn statements(folder: &Path) -> Vec<String> {
    let size = summary(folder, "best");
    let design = |name: &str| {
        let at = size[name].as_u64().and_then(|at| usize::try_from(at).ok());
        &size["designs"][at.expect("the number of a design")]["size"]
    };
    let (best, now) = (design("best"), design("now"));
    let share = |of: &str| format!("{:.0} %", 100.0 * number(&size[of]["served_share"]));
    let fares = profits(&summary(folder, "fare")).into_iter();
    let (fare, _) = fares.max_by(|one, other| one.1.total_cmp(&other.1)).expect("fares");
    let chargers = profits(&summary(folder, "chargers"));
    let profit = |charging: &str, kw: u32| {
        let is_it =
            |settings: &[Value]| settings[0] == charging && number(&settings[1]) == f64::from(kw);
        chargers.iter().find(|(settings, _)| is_it(settings)).expect("a cell").1
    };
    let sooner = [50, 100, 200].map(|kw| profit("as_needed", kw) - profit("to_full", kw));
    let stronger = ["to_full", "as_needed"].map(|one| profit(one, 200) - profit(one, 100));
    let is_at_limit = |one: &&Value| {
        one["found"] == one["highest"] && number(&one["one_more_is_worth_at_most"]) >= 0.05
    };
    let at_limit = size["dimensions"].as_array().expect("members").iter().filter(is_at_limit);
    let limits = match at_limit.count() {
        0 => None,
        1 => Some("The output warns that one member is at the highest value searched".to_owned()),
        many => {
            Some(format!("The output warns that {many} members are at the highest value searched"))
        }
    };
    let mut statements = vec![
        format!(
            "The best design here has {} stands and {} aircraft; the searched design nearest to the network has {} stands and {} aircraft.",
            best["stands"], best["aircraft"], now["stands"], now["aircraft"]
        ),
        format!(
            "the best one earns about {} a day more and carries {} of the passengers instead of {}",
            thousands(number(&size["holdout_gain_usd"]["mean"])),
            share("best_on_holdout"),
            share("now_on_holdout")
        ),
        format!("highest near {}", fare.last().expect("a level")),
        format!("leaving as soon as the charge suffices is worth {} a day", range(&sooner)),
        format!("Chargers of 200 kW instead of 100 kW are worth {} a day", range(&stronger)),
    ];
    statements.extend(limits);
    statements
}

/// The statements and pictures of a whole run of the guide.
fn whole_run() -> (Value, Vec<(&'static str, Vec<u8>)>) {
    let (folder, page) = (folder(), page());
    let explained = run_all(folder.path(), commands(&page).into_iter().map(str::to_owned));
    let quick = quick_statements(folder.path(), &explained).into_iter();
    let statements: Vec<String> = quick.chain(statements(folder.path())).collect();
    let figures = json!({ "commands": commands(&page), "statements": statements });
    let picture = |(name, file)| (name, fs::read(folder.path().join(file)).expect("a picture"));
    (figures, QUICK_PICTURES.into_iter().chain(PICTURES).map(picture).collect())
}

#[test]
fn the_guide_states_what_its_commands_print() {
    let file = docs().join("guide/bay/figures.json");
    let is_update = std::env::var_os("VERTIFLEET_UPDATE").is_some();
    if is_update || std::env::var_os("VERTIFLEET_WHOLE_GUIDE").is_some() {
        let (figures, pictures) = whole_run();
        if is_update {
            let text = serde_json::to_string_pretty(&figures).expect("plain data");
            fs::write(&file, text + "\n").expect("room");
        }
        assert_eq!(figures, self::figures(), "run this test with VERTIFLEET_UPDATE=1");
        for (name, picture) in pictures {
            let kept = docs().join("images").join(name);
            if is_update {
                fs::write(&kept, &picture).expect("room");
            }
            assert!(fs::read(kept).expect("it is there") == picture, "{name} is another picture");
        }
    }
    let figures = figures();
    let page = page();
    assert_eq!(figures["commands"], json!(commands(&page)), "run with VERTIFLEET_UPDATE=1");
    let prose = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut other = prose.clone();
    let warns = figures["statements"].to_string().contains("The output warns");
    assert_eq!(prose.contains("The output warns"), warns, "of members at the highest value");
    for one in figures["statements"].as_array().expect("statements") {
        let one = one.as_str().expect("text");
        assert!(prose.contains(one), "the guide does not state: {one}");
        other = other.replace(one, "");
    }
    for command in commands(&page) {
        let words: Vec<&str> = command.split_whitespace().collect();
        other = other.replace(&words.join(" "), "");
    }
    // Names of formats and members are in code, links and pictures in brackets.
    let code = other.split('`').step_by(2).collect::<String>();
    let unknown: Vec<&str> = code
        .split_whitespace()
        .filter(|word| word.contains(|c: char| c.is_ascii_digit()))
        .filter(|word| !word.contains("](") && !KNOWN.contains(word))
        .collect();
    assert_eq!(unknown, Vec::<&str>::new(), "numbers that no command prints");
}

/// Numbers of the guide that are no output: the days that it advises, and a share in an example.
const KNOWN: [&str; 2] = ["50", "90"];
