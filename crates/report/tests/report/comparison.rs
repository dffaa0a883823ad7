//! Tests that a report is complete, self-contained, escaped and paired, and tests the terminal's
//! text.

use crate::made_up;
use std::fs;
use std::path::Path;

use vertifleet_core::Coded;
use vertifleet_report::folder::{self, Written};
use vertifleet_report::{comparison, comparison_folder};
use vertifleet_study::{ComparisonRecords, ComparisonReport, Error, NetworkOrigin, PolicyRecord};

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("a written file")
}

fn summary(study: &ComparisonRecords) -> ComparisonReport {
    ComparisonReport::of(study).expect("a sound study")
}

fn text(study: &ComparisonRecords) -> String {
    comparison(&summary(study), &[]).text()
}

fn write(study: &ComparisonRecords, folder: &Path, force: bool) -> Result<Written, Error> {
    folder::write(&comparison_folder(&summary(study), study), folder, force)
}

fn written(study: &ComparisonRecords) -> (tempfile::TempDir, Written) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let paths = write(study, &folder.path().join("new/folder"), false).expect("a report");
    (folder, paths)
}

#[test]
fn the_table_of_five_policies() {
    insta::assert_snapshot!(text(&made_up::study(20)));
}

#[test]
fn the_table_of_one_policy_on_one_day_leaves_undefined_numbers_out() {
    let mut study = made_up::study(1);
    study.policies.truncate(1);
    insta::assert_snapshot!(text(&study));
}

/// Five policies on days with upper bounds, and a reference that knows the days in advance.
fn bounded(days: usize) -> ComparisonRecords {
    let mut study = made_up::study(days);
    let best = study.policies[4].clone();
    let mut plan = PolicyRecord {
        name: "plan".to_owned(),
        decision_ns: None,
        sees: vertifleet_study::Sees::WholeDay,
        weights_sha256: None,
        training_seed: None,
        ..best
    };
    for (day, number) in plan.days.iter_mut().zip(0_u32..) {
        day.totals.profit_usd += 1_000.0 + f64::from(number % 5);
    }
    let bounds_usd: Vec<f64> = plan.days.iter().map(|day| day.totals.profit_usd / 0.97).collect();
    study.policies.push(plan);
    study.bound_step_s = Some(180);
    for policy in &mut study.policies {
        for (day, bound_usd) in policy.days.iter_mut().zip(&bounds_usd) {
            day.upper_bound_usd = Some(*bound_usd);
        }
    }
    study
}

#[test]
fn the_table_of_five_policies_a_reference_and_the_bound() {
    insta::assert_snapshot!(text(&bounded(20)));
}

#[test]
fn shares_of_the_bound_stand_in_page_days_and_numbers_for_machines() {
    let (_folder, paths) = written(&bounded(12));
    let page = read(&paths.page);
    assert!(page.contains("of bound, %") && page.contains("knows the day"));
    assert!(page.contains("gcaps earns"), "a reference is not the best policy");
    assert!(page.contains("% of the proven upper bound, "));
    assert!(page.contains("5 policies and 1 reference on 12 unseen days"));
    let summary: serde_json::Value =
        serde_json::from_str(&read(&paths.page.with_file_name("summary.json"))).expect("JSON");
    assert_eq!(summary["bound"]["step_s"], 180);
    let plan = &summary["policies"][0];
    assert_eq!((&plan["name"], &plan["decision_ns"]), (&"plan".into(), &serde_json::Value::Null));
    let share = plan["bound_share"]["mean"].as_f64().expect("a share");
    assert!((share - 0.97).abs() < 1e-9, "{share}");
    let mut days =
        csv::Reader::from_path(paths.page.with_file_name("days.csv")).expect("a CSV file");
    let column = days.headers().expect("names").iter().position(|name| name == "bound_share");
    let column = column.expect("a column of shares");
    for row in days.records() {
        let share: f64 = row.expect("a row")[column].parse().expect("a share");
        assert!((0.5..=0.98).contains(&share), "{share}");
    }
    let (_folder, paths) = written(&made_up::study(12));
    assert!(!read(&paths.page).contains("of bound, %"));
}

#[test]
fn the_share_is_one_if_nothing_can_be_earned() {
    let mut day = made_up::study(1).policies[0].days[0].clone();
    let mut share = |profit_usd, upper_bound_usd| {
        (day.totals.profit_usd, day.upper_bound_usd) = (profit_usd, upper_bound_usd);
        day.bound_share()
    };
    assert_eq!(share(90.0, None), None);
    assert_eq!(share(90.0, Some(100.0)), Some(0.9));
    assert_eq!((share(0.0, Some(0.0)), share(-5.0, Some(0.0))), (Some(1.0), Some(0.0)));
    // If aircraft cost more a day than they can earn, results are measured by the least possible
    // loss.
    assert_eq!((share(-80.0, Some(-80.0)), share(-100.0, Some(-80.0))), (Some(1.0), Some(0.8)));
}

#[test]
fn a_report_loads_no_other_resource() {
    let (_folder, paths) = written(&made_up::study(12));
    let page = read(&paths.page);
    for loading in ["src=", "@import", "url(", "<script", "<link", "href=\"http", "href=\"//"] {
        assert!(!page.contains(loading), "{loading}");
    }
    // The only address in the page is the name of SVG's vocabulary, which no browser fetches.
    let addresses = page.matches("http").count();
    assert_eq!(addresses, page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
}

#[test]
fn links_of_a_report_lead_to_files_in_its_folder() {
    let (_folder, paths) = written(&made_up::study(12));
    let page = read(&paths.page);
    let folder = paths.page.parent().expect("a file has a folder");
    let links: Vec<&str> =
        page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let files = fs::read_dir(folder).expect("the report's folder").count();
    assert_eq!(links.len(), files - 1, "all files but the page itself");
    for link in links {
        assert!(folder.join(link).is_file(), "{link}");
    }
}

#[test]
fn every_name_in_a_report_is_escaped() {
    let hostile = "<script>alert(\"x\")</script>&";
    let mut study = made_up::study(12);
    study.network = hostile.to_owned();
    study.command = hostile.to_owned();
    for (position, policy) in study.policies.iter_mut().enumerate() {
        policy.name = format!("{position}{hostile}");
        policy.description = hostile.to_owned();
    }
    for curve in &mut study.curves {
        curve.name = hostile.to_owned();
    }
    let (_folder, paths) = written(&study);
    let page = read(&paths.page);
    assert!(!page.contains("<script") && !page.contains("</script"));
    assert!(page.contains("&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt;&amp;"));
}

#[test]
fn a_headline_states_whether_the_lead_is_significant() {
    let mut study = made_up::study(40);
    let (_folder, paths) = written(&study);
    assert!(read(&paths.page).contains("% more than greedy (95 % interval of the difference +$"));
    let profits: Vec<f64> =
        study.policies[1].days.iter().map(|day| day.totals.profit_usd).collect();
    for (position, (day, profit)) in study.policies[4].days.iter_mut().zip(profits).enumerate() {
        day.totals.profit_usd = profit + if position % 2 == 0 { 500.0 } else { -480.0 };
    }
    study.policies.remove(2);
    let (_folder, paths) = written(&study);
    assert!(read(&paths.page).contains("Its lead over greedy, +$10, is not significant"));
}

#[test]
fn published_figures_stand_in_the_report_of_the_paper_network_only() {
    let mut study = made_up::study(12);
    let (_folder, paths) = written(&study);
    assert!(read(&paths.page).contains("28,747"));
    assert!(read(&paths.page).contains("Corresponds to Fig. 5 of the paper"));
    let own_days =
        ComparisonRecords { days_from: Some("my days".to_owned()), seed: None, ..study.clone() };
    study.network = "new-york".to_owned();
    for elsewhere in [study, own_days] {
        let (_folder, paths) = written(&elsewhere);
        let page = read(&paths.page);
        assert!(
            !page.contains("28,747") && !page.contains("of the paper."),
            "{}",
            elsewhere.network
        );
    }
}

#[test]
fn a_page_names_the_origin_of_its_days() {
    let shown = |study: &ComparisonRecords| {
        let (_folder, paths) = written(study);
        read(&paths.page)
    };
    let mut study = made_up::study(4);
    let page = shown(&study);
    assert!(page.contains("paper, as shipped") && page.contains("1 to 4"));
    assert!(page.contains("On validation days of the network “paper”, not on those compared here"));
    study.network_origin = NetworkOrigin::Changed;
    let page = shown(&study);
    assert!(page.contains("paper, changed") && page.contains("perhaps before it was changed"));
    study.network_origin = NetworkOrigin::Own;
    (study.seed, study.days_from) = (None, Some("days/of mine".to_owned()));
    let page = shown(&study);
    assert!(page.contains("paper, not shipped") && page.contains("4 days from days/of mine"));
    assert!(!page.contains("unseen") && !page.contains("Days drawn from seeds"));
    let summary: serde_json::Value =
        serde_json::from_str(&ComparisonReport::of(&study).expect("a sound study").to_json())
            .expect("JSON");
    assert_eq!(summary["days_from"], "days/of mine");
    assert!(summary["seed"].is_null() && summary["day_seeds"].is_null());
}

#[test]
fn a_folder_with_anything_else_in_it_is_no_report() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().join("out");
    write(&made_up::study(5), &target, false).expect("a report");
    fs::write(target.join("notes.txt"), "dear").expect("a file");
    for attempt in [
        folder::check(&target, false).map(|()| None),
        write(&made_up::study(9), &target, false).map(|paths| paths.kept),
    ] {
        assert_eq!(attempt.expect_err("notes are there").code().0, 143);
    }
    assert!(read(&target.join("report.html")).contains("5 unseen days"), "it is untouched");
    let paths = write(&made_up::study(9), &target, true).expect("by force");
    let kept = paths.kept.expect("a place for what was there");
    assert_eq!(read(&kept.join("notes.txt")), "dear");
    assert!(read(&kept.join("report.html")).contains("5 unseen days"));
    assert!(read(&paths.page).contains("9 unseen days"));
}

#[test]
fn days_have_one_row_a_policy_and_day() {
    let study = made_up::study(7);
    let (_folder, paths) = written(&study);
    let mut reader =
        csv::Reader::from_path(paths.page.with_file_name("days.csv")).expect("a CSV file");
    let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().expect("rows");
    assert_eq!(rows.len(), study.policies.len() * 7);
    assert_eq!((&rows[0][0], &rows[0][1], &rows[0][2]), ("random", "paper-1", "1"));
    assert_eq!(rows[0][3].parse(), Ok(study.policies[0].days[0].totals.profit_usd));
}

#[test]
fn the_summary_for_machines_holds_policies_by_profit_and_every_pair() {
    let (_folder, paths) = written(&made_up::study(30));
    let summary: serde_json::Value =
        serde_json::from_str(&read(&paths.page.with_file_name("summary.json"))).expect("JSON");
    assert_eq!(summary["format"], "vertifleet-comparison/1");
    let policies = summary["policies"].as_array().expect("a list");
    let profits: Vec<f64> =
        policies.iter().filter_map(|policy| policy["profit_usd"]["mean"].as_f64()).collect();
    assert_eq!(profits.len(), 5);
    assert!(profits.is_sorted_by(|a, b| a >= b), "{profits:?}");
    let comparisons = summary["comparisons"].as_array().expect("a list");
    assert_eq!(comparisons.len(), 10);
    assert!(comparisons.iter().all(|pair| pair["profit_usd"]["p_value"].is_number()));
}

#[test]
fn a_report_replaces_an_older_one_and_leaves_no_other_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&made_up::study(5), folder.path(), false).expect("a report");
    fs::write(folder.path().join("figure-of-before.svg"), "<svg/>").expect("an older figure");
    let paths = write(&made_up::study(9), folder.path(), false).expect("a second report");
    assert!(read(&paths.page).contains("9 unseen days"));
    let files = fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(files, {
        let study = made_up::study(9);
        folder::files(&comparison_folder(&summary(&study), &study)).len()
    });
}

#[test]
fn a_report_that_cannot_be_written_names_the_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("taken");
    fs::write(&file, "").expect("a file");
    let error = write(&made_up::study(3), &file, false).expect_err("a file is no folder");
    assert_eq!(error.code().0, 401);
    assert!(error.to_string().contains("taken"), "{error}");
}

#[test]
fn a_folder_is_checked_without_a_trace() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    folder::check(&folder.path().join("new/folder"), false).expect("a folder that can be made");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
    folder::check(folder.path(), false).expect("a folder that is there");
    assert!(folder.path().exists(), "it stays");
    let file = folder.path().join("taken");
    fs::write(&file, "").expect("a file");
    for taken in [file.clone(), file.join("below")] {
        assert_eq!(folder::check(&taken, false).expect_err("a file").code().0, 401);
    }
    assert!(file.exists());
}

/// The error for a change to a sound study of five policies on four days.
fn refusal(change: impl FnOnce(&mut ComparisonRecords)) -> (String, String) {
    let mut study = made_up::study(4);
    change(&mut study);
    let error: Error = ComparisonReport::of(&study).expect_err("an unsound study");
    (error.code().to_string(), error.to_string())
}

#[test]
fn records_that_cannot_be_compared_are_refused() {
    let refusals = [
        refusal(|study| study.policies.clear()),
        refusal(|study| study.days = 0),
        refusal(|study| study.policies[2].days.swap(0, 1)),
        refusal(|study| study.policies[1].days.truncate(3)),
        refusal(|study| study.days = 5),
        refusal(|study| study.days = 3),
        refusal(|study| study.policies[0].days[3].totals.reward = f64::NAN),
    ];
    let text: Vec<String> = refusals.iter().map(|(code, text)| format!("{code}: {text}")).collect();
    insta::assert_snapshot!(text.join("\n"));
}
