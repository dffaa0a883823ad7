//! Opens a store: connects, creates or upgrades its tables, and checks its version.

use std::path::Path;
use std::time::{Duration, Instant};

use sqlx::any::{AnyPoolOptions, install_default_drivers};
use sqlx::{Any, AnyConnection, Connection as _, Executor as _, Transaction, query, query_scalar};
use tokio::time::sleep;

use super::server::{Server, TIMEOUT};
use super::{DATABASE, Location, Store, VERSION};
use crate::error::Error;

/// Interval between two tries to reach a server.
const PAUSE: Duration = Duration::from_millis(100);
/// The statements that create the tables.
const TABLES: [&str; 10] = [
    "CREATE TABLE IF NOT EXISTS meta (name TEXT PRIMARY KEY, value TEXT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS days (
        id TEXT PRIMARY KEY, name TEXT NOT NULL, created_ms BIGINT NOT NULL, archived BIGINT NOT NULL,
        policy TEXT NOT NULL, date TEXT NOT NULL DEFAULT '',
        time_zone TEXT NOT NULL DEFAULT '', sum BIGINT NOT NULL DEFAULT -1,
        seq BIGINT NOT NULL DEFAULT 0, chain BIGINT NOT NULL DEFAULT 0)",
    // A separate table from the rows of days, which change with every event.
    "CREATE TABLE IF NOT EXISTS scenarios (day TEXT PRIMARY KEY, scenario TEXT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS events (
        day TEXT NOT NULL, seq BIGINT NOT NULL, at_ms BIGINT NOT NULL, actor TEXT NOT NULL,
        body TEXT NOT NULL, notices TEXT NOT NULL, chain BIGINT NOT NULL,
        append_id BIGINT NOT NULL DEFAULT 0, PRIMARY KEY (day, seq))",
    "CREATE TABLE IF NOT EXISTS answers (
        idempotency_key TEXT PRIMARY KEY, request TEXT NOT NULL, answer TEXT NOT NULL,
        at_ms BIGINT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS tokens (
        id TEXT PRIMARY KEY, name TEXT NOT NULL, role TEXT NOT NULL, hash TEXT NOT NULL,
        created_ms BIGINT NOT NULL, revoked_ms BIGINT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS audit (
        at_ms BIGINT NOT NULL, actor TEXT NOT NULL, action TEXT NOT NULL, target TEXT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS networks (
        name TEXT PRIMARY KEY, toml TEXT NOT NULL, created_ms BIGINT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS policies (
        name TEXT PRIMARY KEY, weights BYTEA NOT NULL, sha256 TEXT NOT NULL, created_ms BIGINT NOT NULL)",
    // Descriptions of networks and policies, so that listing them does not read their content. Rows
    // may be missing.
    "CREATE TABLE IF NOT EXISTS descriptions (
        kind TEXT NOT NULL, name TEXT NOT NULL, program TEXT NOT NULL, created_ms BIGINT NOT NULL,
        description TEXT NOT NULL, PRIMARY KEY (kind, name, program))",
];

/// If two tokens are made with one name at the same moment, one is refused.
const ONE_NAME: &str =
    "CREATE UNIQUE INDEX IF NOT EXISTS tokens_in_force ON tokens (name) WHERE revoked_ms = 0";

/// The lock of PostgreSQL under which tables are created: the letters of `fleet`.
const LOCK: i64 = 0x66_6c65_6574;

/// The upgrades of older stores, each with the last version that needs it. Version 6 only adds
/// kinds of events, so that earlier programs refuse the store instead of calling its logs damaged.
const ADDED_AFTER: [(&str, &str); 10] = [
    ("1", "ALTER TABLE days ADD COLUMN date TEXT NOT NULL DEFAULT ''"),
    ("1", "ALTER TABLE days ADD COLUMN time_zone TEXT NOT NULL DEFAULT ''"),
    ("2", "ALTER TABLE days ADD COLUMN sum BIGINT NOT NULL DEFAULT -1"),
    ("3", "ALTER TABLE events ADD COLUMN append_id BIGINT NOT NULL DEFAULT 0"),
    ("4", "ALTER TABLE days ADD COLUMN seq BIGINT NOT NULL DEFAULT 0"),
    ("4", "ALTER TABLE days ADD COLUMN chain BIGINT NOT NULL DEFAULT 0"),
    (
        "4",
        "UPDATE days SET seq = last.seq, chain = last.chain FROM events AS last WHERE last.day = days.id
         AND last.seq = (SELECT MAX(seq) FROM events WHERE day = days.id)",
    ),
    ("4", "INSERT INTO scenarios (day, scenario) SELECT id, scenario FROM days"),
    ("4", "ALTER TABLE days DROP COLUMN scenario"),
    (
        "4",
        "UPDATE tokens SET name = name || '-' || id WHERE revoked_ms = 0 AND EXISTS (
         SELECT 1 FROM tokens AS other WHERE other.name = tokens.name AND other.revoked_ms = 0
         AND other.id < tokens.id)",
    ),
];

/// The settings of each connection to `SQLite`: a write-ahead log, so that readers do not wait,
/// which is written to the disk before a commit is answered.
const SQLITE: &str =
    "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA busy_timeout = 5000;
    PRAGMA foreign_keys = ON";

/// A first connection, which reports the error; a pool would retry and finally report only a
/// timeout. A server may be about to start, so it has a while.
async fn connect(url: &str, is_shared: bool) -> Result<AnyConnection, sqlx::Error> {
    let begun = Instant::now();
    loop {
        match AnyConnection::connect(url).await {
            Err(_) if is_shared && begun.elapsed() < TIMEOUT => sleep(PAUSE).await,
            outcome => return outcome,
        }
    }
}

/// Begins a transaction, and creates the tables in it if there are none. Services that start at the
/// same time wait for each other.
async fn make_tables(
    database: &mut AnyConnection,
    is_shared: bool,
) -> Result<Transaction<'_, Any>, sqlx::Error> {
    // SQLite guarantees that a transaction can write only if it begins as one that writes.
    let begin = if is_shared { "BEGIN" } else { "BEGIN IMMEDIATE" };
    let mut transaction = database.begin_with(begin).await?;
    if is_shared {
        query("SELECT 1 FROM (SELECT pg_advisory_xact_lock($1)) AS held")
            .bind(LOCK)
            .execute(&mut *transaction)
            .await?;
    }
    for statement in TABLES {
        query(statement).execute(&mut *transaction).await?;
    }
    Ok(transaction)
}

/// Upgrades a store of an earlier version.
async fn bring_up_to_date(database: &mut AnyConnection) -> Result<(), Error> {
    query("INSERT INTO meta (name, value) VALUES ('version', $1) ON CONFLICT (name) DO NOTHING")
        .bind(VERSION)
        .execute(&mut *database)
        .await?;
    let found: String = query_scalar("SELECT value FROM meta WHERE name = 'version'")
        .fetch_one(&mut *database)
        .await?;
    if found == VERSION {
        return Ok(());
    }
    // Versions have one digit, so their order is that of their texts.
    if !(found.len() == 1 && ("1"..VERSION).contains(&&*found)) {
        let rule =
            format!("it is of version {found:?}, and this program reads version {VERSION:?}");
        return Err(Error::ForeignData { rule });
    }
    for (_, statement) in ADDED_AFTER.iter().filter(|(version, _)| *version >= &*found) {
        query(*statement).execute(&mut *database).await?;
    }
    query("UPDATE meta SET value = $1 WHERE name = 'version'")
        .bind(VERSION)
        .execute(&mut *database)
        .await?;
    Ok(())
}

impl Store {
    /// Opens a store, and creates its tables if there are none.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the database cannot be reached, [`Error::BadDatabase`] if it is
    /// not a `PostgreSQL` database, and [`Error::BadData`] if a newer program wrote it.
    pub(crate) async fn open(location: &Location) -> Result<Self, Error> {
        if let Location::Postgres(url) = location
            && !["postgres://", "postgresql://"].iter().any(|scheme| url.starts_with(scheme))
        {
            return Err(Error::BadDatabase);
        }
        install_default_drivers();
        // A failure in a transaction may leave a connection in an unusable state: when a disk is
        // full, SQLite ends the transaction, and all later statements would be part of one that is
        // never committed.
        let mut options = AnyPoolOptions::new()
            .max_connections(8)
            // Longer than the limit of a query, which then ends first.
            .acquire_timeout(2 * TIMEOUT)
            .before_acquire(|connection, _| {
                let is_free = !connection.is_in_transaction();
                Box::pin(async move { Ok(is_free) })
            });
        let url = match location {
            Location::Folder(folder) => {
                make_folder(folder).map_err(|cause| Error::Store {
                    cause: format!("{}: {cause}", folder.display()),
                })?;
                options = options.after_connect(|connection, _| {
                    Box::pin(async move { connection.execute(SQLITE).await.map(drop) })
                });
                sqlite_url(&folder.join(DATABASE))
            }
            Location::Postgres(url) => url.clone(),
        };
        let server = match location {
            Location::Folder(_) => None,
            Location::Postgres(url) => Some(Server::at(url)),
        };
        let is_shared = server.is_some();
        let mut first = connect(&url, is_shared).await.map_err(of_opening)?;
        if !is_shared {
            first.execute(SQLITE).await.map_err(of_opening)?;
        }
        let mut transaction = make_tables(&mut first, is_shared).await.map_err(of_opening)?;
        bring_up_to_date(&mut transaction).await?;
        query(ONE_NAME).execute(&mut *transaction).await?;
        transaction.commit().await?;
        first.close().await?;
        Ok(Self { pool: options.connect(&url).await?, server })
    }

    /// Opens a store that must exist.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if it does not, and the errors of [`open`](Self::open).
    pub(crate) async fn open_existing(location: &Location) -> Result<Self, Error> {
        if let Location::Folder(folder) = location {
            let file = folder.join(DATABASE);
            let missing = || {
                let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
                let cause = format!("there is no data of a service in {}", folder.display());
                Error::Store { cause }
            };
            if !file.exists() {
                return Err(missing());
            }
            install_default_drivers();
            let mut database =
                AnyConnection::connect(&sqlite_url(&file)).await.map_err(of_opening)?;
            let select = "SELECT name FROM sqlite_master WHERE name = 'meta'";
            let found = query(select).fetch_optional(&mut database).await;
            database.close().await?;
            if found.map_err(of_opening)?.is_none() {
                return Err(missing());
            }
        }
        Self::open(location).await
    }
}

/// The error of a store that cannot be opened.
fn of_opening(error: sqlx::Error) -> Error {
    match &error {
        sqlx::Error::Database(cause)
            if ["malformed", "not a database"]
                .iter()
                .any(|rule| cause.message().contains(rule)) =>
        {
            Error::ForeignData { rule: cause.message().to_owned() }
        }
        _ => error.into(),
    }
}

/// Creates a folder that only its owner can read, unless it exists.
pub(crate) fn make_folder(folder: &Path) -> std::io::Result<()> {
    let mut builder = std::fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    if folder.is_file() {
        let rule = "a file has this name, and a folder is needed";
        return Err(std::io::Error::new(std::io::ErrorKind::NotADirectory, rule));
    }
    builder.recursive(true).create(folder)
}

/// The address of a file, with percent-encoding of characters that have a meaning in addresses.
fn sqlite_url(path: &Path) -> String {
    let path = path.display().to_string();
    let path = path.replace('%', "%25").replace('?', "%3F").replace('#', "%23");
    format!("sqlite://{path}?mode=rwc")
}

#[cfg(test)]
mod tests {
    use sqlx::Executor as _;

    use crate::store::{Kind, Location, Store, StoredDay};

    #[tokio::test]
    async fn a_store_of_the_version_before_is_brought_up_to_date() {
        let folder = tempfile::tempdir().expect("a folder");
        let location = Location::Folder(folder.path().to_owned());
        let store = Store::open(&location).await.expect("a store");
        let day = StoredDay {
            id: "1".to_owned(),
            name: "old".to_owned(),
            created_ms: 7,
            archived: false,
            policy: "greedy".to_owned(),
            date: String::new(),
            time_zone: String::new(),
        };
        store.add_day(&day, "{}", None).await.expect("it is stored");
        for statement in [
            "ALTER TABLE days DROP COLUMN date",
            "ALTER TABLE days DROP COLUMN time_zone",
            "ALTER TABLE days DROP COLUMN sum",
            "ALTER TABLE events DROP COLUMN append_id",
            "ALTER TABLE days DROP COLUMN seq",
            "ALTER TABLE days DROP COLUMN chain",
            "ALTER TABLE days ADD COLUMN scenario TEXT NOT NULL DEFAULT '{}'",
            "DROP TABLE scenarios",
            "DROP INDEX tokens_in_force",
            "DROP TABLE networks",
            "DROP TABLE policies",
            "DROP TABLE descriptions",
            "UPDATE meta SET value = '1' WHERE name = 'version'",
        ] {
            store.pool.execute(statement).await.expect("a store as it was");
        }
        drop(store);
        for _ in 0..2 {
            let store = Store::open(&location).await.expect("it is brought up to date");
            assert_eq!(store.days("", 10).await.expect("days"), std::slice::from_ref(&day));
            let found = store.day("1").await.expect("it is there");
            assert_eq!(found, Some((day.clone(), "{}".to_owned())));
            let networks = store.uploaded::<()>(Kind::Network).await;
            assert_eq!(networks.expect("a table"), []);
        }
    }
}
