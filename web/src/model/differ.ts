// Where two plays of the same day differ. Two plays of policies are the same up to the first decision in which they differ, so that
// one is a choice between two legs from one situation. Plays of people differ in the order and the second of their decisions too,
// so legs are compared aircraft by aircraft.

import { grouped } from './arrays'
import type { DayRecord, LegRecord, Seconds } from './record'

/** What each day did at a time; undefined where the aircraft has decided nothing. */
export interface Difference {
  time: Seconds
  one: LegRecord | undefined
  other: LegRecord | undefined
}

export interface FirstDifference extends Difference {
  /** The first day's profit of this leg less the other's. */
  atDecision_usd: number
  /** The first day's profit of the whole day less the other's. Where both played the same day, this is what the decision and all
   *  later ones come to; a plan beside what happened was for another day, and owes the difference to that as well. */
  atEnd_usd: number
}

/** The first decision in which an aircraft is sent elsewhere; undefined if all go the same ways all day. */
export function firstDifference(one: DayRecord, other: DayRecord): FirstDifference | undefined {
  const [ones, others] = [grouped(one.legs, aircraftOf), grouped(other.legs, aircraftOf)]
  const aircraft = [...new Set([...ones.keys(), ...others.keys()])]
  const first = earliest(aircraft.flatMap((id) => partings(ones.get(id) ?? [], others.get(id) ?? [])))
  if (first === undefined) return undefined
  return {
    ...first,
    atDecision_usd: (first.one?.profit_usd ?? 0) - (first.other?.profit_usd ?? 0),
    atEnd_usd: sumOf(one) - sumOf(other),
  }
}

/** Where the legs of an aircraft first lead elsewhere, as a list of one or of none. */
function partings(ones: readonly LegRecord[], others: readonly LegRecord[]): Difference[] {
  const longer = ones.length > others.length ? ones : others
  const position = longer.findIndex((_, leg) => ones[leg]?.to !== others[leg]?.to)
  if (position === -1) return []
  const [one, other] = [ones[position], others[position]]
  return [{ time: Math.min(one?.decided ?? Infinity, other?.decided ?? Infinity), one, other }]
}

/** How a leg differs from another day. */
export interface Differing {
  /** What the aircraft does there: the same way at another time or with other passengers, or else what it was sent on last. */
  twin: LegRecord | undefined
  /** Whether the aircraft does not go this way at about this time at all. */
  isElsewhere: boolean
}

/** Legs that another day does not have, by their positions in the record. */
export type Otherwise = ReadonlyMap<number, Differing>

export interface Differences {
  one: Otherwise
  other: Otherwise
  first: Difference | undefined
}

/** All that differs for people who look at two timelines: where aircraft fly, when, and with how many passengers. */
export function differences(one: DayRecord, other: DayRecord): Differences {
  const [inOne, inOther] = [otherwise(one, other), otherwise(other, one)]
  const first = earliest([
    ...[...inOne].map(([leg, { twin }]) => differenceOf(one.legs[leg], twin)),
    ...[...inOther].map(([leg, { twin }]) => swapped(differenceOf(other.legs[leg], twin))),
  ])
  return { one: inOne, other: inOther, first }
}

/** Timelines are read to the minute: decisions that are closer are the same. */
const SAME_S = 60
/** An aircraft that goes the same way within this time goes there later or earlier, and not elsewhere. */
const NEAR_S = 900

function otherwise(record: DayRecord, other: DayRecord): Otherwise {
  const others = grouped(other.legs, aircraftOf)
  const found = new Map<number, Differing>()
  record.legs.forEach((leg, position) => {
    const twins = others.get(leg.aircraft) ?? []
    if (twins.some((twin) => isAlike(leg, twin))) return
    const near = nearest(leg, twins)
    const meanwhile = twins.findLast((twin) => twin.decided < leg.decided + SAME_S)
    found.set(position, { twin: near ?? meanwhile, isElsewhere: near === undefined })
  })
  return found
}

/** The leg on the same way that is nearest in time, if one is near. */
function nearest(leg: LegRecord, twins: readonly LegRecord[]): LegRecord | undefined {
  const away = (twin: LegRecord) => Math.abs(twin.decided - leg.decided)
  return twins
    .filter((twin) => twin.from === leg.from && twin.to === leg.to && away(twin) < NEAR_S)
    .toSorted((one, other) => away(one) - away(other))[0]
}

function isAlike(one: LegRecord, other: LegRecord): boolean {
  return (
    one.from === other.from &&
    one.to === other.to &&
    one.passengers === other.passengers &&
    Math.abs(one.decided - other.decided) < SAME_S
  )
}

function differenceOf(leg: LegRecord | undefined, twin: LegRecord | undefined): Difference {
  return { time: leg?.decided ?? Infinity, one: leg, other: twin }
}

function swapped({ time, one, other }: Difference): Difference {
  return { time, one: other, other: one }
}

/** The earliest; of several at one time the first in the list. */
function earliest(list: readonly Difference[]): Difference | undefined {
  return list.toSorted((one, other) => one.time - other.time)[0]
}

function aircraftOf({ aircraft }: LegRecord): number {
  return aircraft
}

function sumOf(record: DayRecord): number {
  return record.legs.reduce((sum, leg) => sum + leg.profit_usd, 0)
}
