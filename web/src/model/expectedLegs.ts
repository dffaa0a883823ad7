// The expected legs of an outlook that still hold. Decisions may have been taken, undone or
// reported since. The plan of an aircraft that went another way is dropped until there is a newer
// outlook.

import type { Leg, Outlook } from '../api/types'
import { grouped } from './arrays'
import { nominal, withTakeoff } from './nominal'
import type { LegRecord } from './record'
import { indexed, known } from './reports'
import type { Scenario } from './scenario'
import { timeOf } from './time'

/** The legs of outlooks, converted once, because a day is drawn many times with one outlook. */
const readLegs = new WeakMap<Outlook, LegRecord[]>()

/** The legs of an outlook in order of decision, as in the outlook. */
export function legsOf(outlook: Outlook, scenario: Scenario): LegRecord[] {
  const former = readLegs.get(outlook)
  if (former !== undefined) return former
  const [aircraft, vertiports] = [indexed(scenario.aircraft), indexed(scenario.vertiports)]
  const legs = outlook.legs.map((one) => {
    const leg = withTakeoff(legOf(one, aircraft, vertiports), one.takeoff)
    return { ...leg, energy_kwh: nominal(scenario, leg).energy_kwh }
  })
  readLegs.set(outlook, legs)
  return legs
}

function legOf(leg: Leg, aircraft: Map<string, number>, vertiports: Map<string, number>): LegRecord {
  const decided = timeOf(leg.time)
  return {
    aircraft: known(aircraft, leg.aircraft),
    from: known(vertiports, leg.from),
    to: known(vertiports, leg.to),
    decided,
    departs: decided,
    arrives: timeOf(leg.arrival),
    ready: timeOf(leg.ready),
    passengers: leg.passengers,
    profit_usd: leg.profit_usd,
    is_expected: !leg.is_taken,
  }
}

/** The expected legs of an outlook that follow from the decided legs of today. */
export function expectedLegs(outlook: Outlook, scenario: Scenario, decided: LegRecord[]): LegRecord[] {
  const places = indexed(scenario.vertiports)
  const [planned, taken] = [grouped(legsOf(outlook, scenario), byAircraft), grouped(decided, byAircraft)]
  return scenario.aircraft.flatMap((one, aircraft) =>
    stillExpected(planned.get(aircraft) ?? [], taken.get(aircraft) ?? [], known(places, one.at)),
  )
}

/** The expected legs of one aircraft, if those that were decided since went as planned. */
function stillExpected(planned: LegRecord[], decided: LegRecord[], begins_at: number): LegRecord[] {
  const past = planned.filter((leg) => !leg.is_expected)
  const isKnown = (leg: LegRecord) => past.some((one) => one.decided === leg.decided)
  if (past.some((leg) => !decided.some((one) => one.decided === leg.decided))) return []
  const since = decided.filter((leg) => !isKnown(leg))
  const expected = planned.filter((leg) => leg.is_expected)
  if (since.some((leg, index) => !isSameWay(leg, expected[index]))) return []
  const rest = expected.slice(since.length)
  const place = decided.at(-1)?.to ?? begins_at
  return rest[0]?.from === place ? rest : []
}

function isSameWay(leg: LegRecord, other: LegRecord | undefined): boolean {
  return leg.from === other?.from && leg.to === other.to
}

function byAircraft({ aircraft }: LegRecord): number {
  return aircraft
}
