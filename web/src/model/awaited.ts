// What a live day still waits to hear of: a departure or a landing that is due and has not been reported. What is not reported has
// not happened, so its time is the later of planned and now, and everything that follows from it moves with it. The service's own
// outlook is made by the same rule (`LiveDay::expect_from` in crates/sim/src/live.rs).

import type { AircraftState, DayState } from '../api/types'
import type { DayRecord, LegRecord, Seconds } from './record'
import { clock, timeOf } from './time'

/** An aircraft that should have departed or landed so long ago is overdue: `LATE_S` of the service, which gives a notice then. */
const OVERDUE_S = 300
/** Pictures of the whole day move on once in this time. */
const STEP_S = 60

/** When a leg does what is awaited of it, as far as its record has moved on. */
function expectedAt({ awaited, departs, arrives }: LegRecord): Seconds {
  return awaited?.report === 'departure' ? departs : arrives
}

/** How long a leg has waited for its report at a time, by which all that follows is late; 0 if the report is not due yet. */
export function latenessOf(leg: LegRecord, time: Seconds): Seconds {
  return leg.awaited === undefined ? 0 : Math.max(0, time - expectedAt(leg))
}

/** Whole minutes by which a leg is overdue at a time, or as far as its record has moved on; 0 if it is not. All pictures and lists of a
 *  minute have the same number. */
export function minutesOverdue(leg: LegRecord, time = expectedAt(leg)): number {
  if (leg.awaited === undefined) return 0
  const late_s = endOfMinute(time) - leg.awaited.due
  return late_s > OVERDUE_S ? Math.floor(late_s / 60) : 0
}

/** The end of the minute in which a time lies: what is awaited then has not happened before it. */
export function endOfMinute(time: Seconds): Seconds {
  return Math.ceil(time / STEP_S) * STEP_S
}

/** The day as it stands in the minute of a time: what is awaited has not happened in it, and what is only expected of an aircraft
 *  begins neither before the minute nor before the aircraft is ready. */
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

  /** All that is expected of an aircraft moves on by as much as its first leg has to: the legs follow from each other. */
  function delayOf({ aircraft, decided }: LegRecord): Seconds {
    const known = movedBy.get(aircraft)
    if (known !== undefined) return known
    const delay_s = Math.max(0, now - STEP_S - decided, (readyAt.get(aircraft) ?? 0) - decided)
    movedBy.set(aircraft, delay_s)
    return delay_s
  }
}

/** Another course of the same day, in which the same flights are under way and awaited. */
export function awaitedLike(record: DayRecord, day: DayRecord): DayRecord {
  const underWay = day.legs.filter((leg) => leg.awaited !== undefined)
  const legs = record.legs.map((leg) => {
    const same = underWay.find((one) => one.aircraft === leg.aircraft && one.decided === leg.decided)
    if (same?.awaited === undefined || leg.is_expected) return leg
    const { report } = same.awaited
    return { ...leg, awaited: { report, due: report === 'departure' ? leg.departs : leg.arrives } }
  })
  return { ...record, legs }
}

/** What a state says of its aircraft, with what is awaited of them moved on as in the record of the same day. */
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
  return { ...leg, decided, departs, arrives: leg.arrives + delay_s, ready: leg.ready + delay_s }
}
