// The reports of a day so far, as pictures need them: departures, closures, outages and demand.
// Each event is applied once and in order, so the cost is proportional to the number of events.

import type { Event, RouteNames, TakenEvent } from '../api/types'
import { Closures, isInForce, type Routes } from './closures'
import type { ClosureRecord, OutageRecord, RouteRecord, Seconds } from './record'
import type { Scenario, ScenarioClosure } from './scenario'
import { ReportedDecisions } from './reportedDecisions'
import { timeOf } from './time'

/** The reports about the passengers of a pair in a period. */
export interface DemandReport extends RouteRecord {
  period: number
  /** The number who still wanted to fly at a time. */
  left?: { passengers: number; at: Seconds }
  /** The change in their number since then; negative if there are fewer. */
  more: number
}

export class Reports {
  readonly outages: OutageRecord[] = []
  /** By period and pair; only the latest report counts. */
  readonly #demand = new Map<string, DemandReport>()
  readonly periods: Seconds[]
  /** The number of the latest event that was applied. */
  seq = 0
  /** The latest time of an event: the day's clock. */
  #now: Seconds
  readonly #closures: Closures
  readonly #aircraft: Map<string, number>
  readonly #vertiports: Map<string, number>
  readonly decisions: ReportedDecisions

  constructor(scenario: Scenario) {
    this.#aircraft = indexed(scenario.aircraft)
    this.#vertiports = indexed(scenario.vertiports)
    this.periods = scenario.periods.map(timeOf)
    this.#now = timeOf(scenario.operations.start)
    const announced = closuresOf(scenario, (one) => one.known === true)
    this.#closures = new Closures(scenario.vertiports.length, announced)
    const places = scenario.aircraft.map(({ at }) => this.#vertiport(at))
    this.decisions = new ReportedDecisions(places, (id) => this.#vertiport(id))
  }

  /** The closures so far, past ones and those known in advance among them. */
  get closures(): readonly ClosureRecord[] {
    return this.#closures.records
  }

  take({ seq, event }: TakenEvent): void {
    this.seq = seq
    if (event.type === 'corrected') return
    const at = timeOf(event.time ?? 0)
    const now = Math.max(this.#now, at)
    this.#now = now
    if ('aircraft' in event) {
      const aircraft = known(this.#aircraft, event.aircraft)
      this.decisions.take(aircraft, { seq, event, at, now })
      this.#takeOutage(event, aircraft, at)
    }
    if (event.type === 'closed') {
      const until = event.until == null ? {} : { until: timeOf(event.until) }
      const reason = event.reason == null ? {} : { reason: event.reason }
      this.#closures.close(this.#routes(event.routes), { seq, at, ...until, ...reason }, now)
    } else if (event.type === 'reopened') this.#closures.reopen(this.#routes(event.routes), now)
    else this.#takeDemand(event, at)
  }

  #takeOutage(event: Event, aircraft: number, at: Seconds): void {
    if (event.type === 'out_of_service') {
      this.#endOutage(aircraft, at)
      const until = event.until == null ? {} : { until: timeOf(event.until) }
      const reason = event.reason == null ? {} : { reason: event.reason }
      this.outages.push({ aircraft, since: at, ...until, ...reason })
    } else if (event.type === 'back_in_service') this.#endOutage(aircraft, at)
  }

  #endOutage(aircraft: number, at: Seconds): void {
    const outage = this.outages.findLast((one) => one.aircraft === aircraft)
    if (outage !== undefined && isInForce(outage, at)) outage.until = at
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

  #routes(names: RouteNames): Routes {
    return 'vertiport' in names
      ? { vertiport: this.#vertiport(names.vertiport) }
      : { from: this.#vertiport(names.from), to: this.#vertiport(names.to) }
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
}

/** The closures of a scenario for which a table is true, one per direction. */
export function closuresOf(
  { vertiports, closures = [] }: Scenario,
  isOne: (closure: ScenarioClosure) => boolean = () => true,
): (RouteRecord & { since: Seconds; until: Seconds })[] {
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
