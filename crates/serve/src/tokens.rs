//! Tokens: their roles, and how their text is checked, of which only a hash is stored.

use serde::Serialize;
use sha2::{Digest as _, Sha256};
use subtle::ConstantTimeEq as _;
use utoipa::ToSchema;

use crate::error::Error;

/// Every token begins like this, so that secret scanners recognise it.
const PREFIX: &str = "vf_";

/// The role of a token. Each role includes the ones before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// To read days, and to ask for proposals, outlooks and what-if.
    Read,
    /// To report events and to take decisions, and to make days and studies.
    Dispatch,
    /// To archive days, open them again and delete them, and to upload networks and policies.
    Admin,
}

impl Role {
    /// All roles.
    pub const ALL: [Self; 3] = [Self::Read, Self::Dispatch, Self::Admin];

    /// The role's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Dispatch => "dispatch",
            Self::Admin => "admin",
        }
    }

    /// The role with a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }
}

/// A token as it is stored. Its secret is not.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StoredToken {
    /// Its id, which is the first part of the token.
    pub id: String,
    /// Its name in the audit.
    pub name: String,
    /// Its role.
    pub role: Role,
    /// SHA-256 of its secret, in hexadecimal digits.
    #[serde(skip)]
    pub hash: String,
    /// When it was made, milliseconds of the Unix clock.
    pub created_ms: i64,
    /// When it was revoked; 0 if it is in force.
    pub revoked_ms: i64,
}

impl StoredToken {
    /// Draws a token, and its text, which cannot be shown again.
    ///
    /// # Errors
    /// Returns [`Error::Internal`] if the operating system has no random numbers.
    pub(crate) fn draw(name: &str, role: Role, created_ms: i64) -> Result<(Self, String), Error> {
        let (id, secret) = (random_digits(4)?, random_digits(32)?);
        let text = format!("{PREFIX}{id}_{secret}");
        let (name, hash) = (name.to_owned(), hash(&secret));
        Ok((Self { id, name, role, hash, created_ms, revoked_ms: 0 }, text))
    }

    /// Checks that its role includes a role.
    pub(crate) fn check(&self, needed: Role) -> Result<(), Error> {
        if self.role < needed {
            return Err(Error::NotPermitted { role: self.role.name(), needed: needed.name() });
        }
        Ok(())
    }
}

/// The valid token whose text this is.
pub(crate) fn matching<'a>(tokens: &'a [StoredToken], given: &str) -> Option<&'a StoredToken> {
    let (id, secret) = given.strip_prefix(PREFIX)?.split_once('_')?;
    let token = tokens.iter().find(|token| token.id == id && token.revoked_ms == 0)?;
    let is_it: bool = hash(secret).as_bytes().ct_eq(token.hash.as_bytes()).into();
    is_it.then_some(token)
}

pub(crate) fn hash(secret: &str) -> String {
    hexadecimal(&Sha256::digest(secret.as_bytes()))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

fn random_digits(bytes: usize) -> Result<String, Error> {
    let mut random = vec![0; bytes];
    let failed = |error: getrandom::Error| Error::Internal { cause: error.to_string() };
    getrandom::fill(&mut random).map_err(failed)?;
    Ok(hexadecimal(&random))
}

#[cfg(test)]
mod tests {
    use super::{Role, StoredToken, hash, matching};

    fn token(revoked_ms: i64) -> StoredToken {
        StoredToken {
            id: "1f".to_owned(),
            name: "console".to_owned(),
            role: Role::Dispatch,
            hash: hash("secret"),
            created_ms: 1,
            revoked_ms,
        }
    }

    #[test]
    fn a_token_matches_by_its_whole_secret_and_only_while_it_is_valid() {
        let (good, revoked) = ([token(0)], [token(5)]);
        assert_eq!(matching(&good, "vf_1f_secret"), Some(&good[0]));
        for wrong in ["vf_1f_secre", "vf_1f_secret2", "vf_1e_secret", "1f_secret", "vf_1f", ""] {
            assert_eq!(matching(&good, wrong), None, "{wrong:?}");
        }
        assert_eq!(matching(&revoked, "vf_1f_secret"), None);
    }
}
