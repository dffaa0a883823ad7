//! The commands as a user runs them.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;

fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let mut command = cargo_bin_cmd!("vertifleet");
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn stdout(folder: &Path, arguments: &str) -> String {
    let output = vertifleet(folder, arguments).assert().success().get_output().stdout.clone();
    String::from_utf8(output).expect("text")
}

/// Runs a command that must fail, and returns its stderr. Its stdout must be empty.
fn failure(folder: &Path, arguments: &str, code: i32) -> String {
    let assert = vertifleet(folder, arguments).assert().code(code);
    assert!(assert.get_output().stdout.is_empty(), "stdout is for results");
    String::from_utf8(assert.get_output().stderr.clone()).expect("text")
}

#[test]
fn a_day_is_drawn_played_checked_and_replayed() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario paper --seed 7 -o day.json");
    for policy in ["random", "greedy", "prices", "rolling", "gcaps", "mlp"] {
        let played = stdout(
            at,
            &format!("simulate day.json --policy {policy} --seed 3 --trace {policy}.csv --json"),
        );
        let report = stdout(at, &format!("check day.json {policy}.csv --json"));
        let replayed =
            stdout(at, &format!("simulate day.json --policy replay:{policy}.csv --json"));
        assert_eq!(played, replayed, "{policy}");

        let played: Value = serde_json::from_str(&played).expect("JSON");
        let report: Value = serde_json::from_str(&report).expect("JSON");
        assert_eq!(report["valid"], true);
        let (found, stated) = (&report["totals"]["profit_usd"], &played["profit_usd"]);
        let apart = found.as_f64().expect("dollars") - stated.as_f64().expect("dollars");
        assert!(apart.abs() < 1e-6, "{policy}: {found} is not {stated}");
    }
}

#[test]
fn a_day_is_bounded_above_what_a_rule_earns() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario paper --seed 4 -o day.json");
    let json =
        |arguments: &str| -> Value { serde_json::from_str(&stdout(at, arguments)).expect("JSON") };
    let greedy = json("simulate day.json --policy greedy --json");
    let bound = json("bound day.json --step 15 --json");
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!(number(&greedy["profit_usd"]) < number(&bound["upper_bound_usd"]));
    assert_eq!(bound["step_s"], 900);
    assert!(number(&bound["seconds"]) > 0.0);
    assert_eq!(bound["stand_shadow_price_usd"].as_object().map(serde_json::Map::len), Some(8));
    let people = stdout(at, "bound day.json --step 60");
    assert!(people.contains("upper bound") && people.contains("one more stand"));
    assert!(failure(at, "bound day.json --step 0", 2).contains("error[V501]"));
}

#[test]
fn several_days_are_bounded_with_means() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario as-coded --seed 1 --days 3 -o days");
    let json =
        |arguments: &str| -> Value { serde_json::from_str(&stdout(at, arguments)).expect("JSON") };
    let found = json("bound days --step 60 --json");
    let days = found["days"].as_array().expect("days");
    assert_eq!(days.len(), 3);
    let number = |value: &Value| value.as_f64().expect("a number");
    let near = |mean: &Value, values: Vec<f64>| {
        let expected = values.iter().sum::<f64>() / 3.0;
        assert!((number(&mean["mean"]) - expected).abs() < 1e-6, "{mean} is not {expected}");
        let squares: f64 = values.iter().map(|value| (value - expected).powi(2)).sum();
        let error = (squares / 2.0 / 3.0).sqrt();
        assert!((number(&mean["standard_error"]) - error).abs() < 1e-6, "{mean}: not {error}");
    };
    let of = |name: &str| days.iter().map(|day| number(&day[name])).collect();
    near(&found["mean"]["upper_bound_usd"], of("upper_bound_usd"));
    for (id, mean) in found["mean"]["stand_shadow_price_usd"].as_object().expect("vertiports") {
        near(mean, days.iter().map(|day| number(&day["stand_shadow_price_usd"][id])).collect());
        // The vertiport has separate chargers, and the bound does not distinguish them from stands.
        assert_eq!(mean, &found["mean"]["charger_shadow_price_usd"][id]);
    }
    assert_eq!(days[0]["charger_shadow_price_usd"], days[0]["stand_shadow_price_usd"]);
    let passengers =
        found["mean"]["passenger_shadow_price_usd"].as_array().expect("pairs and periods");
    assert!(passengers.iter().all(|passenger| number(&passenger["mean"]) > 0.0));

    let first = days[0]["name"].as_str().expect("a name");
    let alone = json(&format!("bound days/{first}.json --step 60 --json"));
    assert_eq!(alone["upper_bound_usd"], days[0]["upper_bound_usd"]);
    let people = stdout(at, "bound days --step 60");
    assert!(people.contains("standard error") && people.contains("in the mean"));
    stdout(at, "scenario new-york --seed 1 -o other.json");
    assert!(failure(at, "bound days other.json --step 60", 2).contains("error[V410]"));
    assert!(failure(at, "bound nowhere.json", 2).contains("error[V101]"));
}

#[test]
fn a_day_is_planned_between_the_best_policy_and_the_bound() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario paper --seed 1 -o day.json");
    let planned = stdout(at, "plan day.json --time-limit 1 --json -o plan.csv");
    let planned: Value = serde_json::from_str(&planned).expect("JSON");
    let number = |name: &str| planned[name].as_f64().unwrap_or_else(|| panic!("{name} is missing"));
    assert!(number("best_policy_usd") <= number("profit_usd"));
    assert!(number("profit_usd") <= number("upper_bound_usd"));
    let gap = (number("upper_bound_usd") - number("profit_usd")) / number("upper_bound_usd");
    assert!((number("gap") - gap).abs() < 1e-9);
    assert!(number("seconds") > 0.0 && planned["stand_shadow_price_usd"]["V1"].is_number());
    let replayed = stdout(at, "simulate day.json --policy replay:plan.csv --json");
    let replayed: Value = serde_json::from_str(&replayed).expect("JSON");
    assert_eq!(replayed["profit_usd"], planned["profit_usd"]);
    stdout(at, "check day.json plan.csv");

    let people = stdout(at, "plan day.json --time-limit 0 -o rule.csv");
    assert!(people.contains("gap") && people.contains("one more stand"));
    failure(at, "plan day.json --gap 3 -o plan.csv", 2);
}

#[test]
fn a_day_with_chargers_beside_the_stands_is_planned() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario as-coded --seed 1 -o day.json");
    stdout(at, "plan day.json --time-limit 3 -o plan.csv");
    stdout(at, "check day.json plan.csv");
}

#[test]
fn simulate_prints_every_number_of_the_day() {
    let folder = folder();
    stdout(folder.path(), "scenario paper --seed 1 -o day.json");
    let text = stdout(folder.path(), "simulate day.json --policy greedy --json");
    let day: Value = serde_json::from_str(&text).expect("JSON");
    let number = |name: &str| day[name].as_f64().unwrap_or_else(|| panic!("{name} is missing"));
    assert_eq!(number("decisions"), number("flights") + number("holds"));
    assert!((number("reward") - number("profit_usd") / number("potential_usd")).abs() < 1e-12);
    let earned = number("revenue_usd") - number("passenger_cost_usd") - number("energy_cost_usd");
    assert!((number("profit_usd") - earned).abs() < 1e-9);
    for name in
        ["energy_kwh", "repositioning_flights", "passengers", "spilled_passengers", "load_factor"]
    {
        number(name);
    }
    let people = stdout(folder.path(), "simulate day.json --policy greedy");
    assert!(people.contains("profit") && people.contains("load factor"));
}

#[test]
fn the_same_command_prints_the_same_on_any_number_of_threads() {
    let folder = folder();
    let compare = |threads: u32| {
        let text = stdout(
            folder.path(),
            &format!(
                "compare --network paper --policies random,greedy,gcaps --days 6 --seed 5 --json --threads {threads}"
            ),
        );
        let mut results: Value = serde_json::from_str(&text).expect("JSON");
        // Only the times per decision and the command itself may differ.
        results["command"].take();
        for policy in results["policies"].as_array_mut().expect("a list") {
            policy["decision_ns"].take();
        }
        results
    };
    assert_eq!(compare(1), compare(2));
}

#[test]
fn the_environment_bounds_the_threads_too() {
    let folder = folder();
    let compare = "compare --network paper --policies random,gcaps --days 3 --seed 5 --report";
    let days = |threads: &str| {
        let arguments = format!("{compare} out-{threads}");
        vertifleet(folder.path(), &arguments).env("RAYON_NUM_THREADS", threads).assert().success();
        fs::read(folder.path().join(format!("out-{threads}/days.csv"))).expect("a table")
    };
    assert!(days("1") == days("2"));
}

#[test]
fn unlikely_settings_raise_a_warning_with_a_code() {
    let folder = folder();
    let day = stdout(folder.path(), "scenario paper --seed 7");
    let weak = day.replace("\"battery_kwh\": 110", "\"battery_kwh\": 1");
    assert_ne!(weak, day);
    fs::write(folder.path().join("weak.json"), weak).expect("a file");
    let assert = vertifleet(folder.path(), "simulate weak.json --policy greedy").assert().success();
    let said = String::from_utf8(assert.get_output().stderr.clone()).expect("text");
    assert!(said.starts_with("warning[V135]: weak.json: no aircraft can fly"), "{said}");
    assert!(said.contains("\nwarning[V120]: weak.json: aircraft"), "{said}");
}

#[test]
fn a_report_is_a_folder_with_a_page_figures_and_tables() {
    let folder = folder();
    stdout(
        folder.path(),
        "compare --network paper --policies random,greedy,gcaps --days 4 --seed 9 --report out",
    );
    for name in ["report.html", "replay.html", "days.csv", "summary.json"] {
        assert!(folder.path().join("out").join(name).exists(), "{name}");
    }
    let page = fs::read_to_string(folder.path().join("out/report.html")).expect("a page");
    assert!(page.contains("The first 3 days as each policy played them"), "{page}");
    let replay = fs::read_to_string(folder.path().join("out/replay.html")).expect("a page");
    assert_eq!(framed(&page), replay, "the page can be sent alone");
    for figure in ["figure-3-learning-curves", "figure-4-reward", "figure-5-profit"] {
        for kind in ["svg", "png"] {
            let name = format!("{figure}.{kind}");
            assert!(folder.path().join("out").join(&name).exists(), "{name}");
        }
    }
}

/// The page of the replay inside the frame of a page.
fn framed(page: &str) -> String {
    let (_, frame) = page.split_once(r#"<iframe class="replay""#).expect("a frame");
    let (_, within) = frame.split_once("srcdoc=\"").expect("its page");
    let within = within.split('"').next().expect("its end");
    let within = within.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"");
    within.replace("&amp;", "&")
}

/// The days in a page that is a replay or contains one in a frame.
fn replayed(page: &Path) -> Vec<Value> {
    let page = fs::read_to_string(page).expect("a page");
    let page = if page.contains("<iframe") { framed(&page) } else { page };
    let (_, data) = page.split_once(r#"id="vertifleet-data">"#).expect("a place for the days");
    let (data, _) = data.split_once("</script>").expect("its end");
    let data: Value = serde_json::from_str(data).expect("JSON");
    data["days"].as_array().expect("days").clone()
}

#[test]
fn a_page_replays_the_day_that_was_simulated() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario new-york --seed 3 -o day.json");
    let printed =
        stdout(at, "simulate day.json --policy prices --trace day.csv --report day.html --json");
    let printed: Value = serde_json::from_str(&printed).expect("JSON");
    let [day] = &replayed(&at.join("day.html"))[..] else { panic!("one day was simulated") };
    let scenario = fs::read(at.join("day.json")).expect("a day");
    let scenario: Value = serde_json::from_slice(&scenario).expect("JSON");
    assert!(day["scenario"] == scenario, "the page carries the whole scenario");
    assert_eq!((&day["name"], &day["plays"][0]["policy"]), (&scenario["name"], &"prices".into()));
    assert_eq!(day["plays"][0]["profit_usd"], printed["profit_usd"]);

    let page = fs::read_to_string(at.join("day.html")).expect("a page");
    assert!(page.starts_with("<!DOCTYPE html>\n<!-- vertifleet-day/1 -->"));
    for picture in ["ledger", "map", "aircraft", "occupancy", "demand"] {
        assert!(page.contains(&format!("<h2 id=\"{picture}\">")), "{picture}");
        for kind in ["svg", "png"] {
            assert!(page.contains(&format!("download=\"new-york-3-{picture}.{kind}\"")));
            let file = format!("{picture}.{kind}");
            stdout(
                at,
                &format!("export day.json day.csv --as {kind} --picture {picture} -o {file}"),
            );
        }
    }

    let exported = fs::read_to_string(at.join("occupancy.svg")).expect("a picture");
    assert!(page.contains(&exported), "the page shows what export writes");

    // The trace in the page is that of the file, rounded to the cent, and still passes the checker.
    let (text, exact) =
        (day["plays"][0]["trace"].as_str().expect("text"), fs::read_to_string(at.join("day.csv")));
    let choices = |text: &str| -> Vec<String> {
        let columns = |line: &str| line.splitn(6, ',').take(5).collect::<Vec<_>>().join(",");
        text.lines().map(columns).collect()
    };
    assert_eq!(choices(text), choices(&exact.expect("a trace")));

    // A page of this program is replaced, also by that of another day.
    stdout(at, "simulate day.json --policy greedy --report day.html");
    assert_eq!(replayed(&at.join("day.html"))[0]["plays"][0]["policy"], "greedy");
}

#[test]
fn a_report_replays_its_first_days_as_every_policy_played_them() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "compare --network paper --policies random,greedy --days 4 --seed 9 --report out");
    let days = replayed(&at.join("out/replay.html"));
    let names: Vec<&Value> = days.iter().map(|day| &day["name"]).collect();
    assert_eq!(names, ["paper-9", "paper-10", "paper-11"]);
    let table = fs::read_to_string(at.join("out/days.csv")).expect("a table");
    for day in &days {
        let plays = day["plays"].as_array().expect("plays");
        assert_eq!(plays.len(), 2);
        for play in plays {
            let (policy, name) = (&play["policy"], &day["name"]);
            let row =
                format!("{},{},", policy.as_str().expect("text"), name.as_str().expect("text"));
            let row =
                table.lines().find(|line| line.starts_with(&row)).expect("a row of the table");
            let profit_usd = play["profit_usd"].to_string();
            assert!(row.split(',').any(|field| field == profit_usd), "{row} has no {profit_usd}");
        }
    }
    stdout(at, "compare --network paper --policies greedy --days 1 --seed 9 --report out");
    assert_eq!(
        replayed(&at.join("out/replay.html")).len(),
        1,
        "the report was replaced as a whole"
    );
}

#[test]
fn shipped_weights_and_published_figures_do_not_pass_for_those_of_a_changed_copy() {
    let folder = folder();
    let at = folder.path();
    let paper = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../networks/paper.toml");
    let paper = fs::read_to_string(paper).expect("the shipped network");
    let copy = paper.replace("stands = 6", "stands = 7");
    assert_ne!(copy, paper);
    fs::write(at.join("copy.toml"), copy).expect("a file");
    fs::write(at.join("same.toml"), format!("# my own remark\n{paper}")).expect("a file");

    let compare = |network: &str| {
        let compare = format!(
            "compare --network {network} --policies greedy,gcaps --days 2 --seed 1 --json --report out"
        );
        let output = vertifleet(at, &compare).assert().success().get_output().clone();
        let summary: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let page = fs::read_to_string(at.join("out/report.html")).expect("a page");
        let said = String::from_utf8(output.stderr).expect("text");
        let published = summary["published"].as_array().expect("a list").len();
        (said.matches("warning[V310]").count(), published, page.contains("a changed copy"))
    };
    for shipped in ["paper", "same.toml"] {
        assert_eq!(compare(shipped), (0, 3, false), "{shipped}");
    }
    assert_eq!(compare("copy.toml"), (1, 0, true));

    stdout(at, "scenario copy.toml --seed 7 -o day.json");
    let assert = vertifleet(at, "simulate day.json --policy gcaps").assert().success();
    let said = String::from_utf8(assert.get_output().stderr.clone()).expect("text");
    assert!(said.starts_with("warning[V310]: policy \"gcaps\""), "{said}");
}

#[test]
fn many_days_go_into_a_folder() {
    let folder = folder();
    stdout(folder.path(), "scenario paper --seed 7 --days 3 -o days");
    for seed in 7..10 {
        let text = fs::read_to_string(folder.path().join(format!("days/paper-{seed}.json")))
            .expect("a day");
        assert_eq!(text, stdout(folder.path(), &format!("scenario paper --seed {seed}")));
    }
}

#[test]
fn a_broken_rule_is_named_and_the_exit_code_is_1() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario paper --seed 7 -o day.json");
    stdout(at, "simulate day.json --policy greedy --trace trace.csv");
    let trace = fs::read_to_string(at.join("trace.csv")).expect("a trace");
    let mut lines: Vec<&str> = trace.lines().collect();
    lines.remove(30);
    fs::write(at.join("trace.csv"), lines.join("\n")).expect("a file");
    let output =
        vertifleet(at, "check day.json trace.csv").assert().code(1).get_output().stdout.clone();
    let text = String::from_utf8(output).expect("text");
    assert!(text.contains("decision"), "{text}");
}

#[test]
fn training_leaves_weights_that_run() {
    let folder = folder();
    let settings = "--steps 400 --set n_envs=4 --set n_steps=50 --set batch_size=100 --set n_epochs=1 --set eval_days=2";
    let train = format!("train --network paper --policy mlp {settings} --out run");
    stdout(folder.path(), &train);
    let first = fs::read(folder.path().join("run/mlp.safetensors")).expect("weights");
    stdout(folder.path(), &train.replace("--out run", "--out again --threads 1"));
    let again = fs::read(folder.path().join("again/mlp.safetensors")).expect("weights");
    assert!(first == again, "same seed, same weights");

    let compare = "compare --network paper --policies greedy,mine --days 2 --seed 1 --model mine=run/mlp.safetensors";
    assert!(stdout(folder.path(), compare).contains("mine"));
    stdout(folder.path(), "scenario paper --seed 7 -o day.json");
    stdout(folder.path(), "simulate day.json --policy mlp --model run/mlp.safetensors");
}

#[test]
fn errors_of_users_have_a_code_and_a_remedy() {
    let folder = folder();
    let at = folder.path();
    stdout(at, "scenario paper --seed 7 -o day.json");
    stdout(at, "scenario paper --seed 8 -o other.json");
    stdout(at, "simulate other.json --policy greedy --trace other.csv");
    fs::write(at.join("broken.json"), "{").expect("a file");
    let shipped =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/paper/gcaps.safetensors");
    fs::copy(shipped, at.join("gcaps.safetensors")).expect("a copy");
    fs::write(at.join("gcaps-checkpoint.safetensors"), "of an earlier run").expect("a file");
    let cases = [
        ("simulate nowhere.json --policy greedy", "V101"),
        ("simulate broken.json --policy greedy", "V105"),
        ("scenario nowhere --seed 1", "V1"),
        ("scenario paper --seed 9999999999999999", "V1"),
        ("simulate day.json --policy fastest", "V307"),
        ("simulate day.json --policy gcaps --model day.json", "V304"),
        ("simulate day.json --policy greedy --model day.json", "V407"),
        ("simulate day.json --policy replay:other.csv", "V406"),
        ("train --network paper --policy mlp --out run --set speed=9", "V302"),
        ("train --network paper --policy mlp --out run --set gamma=9", "V303"),
        ("train --network paper --policy mlp --out run --preset best", "V301"),
        ("compare --network paper --policies greedy --days 1 --seed 1 --model gcaps=x", "V407"),
        (
            "compare --network paper --policies greedy,greedy --days 1 --seed 1 --report twice",
            "V404",
        ),
        ("compare --network paper --policies greedy --days 1 --seed 1 --model greedy=x", "V407"),
        ("simulate day.json --policy mlp --model gcaps.safetensors", "V407"),
        ("train --network paper --policy gcaps --out .", "V311"),
    ];
    for (arguments, code) in cases {
        let said = failure(at, arguments, 2);
        assert!(said.starts_with(&format!("error[{code}")), "{arguments}: {said}");
    }
    assert!(!at.join("twice").exists(), "what is refused leaves nothing behind");
    let taken = "compare --network paper --policies greedy --days 1 --seed 1 --report day.json";
    assert!(failure(at, taken, 1).starts_with("error[V401]"), "no fault of the input");
    failure(at, "simulate", 2);
    failure(at, "fly", 2);
}
