//! A `PostgreSQL` server for tests of services that keep their data in one. Debian's packages bring
//! it (`scripts/database`).

use std::net::{TcpListener, TcpStream};
use std::os::unix::fs::{PermissionsExt as _, chown};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Time limit for a server to start, even after a crash.
const START_TIMEOUT: Duration = Duration::from_secs(20);

/// A separate database server on a separate port. It ends when it is dropped.
#[derive(Debug)]
pub struct Postgres {
    folder: tempfile::TempDir,
    port: u16,
    server: Child,
}

impl Postgres {
    /// Starts a server with an empty database.
    ///
    /// # Panics
    /// Panics if `PostgreSQL` is not installed, or does not start.
    pub fn start() -> Self {
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
        let server = serve(folder.path(), port);
        Self { folder, port, server }
    }

    /// The address of the database, as an argument of a service.
    pub fn url(&self) -> String {
        format!("postgres://postgres@127.0.0.1:{}/postgres", self.port)
    }

    /// Ends the server like a crash: uncommitted data is lost.
    pub fn crash(&mut self) {
        self.signal("-QUIT");
        let _ = self.server.wait();
    }

    /// Starts the server again.
    ///
    /// # Panics
    /// Panics if it does not start.
    pub fn resume(&mut self) {
        self.server = serve(self.folder.path(), self.port);
    }

    /// Suspends all processes of the server, so that its connections stay open and do not answer.
    pub fn freeze(&self) {
        self.signal("-STOP");
        self.signal_connections("-STOP");
    }

    /// Resumes them.
    pub fn thaw(&self) {
        self.signal_connections("-CONT");
        self.signal("-CONT");
        // A program that runs the server as another user stops when the server does.
        let _ = Command::new("kill").args(["-CONT", &self.server.id().to_string()]).status();
    }

    /// Each connection has a separate process.
    fn signal_connections(&self, signal: &str) {
        let pid = self.pid();
        let children = std::fs::read_to_string(format!("/proc/{pid}/task/{pid}/children"));
        let children = children.unwrap_or_default();
        // A connection may have ended in the meantime.
        let _ = Command::new("kill").arg(signal).args(children.split_whitespace()).output();
    }

    /// The first line of the file is the process that the server runs in, which is not the one that
    /// was started if another user runs it.
    fn pid(&self) -> String {
        let file = std::fs::read_to_string(self.folder.path().join("postmaster.pid"));
        file.unwrap_or_default().lines().next().unwrap_or_default().to_owned()
    }

    fn signal(&self, signal: &str) {
        let _ = Command::new("kill").args([signal, &self.pid()]).status();
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        // A test may have failed while the server was frozen, and a frozen one does not end.
        self.thaw();
        // Not SIGKILL, which would leave its children and the memory that they share.
        self.signal("-INT");
        let _ = self.server.wait();
    }
}

/// The newest installed server.
fn programs() -> PathBuf {
    let versions = std::fs::read_dir("/usr/lib/postgresql").into_iter().flatten();
    let mut found: Vec<PathBuf> = versions.filter_map(|entry| Some(entry.ok()?.path())).collect();
    found.sort();
    found.pop().expect("PostgreSQL is installed: `scripts/database` installs it").join("bin")
}

/// A program of the server. It refuses to run as root, so root runs it as the user that the package
/// creates.
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

/// Runs the server on a port, and returns when it listens.
fn serve(folder: &Path, port: u16) -> Child {
    let server = command("postgres")
        .arg("-D")
        .arg(folder)
        .arg("-k")
        .arg(folder)
        .args(["-p", &port.to_string(), "-c", "listen_addresses=127.0.0.1"])
        .current_dir("/")
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    let begun = Instant::now();
    while TcpStream::connect(("127.0.0.1", port)).is_err() {
        assert!(begun.elapsed() < START_TIMEOUT, "PostgreSQL starts");
        thread::sleep(Duration::from_millis(50));
    }
    server
}
