//! The service in a separate process, as its users start it.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

/// A running service. It is killed when it is dropped.
pub(crate) struct Service {
    /// Its process, or that of a wrapper command.
    pub(crate) child: Child,
    /// The address in its log, such as `127.0.0.1:40123`.
    pub(crate) address: String,
}

impl Drop for Service {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Service {
    /// `vertifleet serve` at an address. Port 0 is any free port.
    pub(crate) fn command(listen: &str) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("vertifleet"));
        command.args(["serve", "--listen", listen]);
        command
    }

    /// Starts the program, or a wrapper command, and returns when the service listens.
    ///
    /// # Errors
    /// Returns the output if the service does not start.
    pub(crate) fn start(command: &mut Command) -> Result<Self, String> {
        let started = command.stderr(Stdio::piped()).spawn();
        let mut child = started.map_err(|error| format!("{command:?}: {error}"))?;
        let mut lines = BufReader::new(child.stderr.take().expect("a pipe")).lines();
        // On a busy machine it may first warn of a slow statement; those lines are JSON.
        let mut said =
            lines.by_ref().map_while(Result::ok).skip_while(|line| line.starts_with('{'));
        let first = said.next().unwrap_or_default();
        let address =
            first.strip_prefix("listening on http://").and_then(|at| at.split(',').next());
        let mut service = Self { child, address: String::new() };
        address.ok_or(&first)?.clone_into(&mut service.address);
        // Later output must not fill the pipe.
        std::thread::spawn(move || lines.for_each(drop));
        Ok(service)
    }
}
