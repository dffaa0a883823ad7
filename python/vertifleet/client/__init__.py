"""A client of the dispatch service that ``vertifleet serve`` runs: live days, their events and decisions.

Needs httpx: ``pip install vertifleet[client]``. A day, and a decision that a person changes::

    from vertifleet.client import Client

    with Client("http://127.0.0.1:8080") as client:
        day = client.make_day("paper", seed=1)
        proposal = day.propose("A01")
        print(proposal["to"], [each["flight_profit_usd"] for each in proposal["alternatives"]])
        day.decide("A01", if_match=proposal["seq"])
        day.report({"type": "undone", "aircraft": "A01", "reason": "the crew is late"})
        day.decide("A01", to="V1", reason="the crew lives there")
        print(day.outlook()["profit_so_far_usd"])

The same with asyncio::

    import asyncio
    from vertifleet.client import AsyncClient

    async def main() -> None:
        async with AsyncClient("http://127.0.0.1:8080") as client:
            day = await client.make_day("paper", seed=1)
            await day.decide("A01")
            async for event in day.events():
                print(event["seq"], event["event"]["type"])

    asyncio.run(main())

`vertifleet.client.types` has the types of requests and answers. Errors are `ServiceError`, with the codes of
the error index.
"""

from __future__ import annotations

from importlib.util import find_spec

if find_spec("httpx") is None:
    raise ImportError("vertifleet.client needs httpx: pip install vertifleet[client]", name="httpx")

from vertifleet.client import types
from vertifleet.client._async.client import AsyncClient
from vertifleet.client._async.day import AsyncDay
from vertifleet.client._errors import NoAnswerError, ServiceError
from vertifleet.client._sync.client import Client
from vertifleet.client._sync.day import Day

__all__ = ["AsyncClient", "AsyncDay", "Client", "Day", "NoAnswerError", "ServiceError", "types"]
