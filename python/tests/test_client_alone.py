"""The client of the dispatch service, without a service or with one that fails."""

from __future__ import annotations

import socket
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from vertifleet import Error
from vertifleet.client import Client, NoAnswerError, ServiceError
from vertifleet.client._messages import Message, Messages


def test_messages_are_assembled_from_any_pieces() -> None:
    said = (
        ": keep-alive\n\nevent: behind\ndata: 3 events came\n\n"
        'id: 7\r\ndata: {"reason":\r\ndata: "a\u2028b"}\r\n\r\nid: 8\n\n'
    ).encode()
    expected = [
        Message("comment", "", "keep-alive"),
        Message("behind", "", "3 events came"),
        Message("message", "7", '{"reason":\n"a\u2028b"}'),
    ]
    for length in (1, 5, len(said)):
        messages = Messages()
        pieces = [said[start : start + length] for start in range(0, len(said), length)]
        assert [found for piece in pieces for found in messages.read(piece)] == expected


def test_a_stream_reads_on_after_it_was_behind() -> None:
    fifth = 'id: 5\ndata: {"seq": 5, "mark": "5-0a0b0c0d"}\n\n'
    streams = iter(["event: behind\ndata: 2\n\n", fifth, ": \n\n" * 20])
    asked = []

    def answer(request: httpx.Request) -> httpx.Response:
        if not request.url.path.endswith("/stream"):
            return httpx.Response(200, json={"id": "d", "name": "d"})
        asked.append((request.url.params.get("after"), request.headers.get("last-event-id")))
        text = next(streams, None)
        return httpx.Response(404) if text is None else httpx.Response(200, text=text)

    with Client(transport=httpx.MockTransport(answer), retries=1) as client:
        stream = client.day("d").stream(after=4)
        assert next(stream)["seq"] == 5
        with pytest.raises(ServiceError, match="404"):
            next(stream)
    assert asked == [("4", None), ("4", None), ("4", "5-0a0b0c0d"), ("4", "5-0a0b0c0d")]


def test_a_request_is_sent_again_as_it_was_and_not_for_ever() -> None:
    sent = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append((request.headers["idempotency-key"], request.content))
        return httpx.Response(503, text="<h1>down</h1>")

    with Client(transport=httpx.MockTransport(answer), retries=2) as client:
        with pytest.raises(ServiceError, match=r"V613.*503 Service Unavailable: <h1>down</h1>") as caught:
            client.make_day("paper")
        assert (len(sent), len(set(sent)), caught.value.tries) == (3, 1, 3)
        with pytest.raises(ServiceError):
            client.make_day("paper")
        assert len(set(sent)) == 2, "another request has another key"


def test_a_missing_service_raises_v613() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with Client(f"http://127.0.0.1:{port}", retries=1) as client, pytest.raises(NoAnswerError) as caught:
        client.day("any")
    assert (caught.value.code, caught.value.status) == ("V613", None)
    assert f"http://127.0.0.1:{port}" in str(caught.value)


def test_another_program_at_the_address_is_noticed() -> None:
    page = httpx.MockTransport(lambda request: httpx.Response(200, text="<html>"))
    with Client(transport=page) as client, pytest.raises(ServiceError, match=r"V613.*no DayInfo"):
        client.day("any")


def test_wrong_addresses_and_certificates_are_refused(tmp_path: Path) -> None:
    for url in ("127.0.0.1:8080", "http://", "ftp://host", "http://[::1"):
        with pytest.raises(Error, match="V451"):
            Client(url)
    with pytest.raises(Error, match="V624"):
        Client(verify=tmp_path / "none.pem")


def test_httpx_is_needed_by_the_client_alone(tmp_path: Path) -> None:
    lines = ["import sys", "import vertifleet", "assert 'httpx' not in sys.modules"]
    lines += ["sys.modules['httpx'] = None", "import vertifleet.client"]
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(lines)], cwd=tmp_path, capture_output=True, text=True
    )
    assert "ImportError: vertifleet.client needs httpx: pip install vertifleet[client]" in done.stderr
