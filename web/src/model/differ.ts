// Finds where two plays of the same day differ. Plays of policies are equal up to their first
// different decision, so that is a choice between two legs in one situation. Decisions by people
// also differ in order and by seconds, so legs are compared per aircraft.

import { grouped } from './arrays'
import type { DayRecord, LegRecord, Seconds } from './record'

/** What each day did at that time; undefined if the aircraft has no decision there. */
export interface Difference {
  time: Seconds
  one: LegRecord | undefined
  other: LegRecord | undefined
}

export interface FirstDifference extends Difference {
  /** The first day's profit of this leg minus the other's. */
  atDecision_usd: number
  /**
   * The first day's profit of the whole day minus the other's. If both played the same day, this is
   * the effect of the decision and all later ones. A plan was made for a different day than the one
   * that was flown, so its difference includes that too.
   */
  atEnd_usd: number
}

/**
 * The first decision that sends an aircraft to different destinations; undefined if all routes are
 * equal.
 */
export function firstDifference(one: DayRecord, other: DayRecord): FirstDifference | undefined {
  const [ones, others] = [grouped(one.legs, aircraftOf), grouped(other.legs, aircraftOf)]
  const aircraft = [...new Set([...ones.keys(), ...others.keys()])]
  const first = earliest(aircraft.flatMap((id) => firstDivergence(ones.get(id) ?? [], others.get(id) ?? [])))
  if (first === undefined) return undefined
  return {
    ...first,
    atDecision_usd: (first.one?.profit_usd ?? 0) - (first.other?.profit_usd ?? 0),
    atEnd_usd: sumOf(one) - sumOf(other),
  }
}

/** The first legs of an aircraft with different destinations, as a list of at most one element. */
function firstDivergence(ones: readonly LegRecord[], others: readonly LegRecord[]): Difference[] {
  const longer = ones.length > others.length ? ones : others
  const position = longer.findIndex((_, leg) => ones[leg]?.to !== others[leg]?.to)
  if (position === -1) return []
  const [one, other] = [ones[position], others[position]]
  return [{ time: Math.min(one?.decided ?? Infinity, other?.decided ?? Infinity), one, other }]
}

/** How a leg differs from another day. */
export interface DifferingLeg {
  /**
   * The aircraft's leg on the other day: the same route at another time or with other passengers,
   * otherwise the latest leg there.
   */
  twin: LegRecord | undefined
  /** Whether the other day has no leg on this route at about this time. */
  isElsewhere: boolean
}

/** Legs without an equal leg on the other day, by position in the record. */
export type DifferingLegs = ReadonlyMap<number, DifferingLeg>

export interface Differences {
  one: DifferingLegs
  other: DifferingLegs
  first: Difference | undefined
}

/**
 * All differences that matter when two timelines are compared: routes, times and numbers of
 * passengers.
 */
export function differences(one: DayRecord, other: DayRecord): Differences {
  const [inOne, inOther] = [differingLegs(one, other), differingLegs(other, one)]
  const first = earliest([
    ...[...inOne].map(([leg, { twin }]) => differenceOf(one.legs[leg], twin)),
    ...[...inOther].map(([leg, { twin }]) => swapped(differenceOf(other.legs[leg], twin))),
  ])
  return { one: inOne, other: inOther, first }
}

/** Timelines are read to the minute, so decisions closer than this are equal. */
const SAME_S = 60
/** A leg on the same route within this time counts as earlier or later, not as another route. */
const NEAR_S = 900

function differingLegs(record: DayRecord, other: DayRecord): DifferingLegs {
  const others = grouped(other.legs, aircraftOf)
  const found = new Map<number, DifferingLeg>()
  record.legs.forEach((leg, position) => {
    const twins = others.get(leg.aircraft) ?? []
    if (twins.some((twin) => isAlike(leg, twin))) return
    const near = nearest(leg, twins)
    const meanwhile = twins.findLast((twin) => twin.decided < leg.decided + SAME_S)
    found.set(position, { twin: near ?? meanwhile, isElsewhere: near === undefined })
  })
  return found
}

/** The leg on the same route that is nearest in time, if one is near enough. */
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
