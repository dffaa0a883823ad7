//! The meaning of the values of a Parquet column: which types can be read, and the cell that a
//! value becomes.

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::schema::types::ColumnDescriptor;

use crate::Error;
use crate::cell::Cell;
use crate::date_time::{DAY_S, Moment, Stamp};
use crate::error::shortened;

/// The values that a column must hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Values {
    /// Numbers, texts or times of day.
    Plain,
    /// Dates with times.
    Moments,
    /// Values of any type, to be shown.
    Any,
}

/// The meaning of the values of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Meaning {
    /// Numbers, texts or truth values, as they are.
    Plain,
    /// A date and time: a count of units since 1970, `per_second` to the second, of local clocks or
    /// (`utc`) of UTC.
    Time { per_second: i64, utc: bool },
    /// A date: a count of days since 1970.
    Date,
    /// A time of day: a count since midnight.
    TimeOfDay { per_second: i64 },
    /// A whole number, the last `scale` digits of which are after the decimal point.
    Decimal { scale: i32 },
}

/// A type that a column must not have.
pub(crate) struct WrongType {
    expected: &'static str,
    found: String,
}

impl WrongType {
    pub(crate) fn in_column(self, origin: &str, column: &str) -> Error {
        let Self { expected, found } = self;
        let column = shortened(column, 64);
        Error::ColumnType { origin: origin.to_owned(), column, expected, found }
    }
}

impl Meaning {
    /// The meaning of a column's values, if the column can hold the wanted ones.
    pub(crate) fn of(column: &ColumnDescriptor, wanted: Values) -> Result<Self, WrongType> {
        if wanted == Values::Any {
            let is_date = matches!(column.logical_type_ref(), Some(LogicalType::Date))
                || column.converted_type() == ConvertedType::DATE;
            let usual =
                Self::of(column, Values::Plain).or_else(|_| Self::of(column, Values::Moments));
            return Ok(if is_date { Self::Date } else { usual.unwrap_or(Self::Plain) });
        }
        let moment = wanted == Values::Moments;
        let logical = column.logical_type_ref();
        let plain = match (column.physical_type(), logical, column.converted_type()) {
            (Type::INT64, Some(LogicalType::Timestamp(time)), _) => {
                let utc = time.is_adjusted_to_u_t_c;
                return Ok(Self::Time { per_second: per_second(time.unit), utc });
            }
            // Programs that do not write the newer kind of type write wall-clock times in these.
            (Type::INT64, None, ConvertedType::TIMESTAMP_MILLIS) => {
                return Ok(Self::Time { per_second: 1_000, utc: false });
            }
            (Type::INT64, None, ConvertedType::TIMESTAMP_MICROS) => {
                return Ok(Self::Time { per_second: 1_000_000, utc: false });
            }
            (Type::INT96, _, _) => return Ok(Self::Time { per_second: 1, utc: false }),
            (Type::BYTE_ARRAY, None | Some(LogicalType::String | LogicalType::Enum), converted)
                if converted != ConvertedType::DECIMAL =>
            {
                return Ok(Self::Plain);
            }
            (Type::INT32 | Type::INT64, Some(LogicalType::Time(time)), _) => {
                Some(Self::TimeOfDay { per_second: per_second(time.unit) })
            }
            (Type::INT32, None, ConvertedType::TIME_MILLIS) => {
                Some(Self::TimeOfDay { per_second: 1_000 })
            }
            (Type::INT64, None, ConvertedType::TIME_MICROS) => {
                Some(Self::TimeOfDay { per_second: 1_000_000 })
            }
            (
                Type::INT32 | Type::INT64 | Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY,
                Some(LogicalType::Decimal(_)),
                _,
            )
            | (_, None, ConvertedType::DECIMAL) => {
                Some(Self::Decimal { scale: column.type_scale() })
            }
            (
                Type::INT32 | Type::INT64,
                None | Some(LogicalType::Integer(_)),
                ConvertedType::NONE
                | ConvertedType::INT_8
                | ConvertedType::INT_16
                | ConvertedType::INT_32
                | ConvertedType::INT_64
                | ConvertedType::UINT_8
                | ConvertedType::UINT_16
                | ConvertedType::UINT_32
                | ConvertedType::UINT_64,
            )
            | (Type::BOOLEAN | Type::FLOAT | Type::DOUBLE, None, _) => Some(Self::Plain),
            _ => None,
        };
        plain.filter(|_| !moment).ok_or_else(|| WrongType {
            expected: if moment {
                "timestamps, or texts as 2015-06-01 07:08:09"
            } else {
                "numbers, texts or times of day"
            },
            found: named(column),
        })
    }

    pub(crate) fn of_whole(self, value: i64) -> Cell<'static> {
        match self {
            Self::Plain => Cell::Whole(value),
            Self::Time { per_second, .. } => self.of_seconds(value.div_euclid(per_second)),
            Self::Date => self.of_seconds(value.saturating_mul(DAY_S.into())),
            Self::TimeOfDay { per_second } => {
                let second = u32::try_from(value.div_euclid(per_second)).ok();
                second.filter(|second| *second < DAY_S).map_or(Cell::Missing, Cell::TimeOfDay)
            }
            Self::Decimal { scale } => decimal(i128::from(value), scale),
        }
    }

    /// The date and time `seconds` after 1970 began.
    pub(crate) fn of_seconds(self, seconds: i64) -> Cell<'static> {
        let offset_s = matches!(self, Self::Time { utc: true, .. }).then_some(0);
        let moment = Moment::from_seconds(seconds);
        moment.map_or(Cell::Missing, |moment| Cell::Stamp(Stamp { moment, offset_s }))
    }

    pub(crate) fn of_bytes(self, bytes: &[u8]) -> Cell<'_> {
        let Self::Decimal { scale } = self else { return Cell::text(bytes) };
        // Big-endian, in two's complement. More than 16 bytes are more digits than any number in
        // these files has.
        let negative = bytes.first().is_some_and(|byte| byte & 0x80 != 0);
        let mut all = [if negative { 0xff } else { 0 }; 16];
        let Some(begin) = all.len().checked_sub(bytes.len()) else { return Cell::Missing };
        all[begin..].copy_from_slice(bytes);
        decimal(i128::from_be_bytes(all), scale)
    }
}

/// A number with `scale` digits after the decimal point, as it is read from its text.
fn decimal(unscaled: i128, scale: i32) -> Cell<'static> {
    let number = format!("{unscaled}e{}", -i64::from(scale)).parse();
    number.map_or(Cell::Missing, Cell::Number)
}

/// A number in single precision with the digits with which it is written, and not those of its
/// nearest double.
#[inline]
pub(crate) fn written(number: f32) -> f64 {
    // Whole numbers, and halves and quarters, are the same in both.
    if (number * 4.0).fract() == 0.0 {
        return number.into();
    }
    number.to_string().parse().unwrap_or(f64::NAN)
}

fn per_second(unit: TimeUnit) -> i64 {
    match unit {
        TimeUnit::MILLIS => 1_000,
        TimeUnit::MICROS => 1_000_000,
        TimeUnit::NANOS => 1_000_000_000,
    }
}

/// The type of a column in words.
fn named(column: &ColumnDescriptor) -> String {
    let words = match column.logical_type_ref() {
        Some(LogicalType::String | LogicalType::Enum) => "texts",
        Some(LogicalType::Map) => "maps",
        Some(LogicalType::List) => "lists",
        Some(LogicalType::Decimal(_)) => "decimal numbers",
        Some(LogicalType::Date) => "dates without a time",
        Some(LogicalType::Time(_)) => "times of day",
        Some(LogicalType::Timestamp(_)) => "timestamps",
        Some(LogicalType::Integer(_)) => "whole numbers",
        Some(LogicalType::Json | LogicalType::Bson) => "JSON",
        Some(LogicalType::Uuid) => "UUIDs",
        Some(LogicalType::Float16) => "numbers of 16 bits",
        Some(LogicalType::Geometry(_) | LogicalType::Geography(_)) => "geometries",
        Some(_) => "values of another kind",
        None => match (column.physical_type(), column.converted_type()) {
            (_, ConvertedType::DATE) => "dates without a time",
            (_, ConvertedType::TIME_MILLIS | ConvertedType::TIME_MICROS) => "times of day",
            (_, ConvertedType::DECIMAL) => "decimal numbers",
            (_, ConvertedType::INTERVAL) => "intervals of time",
            (Type::BOOLEAN, _) => "truth values",
            (Type::INT32 | Type::INT64, _) => "whole numbers",
            (Type::FLOAT | Type::DOUBLE, _) => "floating-point numbers",
            (Type::INT96, _) => "timestamps",
            (Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY, _) => "bytes",
        },
    };
    words.to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Meaning, written};
    use crate::cell::Cell;

    #[test]
    fn decimals_are_read_from_whole_numbers_and_from_bytes() {
        let money = Meaning::Decimal { scale: 2 };
        assert_eq!(money.of_whole(1_230), Cell::Number(12.3));
        assert_eq!(money.of_bytes(&[0x04, 0xce]), Cell::Number(12.3));
        assert_eq!(money.of_bytes(&[0xff, 0xff, 0x9c]), Cell::Number(-1.0));
        assert_eq!(money.of_bytes(&[1; 17]), Cell::Missing);
    }

    #[test]
    fn single_precision_keeps_its_digits() {
        assert_eq!([40.7_f32, -74.0, 0.1, 1e-20].map(written), [40.7, -74.0, 0.1, 1e-20]);
        assert!(written(f32::NAN).is_nan() && written(f32::INFINITY).is_infinite());
    }

    #[test]
    fn a_time_of_day_is_below_24_hours() {
        let time = Meaning::TimeOfDay { per_second: 1_000 };
        assert_eq!(time.of_whole(7 * 3_600_000), Cell::TimeOfDay(7 * 3_600));
        assert_eq!([-1, 86_400_000].map(|value| time.of_whole(value)), [Cell::Missing; 2]);
    }
}
