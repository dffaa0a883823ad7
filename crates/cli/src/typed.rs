//! Parses the values of arguments one by one. The error of an invalid value states the expected
//! form.

use std::fmt::Display;
use std::str::FromStr;
use std::time::Duration;

use vertifleet_core::{Coded as _, Purpose};
use vertifleet_import::NewVertiport;
use vertifleet_study::size::Goal;
use vertifleet_study::sweep::Factor;
use vertifleet_study::{MOST_DAYS, PolicySource};

pub(crate) fn parse_pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() && !value.is_empty() => {
            Ok((name.to_owned(), value.to_owned()))
        }
        _ => Err("expected a name, an equals sign and a value".to_owned()),
    }
}

pub(crate) fn parse_model(text: &str) -> Result<(String, PolicySource), String> {
    parse_pair(text).map(|(name, path)| (name, PolicySource::File(path.into())))
}

/// A setting of a network and its values.
pub(crate) fn parse_factor(text: &str) -> Result<Factor, String> {
    Factor::parse(text).map_err(|error| with_hint(&error))
}

/// The goal of a design.
pub(crate) fn parse_goal(text: &str) -> Result<Goal, String> {
    Goal::parse(text).map_err(|error| with_hint(&error))
}

fn with_hint(error: &vertifleet_study::Error) -> String {
    let hint = error.hint().map_or_else(String::new, |hint| format!("; {hint}"));
    format!("{error}{hint}")
}

/// A value of a type that parses itself and states the expected form.
pub(crate) fn parse_known<T: FromStr<Err: Display>>(text: &str) -> Result<T, String> {
    text.parse().map_err(|error: T::Err| error.to_string())
}

/// A vertiport as `ID,LATITUDE,LONGITUDE` with the number of its stands behind it, or else 4.
pub(crate) fn parse_vertiport(text: &str) -> Result<NewVertiport, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let (&[id, latitude, longitude], stands) = (match parts.as_slice() {
        [place @ .., stands] if parts.len() == 4 => (place, *stands),
        place => (place, "4"),
    }) else {
        return Err("expected ID,LATITUDE,LONGITUDE or ID,LATITUDE,LONGITUDE,STANDS".to_owned());
    };
    let number =
        |text: &str| text.parse().map_err(|_| format!("{text:?} is not a number of degrees"));
    Ok(NewVertiport {
        id: id.to_owned(),
        latitude: number(latitude)?,
        longitude: number(longitude)?,
        stands: stands.parse().map_err(|_| format!("{stands:?} is not a number of stands"))?,
    })
}

/// A policy's name. Blanks around it are removed, since users put them after commas.
pub(crate) fn parse_name(text: &str) -> Result<String, String> {
    match text.trim() {
        "" => Err("expected a policy's name, found none; is there a comma too many?".to_owned()),
        name => Ok(name.to_owned()),
    }
}

/// The purpose of days.
pub(crate) fn parse_split(text: &str) -> Result<Purpose, String> {
    let known = Purpose::ALL.map(Purpose::name).join(", ");
    Purpose::named(text).ok_or_else(|| format!("expected one of {known}"))
}

/// A number of days or networks.
pub(crate) fn parse_count(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(count @ 1..=MOST_DAYS) => Ok(count),
        _ => Err(format!("expected a whole number from 1 to {MOST_DAYS}")),
    }
}

/// A seed. The code that draws from it checks its upper limit.
pub(crate) fn parse_seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| "seeds are whole numbers from 0".to_owned())
}

/// The seed of a training run, parsed as by [`parse_seed`].
pub(crate) fn parse_seed_of_a_run(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "seeds of a training are whole numbers from 0 to 16777215".to_owned())
}

/// The number of decisions to learn from.
pub(crate) fn parse_steps(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| "expected a whole number".to_owned())
}

/// The length of a bound's slices in minutes. The code that proves the bound checks its limits.
pub(crate) fn parse_minutes(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "expected whole minutes from 1 to 60".to_owned())
}

pub(crate) fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=1024) => Ok(threads),
        _ => Err("expected a number from 1 to 1024".to_owned()),
    }
}

pub(crate) fn parse_seconds(text: &str) -> Result<Duration, String> {
    match text.parse() {
        Ok(seconds @ 0.0..=1e6) => Ok(Duration::from_secs_f64(seconds)),
        _ => Err("expected seconds from 0 to 1000000".to_owned()),
    }
}

/// A number that is a share. The code that uses it checks its limits.
pub(crate) fn parse_mode_share(text: &str) -> Result<f64, String> {
    let percent = text.trim().strip_suffix('%').and_then(|number| number.trim().parse().ok());
    if let Some(percent) = percent {
        let percent: f64 = percent;
        return Err(format!("expected a share from 0 to 1: {percent} % are {}", percent / 100.0));
    }
    text.parse().map_err(|_| "expected a share from 0 to 1, as 0.05 for 5 %".to_owned())
}

pub(crate) fn parse_share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share @ 0.0..=1.0) => Ok(share),
        _ => Err("expected a share from 0 to 1, as 0.03".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::parse_mode_share;

    #[test]
    fn a_share_in_percent_is_refused_with_the_share() {
        for text in ["5%", " 5 %", "5.0%"] {
            let problem = parse_mode_share(text).expect_err("percent");
            assert_eq!(problem, "expected a share from 0 to 1: 5 % are 0.05");
        }
        assert_eq!(parse_mode_share("0.05"), Ok(0.05));
        assert!(parse_mode_share("five").is_err_and(|problem| problem.contains("0.05 for 5 %")));
    }
}
