//! The disk fills up, and has room again: no acknowledged event is lost, and the service continues
//! without a restart.
//!
//! The disk is a small one in memory, which the operating system lets the test mount in a separate
//! namespace. Where it does not, the test prints that and ends.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use crate::service::Service;
use serde_json::{Value, json};

/// Writes before the disk is full, while it is, and after it has room again.
const WRITES: usize = 60;

/// Mounts the disk and runs a command. The disk exists until this shell ends.
const SCRIPT: &str = r#"mount -t tmpfs -o size=8m tmpfs "$0" || exit 9
"$@"
exec sleep 600"#;

/// A shell with a small separate disk, on which the service runs.
struct SmallDisk {
    shell: Service,
    folder: PathBuf,
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        self.kill_service();
    }
}

impl SmallDisk {
    /// Starts the service; `None` if the operating system permits no mount.
    fn start(place: &Path) -> Option<Self> {
        let mut serve = Service::command("127.0.0.1:0");
        serve.arg("--data").arg(place.join("data"));
        let mut shell = Command::new("unshare");
        shell.args(["--user", "--map-root-user", "--mount", "sh", "-c", SCRIPT]).arg(place);
        shell.arg(serve.get_program()).args(serve.get_args());
        match Service::start(&mut shell) {
            Ok(shell) => {
                // The disk in the view of processes outside the namespace.
                let seen = format!("/proc/{}/root{}", shell.child.id(), place.display());
                Some(Self { shell, folder: seen.into() })
            }
            Err(said) => {
                eprintln!("skipped: {said}");
                None
            }
        }
    }

    fn kill_service(&self) {
        let children = format!("/proc/{0}/task/{0}/children", self.shell.child.id());
        let children = std::fs::read_to_string(children).unwrap_or_default();
        for child in children.split_whitespace() {
            let _ = Command::new("kill").args(["-9", child]).status();
        }
    }

    fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.shell.address)
    }

    fn post(&self, path: &str, key: &str, body: &Value) -> (u16, Value) {
        let agent: ureq::Agent = ureq::Agent::config_builder()
            .http_status_as_error(false)
            .timeout_global(Some(Duration::from_secs(30)))
            .build()
            .into();
        let request = agent.post(self.url(path)).header("idempotency-key", key);
        let mut answer = request.send(body.to_string().as_bytes()).expect("the service answers");
        let text = answer.body_mut().read_to_vec().expect("a body");
        (answer.status().as_u16(), serde_json::from_slice(&text).expect("JSON"))
    }

    fn is_ready(&self) -> bool {
        let answer = ureq::get(self.url("/readyz")).call();
        answer.is_ok_and(|answer| answer.status() == 200)
    }

    /// Writes events with marks. Returns the marks that were acknowledged.
    fn write(&self, day: &str, when: &str) -> Vec<String> {
        let send = |number: usize| {
            let mark = format!("{when} {number} {}", "x".repeat(900));
            let body = json!({"type": "out_of_service", "aircraft": "A01", "reason": mark});
            let (status, answer) = self.post(&format!("{day}/events"), &mark[..16], &body);
            assert!(matches!(status, 201 | 503), "{status} {answer}");
            (status == 201).then_some(mark)
        };
        (0..WRITES).filter_map(send).collect()
    }
}

#[test]
fn a_full_disk_loses_no_acknowledged_event_and_the_service_continues() {
    let place = tempfile::tempdir().expect("a folder");
    let Some(disk) = SmallDisk::start(place.path()) else { return };
    let (status, made) =
        disk.post("/v1/days", "day", &json!({"network": "paper", "policy": "greedy"}));
    assert_eq!(status, 201, "{made}");
    let id = made["id"].as_str().expect("an id");
    let day = format!("/v1/days/{id}");
    let mut acknowledged = disk.write(&day, "at first");
    assert_eq!(acknowledged.len(), WRITES);

    let filler = disk.folder.join("filler");
    let mut file = std::fs::File::create(&filler).expect("a file");
    for size in [100_000, 1_000, 1] {
        while file.write_all(&vec![0; size]).is_ok() {}
    }
    drop(file);
    let while_full = disk.write(&day, "when full");
    assert!(while_full.len() < WRITES, "the disk was never full");
    assert!(!disk.is_ready(), "a service whose store takes nothing must not say that it is ready");
    acknowledged.extend(while_full);

    std::fs::remove_file(&filler).expect("it was there");
    for _ in 0..100 {
        if disk.is_ready() {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    let afterwards = disk.write(&day, "afterwards");
    assert_eq!(afterwards.len(), WRITES, "it goes on when there is room again");
    acknowledged.extend(afterwards);

    disk.kill_service();
    let copy = tempfile::tempdir().expect("a folder");
    for name in ["vertifleet.db", "vertifleet.db-wal"] {
        let from = disk.folder.join("data").join(name);
        std::fs::copy(from, copy.path().join(name)).expect("the data");
    }
    let exported = Command::new(assert_cmd::cargo::cargo_bin!("vertifleet"))
        .args(["serve", "export", id, "--data"])
        .arg(copy.path())
        .output()
        .expect("the program runs");
    let exported: Value = serde_json::from_slice(&exported.stdout).expect("JSON");
    let stored: Vec<&str> = exported["events"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|event| event["event"]["reason"].as_str())
        .collect();
    assert_eq!(stored, acknowledged);
}
