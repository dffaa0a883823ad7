//! The codes of the errors, their hints and exit codes.

use vertifleet_core::{Code, Coded, Exit};

use super::Error;

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::Core(error) => return error.code(),
            Self::Study(error) => return error.code(),
            Self::InList { cause, .. } | Self::Overtaken { cause, .. } => return cause.code(),
            Self::BadRequest { .. } => 601,
            Self::NotFound { .. } | Self::NoSuchEvent { .. } => 602,
            Self::UnknownId { .. } => 603,
            Self::ReportError(_) => 604,
            Self::Moved { .. } => 605,
            Self::Store { .. } | Self::StoreHangs { .. } => 606,
            Self::BadData { .. } | Self::ForeignData { .. } => 607,
            Self::Archived { .. } => 608,
            Self::KeyReused { .. } => 609,
            Self::NoToken => 610,
            Self::CannotListen { .. } => 611,
            Self::TooMuch { .. } => 612,
            Self::NoAnswer { .. } => 613,
            Self::KeyInUse { .. } => 614,
            Self::Internal { .. } => 615,
            Self::NotAllowed { .. } => 616,
            Self::Contradiction { .. } => 617,
            Self::NotPermitted { .. } => 618,
            Self::Unprotected { .. } => 619,
            Self::InUse { .. } => 620,
            Self::Conflict => 621,
            Self::TooSlow { .. } => 622,
            Self::TooOften { .. } => 623,
            Self::BadCertificate { .. } => 624,
            Self::BadCollector { .. } => 625,
            Self::BadBasemap { .. } => 626,
            Self::ForeignPage { .. } => 627,
            Self::BadDatabase => 628,
            Self::NameTaken { .. } => 629,
            Self::PolicyInUse { .. } => 630,
            Self::OtherLog { .. } => 631,
            Self::CannotCorrect(_) => 632,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::Core(error) => error.hint(),
            Self::Study(error) => error.hint(),
            Self::InList { cause, .. } | Self::Overtaken { cause, .. } => cause.hint(),
            Self::Moved { .. } => Some("read the day again, and decide again"),
            Self::ReportError(_) => {
                Some("if the event did happen, report first the events that led to it")
            }
            Self::NoSuchEvent { .. } | Self::OtherLog { .. } => {
                Some("the day may have been put back from a copy: read its state again")
            }
            Self::NotFound { what: "policy", .. } => Some(
                "GET /v1/policies lists them; PUT /v1/policies/NAME keeps weights under a name",
            ),
            Self::NotFound { what: "network", .. } => {
                Some("GET /v1/networks lists them; PUT /v1/networks/NAME keeps a network file")
            }
            Self::Archived { .. } => Some("POST /v1/days/DAY/unarchive opens it again"),
            Self::KeyReused { .. } => Some("use a new Idempotency-Key for each request"),
            Self::BadData { .. } => Some("`vertifleet serve verify` names the damaged part"),
            Self::ForeignData { .. } => Some(
                "use the program that wrote it or a newer one, or name the right folder or file",
            ),
            Self::NoToken => Some("send it as `Authorization: Bearer vf_...`"),
            Self::ForeignPage { .. } => Some(
                "ask for 127.0.0.1 or localhost, or make a token: `vertifleet serve token make`",
            ),
            Self::Unprotected { .. } => Some(
                "listen on 127.0.0.1, or name a certificate (--certificate, --key) or stand behind a proxy that speaks TLS (--behind-proxy), and make a token",
            ),
            _ => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            Self::Study(error) => error.exit(),
            Self::Store { .. }
            | Self::StoreHangs { .. }
            | Self::Internal { .. }
            | Self::CannotListen { .. }
            | Self::NoAnswer { .. } => Exit::Failed,
            _ => Exit::Input,
        }
    }
}
