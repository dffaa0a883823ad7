"""Measures how soon a restarted dispatch service answers for a day of 100,000 events.

    make program
    python benches/restart.py target/release/vertifleet [ANOTHER/PROGRAM ...]

The first program makes the day. Then all are started by turns, six times each, and killed as soon as they
have answered. Everything runs on this machine, in a temporary folder.
"""

import json
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

EVENTS, TOGETHER, STARTS = 100_000, 500, 6
DEADLINE_S = 60


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Service:
    """A running service."""

    def __init__(self, program: str, data: Path) -> None:
        self.url = f"http://127.0.0.1:{free_port()}"
        command = [program, "serve", "--data", str(data), "--listen", self.url.removeprefix("http://")]
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def get(self, path: str) -> bytes:
        """The answer, as soon as the service listens."""
        until = time.monotonic() + DEADLINE_S
        while True:
            try:
                return urllib.request.urlopen(self.url + path).read()
            except urllib.error.URLError:
                if time.monotonic() > until or self.process.poll() is not None:
                    raise
                time.sleep(0.002)

    def post(self, path: str, body: object) -> dict[str, object]:
        headers = {"content-type": "application/json"}
        request = urllib.request.Request(self.url + path, json.dumps(body).encode(), headers)
        return json.load(urllib.request.urlopen(request))

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


def make_day(program: str, data: Path) -> str:
    """Makes a day with many events, and returns its path."""
    service = Service(program, data)
    service.get("/healthz")
    day = f"/v1/days/{service.post('/v1/days', {'network': 'paper', 'seed': 1})['id']}"
    booked = {"type": "booked", "period": "07:00:00", "from": "V1", "to": "V2", "passengers": 1}
    pair = [booked, booked | {"type": "cancelled"}]
    for _ in range(EVENTS // TOGETHER):
        service.post(f"{day}/events", pair * (TOGETHER // 2))
    service.kill()
    return day


def main(programs: list[str]) -> None:
    took_s: dict[str, list[float]] = {program: [] for program in programs}
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "data"
        day = make_day(programs[0], data)
        for _ in range(STARTS):
            for program, times in took_s.items():
                begun = time.perf_counter()
                service = Service(program, data)
                seq = json.loads(service.get(day))["seq"]
                times.append(time.perf_counter() - begun)
                service.kill()
                if seq != EVENTS:
                    raise SystemExit(f"{program}: the day has {seq} events, not {EVENTS}")
    for program, times in took_s.items():
        print(f"{program}: {statistics.median(times):.3f} s ({min(times):.3f} to {max(times):.3f})")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    main(sys.argv[1:])
