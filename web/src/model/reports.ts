// The reports of a day so far, as pictures need them: departures, closures, outages and demand.
// Each event is applied once and in order, so the cost is proportional to the number of events.

import type { Event, RouteNames, TakenEvent } from '../api/types'
import type { ClosureRecord, OutageRecord, RouteRecord, Seconds } from './record'
import type { Scenario, ScenarioClosure } from './scenario'
import { timeOf } from './time'

/** Facts about a decision that the service's outlook does not contain. */
export interface ReportedDecision {
  departs?: Seconds
  hasDeparted: boolean
  landed?: Seconds
  /** The charge that the aircraft landed with, if it was reported. */
  lands_with_kwh?: number
  policy?: string
}

/** The reports about the passengers of a pair in a period. */
export interface DemandReport extends RouteRecord {
  period: number
  /** The number who still wanted to fly at a time. */
  left?: { passengers: number; at: Seconds }
  /** The change in their number since then; negative if there are fewer. */
  more: number
}

export class Reports {
  readonly closures: ClosureRecord[]
  readonly outages: OutageRecord[] = []
  /** By period and pair; only the latest report counts. */
  readonly #demand = new Map<string, DemandReport>()
  readonly periods: Seconds[]
  /** The number of the latest event that was applied. */
  seq = 0
  readonly #aircraft: Map<string, number>
  readonly #vertiports: Map<string, number>
  readonly #decisions = new Map<string, ReportedDecision>()
  /** When the latest decision of each aircraft was taken. */
  readonly #latest = new Map<number, Seconds>()

  constructor(scenario: Scenario) {
    this.#aircraft = indexed(scenario.aircraft)
    this.#vertiports = indexed(scenario.vertiports)
    this.periods = scenario.periods.map(timeOf)
    this.closures = closuresOf(scenario, (one) => one.known === true)
  }

  /** The known facts about the decision of an aircraft at a time. */
  decision(aircraft: number, decided: Seconds): ReportedDecision | undefined {
    return this.#decisions.get(key(aircraft, decided))
  }

  take({ seq, event }: TakenEvent): void {
    this.seq = seq
    const at = timeOf(event.time ?? 0)
    if ('aircraft' in event) this.#takeOfAircraft(event, this.#aircraftAt(event.aircraft), at)
    else if (event.type === 'closed') this.#close(event, at)
    else if (event.type === 'reopened') this.#reopen(event.routes, at)
    else this.#takeDemand(event, at)
  }

  #takeOfAircraft(event: Event & { aircraft: string }, aircraft: number, at: Seconds): void {
    const decided = this.#latest.get(aircraft) ?? at
    switch (event.type) {
      case 'decided':
        this.#latest.set(aircraft, at)
        this.#decisions.set(key(aircraft, at), {
          hasDeparted: false,
          ...(event.policy == null ? {} : { policy: event.policy }),
        })
        break
      case 'undone':
        this.#decisions.delete(key(aircraft, decided))
        break
      case 'departed': {
        const known = this.#decisions.get(key(aircraft, decided))
        const time = known === undefined || known.hasDeparted ? at : decided
        this.#latest.set(aircraft, time)
        this.#decisions.set(key(aircraft, time), { ...known, departs: at, hasDeparted: true })
        break
      }
      case 'landed': {
        const known = this.#decisions.get(key(aircraft, decided))
        if (known === undefined) break
        known.landed = at
        if (event.charge_kwh != null) known.lands_with_kwh = event.charge_kwh
        break
      }
      case 'delayed': {
        const known = this.#decisions.get(key(aircraft, decided))
        if (known?.hasDeparted === false) known.departs = timeOf(event.until)
        break
      }
      case 'out_of_service':
        this.#endOutage(aircraft, at)
        this.outages.push({
          aircraft,
          since: at,
          ...(event.until == null ? {} : { until: timeOf(event.until) }),
          ...(event.reason == null ? {} : { reason: event.reason }),
        })
        break
      case 'back_in_service':
        this.#endOutage(aircraft, at)
        break
      default:
    }
  }

  #endOutage(aircraft: number, at: Seconds): void {
    const outage = this.outages.findLast((one) => one.aircraft === aircraft)
    if (outage !== undefined && isInForce(outage, at)) outage.until = at
  }

  #close(event: Event & { type: 'closed' }, at: Seconds): void {
    const closed = this.#routes(event.routes)
    for (const former of this.closures.filter((one) => isInForce(one, at) && isOf(one, closed)))
      former.until = at
    this.closures.push({
      ...closed,
      since: at,
      ...(event.until == null ? {} : { until: timeOf(event.until) }),
      ...(event.reason == null ? {} : { reason: event.reason }),
    })
  }

  /**
   * Ends the closures of these routes. If one route of a closed vertiport opens, the closure is
   * split into its other routes.
   */
  #reopen(names: RouteNames, at: Seconds): void {
    const opened = this.#routes(names)
    for (const closure of this.closures.filter((one) => isInForce(one, at) && touches(one, opened))) {
      if ('vertiport' in closure && !('vertiport' in opened)) {
        const { vertiport, ...rest } = closure
        for (const route of this.#routesOf(vertiport)) {
          if (route.from !== opened.from || route.to !== opened.to)
            this.closures.push({ ...rest, ...route, since: at })
        }
      }
      closure.until = at
    }
  }

  get demand(): Iterable<DemandReport> {
    return this.#demand.values()
  }

  #takeDemand(event: Event, at: Seconds): void {
    if (event.type === 'demand') {
      const period = this.#period(timeOf(event.period))
      for (const { from, to, passengers } of event.pairs) {
        const report = this.#demandOf(period, from, to)
        report.left = { passengers, at }
        report.more = 0
      }
    } else if (event.type === 'booked' || event.type === 'cancelled') {
      const report = this.#demandOf(this.#period(timeOf(event.period)), event.from, event.to)
      report.more += event.type === 'booked' ? event.passengers : -event.passengers
    }
  }

  #demandOf(period: number, origin: string, destination: string): DemandReport {
    const [from, to] = [this.#vertiport(origin), this.#vertiport(destination)]
    const name = `${period} ${from} ${to}`
    const report = this.#demand.get(name) ?? { period, from, to, more: 0 }
    this.#demand.set(name, report)
    return report
  }

  #routes(names: RouteNames): RouteRecord | { vertiport: number } {
    return 'vertiport' in names
      ? { vertiport: this.#vertiport(names.vertiport) }
      : { from: this.#vertiport(names.from), to: this.#vertiport(names.to) }
  }

  #routesOf(vertiport: number): RouteRecord[] {
    const others = [...this.#vertiports.values()].filter((other) => other !== vertiport)
    return others.flatMap((other) => [
      { from: vertiport, to: other },
      { from: other, to: vertiport },
    ])
  }

  #period(time: Seconds): number {
    return Math.max(
      0,
      this.periods.findLastIndex((begins) => begins <= time),
    )
  }

  #vertiport(id: string): number {
    return known(this.#vertiports, id)
  }

  #aircraftAt(id: string): number {
    return known(this.#aircraft, id)
  }
}

/** The closures of a scenario for which a table is true, one per direction. */
export function closuresOf(
  { vertiports, closures = [] }: Scenario,
  isOne: (closure: ScenarioClosure) => boolean = () => true,
): ClosureRecord[] {
  const positions = indexed(vertiports)
  return closures.filter(isOne).flatMap((one) => {
    const [from, to] = [known(positions, one.from), known(positions, one.to)]
    const times = { since: timeOf(one.start), until: timeOf(one.end) }
    const back = one.both_ways === true ? [{ from: to, to: from, ...times }] : []
    return [{ from, to, ...times }, ...back]
  })
}

/** Positions by id. */
export function indexed(things: { id: string }[]): Map<string, number> {
  return new Map(things.map(({ id }, at) => [id, at]))
}

/** The position of an id from the service, which is always part of the scenario. */
export function known(positions: Map<string, number>, id: string): number {
  const at = positions.get(id)
  if (at === undefined) throw new Error(`the scenario of the day has no "${id}"`)
  return at
}

function key(aircraft: number, decided: Seconds): string {
  return `${aircraft}@${decided}`
}

function isInForce({ since, until }: { since: Seconds; until?: Seconds }, at: Seconds): boolean {
  return since <= at && (until === undefined || until > at)
}

/** Whether a closure covers exactly these routes. */
function isOf(closure: ClosureRecord, routes: RouteRecord | { vertiport: number }): boolean {
  if ('vertiport' in closure) return 'vertiport' in routes && closure.vertiport === routes.vertiport
  return !('vertiport' in routes) && closure.from === routes.from && closure.to === routes.to
}

/** Whether a closure covers routes that reopen, or some of them. */
function touches(closure: ClosureRecord, opened: RouteRecord | { vertiport: number }): boolean {
  if ('vertiport' in closure) {
    if ('vertiport' in opened) return closure.vertiport === opened.vertiport
    return closure.vertiport === opened.from || closure.vertiport === opened.to
  }
  if ('vertiport' in opened) return closure.from === opened.vertiport || closure.to === opened.vertiport
  return closure.from === opened.from && closure.to === opened.to
}
