// The near-term impact of a what-if: the differences between two continuations of a day within the
// next hours. Later on nearly every decision differs, because each follows from earlier ones, so
// those differences show nothing about the change.

import { grouped } from './arrays'
import type { DifferingLegs } from './differ'
import { isHold, type DayRecord, type LegRecord, type Seconds } from './record'

/** A dispatcher can act on expectations this far ahead. */
export const HORIZON_S = 2 * 3600

/** An aircraft with another destination, and the first leg with that difference. */
export interface AffectedAircraft {
  id: string
  asItIs: LegRecord | undefined
  whatIf: LegRecord | undefined
}

/** The difference in passengers carried from one vertiport to another. */
export interface PairChange {
  from: string
  to: string
  more: number
}

/** The difference in landings at a vertiport. */
export interface LandingChange {
  id: string
  more: number
}

export interface Impact {
  until: Seconds
  aircraft: AffectedAircraft[]
  /** Passengers who take off within these hours. */
  passengers: { asItIs: number; whatIf: number }
  /** The pairs with the largest differences first. */
  pairs: PairChange[]
  places: LandingChange[]
}

/** The differences within two hours of `now`. */
export function impactOf(asItIs: DayRecord, whatIf: DayRecord, now: Seconds): Impact {
  const until = now + HORIZON_S
  const [ones, others] = [upcomingLegs(asItIs, now, until), upcomingLegs(whatIf, now, until)]
  const byPair = (record: DayRecord, legs: readonly LegRecord[]) =>
    summed(
      legs,
      (leg) => `${idOf(record, leg.from)} ${idOf(record, leg.to)}`,
      (leg) => leg.passengers,
    )
  const byPlace = (record: DayRecord, legs: readonly LegRecord[]) =>
    summed(
      legs,
      (leg) => idOf(record, leg.to),
      (leg) => Number(!isHold(leg)),
    )
  const pairs = increases(byPair(asItIs, ones), byPair(whatIf, others)).map(([pair, more]) => {
    const [from = '', to = ''] = pair.split(' ')
    return { from, to, more }
  })
  const places = increases(byPlace(asItIs, ones), byPlace(whatIf, others))
  return {
    until,
    aircraft: aircraftOf(asItIs, whatIf, now, until),
    passengers: { asItIs: passengersOf(ones), whatIf: passengersOf(others) },
    pairs,
    places: places.map(([id, more]) => ({ id, more })),
  }
}

/** Differences of legs that are decided before a time; later ones are left out. */
export function decidedBefore(differing: DifferingLegs, record: DayRecord, until: Seconds): DifferingLegs {
  return new Map([...differing].filter(([index]) => (record.legs[index]?.decided ?? Infinity) < until))
}

/** The legs that will be decided within the horizon. */
function upcomingLegs({ legs }: DayRecord, now: Seconds, until: Seconds): LegRecord[] {
  return legs.filter((leg) => leg.is_expected && leg.decided >= now && leg.decided < until)
}

/**
 * Aircraft that get another destination before a time. Their complete continuations are compared
 * leg by leg. So a leg just before the time in one and just after it in the other is no difference.
 */
function aircraftOf(asItIs: DayRecord, whatIf: DayRecord, now: Seconds, until: Seconds): AffectedAircraft[] {
  const [mine, theirs] = [byAircraft(asItIs, now), byAircraft(whatIf, now)]
  const ids = [...new Set([...mine.keys(), ...theirs.keys()])]
  const impact = ids.flatMap((id): AffectedAircraft[] => {
    const [mineOf, theirsOf] = [mine.get(id) ?? [], theirs.get(id) ?? []]
    const longer = mineOf.length > theirsOf.length ? mineOf : theirsOf
    const leadsElsewhere = (at: number) => {
      const [one, other] = [mineOf[at], theirsOf[at]]
      const areBoth = one !== undefined && other !== undefined
      return !areBoth || idOf(asItIs, one.to) !== idOf(whatIf, other.to)
    }
    const first = longer.findIndex((_, at) => leadsElsewhere(at))
    return first < 0 ? [] : [{ id, asItIs: mineOf[first], whatIf: theirsOf[first] }]
  })
  const soon = impact.filter((one) => timeOf(one) < until)
  return soon.sort((one, other) => timeOf(one) - timeOf(other))
}

function timeOf({ asItIs, whatIf }: AffectedAircraft): Seconds {
  return Math.min(asItIs?.decided ?? Infinity, whatIf?.decided ?? Infinity)
}

/** The undecided legs of each aircraft. */
function byAircraft({ aircraft, legs }: DayRecord, now: Seconds): Map<string, LegRecord[]> {
  const left = legs.filter((leg) => leg.is_expected && leg.decided >= now)
  return grouped(left, (leg) => aircraft[leg.aircraft]?.id ?? '')
}

function idOf({ vertiports }: DayRecord, vertiport: number): string {
  return vertiports[vertiport]?.id ?? ''
}

function passengersOf(legs: readonly LegRecord[]): number {
  return legs.reduce((sum, leg) => sum + leg.passengers, 0)
}

function summed(
  legs: readonly LegRecord[],
  name: (leg: LegRecord) => string,
  number: (leg: LegRecord) => number,
): Map<string, number> {
  const sums = new Map<string, number>()
  for (const leg of legs) sums.set(name(leg), (sums.get(name(leg)) ?? 0) + number(leg))
  return sums
}

/**
 * The increase of each sum from the first map to the second, without zeros; the largest changes
 * first.
 */
function increases(ones: Map<string, number>, others: Map<string, number>): [string, number][] {
  const names = [...new Set([...ones.keys(), ...others.keys()])]
  const more = names.map((name): [string, number] => [name, (others.get(name) ?? 0) - (ones.get(name) ?? 0)])
  const differing = more.filter(([, by]) => by !== 0)
  return differing.sort(
    ([one, by], [other, otherBy]) => Math.abs(otherBy) - Math.abs(by) || one.localeCompare(other),
  )
}
