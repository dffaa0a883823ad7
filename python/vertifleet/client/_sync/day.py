# Written from ../_async/day.py by python/tools/client_sync.py: do not edit.
"""A live day: its state, its events, its decisions and its outlook."""

from __future__ import annotations

import json
import time as clock
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace

from vertifleet._native import Scenario
from vertifleet.client._errors import ServiceError
from vertifleet.client._requests import asking, changing, given, reading, writing
from vertifleet.client._sync.connection import Connection
from vertifleet.client.types import (
    Comparison,
    DayInfo,
    DayState,
    Event,
    EventList,
    Ledger,
    Moment,
    MoreAircraft,
    Outlook,
    PeriodDemand,
    Proposal,
    Taken,
    TakenDecision,
    TakenEvent,
    Times,
)


class Day:
    """A day of a service. `Client.make_day`, `Client.day` and `Client.days` return days.

    Times of the day are texts as "07:10:00", which may pass "24:00:00", or seconds since midnight. A day with
    a date also accepts them in ISO 8601 with an offset ("2026-11-23T07:10:00-05:00"), and returns them so
    with ``times="iso"``.

    All methods raise `ServiceError` V602 if the day was deleted, and `NoAnswerError` if the service does not
    answer.
    """

    def __init__(self, connection: Connection, info: DayInfo) -> None:
        self._connection = connection
        self.info = info
        """The name of the day, the time of its creation and so on, as last read."""

    @property
    def id(self) -> str:
        """The id of the day."""
        return self.info["id"]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.id!r}, {self.info['name']!r})"

    def refresh(self) -> DayInfo:
        """Updates `info`, and returns it with the number of the latest event (``seq``)."""
        self.info = self._connection.object(DayInfo, reading("days", self.id))
        return self.info

    def state(self, seq: int | None = None, *, times: Times | None = None) -> DayState:
        """The state of the day: every aircraft, every vertiport, the account and the notices.

        Args:
            seq: the number of an event; returns the state after it in place of the current one.
            times: how times are written.

        Raises:
            ServiceError: V602 if there is no such event.
        """
        asked = reading("days", self.id, "state", seq=seq, times=times)
        return self._connection.object(DayState, asked)

    def demand(self, period: Moment | None = None, *, times: Times | None = None) -> PeriodDemand:
        """The passengers of a demand period who still want to fly, by pair.

        Args:
            period: the beginning of the period, or a time within it; without it, the current one.
            times: how times are written.

        Raises:
            ServiceError: V603 if the day has no such period.
        """
        asked = reading("days", self.id, "demand", period=period, times=times)
        return self._connection.object(PeriodDemand, asked)

    def ledger(self, *, times: Times | None = None) -> Ledger:
        """The earnings and costs of the day so far, flight by flight; amounts in dollars.

        Args:
            times: how times are written.
        """
        return self._connection.object(Ledger, reading("days", self.id, "ledger", times=times))

    def scenario(self) -> Scenario:
        """The scenario at the beginning of the day, for example to play it with other policies.

        Raises:
            Error: if this version of the package does not support a part of it.
        """
        answer = self._connection.answer(reading("days", self.id, "scenario"))
        return Scenario.from_json(answer.text, self.id)

    def trace_csv(self) -> str:
        """The decisions so far as a trace: the text of a CSV file."""
        answer = self._connection.answer(reading("days", self.id, "trace.csv"))
        return answer.text

    def events(
        self, after: int = 0, *, times: Times | None = None, page_size: int = 1_000
    ) -> Generator[TakenEvent, None, None]:
        """All events so far, in order.

        Args:
            after: only events after the one with this number.
            times: how times are written.
            page_size: number of events in a request, at most 10,000.

        Raises:
            ServiceError: V602 if the day has no event with the number ``after``.
        """
        number: int | None = after
        while number is not None:
            asked = reading("days", self.id, "events", after=number, limit=page_size, times=times)
            page = self._connection.object(EventList, asked)
            for event in page["events"]:
                yield event
            number = page.get("next")

    def report(
        self, *events: Event, if_match: int | None = None, idempotency_key: str | None = None
    ) -> Taken:
        """Reports events. Several are applied together or not at all. They are on the disk afterwards.

        ``notices`` of the answer has, for each event, the notices for people.

        Args:
            events: one or more events, at most 1,000, for example ``{"type": "departed", "aircraft": "A01",
                "time": "06:02:00"}``; `vertifleet.client.types.Event` has all kinds.
            if_match: the expected number of the latest event. If there is a later one, no event is applied.
            idempotency_key: a key of your own, at most 128 characters that no other request to the service
                has. Sent again with the same key, the same events are taken once.

        Raises:
            ServiceError: V601 if an event is invalid, V603 for an unknown aircraft or vertiport, V604 if it
                contradicts earlier events, V605 if the day has changed, V608 if it is archived.
        """
        body = events[0] if len(events) == 1 else list(events)
        path = ("days", self.id, "events")
        asked = writing(*path, body=body, if_match=if_match, idempotency_key=idempotency_key)
        return self._connection.object(Taken, asked)

    def stream(
        self, after: int | None = None, *, times: Times | None = None
    ) -> Generator[TakenEvent, None, None]:
        """All events, and then later ones as they arrive. It ends only with an error.

        After a lost connection it reconnects and continues, so that every event arrives once. No event is
        lost if events arrive faster than they are read.

        Args:
            after: only events after the one with this number; ``refresh()["seq"]`` leaves out all earlier
                ones.
            times: how times are written in the events.

        Raises:
            ServiceError: V602 if the day has no such event, and V631 if it was restored from a copy while the
                stream was read: then read its state again. That fails too if the day has been deleted.
            NoAnswerError: if the service does not come back.
        """
        pauses = self._connection.pauses()
        last: str | None = None
        while True:
            asked = reading("days", self.id, "stream", after=after, times=times)
            if last is not None:
                asked = replace(asked, headers={"Last-Event-ID": last})
            try:
                with closing(self._connection.messages(asked)) as messages:
                    for message in messages:
                        pauses = self._connection.pauses()
                        # Other kinds are comments, and `behind`, after which the missed events
                        # follow.
                        if message.kind == "message":
                            event: TakenEvent = json.loads(message.text)
                            last = event["mark"]
                            yield event
            except ServiceError as error:
                pause_s = next(pauses, None)
                if pause_s is None or not error.is_transient:
                    raise
                clock.sleep(pause_s)

    def propose(
        self,
        aircraft: str,
        policy: str | None = None,
        *,
        time: Moment | None = None,
        deadline_ms: int | None = None,
        times: Times | None = None,
    ) -> Proposal:
        """Where a policy would send a ready aircraft, and the result of flying to every vertiport.

        Nothing changes.

        Args:
            aircraft: the id of the aircraft.
            policy: the policy; without it, the day's.
            time: the time of the decision; without it, or before what has happened, now.
            deadline_ms: time limit of the answer, milliseconds. If the policy is not ready then, a faster one
                answers, and ``too_late`` names the requested one.
            times: how times are written.

        Raises:
            ServiceError: V603 for an unknown aircraft, V604 if it is not ready, V602 for an unknown policy.
        """
        path = ("days", self.id, "aircraft", aircraft, "decision")
        asked = reading(*path, policy=policy, time=time, deadline_ms=deadline_ms, times=times)
        return self._connection.object(Proposal, asked)

    def decide(
        self,
        aircraft: str,
        to: str | None = None,
        reason: str | None = None,
        *,
        policy: str | None = None,
        time: Moment | None = None,
        deadline_ms: int | None = None,
        if_match: int | None = None,
        idempotency_key: str | None = None,
    ) -> TakenDecision:
        """Takes a decision: the policy's, or with ``to`` a person's. It is on the disk afterwards.

        Args:
            aircraft: the id of the aircraft, which must be ready.
            to: the vertiport that a person chooses; the one where the aircraft stands means hold.
            reason: why.
            policy: the policy that chooses; without it, the day's.
            time: the time of the decision; without it, or before what has happened, now.
            deadline_ms: time limit of the policy, milliseconds. If it is not ready then, a faster one
                decides.
            if_match: the expected number of the latest event, for example ``seq`` of a proposal. If there is
                a later one, no decision is taken.
            idempotency_key: a key of your own, at most 128 characters that no other request to the service
                has. Sent again with the same key, the same decision is taken once.

        Raises:
            ServiceError: V603 for an unknown aircraft or vertiport, V604 if the decision breaks a rule, V605
                if the day has changed, V608 if it is archived, V602 for an unknown policy.
        """
        chosen = given({"aircraft": aircraft, "to": to, "reason": reason})
        how = given({"policy": policy, "time": time, "deadline_ms": deadline_ms})
        path = ("days", self.id, "decisions")
        asked = writing(*path, body=chosen | how, if_match=if_match, idempotency_key=idempotency_key)
        return self._connection.object(TakenDecision, asked)

    def outlook(
        self, policy: str | None = None, seq: int | None = None, *, times: Times | None = None
    ) -> Outlook:
        """The expected rest of the day, flight by flight, if a policy takes every decision from now on.

        Args:
            policy: the policy; without it, the day's.
            seq: the number of an event; returns the outlook after it in place of the current one. 0 is the
                morning.
            times: how times are written.

        Raises:
            ServiceError: V602 if there is no such event.
        """
        asked = reading("days", self.id, "outlook", policy=policy, seq=seq, times=times)
        return self._connection.object(Outlook, asked)

    def what_if(
        self,
        *events: Event,
        policy: str | None = None,
        stands: Mapping[str, int] | None = None,
        aircraft: Sequence[MoreAircraft] = (),
        times: Times | None = None,
    ) -> Comparison:
        """Compares the outlook with that of a changed day. Nothing changes.

        Args:
            events: events that might happen now, in order.
            policy: the policy that would decide; without it, the day's.
            stands: numbers of stands of vertiports from the morning on, by their ids: of chargers if they are
                counted separately.
            aircraft: additional aircraft of the fleet from the morning on, for example ``{"id": "B01", "at":
                "V1"}``.
            times: how times are written.

        Raises:
            ServiceError: V603 and V604 as for `report`, V617 if an earlier event would have been impossible.
        """
        members = {"events": events, "aircraft": aircraft, "policy": policy, "stands": stands}
        asked = asking("days", self.id, "what-if", body=given(members), times=times)
        return self._connection.object(Comparison, asked)

    def archive(self, *, if_match: int | None = None) -> None:
        """Closes the day to writes. It can still be read, and reopened.

        Args:
            if_match: the number of the latest event that you know of. If there is a later one, nothing
                happens.

        Raises:
            ServiceError: V605 if the day has gone on.
        """
        self._connection.answer(changing("POST", "days", self.id, "archive", if_match=if_match))

    def unarchive(self, *, if_match: int | None = None) -> None:
        """Reopens the day after it was archived.

        Args:
            if_match: the number of the latest event that you know of. If there is a later one, nothing
                happens.

        Raises:
            ServiceError: V605 if the day has gone on.
        """
        self._connection.answer(changing("POST", "days", self.id, "unarchive", if_match=if_match))

    def delete(self, *, if_match: int | None = None) -> None:
        """Removes the day with its events.

        Args:
            if_match: the number of the latest event that you know of. If there is a later one, nothing
                happens.

        Raises:
            ServiceError: V605 if the day has gone on.
        """
        self._connection.remove("days", self.id, if_match=if_match)
