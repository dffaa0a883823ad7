"""Writes the networks of San Francisco Bay, Los Angeles, Dallas and Paris from the tables beside this file.

    python3 networks/sources/make.py            # writes networks/san-francisco.toml and the others
    python3 networks/sources/make.py --check    # changes nothing; fails if a file differs

README.md says where every table is from and how demand follows from them. What the tables do not say is in
a template of each network, as san-francisco.template.toml: fleet, tariffs, disturbances, their sources.
"""

import csv
import math
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent

# The radius of the Earth of crates/core, in miles, so that distances here are those of the program.
EARTH_MI = 3_958.761_3
# assumption: people come to a vertiport from up to 12 miles away, and to the nearest one.
CATCHMENT_MI = 12.0
# assumption: three fifths of all passengers fly to or from an airline.
AIRLINE_SHARE = 0.6
# assumption: a trip of 15 miles or more saves enough time to be considered, a shorter one in proportion.
WORTHWHILE_MI = 15.0
# assumption: before noon seven tenths of those who fly between a busy site and another fly to the busy one.
TO_WORK_SHARE = 0.7
NOON = 12
# Pairs with fewer passengers a day have none: an aircraft would wait for them all day.
LEAST_A_DAY = 2.0


@dataclass(frozen=True)
class Recipe:
    """What a network has beside its tables and its template."""

    # Each has 100 passengers a day: Archer's finance officer counted on 25 trips with four seats taken.
    aircraft: int
    first_hour: int
    last_hour: int
    # The table of those who live around the sites.
    people: str

    @property
    def passengers(self) -> int:
        """Passengers a day of all pairs together."""
        return 100 * self.aircraft

    @property
    def hours(self) -> range:
        """The hours in which they fly."""
        return range(self.first_hour, self.last_hour)


RECIPES = {
    "san-francisco": Recipe(aircraft=30, first_hour=6, last_hour=21, people="homes.csv"),
    "los-angeles": Recipe(aircraft=40, first_hour=6, last_hour=22, people="homes.csv"),
    "dallas": Recipe(aircraft=36, first_hour=6, last_hour=22, people="homes.csv"),
    "paris": Recipe(aircraft=28, first_hour=7, last_hour=21, people="places.csv"),
}

Place = tuple[float, float]


def rows(table: str) -> list[dict[str, str]]:
    """The rows of a table beside this file."""
    with (HERE / table).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def sites(network: str) -> list[dict[str, str]]:
    """The sites of a network, in its order."""
    return [row for row in rows("sites.csv") if row["network"] == network]


def positions(network: str) -> dict[str, Place]:
    """Where the sites of a network are: as OurAirports has it, or sites.csv for those that it lacks."""
    airports = {row["ident"]: row for row in rows("airports.csv")}
    found = {}
    for site in sites(network):
        if site["ident"]:
            airport = airports[site["ident"]]
            found[site["id"]] = (float(airport["latitude_deg"]), float(airport["longitude_deg"]))
        else:
            found[site["id"]] = (float(site["latitude"]), float(site["longitude"]))
    return {site: (round(latitude, 5), round(longitude, 5)) for site, (latitude, longitude) in found.items()}


def miles(one: Place, other: Place) -> float:
    """The great-circle distance."""
    (from_lat, from_lon), (to_lat, to_lon) = (tuple(map(math.radians, place)) for place in (one, other))
    across = math.sin((to_lat - from_lat) / 2) ** 2
    across += math.cos(from_lat) * math.cos(to_lat) * math.sin((to_lon - from_lon) / 2) ** 2
    return 2 * EARTH_MI * math.asin(math.sqrt(across))


def people(network: str, table: str) -> dict[str, float]:
    """Those who live nearest to each site: households with 200,000 dollars a year, or inhabitants."""
    at = positions(network)
    living = dict.fromkeys(at, 0.0)
    for row in rows(table):
        home = (float(row["latitude_deg"]), float(row["longitude_deg"]))
        nearest = min(at, key=lambda site: miles(home, at[site]))
        if miles(home, at[nearest]) <= CATCHMENT_MI:
            if "population" in row:
                living[nearest] += float(row["population"])
            else:
                living[nearest] += float(row["households"]) * float(row["share_over_200k"])
    return living


def scaled(weights: dict[tuple[str, str], float], total: float) -> dict[tuple[str, str], float]:
    """The total, shared out in proportion to the weights."""
    factor = total / sum(weights.values())
    return {pair: weight * factor for pair, weight in weights.items()}


def passengers_a_day(network: str) -> tuple[dict[tuple[str, str], float], dict[tuple[str, str], float]]:
    """Mean passengers a day of each pair: those on their way to or from an airline, and the others."""
    recipe, at = RECIPES[network], positions(network)
    living = people(network, recipe.people)
    airline = {}
    for row in rows("traffic.csv"):
        airline[row["id"]] = float(row["passengers"]) * float(row["of_them_local"] or 1)
    flyers, others = {}, {}
    for start in at:
        for end in at:
            if start != end:
                worth = min(1.0, miles(at[start], at[end]) / WORTHWHILE_MI)
                flyers[start, end] = worth * (
                    airline.get(start, 0) * living[end] + airline.get(end, 0) * living[start]
                )
                others[start, end] = worth * living[start] * living[end]
    flyers = scaled(flyers, AIRLINE_SHARE * recipe.passengers)
    others = scaled(others, (1 - AIRLINE_SHARE) * recipe.passengers)
    kept = [pair for pair in flyers if flyers[pair] + others[pair] >= LEAST_A_DAY]
    factor = recipe.passengers / sum(flyers[pair] + others[pair] for pair in kept)
    return {pair: factor * flyers[pair] for pair in kept}, {pair: factor * others[pair] for pair in kept}


def demand(network: str) -> dict[tuple[str, str], list[float]]:
    """Mean passengers of each pair and hour."""
    hours = RECIPES[network].hours
    trips = {int(row["hour"]): float(row["vehicle_trips"]) for row in rows("hours.csv")}
    share = {hour: trips[hour] / sum(trips[hour] for hour in hours) for hour in hours}
    morning = sum(share[hour] for hour in hours if hour < NOON)
    # As many fly back from a busy site over the day as fly to it.
    home_share = (0.5 - TO_WORK_SHARE * morning) / (1 - morning)
    busy = {site["id"] for site in sites(network) if site["busy"] == "true"}
    flyers, others = passengers_a_day(network)
    found = {}
    for start, end in flyers:
        both = others[start, end] + others.get((end, start), 0.0)
        found[start, end] = []
        for hour in hours:
            to_work = TO_WORK_SHARE if hour < NOON else home_share
            part = 0.5
            if (start in busy) != (end in busy):
                part = to_work if end in busy else 1 - to_work
            found[start, end].append(share[hour] * (flyers[start, end] + part * both))
    return found


def vertiports(network: str) -> str:
    """The tables of the vertiports."""
    at, found = positions(network), []
    for site in sites(network):
        latitude, longitude = at[site["id"]]
        where = f"OurAirports: {site['ident']}" if site["ident"] else f"position of {site['source']}"
        found.append(
            f"[[vertiports]]  # {site['name']} ({where})\n"
            f'id = "{site["id"]}"\nlatitude = {latitude:.5f}\nlongitude = {longitude:.5f}\n'
            f"stands = {site['stands']}\nbusy = {site['busy']}\n"
        )
    return "\n".join(found)


def text(network: str) -> str:
    """The network file."""
    pairs = []
    for (start, end), means in demand(network).items():
        numbers = ", ".join(f"{mean:.2f}" for mean in means)
        pairs.append(f'    {{ from = "{start}", to = "{end}", passengers = [{numbers}] }},\n')
    starts = [f'"{hour:02}:00:00"' for hour in RECIPES[network].hours]
    lines = [", ".join(starts[at : at + 8]) for at in range(0, len(starts), 8)]
    insertions = {
        "@vertiports@": vertiports(network).rstrip("\n"),
        "@aircraft types@": (HERE / "aircraft-types.toml").read_text(encoding="utf-8").rstrip("\n"),
        "@periods@": "periods = [\n" + "".join(f"    {line},\n" for line in lines) + "]",
        "@pairs@": "pairs = [\n" + "".join(pairs) + "]",
    }
    written = (HERE / f"{network}.template.toml").read_text(encoding="utf-8")
    for place, content in insertions.items():
        assert written.count(f"{place}\n") == 1, f"{network}.template.toml has {place} once"
        written = written.replace(f"{place}\n", f"{content}\n")
    return written


def main() -> None:
    """Writes or checks all of them."""
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    for network in RECIPES:
        path = HERE.parent / f"{network}.toml"
        if not check:
            path.write_text(text(network), encoding="utf-8", newline="\n")
        elif path.read_text(encoding="utf-8") != text(network):
            sys.exit(f"{path.name} is not what its sources say: run python3 networks/sources/make.py")


if __name__ == "__main__":
    main()
