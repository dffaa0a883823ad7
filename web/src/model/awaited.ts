// Reports that a live day awaits: a departure or a landing that is due and has not been reported.
// Without a report an event has not happened, so its time is the later of planned and now. All
// later events of the aircraft move with it. The service's outlook follows the same rule
// (`LiveDay::expect_from` in crates/sim/src/live.rs).

import type { AircraftState, DayState } from '../api/types'
import type { DayRecord, LegRecord, Seconds } from './record'
import { clock, timeOf } from './time'

/**
 * An aircraft is overdue this long after its due departure or landing: `LATE_S` of the service,
 * which then sends a notice.
 */
const OVERDUE_S = 300
/** Pictures of the whole day are updated at this interval. */
const STEP_S = 60

/** The time of a leg's awaited departure or landing, as its record currently has it. */
function expectedAt({ awaited, departs, arrives }: LegRecord): Seconds {
  return awaited?.report === 'departure' ? departs : arrives
}

/**
 * How long a leg has waited for its report at a time, which delays all later legs; 0 if the report
 * is not due yet.
 */
export function latenessOf(leg: LegRecord, time: Seconds): Seconds {
  return leg.awaited === undefined ? 0 : Math.max(0, time - expectedAt(leg))
}

/**
 * Whole minutes by which a leg is overdue at a time, by default the time of its record; 0 if it is
 * not. All pictures and lists of a minute have the same number.
 */
export function minutesOverdue(leg: LegRecord, time = expectedAt(leg)): number {
  if (leg.awaited === undefined) return 0
  const late_s = endOfMinute(time) - leg.awaited.due
  return late_s > OVERDUE_S ? Math.floor(late_s / 60) : 0
}

/** The end of the minute that contains a time. Awaited events have not happened before it. */
export function endOfMinute(time: Seconds): Seconds {
  return Math.ceil(time / STEP_S) * STEP_S
}

/**
 * The day as it stands in the minute of a time. Awaited events have not happened in it. Expected
 * legs begin neither before the minute nor before the aircraft is ready.
 */
export function recordAt(record: DayRecord, time: Seconds): DayRecord {
  const now = endOfMinute(time)
  const [readyAt, movedBy] = [new Map<number, Seconds>(), new Map<number, Seconds>()]
  const legs = record.legs.map((leg) => {
    const moved = leg.is_expected ? postponed(leg, delayOf(leg)) : awaitedAt(leg, now)
    if (!leg.is_expected) readyAt.set(leg.aircraft, moved.ready)
    return moved
  })
  if (legs.every((leg, index) => leg === record.legs[index])) return record
  return { ...record, legs: legs.sort((one, other) => one.decided - other.decided) }

  /**
   * All expected legs of an aircraft are delayed by as much as its first one, because each follows
   * from the previous.
   */
  function delayOf({ aircraft, decided }: LegRecord): Seconds {
    const known = movedBy.get(aircraft)
    if (known !== undefined) return known
    const delay_s = Math.max(0, now - STEP_S - decided, (readyAt.get(aircraft) ?? 0) - decided)
    movedBy.set(aircraft, delay_s)
    return delay_s
  }
}

/**
 * Applies the awaited reports of a day to another course of it, in which the same flights are under
 * way.
 */
export function withAwaitedReports(record: DayRecord, day: DayRecord): DayRecord {
  const underWay = day.legs.filter((leg) => leg.awaited !== undefined)
  const legs = record.legs.map((leg) => {
    const same = underWay.find((one) => one.aircraft === leg.aircraft && one.decided === leg.decided)
    if (same?.awaited === undefined || leg.is_expected) return leg
    const { report } = same.awaited
    return { ...leg, awaited: { report, due: report === 'departure' ? leg.departs : leg.arrives } }
  })
  return { ...record, legs }
}

/** The aircraft of a state, with their awaited events moved as in the record of the same day. */
export function aircraftAt({ aircraft }: DayState, record: DayRecord): AircraftState[] {
  const awaited = new Map(
    record.legs.flatMap((leg) =>
      leg.awaited === undefined ? [] : [[record.aircraft[leg.aircraft]?.id, leg] as const],
    ),
  )
  return aircraft.map((one) => {
    const leg = awaited.get(one.id)
    if (leg === undefined) return one
    const late_s = leg.arrives - timeOf(one.arrival)
    return { ...one, arrival: clock(leg.arrives), ready: clock(timeOf(one.ready) + late_s) }
  })
}

function awaitedAt(leg: LegRecord, time: Seconds): LegRecord {
  const late_s = latenessOf(leg, time)
  if (late_s === 0) return leg
  const { departs, arrives, ready } = leg
  return {
    ...leg,
    departs: leg.awaited?.report === 'departure' ? departs + late_s : departs,
    arrives: arrives + late_s,
    ready: ready + late_s,
    planned: leg.planned ?? { departs, arrives, ready },
  }
}

function postponed(leg: LegRecord, delay_s: Seconds): LegRecord {
  if (delay_s === 0) return leg
  const [decided, departs] = [leg.decided + delay_s, leg.departs + delay_s]
  const charged = leg.charged === undefined ? {} : { charged: leg.charged + delay_s }
  return { ...leg, ...charged, decided, departs, arrives: leg.arrives + delay_s, ready: leg.ready + delay_s }
}
