// The changes of a what-if, as a user combines them, and the request to the service.

import type { Event, MoreAircraft, Outlook, RouteNames, WhatIf } from '../api/types'
import type { Scenario } from './scenario'

/**
 * One change. Events can be reported to the day as they are; the other changes concern the fleet or
 * the stands.
 */
export type Change = { id: number } & (
  | { kind: 'event'; event: Event }
  | { kind: 'aircraft'; aircraft: MoreAircraft }
  | { kind: 'stands'; vertiport: string; stands: number }
)

/** The request to the service: all changes together, and the policy that would decide. */
export function requestOf(changes: readonly Change[], policy: string): WhatIf {
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

/** The scenario with the additional aircraft and the changed stands of a what-if. */
export function scenarioWith(scenario: Scenario, request: WhatIf): Scenario {
  const first = scenario.aircraft_types[0]?.id ?? ''
  const more = (request.aircraft ?? []).map(({ id, at, type }) => ({ id, at, type: type ?? first }))
  const vertiports = scenario.vertiports.map((one) => ({
    ...one,
    stands: request.stands?.[one.id] ?? one.stands,
  }))
  return { ...scenario, aircraft: [...scenario.aircraft, ...more], vertiports }
}

/** An id for an additional aircraft, in the program's naming scheme. */
export function freshId(taken: readonly string[]): string {
  for (let number = taken.length + 1; ; number++) {
    const id = `A${String(number).padStart(2, '0')}`
    if (!taken.includes(id)) return id
  }
}

/** Routes in the form of an event: all routes of a vertiport, or one route. */
export function routesOf(from: string, to: string): RouteNames {
  return to === '' ? { vertiport: from } : { from, to }
}

/** A figure of the rest of the day in both outlooks. */
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
  /** Whether a higher value is better for the operator; undefined if that depends. */
  isGood: boolean | undefined
}

/** Both outlooks, figure by figure. */
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
