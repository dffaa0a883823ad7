//! The HTTP status of each error.

use axum::http::StatusCode;

use super::Error;

impl Error {
    /// The status of the answer.
    pub fn status(&self) -> StatusCode {
        match self {
            Self::Core(_) | Self::Study(_) | Self::BadRequest { .. } => StatusCode::BAD_REQUEST,
            Self::InList { cause, .. } | Self::Overtaken { cause, .. } => cause.status(),
            Self::NotFound { .. } | Self::NoSuchEvent { .. } | Self::OtherLog { .. } => {
                StatusCode::NOT_FOUND
            }
            Self::UnknownId { .. }
            | Self::ReportError(_)
            | Self::CannotCorrect(_)
            | Self::Contradiction { .. }
            | Self::KeyReused { .. } => StatusCode::UNPROCESSABLE_ENTITY,
            Self::Moved { .. } => StatusCode::PRECONDITION_FAILED,
            Self::TooMuch { what, .. } if what.starts_with("bytes") => {
                StatusCode::PAYLOAD_TOO_LARGE
            }
            Self::Store { .. } | Self::StoreHangs { .. } => StatusCode::SERVICE_UNAVAILABLE,
            Self::TooOften { .. } | Self::TooMuch { what: "streams", .. } => {
                StatusCode::TOO_MANY_REQUESTS
            }
            Self::Archived { .. }
            | Self::KeyInUse { .. }
            | Self::Conflict
            | Self::PolicyInUse { .. }
            | Self::NameTaken { .. }
            | Self::TooMuch { .. } => StatusCode::CONFLICT,
            Self::TooSlow { .. } => StatusCode::REQUEST_TIMEOUT,
            Self::NoToken => StatusCode::UNAUTHORIZED,
            Self::NotPermitted { .. } | Self::ForeignPage { .. } => StatusCode::FORBIDDEN,
            Self::NotAllowed { .. } => StatusCode::METHOD_NOT_ALLOWED,
            Self::BadData { .. }
            | Self::ForeignData { .. }
            | Self::Internal { .. }
            | Self::Unprotected { .. }
            | Self::InUse { .. }
            | Self::BadCertificate { .. }
            | Self::BadCollector { .. }
            | Self::BadBasemap { .. }
            | Self::BadDatabase
            | Self::CannotListen { .. }
            | Self::NoAnswer { .. } => StatusCode::INTERNAL_SERVER_ERROR,
        }
    }
}
