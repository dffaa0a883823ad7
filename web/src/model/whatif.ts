// Changes that a day might see, as a person puts them together, and what the service is asked about them.

import type { Event, MoreAircraft, Outlook, RouteNames, WhatIf } from '../api/types'
import type { Scenario } from './scenario'

/** One change. Events can be reported to the day as they are; the others are about another fleet or other vertiports. */
export type Change = { id: number } & (
  | { kind: 'event'; event: Event }
  | { kind: 'aircraft'; aircraft: MoreAircraft }
  | { kind: 'stands'; vertiport: string; stands: number }
)

/** What the service is asked: the changes together, and the policy that would decide. */
export function askedOf(changes: readonly Change[], policy: string): WhatIf {
  const events = eventsOf(changes)
  const aircraft = changes.flatMap((one) => (one.kind === 'aircraft' ? [one.aircraft] : []))
  const stands = changes.flatMap((one) =>
    one.kind === 'stands' ? [[one.vertiport, one.stands] as const] : [],
  )
  return {
    ...(events.length > 0 ? { events } : {}),
    ...(aircraft.length > 0 ? { aircraft } : {}),
    ...(stands.length > 0 ? { stands: Object.fromEntries(stands) } : {}),
    ...(policy === '' ? {} : { policy }),
  }
}

export function eventsOf(changes: readonly Change[]): Event[] {
  return changes.flatMap((one) => (one.kind === 'event' ? [one.event] : []))
}

/** The scenario with the aircraft that the fleet might have and the stands that vertiports might have. */
export function scenarioWith(scenario: Scenario, asked: WhatIf): Scenario {
  const first = scenario.aircraft_types[0]?.id ?? ''
  const more = (asked.aircraft ?? []).map(({ id, at, type }) => ({ id, at, type: type ?? first }))
  const vertiports = scenario.vertiports.map((one) => ({
    ...one,
    stands: asked.stands?.[one.id] ?? one.stands,
  }))
  return { ...scenario, aircraft: [...scenario.aircraft, ...more], vertiports }
}

/** An id for another aircraft, as the program names those of a fleet. */
export function freshId(taken: readonly string[]): string {
  for (let number = taken.length + 1; ; number++) {
    const id = `A${String(number).padStart(2, '0')}`
    if (!taken.includes(id)) return id
  }
}

/** Routes as an event names them: all of a vertiport, or one way from it. */
export function routesOf(from: string, to: string): RouteNames {
  return to === '' ? { vertiport: from } : { from, to }
}

/** A number of the rest of the day in both outlooks. */
export interface Compared {
  name:
    | 'profit'
    | 'bound'
    | 'passengers'
    | 'spilled'
    | 'flights'
    | 'repositioning'
    | 'holds'
    | 'energy'
    | 'loadFactor'
  asItIs: number | undefined
  whatIf: number | undefined
  /** Whether more of it is better for the operator; neither, where that depends. */
  isGood: boolean | undefined
}

/** Both outlooks number by number. */
export function compared(asItIs: Outlook, whatIf: Outlook): Compared[] {
  const row = (
    name: Compared['name'],
    isGood: boolean | undefined,
    read: (outlook: Outlook) => number | undefined,
  ): Compared => ({ name, asItIs: read(asItIs), whatIf: read(whatIf), isGood })
  return [
    row('profit', true, (one) => one.totals.profit_usd),
    row('bound', true, (one) => one.upper_bound_usd ?? undefined),
    row('passengers', true, (one) => one.totals.passengers),
    row('spilled', false, (one) => one.totals.spilled_passengers),
    row('flights', undefined, (one) => one.totals.flights),
    row('repositioning', false, (one) => one.totals.repositioning_flights),
    row('holds', false, (one) => one.totals.holds),
    row('energy', undefined, (one) => one.totals.energy_kwh),
    row('loadFactor', true, (one) => one.totals.load_factor),
  ]
}
