//! The data of the service: checked, copied, restored, and refused when it is damaged.

use std::path::Path;

use crate::service::Service;
use assert_cmd::Command;
use vertifleet_serve::{Location, Role, Tokens};

fn serve(arguments: &[&str], data: &Path) -> assert_cmd::assert::Assert {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("vertifleet"));
    command.arg("serve").args(arguments).arg("--data").arg(data).assert()
}

fn printed(outcome: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(outcome.get_output().stdout.clone()).expect("text")
}

/// Data with one day of two events, made by a service that was killed.
fn data(folder: &Path) -> String {
    let mut serve = Service::command("127.0.0.1:0");
    let service = Service::start(serve.arg("--data").arg(folder)).expect("it starts");
    let send = |path: &str, body: &str| {
        let url = format!("http://{}/v1/days{path}", service.address);
        let mut answer = ureq::post(url).send(body).expect("it answers");
        let text = answer.body_mut().read_to_string().expect("a body");
        serde_json::from_str::<serde_json::Value>(&text).expect("JSON")
    };
    let made = send("", r#"{"network": "paper", "policy": "greedy"}"#);
    let id = made["id"].as_str().expect("an id").to_owned();
    send(&format!("/{id}/decisions"), r#"{"aircraft": "A01"}"#);
    send(&format!("/{id}/decisions"), r#"{"aircraft": "A02"}"#);
    id
}

#[test]
fn data_is_checked_copied_and_restored() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let id = data(&first);
    assert_eq!(printed(&serve(&["verify"], &first).success()), format!("{id}: 2 events, sound\n"));
    let copy = folder.path().join("copy.db");
    let name = copy.to_str().expect("text");
    serve(&["backup", name], &first).success();
    serve(&["backup", name], &first).failure();
    serve(&["restore", name], &first).failure();
    serve(&["restore", name], &second).success();
    let exported = |data: &Path| printed(&serve(&["export", &id], data).success());
    assert_eq!(exported(&first), exported(&second));
    let day: serde_json::Value = serde_json::from_str(&exported(&second)).expect("JSON");
    assert_eq!(
        (&day["format"], &day["events"][1]["seq"]),
        (&"vertifleet-live-day/1".into(), &2.into())
    );
}

#[test]
fn damaged_data_is_found_and_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let id = data(folder.path());
    let database = folder.path().join("vertifleet.db");
    // The log of the database goes into its file, in which a letter of an event is then changed.
    let copy = folder.path().join("copy.db");
    serve(&["backup", copy.to_str().expect("text")], folder.path()).success();
    let mut bytes = std::fs::read(&copy).expect("it was written");
    let event = b"\"aircraft\":\"A02\",\"to\"";
    let at =
        bytes.windows(event.len()).position(|window| window == event).expect("the second event");
    bytes[at + 14] = b'3';
    std::fs::write(&copy, &bytes).expect("it is ours");
    let elsewhere = folder.path().join("elsewhere");
    let refused = serve(&["restore", copy.to_str().expect("text")], &elsewhere).failure();
    let said = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(said.contains("V607") && said.contains("event 2: its sum is wrong"), "{said}");
    assert!(!elsewhere.join("vertifleet.db").exists(), "nothing is put back");
    for old in ["vertifleet.db-wal", "vertifleet.db-shm"] {
        let _ = std::fs::remove_file(folder.path().join(old));
    }
    std::fs::write(&database, &bytes).expect("it is ours");
    let found = printed(&serve(&["verify"], folder.path()).code(1));
    assert!(
        found.starts_with(&format!("{id}: 1 events")) && found.contains("sum is wrong"),
        "{found}"
    );
}

#[test]
fn tokens_are_made_listed_and_revoked() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = serve(&["token", "make", "--name", "console", "--role", "dispatch"], folder.path());
    let token = printed(&made.success());
    assert!(token.starts_with("vf_") && token.trim().len() == 3 + 8 + 1 + 64, "{token}");
    let listed = printed(&serve(&["token", "list"], folder.path()).success());
    assert!(listed.contains("\"role\": \"dispatch\"") && !listed.contains("hash"), "{listed}");
    let id = &token[3..11];
    serve(&["token", "revoke", id], folder.path()).success();
    serve(&["token", "revoke", id], folder.path()).code(2);
    let tokens = Tokens::open(&Location::Folder(folder.path().to_owned())).expect("a store");
    let [token] = &tokens.list().expect("a list")[..] else { panic!("one token") };
    assert_eq!((token.role, token.revoked_ms > 0), (Role::Dispatch, true));
    let audit = printed(&serve(&["audit"], folder.path()).success());
    let actions: Vec<&str> = audit
        .lines()
        .filter_map(|line| line.split("\"action\":\"").nth(1)?.split('"').next())
        .collect();
    assert_eq!(actions, ["token made", "token revoked"], "{audit}");
}

#[test]
fn a_file_that_is_no_copy_of_a_service_is_not_restored() {
    let folder = tempfile::tempdir().expect("a folder");
    let (copy, data) = (folder.path().join("copy.db"), folder.path().join("data"));
    let copy_text = copy.display().to_string();
    for bytes in [&b""[..], b"no database at all, but long enough for a header of one"] {
        std::fs::write(&copy, bytes).expect("a file");
        serve(&["restore", &copy_text], &data).failure();
        assert!(!data.join("vertifleet.db").exists() && !data.join("restoring").exists());
    }
    serve(&["restore", &copy_text, "--database", "postgres://nowhere"], &data).code(2);
    // A copy is never written over an existing file.
    serve(&["token", "make", "--name", "a", "--role", "read"], &data).success();
    serve(&["backup", &copy_text], &data).failure();
    assert!(std::fs::read(&copy).expect("it is there").starts_with(b"no database"));
}

#[test]
fn a_changed_beginning_of_a_day_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let id = data(folder.path());
    let copy = folder.path().join("copy.db");
    serve(&["backup", copy.to_str().expect("text")], folder.path()).success();
    let mut bytes = std::fs::read(&copy).expect("it was written");
    let stands = b"\"stands\": 6";
    let at = bytes.windows(stands.len()).position(|window| window == stands).expect("a vertiport");
    bytes[at + stands.len() - 1] = b'9';
    std::fs::write(&copy, &bytes).expect("it is ours");
    let elsewhere = folder.path().join("elsewhere");
    let refused = serve(&["restore", copy.to_str().expect("text")], &elsewhere).failure();
    let said = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(said.contains("V607") && said.contains(&id) && said.contains("began with"), "{said}");
}

#[test]
#[cfg(unix)]
fn only_the_owner_can_read_copies_and_restored_data() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().expect("a folder");
    // Characters with a meaning in addresses are ordinary characters of a name.
    let (first, second) = (folder.path().join("a%42?#"), folder.path().join("second"));
    data(&first);
    let copy = folder.path().join("copy.db");
    serve(&["backup", copy.to_str().expect("text")], &first).success();
    serve(&["restore", copy.to_str().expect("text")], &second).success();
    let mode = |path: &Path| path.metadata().expect("it is there").permissions().mode() & 0o777;
    assert_eq!(mode(&copy), 0o600);
    assert_eq!(mode(&second.join("vertifleet.db")), 0o600);
    for data in [&first, &second] {
        assert_eq!(mode(data), 0o700, "{}", data.display());
        assert!(data.join("vertifleet.db").exists());
    }
    assert!(!folder.path().join("aB").exists());
}

#[test]
fn wrong_commands_create_no_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let nowhere = folder.path().join("nowhere");
    serve(&["token", "list"], &nowhere).failure();
    serve(&["token", "revoke", "1f"], &nowhere).failure();
    assert!(!nowhere.exists());
    for wrong in ["mysql://here", "foo", "sqlite:///any.db"] {
        let refused = serve(&["verify", "--database", wrong], &nowhere).code(2);
        let said = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(said.contains("V628"), "{said}");
    }
}
