//! Tests that `serve --demo` shows a day in progress, and leaves no data.

use std::process::Command;
use std::time::{Duration, Instant};

use crate::service::Service;
use serde_json::Value;

fn get(url: &str) -> String {
    ureq::get(url).call().expect("an answer").body_mut().read_to_string().expect("a text")
}

fn days(address: &str) -> Vec<Value> {
    let days: Value =
        serde_json::from_str(&get(&format!("http://{address}/v1/days"))).expect("JSON");
    days["days"].as_array().expect("a list").clone()
}

fn wait_for<T>(mut found: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(begun.elapsed() < Duration::from_mins(1), "it does not come");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn the_demo_shows_a_day_in_progress_and_keeps_no_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Service::command("127.0.0.1:0");
    command.arg("--demo").env("TMPDIR", folder.path()).current_dir(folder.path());
    let mut service = Service::start(&mut command).expect("it starts");
    assert!(get(&format!("http://{}/", service.address)).contains("<title>Vertifleet</title>"));
    let day = wait_for(|| days(&service.address).pop());
    assert_eq!(day["name"], "new-york-1");
    let id = day["id"].as_str().expect("an id");
    let state = format!("http://{}/v1/days/{id}/state", service.address);
    wait_for(|| {
        let state: Value = serde_json::from_str(&get(&state)).expect("JSON");
        (state["totals"]["flights"].as_u64() > Some(0)).then_some(())
    });
    let asked = Command::new("kill").args(["-TERM", &service.child.id().to_string()]).status();
    assert!(asked.expect("kill").success());
    let ended = service.child.wait().expect("it ends");
    assert!(ended.success(), "{ended}");
    let left: Vec<_> = folder.path().read_dir().expect("a folder").collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn the_demo_takes_no_data_options() {
    let mut command = Service::command("127.0.0.1:0");
    let refused = Service::start(command.args(["--demo", "--data", "here"]));
    assert!(refused.err().expect("it does not start").contains("--demo"));
}
