"""The client of the dispatch service, tested with the program.

``VERTIFLEET_PROGRAM`` names the program; without it, the newest one in ``target`` is taken, or built.
"""

from __future__ import annotations

import asyncio
import os
import pickle
import re
import shutil
import socket
import ssl
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import aclosing, closing, suppress
from datetime import date
from itertools import islice
from pathlib import Path
from types import MappingProxyType

import pytest

import vertifleet
import vertifleet.client
from vertifleet import Error, Model, Network
from vertifleet.client import AsyncClient, Client, ServiceError
from vertifleet.client.types import Event

ROOT = Path(__file__).resolve().parents[2]


def program() -> str:
    """The program that the Rust tests built, or a new build with their settings if there is none."""
    if "VERTIFLEET_PROGRAM" in os.environ:
        return os.environ["VERTIFLEET_PROGRAM"]
    built = ROOT / "target" / "checked" / "release" / "vertifleet"
    if not built.exists():
        command = ["cargo", "t", "--workspace", "--no-run"]
        subprocess.run(command, cwd=ROOT, check=True)
    return str(built)


class Service:
    """A service with a separate data folder, on a port that the system chose."""

    def __init__(self, data: Path) -> None:
        self.data = data
        command = [program(), "serve", "--data", str(data), "--listen", "127.0.0.1:0"]
        self.log = data.with_suffix(".log")
        with self.log.open("w") as log:
            self._process = subprocess.Popen(command, stderr=log)
        found = self._address()
        self.url, self.port = f"http://127.0.0.1:{found[1]}", int(found[1])

    def _address(self) -> re.Match[str]:
        """The first line of the service's output, which contains its address."""
        for _ in range(3_000):
            found = re.search(r"http://127\.0\.0\.1:(\d+),", self.log.read_text())
            if found:
                return found
            assert self._process.poll() is None, self.log.read_text()
            time.sleep(0.02)
        raise AssertionError("the service did not begin to listen")

    def token(self, role: str) -> str:
        command = [
            program(),
            "serve",
            "token",
            "make",
            "--data",
            str(self.data),
            "--name",
            role,
            "--role",
            role,
        ]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        found = re.search(r"vf_\w+", done.stdout)
        assert found, f"it said {done.stdout!r}"
        return found[0]

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait()


class Relay:
    """Passes bytes on between clients and a service, and drops connections on request.

    With a context it uses TLS with the clients, as a proxy in front of a service does.
    """

    def __init__(self, port: int, tls: ssl.SSLContext | None = None) -> None:
        self._service = ("127.0.0.1", port)
        self._tls = tls
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._open: list[socket.socket] = []
        scheme = "https" if tls else "http"
        self.url = f"{scheme}://127.0.0.1:{self._listener.getsockname()[1]}"
        self.heard = b""
        self.answers_to_lose = 0
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            if self._tls:
                try:
                    client = self._tls.wrap_socket(client, server_side=True)
                except OSError:
                    continue
            service = socket.create_connection(self._service)
            self._open += [client, service]
            threading.Thread(target=self._pass_on, args=(client, service, False), daemon=True).start()
            threading.Thread(target=self._pass_on, args=(service, client, True), daemon=True).start()

    def _pass_on(self, source: socket.socket, target: socket.socket, is_answer: bool) -> None:
        try:
            while said := source.recv(65_536):
                if is_answer and self.answers_to_lose:
                    self.answers_to_lose -= 1
                    break
                if not is_answer:
                    self.heard += said
                target.sendall(said)
        except OSError:
            pass
        self._lose(source, target)

    def _lose(self, *ends: socket.socket) -> None:
        for end in ends:
            # Closing alone would wait for the other thread, which reads.
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()

    def lose_connections(self) -> None:
        lost, self._open = self._open, []
        self._lose(*lost)

    def close(self) -> None:
        self._listener.close()
        self.lose_connections()


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with pytest.MonkeyPatch.context() as environment:
        environment.delenv("VERTIFLEET_TOKEN", raising=False)
        running = Service(tmp_path_factory.mktemp("service"))
        yield running
        running.stop()


@pytest.fixture
def client(service: Service) -> Iterator[Client]:
    with Client(service.url) as client:
        yield client


@pytest.fixture
def relay(service: Service) -> Iterator[Relay]:
    with closing(Relay(service.port)) as relay:
        yield relay


def undone(aircraft: str) -> Event:
    return {"type": "undone", "aircraft": aircraft}


def clock(now: str) -> Event:
    return {"type": "clock", "time": now}


def test_a_decision_is_proposed_taken_undone_and_overruled(client: Client) -> None:
    day = client.make_day("paper", seed=1)
    assert day.info["name"] == "paper-1"
    proposal = day.propose("A01")
    assert len(proposal["alternatives"]) == len(day.state()["vertiports"])
    assert day.decide("A01", if_match=proposal["seq"])["to"] == proposal["to"]
    assert day.report(undone("A01"))["seq"] == 2
    other = next(
        each["to"]
        for each in proposal["alternatives"]
        if each.get("impossible") is None and each["to"] != proposal["to"]
    )
    assert day.decide("A01", other, "the crew lives there")["to"] == other
    assert next(each for each in day.state()["aircraft"] if each["id"] == "A01")["place"] == other
    assert f"A01,{proposal['at']},{other}" in day.trace_csv()
    kinds = [taken["event"]["type"] for taken in day.events()]
    assert kinds == ["decided", "undone", "decided"]
    assert day.state(1)["seq"] == 1
    assert day.refresh()["seq"] == 3


def test_a_late_policy_is_replaced_and_named(client: Client) -> None:
    proposal = client.make_day("paper").propose("A01", "rolling", deadline_ms=0)
    assert (proposal["policy"], proposal.get("too_late")) == ("greedy", "rolling")


def test_a_day_can_be_a_scenario_of_the_package(client: Client, day: vertifleet.Scenario) -> None:
    made = client.make_day(scenario=day, policy="greedy")
    assert (made.info["name"], made.info["policy"]) == (day.name, "greedy")
    assert [each["id"] for each in made.state()["aircraft"]] == day.aircraft


def test_an_outlook_is_compared_with_that_of_a_changed_day(client: Client) -> None:
    day = client.make_day("paper", seed=1)
    outlook = day.outlook("greedy")
    assert outlook["policy"] == "greedy"
    assert day.outlook("greedy", seq=0) == outlook
    closed: Event = {"type": "closed", "routes": {"vertiport": "V1"}, "until": "12:00:00"}
    compared = day.what_if(closed, policy="greedy", stands={"V2": 9}, aircraft=[{"id": "B01", "at": "V2"}])
    assert len({leg["aircraft"] for leg in compared["what_if"]["legs"]}) == 1 + len(
        {leg["aircraft"] for leg in compared["as_it_is"]["legs"]}
    )
    assert day.refresh()["seq"] == 0, "nothing has happened"


def test_several_events_are_taken_all_or_none(client: Client) -> None:
    day = client.make_day("paper")
    assert day.report(clock("06:10:00"), clock("06:20:00"))["seq"] == 2
    with pytest.raises(ServiceError, match="V604"):
        day.report(clock("06:30:00"), undone("A01"))
    assert day.state()["now"] == "06:20:00"


def test_events_with_the_same_key_happen_once(client: Client) -> None:
    day = client.make_day("paper")
    first = day.report(clock("06:10:00"), idempotency_key=f"{day.id}-1")
    assert day.report(clock("06:10:00"), idempotency_key=f"{day.id}-1") == first
    with pytest.raises(ServiceError, match="V609"):
        day.report(clock("06:11:00"), idempotency_key=f"{day.id}-1")
    assert len(list(day.events())) == 1


def test_writes_whose_answers_are_lost_happen_once(relay: Relay) -> None:
    with Client(relay.url) as client:
        days = len(list(client.days()))
        relay.answers_to_lose = 2
        day = client.make_day("paper")
        assert len(list(client.days())) == days + 1
        relay.answers_to_lose = 1
        assert day.decide("A01")["seq"] == 1
        relay.answers_to_lose = 1
        assert day.report(clock("06:10:00"))["seq"] == 2
        relay.answers_to_lose = 1
        day.delete()
        with pytest.raises(ServiceError, match="V602"):
            day.delete()


def test_nothing_is_written_to_a_day_that_has_changed(client: Client) -> None:
    day = client.make_day("paper")
    day.report(clock("06:10:00"))
    with pytest.raises(ServiceError) as caught:
        day.decide("A01", if_match=0)
    assert (caught.value.code, caught.value.status) == ("V605", 412)
    with pytest.raises(ServiceError, match="V605"):
        day.report(clock("06:20:00"), if_match=0)
    assert day.report(clock("06:20:00"), if_match=1)["seq"] == 2


def test_errors_have_codes_details_and_hints(client: Client) -> None:
    day = client.make_day("paper")
    with pytest.raises(ServiceError) as caught:
        day.report({"type": "landed", "aircraft": "A01"})
    assert (caught.value.code, caught.value.status, caught.value.tries) == ("V604", 422, 1)
    assert caught.value.detail == caught.value.message
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    with pytest.raises(ServiceError, match="V603"):
        day.propose("A/01?")
    with pytest.raises(ServiceError, match="V602"):
        client.day("../days")
    with pytest.raises(ServiceError, match="V601"):
        day.report()
    with pytest.raises(Error, match="V602"):
        client.make_day("nowhere")


def test_the_demand_of_a_day_is_known_by_period(client: Client) -> None:
    day = client.make_day(
        "paper", forecast=[{"period": "07:00:00", "from": "V1", "to": "V2", "passengers": 3}]
    )
    day.report({"type": "booked", "period": "07:00:00", "from": "V1", "to": "V2", "passengers": 2})
    later = day.demand("07:00:00")
    assert (later["seq"], later["has_begun"]) == (1, False)
    assert later["pairs"] == [{"from": "V1", "to": "V2", "passengers": 5}]
    assert day.demand()["pairs"] == []
    with pytest.raises(ServiceError, match="V603"):
        day.demand("05:00:00")


def test_an_archived_day_takes_nothing_more(client: Client) -> None:
    day = client.make_day("paper")
    day.archive()
    day.archive()
    assert day.refresh()["archived"]
    with pytest.raises(ServiceError, match="V608"):
        day.report(clock("06:10:00"))
    day.unarchive()
    assert day.report(clock("06:10:00"))["seq"] == 1
    assert not day.refresh()["archived"]


def test_a_day_that_has_changed_is_not_archived(client: Client) -> None:
    day = client.make_day("paper")
    day.report(clock("06:10:00"))
    for change in (day.archive, day.unarchive, day.delete):
        with pytest.raises(ServiceError, match="V605"):
            change(if_match=0)
    day.archive(if_match=1)
    day.unarchive(if_match=1)
    day.delete(if_match=1)
    with pytest.raises(ServiceError, match="V602"):
        day.refresh()


def test_all_pages_of_a_list_are_read(client: Client) -> None:
    made = [client.make_day("paper", seed=seed).id for seed in range(1, 6)]
    listed = [day.id for day in client.days(page_size=2)]
    assert listed[-5:] == made
    assert [day.info.get("progress") for day in client.days(after=made[3])] == [None]
    [last] = client.days(after=made[3], progress=True)
    assert last.info["progress"] == {"now": "06:00:00", "is_over": False, "waiting": 40, "profit_usd": 0.0}
    assert [day.id for day in client.days(after=made[1], page_size=3)] == made[2:]
    day = client.day(made[0])
    day.report(*(clock(f"06:{minute:02}:00") for minute in range(1, 8)))
    assert [event["seq"] for event in day.events(page_size=2)] == list(range(1, 8))
    assert [event["seq"] for event in day.events(after=5)] == [6, 7]


def test_a_stream_goes_on_after_a_lost_connection(client: Client, relay: Relay) -> None:
    day = client.make_day("paper")
    day.report(clock("06:01:00"), clock("06:02:00"))
    with Client(relay.url) as relayed, closing(relayed.day(day.id).stream(after=1)) as stream:
        assert next(stream)["seq"] == 2
        for number in (3, 4):
            relay.lose_connections()
            day.report({"type": "clock", "time": f"06:0{number}:00"})
            assert next(stream)["seq"] == number
            assert f"last-event-id: {number - 1}".encode() in relay.heard.lower()


def test_a_stream_ends_with_the_error_that_ends_it(client: Client) -> None:
    day = client.make_day("paper")
    day.report(clock("06:01:00"))
    with pytest.raises(ServiceError, match="V602: there is no event 7"):
        next(day.stream(after=7))
    stream = day.stream()
    next(stream)
    day.delete()
    with pytest.raises(ServiceError, match="V602"):
        next(stream)


def test_a_day_can_have_a_date_a_forecast_and_places_of_aircraft(client: Client) -> None:
    day = client.make_day(
        "new-york",
        name="Monday",
        date=date(2026, 11, 23),
        forecast=[{"period": "07:00:00", "from": "JRA", "to": "JFK", "passengers": 14}],
        aircraft=MappingProxyType({"A01": "JRA"}),
        policy="greedy",
    )
    assert (day.info["name"], day.info.get("time_zone")) == ("Monday", "America/New_York")
    assert day.scenario().demand.sum() == 14
    assert day.state()["aircraft"][0]["place"] == "JRA"
    half_past_six = "2026-11-23T06:30:00-05:00"
    assert day.report(clock(half_past_six))["seq"] == 1
    assert (day.state()["now"], day.state(times="iso")["now"]) == ("06:30:00", half_past_six)
    assert [event["event"].get("time") for event in day.events(times="iso")] == [half_past_six]
    assert day.propose("A01", times="iso")["time"] == half_past_six
    assert day.outlook(times="iso")["now"] == half_past_six
    assert day.what_if(times="iso")["as_it_is"]["now"] == half_past_six


def test_networks_are_uploaded_validated_and_deleted(client: Client) -> None:
    mine = Network.from_toml(Network("paper").toml.replace('name = "paper"', 'name = "mine"'))
    assert client.validate_network(mine)["warnings"] == []
    assert client.put_network(mine) == client.put_network(mine)
    assert client.network("mine").get("toml") == mine.toml
    assert [each["name"] for each in client.networks() if not each["is_shipped"]] == ["mine"]
    assert client.make_day("mine").info["name"] == "mine-1"
    client.delete_network("mine")
    with pytest.raises(ServiceError, match="V602"):
        client.delete_network("mine")
    with pytest.raises(ServiceError, match="V105"):
        client.validate_network("name =")


def test_weights_are_uploaded_validated_and_deleted(client: Client) -> None:
    weights = Model.shipped("gcaps")
    assert client.validate_policy(weights.to_bytes())["kind"] == "gcaps"
    info = client.put_policy("mine", weights)
    assert info["weights_sha256"] == weights.sha256
    assert client.policy("mine") in client.policies()
    assert client.make_day("paper").propose("A01", "mine").get("weights_sha256") == weights.sha256
    client.delete_policy("mine")
    with pytest.raises(ServiceError, match="V602"):
        client.policy("mine")


def test_a_service_answers_health_checks_and_describes_its_api(client: Client) -> None:
    assert client.is_running()
    assert client.is_ready()
    assert "vertifleet" in client.metrics()
    assert client.description()["openapi"] == "3.1.0"


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl makes the certificate")
def test_a_certificate_is_trusted_if_its_file_is_named(service: Service, tmp_path: Path) -> None:
    key, certificate = tmp_path / "key.pem", tmp_path / "certificate.pem"
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost"]
    command += ["-addext", "subjectAltName=IP:127.0.0.1", "-keyout", str(key), "-out", str(certificate)]
    subprocess.run(command, check=True, capture_output=True)
    tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    tls.load_cert_chain(certificate, key)
    with closing(Relay(service.port, tls)) as relay:
        for verify in (certificate, str(certificate), ssl.create_default_context(cafile=certificate)):
            with Client(relay.url, verify=verify) as client:
                assert client.is_ready()
        with Client(relay.url) as client, pytest.raises(ServiceError, match="not trusted") as caught:
            client.day("any")
        assert (caught.value.code, caught.value.tries) == ("V613", 1)


def test_a_token_is_sent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    guarded = Service(tmp_path)
    try:
        reads, dispatches = guarded.token("read"), guarded.token("dispatch")
        monkeypatch.delenv("VERTIFLEET_TOKEN", raising=False)
        with Client(guarded.url) as client, pytest.raises(ServiceError, match="V610") as caught:
            list(client.days())
        assert caught.value.status == 401
        with Client(guarded.url, dispatches) as client:
            day = client.make_day("paper")
            day.report(clock("06:01:00"))
            assert [event["actor"] for event in day.events()] == ["dispatch"]
        monkeypatch.setenv("VERTIFLEET_TOKEN", reads)
        with Client(guarded.url) as client:
            assert [each.id for each in client.days()] == [day.id]
            with pytest.raises(ServiceError, match="V618"):
                client.make_day("paper")
    finally:
        guarded.stop()


def test_the_client_works_with_asyncio(relay: Relay) -> None:
    async def whole_day() -> None:
        async with AsyncClient(relay.url) as client:
            day = await client.make_day("paper", seed=1)
            taken = await day.decide("A01")
            await day.report(undone("A01"))
            with pytest.raises(ServiceError, match="V605"):
                await day.decide("A01", "V1", if_match=taken["seq"])
            relay.answers_to_lose = 1
            assert (await day.decide("A01", taken["to"], "as before"))["seq"] == 3
            seen = await asyncio.gather(*(day.state(seq) for seq in range(4)))
            assert [state["seq"] for state in seen] == [0, 1, 2, 3]
            assert [event["seq"] async for event in day.events(page_size=2)] == [1, 2, 3]
            assert day.id in [each.id async for each in client.days(page_size=1)]
            async with aclosing(day.stream(after=2)) as stream:
                assert (await anext(stream))["seq"] == 3
                relay.lose_connections()
                await day.report(clock("06:30:00"))
                assert (await anext(stream))["seq"] == 4
            relay.answers_to_lose = 1
            await day.delete()
            with pytest.raises(ServiceError, match="V602"):
                await client.day(day.id)

    asyncio.run(whole_day())


def test_a_client_serves_several_threads(client: Client) -> None:
    day = client.make_day("paper")
    events = [clock(f"06:{minute:02}:00") for minute in range(8)]
    threads = [threading.Thread(target=day.report, args=(event,)) for event in events]
    for thread in threads:
        thread.start()
    assert sorted(event["seq"] for event in islice(day.stream(), 8)) == list(range(1, 9))
    for thread in threads:
        thread.join()


def test_the_examples_of_the_documentation_run(service: Service, capsys: pytest.CaptureFixture[str]) -> None:
    examples = re.findall(r"::\n\n((?:    .*\n|\n)+)", vertifleet.client.__doc__ or "")
    assert len(examples) == 2
    for example in examples:
        text = re.sub("^    ", "", example, flags=re.MULTILINE)
        exec(text.replace("http://127.0.0.1:8080", service.url), {})
    assert "1 decided" in capsys.readouterr().out
