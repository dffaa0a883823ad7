//! Invented trip records, the same for the same seed, as CSV in the style of New York's taxi
//! records and as Parquet.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::data_type::{DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

/// 2015-06-01 00:00, a Monday, in seconds since 1970.
const FIRST_S: u64 = 1_433_116_800;
const DAYS: u64 = 30;

/// A trip, with coordinates in millionths of a degree so that both kinds of file hold the same
/// numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Trip {
    pub(crate) pickup_s: u64,
    pub(crate) passengers: u8,
    /// Latitude and longitude.
    pub(crate) pickup: (i64, i64),
    pub(crate) dropoff: (i64, i64),
}

/// Pseudo-random numbers (SplitMix64).
pub(crate) struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A whole number below `limit`.
    pub(crate) fn below(&mut self, limit: u64) -> u64 {
        self.next() % limit
    }

    /// A place within about 3 miles of one of these places, in millionths of a degree.
    fn place(&mut self, around: &[(f64, f64)]) -> (i64, i64) {
        let (latitude, longitude) =
            around[usize::try_from(self.below(around.len() as u64)).expect("small")];
        let mut away = |degrees: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "degrees in millionths are small")]
            let middle = (degrees * 1e6).round() as i64;
            // The sum of two draws is more often near the middle.
            middle + i64::try_from(self.below(40_000) + self.below(40_000)).expect("small") - 40_000
        };
        (away(latitude), away(longitude))
    }
}

/// Trips around these places (latitude and longitude), in the order of their times within a month.
pub(crate) fn trips(around: &[(f64, f64)], count: u64, seed: u64) -> impl Iterator<Item = Trip> {
    let mut random = Random(seed);
    let all_s = DAYS * 86_400;
    (0..count).map(move |trip| Trip {
        pickup_s: FIRST_S + all_s * trip / count.max(1),
        passengers: u8::try_from(random.below(7)).expect("below 7"),
        pickup: random.place(around),
        dropoff: random.place(around),
    })
}

/// A time as `YYYY-MM-DD HH:MM:SS`; all times are in June and the first days of July 2015.
fn time(seconds: u64) -> String {
    let of_june = (seconds - FIRST_S) / 86_400 + 1;
    let (month, day) = if of_june > 30 { (7, of_june - 30) } else { (6, of_june) };
    let second = seconds % 86_400;
    format!(
        "2015-{month:02}-{day:02} {:02}:{:02}:{:02}",
        second / 3600,
        second / 60 % 60,
        second % 60
    )
}

fn degrees(millionths: i64) -> f64 {
    millionths as f64 / 1e6
}

/// Writes a table with some of the columns of New York's taxi records of 2015.
pub(crate) fn write_csv(mut file: impl Write, trips: impl Iterator<Item = Trip>) -> io::Result<()> {
    file.write_all(
        b"VendorID,tpep_pickup_datetime,tpep_dropoff_datetime,passenger_count,trip_distance,pickup_longitude,\
          pickup_latitude,RateCodeID,store_and_fwd_flag,dropoff_longitude,dropoff_latitude,payment_type,total_amount\n",
    )?;
    for trip in trips {
        let (from, to) = (trip.pickup, trip.dropoff);
        writeln!(
            file,
            "2,{},{},{},1.59,{:.6},{:.6},1,N,{:.6},{:.6},1,17.05",
            time(trip.pickup_s),
            time(trip.pickup_s + 900),
            trip.passengers,
            degrees(from.1),
            degrees(from.0),
            degrees(to.1),
            degrees(to.0),
        )?;
    }
    file.flush()
}

/// A column of numbers: whether values may be missing, and the value of a trip.
type NumberColumn = (bool, fn(&Trip) -> f64);

/// Writes the same columns that are read, and one that is not, in row groups of a given number of
/// rows.
pub(crate) fn write_parquet(
    file: impl Write + Send,
    trips: impl Iterator<Item = Trip>,
    rows_of_group: usize,
) -> parquet::errors::Result<()> {
    let schema = "message trips {
        optional int64 tpep_pickup_datetime (TIMESTAMP_MICROS);
        optional double passenger_count;
        optional double pickup_latitude;
        required double pickup_longitude;
        optional double dropoff_latitude;
        required double dropoff_longitude;
        required double total_amount;
    }";
    let properties = WriterProperties::builder()
        .set_compression(parquet::basic::Compression::SNAPPY)
        .set_write_batch_size(4096)
        .build();
    let schema = Arc::new(parse_message_type(schema)?);
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties))?;
    let mut trips = trips.peekable();
    while trips.peek().is_some() {
        let rows: Vec<Trip> = trips.by_ref().take(rows_of_group).collect();
        let present = vec![1_i16; rows.len()];
        let mut group = writer.next_row_group()?;
        let micros = |trip: &Trip| i64::try_from(trip.pickup_s).expect("small") * 1_000_000;
        let mut column = group.next_column()?.expect("the time");
        let times: Vec<i64> = rows.iter().map(micros).collect();
        column.typed::<Int64Type>().write_batch(&times, Some(&present), None)?;
        column.close()?;
        let columns: [NumberColumn; 6] = [
            (true, |trip| f64::from(trip.passengers)),
            (true, |trip| degrees(trip.pickup.0)),
            (false, |trip| degrees(trip.pickup.1)),
            (true, |trip| degrees(trip.dropoff.0)),
            (false, |trip| degrees(trip.dropoff.1)),
            (false, |_| 17.05),
        ];
        for (optional, value) in columns {
            let values: Vec<f64> = rows.iter().map(value).collect();
            let mut column = group.next_column()?.expect("a column of numbers");
            let levels = optional.then_some(present.as_slice());
            column.typed::<DoubleType>().write_batch(&values, levels, None)?;
            column.close()?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(())
}
