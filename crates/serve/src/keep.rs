//! Maintenance of the data: checks every event, makes and restores copies, and exports days.

mod tokens;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use serde_json::value::RawValue;
use tokio::runtime::Runtime;
use vertifleet_core::Scenario;

pub use self::tokens::Tokens;
use crate::days::replay;
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::store::{AuditRecord, DATABASE, Location, PAGE, Store, StoredDay, make_folder};
use crate::taken_event::TakenEvent;

/// The data of a service, which may be running.
#[derive(Debug)]
pub struct Keeper {
    runtime: Runtime,
    store: Store,
}

/// The findings about a day.
#[derive(Debug, Clone, Serialize)]
pub struct DayCheck {
    /// Its id.
    pub day: String,
    /// Number of its events that are sound, from the first on.
    pub events: u64,
    /// The error in the next one, or in the day; `None` if there is none.
    pub finding: Option<String>,
}

/// The amount of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Contents {
    /// Number of days.
    pub days: u64,
    /// Number of events of all days.
    pub events: u64,
}

/// An exported day.
#[derive(Debug, Serialize)]
struct Exported {
    format: &'static str,
    #[serde(flatten)]
    day: StoredDay,
    scenario: Box<RawValue>,
    events: Vec<ExportedEvent>,
}

/// An exported event, without the members that only the log needs.
#[derive(Debug, Serialize)]
struct ExportedEvent {
    seq: u64,
    at_ms: i64,
    actor: String,
    event: Box<RawValue>,
    notices: Box<RawValue>,
}

/// Name and version of the format of exported days.
const FORMAT: &str = "vertifleet-live-day/1";

impl Drop for Keeper {
    fn drop(&mut self) {
        self.runtime.block_on(self.store.close());
    }
}

impl Keeper {
    /// Opens the data of a service, which must exist.
    ///
    /// # Errors
    /// Returns [`Error::Store`] or [`Error::BadData`] if it does not exist or cannot be opened.
    pub fn open(location: &Location) -> Result<Self, Error> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|cause| Error::Internal { cause: cause.to_string() })?;
        let store = runtime.block_on(Store::open_existing(location))?;
        Ok(Self { runtime, store })
    }

    /// Reads every event of every day, checks its checksum, and plays it. Days that are missing
    /// although they were not deleted come last.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the data cannot be read at all.
    pub fn verify(&self, mut found: impl FnMut(DayCheck)) -> Result<(), Error> {
        let mut after = String::new();
        loop {
            let days = self.runtime.block_on(self.store.days(&after, PAGE))?;
            let Some(last) = days.last() else { break };
            after.clone_from(&last.id);
            for day in &days {
                if let Some(check) = self.runtime.block_on(self.check(&day.id))? {
                    found(check);
                }
            }
        }
        for day in self.runtime.block_on(self.store.lost_days())? {
            let finding = Some("the day is missing, and no deletion is recorded".to_owned());
            found(DayCheck { day, events: 0, finding });
        }
        Ok(())
    }

    /// Checks a day; `None` if it has been deleted in the meantime.
    async fn check(&self, id: &str) -> Result<Option<DayCheck>, Error> {
        let check = |events, finding| Some(DayCheck { day: id.to_owned(), events, finding });
        let (_, scenario) = match self.store.day(id).await {
            Ok(Some(found)) => found,
            Ok(None) => return Ok(None),
            Err(Error::BadData { rule }) => return Ok(check(0, Some(rule))),
            Err(error) => return Err(error),
        };
        // The head first: the service may add events in the meantime.
        let Some(head) = self.store.head(id).await? else { return Ok(None) };
        let mut state = match Scenario::from_json(scenario.as_bytes(), id) {
            Ok(scenario) => DispatchDay::new(Arc::new(scenario)),
            Err(error) => return Ok(check(0, Some(error.to_string()))),
        };
        let replayed = replay(&self.store, id, &mut state, u64::MAX).await;
        match replayed.and_then(|()| state.check_head(head)) {
            Ok(()) => Ok(check(state.seq(), None)),
            Err(_) if self.store.head(id).await?.is_none() => Ok(None),
            Err(Error::BadData { rule }) => Ok(check(state.seq(), Some(rule))),
            Err(failure) => Ok(check(state.seq(), Some(failure.to_string()))),
        }
    }

    /// Writes a consistent copy of all data to a new file, while the service may be running.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the file exists or cannot be written, or if the data is in
    /// `PostgreSQL`, whose own programs make copies.
    pub fn backup(&self, file: &Path) -> Result<(), Error> {
        if self.store.is_shared() {
            let cause = "a PostgreSQL database is copied by pg_dump".to_owned();
            return Err(Error::Store { cause });
        }
        if file.exists() {
            return Err(Error::Store { cause: format!("{} is there already", file.display()) });
        }
        // Under another name until it is complete, so that an incomplete copy is never mistaken for
        // one.
        let mut unfinished = file.as_os_str().to_owned();
        unfinished.push(".unfinished");
        let unfinished = PathBuf::from(unfinished);
        let failed = |error: std::io::Error| Error::Store {
            cause: format!("{}: {error}", unfinished.display()),
        };
        // SQLite fills an existing empty file, and keeps its permissions.
        let written = new_private_file(&unfinished).map_err(failed).and_then(|_| {
            self.runtime.block_on(self.store.copy_to(&unfinished.display().to_string()))
        });
        let named = written.and_then(|()| {
            std::fs::File::open(&unfinished).and_then(|copy| copy.sync_all()).map_err(failed)?;
            std::fs::rename(&unfinished, file).map_err(failed)
        });
        if named.is_err() {
            // It may not exist.
            let _ = std::fs::remove_file(&unfinished);
        }
        named
    }

    /// The actions of users except events of days, in order.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if they cannot be read.
    pub fn audit(&self) -> Result<Vec<AuditRecord>, Error> {
        self.runtime.block_on(self.store.audit())
    }

    /// A day with its scenario and all events, as JSON.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such day, and [`Error::Store`].
    pub fn export(&self, id: &str) -> Result<String, Error> {
        self.runtime.block_on(async {
            let found = self.store.day(id).await?;
            let (day, scenario) = found.ok_or_else(|| Error::not_found("day", id))?;
            let mut events: Vec<TakenEvent> = Vec::new();
            loop {
                let after = events.last().map_or(0, |event| event.seq);
                let page = self.store.events(id, after, PAGE).await?;
                events.extend(page.events);
                if page.is_last {
                    return written_out(day, scenario, events);
                }
            }
        })
    }
}

fn written_out(day: StoredDay, scenario: String, events: Vec<TakenEvent>) -> Result<String, Error> {
    let raw = |text: String| {
        RawValue::from_string(text).map_err(|error| Error::BadData { rule: error.to_string() })
    };
    let event = |event: TakenEvent| {
        let TakenEvent { seq, at_ms, actor, body, notices, .. } = event;
        Ok(ExportedEvent { seq, at_ms, actor, event: raw(body)?, notices: raw(notices)? })
    };
    let events = events.into_iter().map(event).collect::<Result<_, Error>>()?;
    let exported = Exported { format: FORMAT, day, scenario: raw(scenario)?, events };
    Ok(serde_json::to_string_pretty(&exported).expect("plain data can be written"))
}

/// Restores a copy as the data of a service, into a folder that has none.
///
/// # Errors
/// Returns [`Error::Store`] if the folder has data already or cannot be written to, and
/// [`Error::BadData`] if the copy is damaged.
pub fn restore(copy: &Path, folder: &Path) -> Result<Contents, Error> {
    let database = folder.join(DATABASE);
    let failed = |cause: String| Error::Store { cause };
    // A log left behind by an earlier database would be applied to the copy.
    for name in [DATABASE.to_owned(), format!("{DATABASE}-wal"), format!("{DATABASE}-shm")] {
        let there = folder.join(name);
        if there.exists() {
            let said = format!("{} is there already: name a folder without data", there.display());
            return Err(failed(said));
        }
    }
    let bytes =
        std::fs::read(copy).map_err(|error| failed(format!("{}: {error}", copy.display())))?;
    // The copy is checked in a separate folder, so that a damaged one is never mistaken for the
    // data of a service.
    let trial: PathBuf = folder.join("restoring");
    let io_failed = |error: std::io::Error| failed(format!("{}: {error}", trial.display()));
    make_folder(&trial).map_err(io_failed)?;
    let checked = put_back(&bytes, &trial, &database);
    let removed = std::fs::remove_dir_all(&trial);
    let contents = checked?;
    removed.map_err(io_failed)?;
    Ok(contents)
}

/// Checks a copy in the folder `trial`, which only its owner can read, and moves it to `database`.
fn put_back(bytes: &[u8], trial: &Path, database: &Path) -> Result<Contents, Error> {
    let failed =
        |error: std::io::Error| Error::Store { cause: format!("{}: {error}", trial.display()) };
    let write = |name: &str| {
        let mut file = new_private_file(&trial.join(name))?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    write(DATABASE).map_err(failed)?;
    let contents = check_copy(trial)?;
    // Opening the copy for the check may have changed it.
    write("copy").map_err(failed)?;
    std::fs::rename(trial.join("copy"), database).map_err(failed)?;
    if let Some(folder) = database.parent() {
        std::fs::File::open(folder).and_then(|folder| folder.sync_all()).map_err(failed)?;
    }
    Ok(contents)
}

/// Creates a file that only its owner can read.
fn new_private_file(path: &Path) -> std::io::Result<std::fs::File> {
    let mut options = std::fs::OpenOptions::new();
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.write(true).create_new(true).open(path)
}

fn check_copy(folder: &Path) -> Result<Contents, Error> {
    let keeper = Keeper::open(&Location::Folder(folder.to_owned()))?;
    let mut finding = None;
    let mut contents = Contents { days: 0, events: 0 };
    keeper.verify(|check| {
        contents.days += 1;
        contents.events += check.events;
        if let Some(rule) = check.finding {
            finding.get_or_insert(format!("day {}: {rule}", check.day));
        }
    })?;
    match finding {
        Some(rule) => Err(Error::BadData { rule }),
        None => Ok(contents),
    }
}
