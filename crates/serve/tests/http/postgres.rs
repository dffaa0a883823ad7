//! Two services that share a `PostgreSQL` database, which Debian's packages bring (`scripts/database`).

use std::net::TcpListener;
use std::os::unix::fs::{PermissionsExt as _, chown};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::json;
use vertifleet_serve::Location;

use crate::operated_days::{day, operated, simulated};
use crate::running::Running;

/// A database server of its own, on a port of its own.
struct Postgres {
    folder: tempfile::TempDir,
    server: Child,
    location: Location,
}

/// The newest server that is installed.
fn programs() -> PathBuf {
    let versions = std::fs::read_dir("/usr/lib/postgresql").into_iter().flatten();
    let mut found: Vec<PathBuf> = versions.filter_map(|entry| Some(entry.ok()?.path())).collect();
    found.sort();
    found.pop().expect("PostgreSQL is installed: `scripts/database` installs it").join("bin")
}

/// A program of the server. It refuses to run as root, so root runs it as the user that the package makes.
fn command(program: &str) -> Command {
    let path = programs().join(program);
    if !is_root() {
        return Command::new(path);
    }
    let mut command = Command::new("runuser");
    command.args(["-u", "postgres", "--"]).arg(path);
    command
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output().expect("id runs");
    id.stdout == b"0\n"
}

fn own(folder: &Path) {
    std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o700))
        .expect("a folder of ours");
    if is_root() {
        let id = |flag: &str| -> u32 {
            let id = Command::new("id").args([flag, "postgres"]).output().expect("id runs");
            String::from_utf8_lossy(&id.stdout).trim().parse().expect("the package makes the user")
        };
        chown(folder, Some(id("-u")), Some(id("-g"))).expect("root may");
    }
}

impl Postgres {
    fn start() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        own(folder.path());
        let made = command("initdb")
            .args(["-A", "trust", "-U", "postgres", "-D"])
            .arg(folder.path())
            .current_dir("/")
            .output()
            .expect("initdb runs");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let port = TcpListener::bind("127.0.0.1:0")
            .and_then(|socket| socket.local_addr())
            .expect("a port")
            .port();
        let server = command("postgres")
            .arg("-D")
            .arg(folder.path())
            .arg("-k")
            .arg(folder.path())
            .args(["-p", &port.to_string(), "-c", "listen_addresses=127.0.0.1"])
            .current_dir("/")
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        let url = format!("postgres://postgres@127.0.0.1:{port}/postgres");
        let begun = Instant::now();
        while std::net::TcpStream::connect(("127.0.0.1", port)).is_err() {
            assert!(begun.elapsed() < Duration::from_secs(20), "PostgreSQL starts");
            thread::sleep(Duration::from_millis(50));
        }
        Self { folder, server, location: Location::Postgres(url) }
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        // Not SIGKILL, which would leave its children and the memory that they share. The first line of this file is the
        // process that the server runs in, which is not the one that was started if another user runs it.
        let pid = std::fs::read_to_string(self.folder.path().join("postmaster.pid"));
        let pid = pid.unwrap_or_default().lines().next().unwrap_or_default().to_owned();
        let _ = Command::new("kill").args(["-INT", &pid]).status();
        let _ = self.server.wait();
    }
}

#[test]
fn two_services_share_a_database() {
    let database = Postgres::start();
    let one = Running::start_at(database.location.clone());
    let two = Running::start_at(database.location.clone());
    // A whole day through one of them.
    let paper = day("paper", 2_002);
    assert_eq!(operated(&one, &paper, "greedy").totals, simulated(&paper, "greedy"));
    // Both write to one day, and each sees what the other wrote.
    let path = one.new_day("greedy");
    let decide = |service: &Running, aircraft: &str| {
        service.post(&format!("{path}/decisions"), &json!({"aircraft": aircraft}))
    };
    assert_eq!(decide(&one, "A01").status, 201);
    assert_eq!(decide(&two, "A02").json["seq"], 2);
    assert_eq!(one.get(&path).json["seq"], 2);
    assert_eq!(decide(&two, "A01").status, 422, "it has been sent off through the other service");
    assert_eq!(one.get(&format!("{path}/state")).json, two.get(&format!("{path}/state")).json);
    // They write at the same time: every event is there once.
    thread::scope(|scope| {
        for (number, service) in [&one, &two, &one, &two].into_iter().enumerate() {
            let path = &path;
            scope.spawn(move || {
                for event in 0..25 {
                    let key = format!("{number}-{event}");
                    let body = json!({"type": "out_of_service", "aircraft": "A40", "reason": key})
                        .to_string();
                    let begun = Instant::now();
                    loop {
                        let headers = [("idempotency-key", key.as_str())];
                        let answer = service.send(
                            "POST",
                            &format!("{path}/events"),
                            &headers,
                            body.as_bytes(),
                        );
                        if answer.status == 201 {
                            break;
                        }
                        assert!(
                            answer.status == 503 && begun.elapsed() < Duration::from_secs(20),
                            "{answer:?}"
                        );
                    }
                }
            });
        }
    });
    let events = two.get(&format!("{path}/events?limit=1000")).json;
    let marks: std::collections::BTreeSet<&str> = events["events"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|event| event["event"]["reason"].as_str())
        .collect();
    assert_eq!((marks.len(), one.get(&path).json["seq"].as_u64()), (100, Some(102)));
}
