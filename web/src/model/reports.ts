// The reports of a day so far, as pictures need them: departures, closures, outages and demand.
// Each event is applied once and in order, so the cost is proportional to the number of events.

import type { Event, RouteNames, TakenEvent } from '../api/types'
import { Closures, isInForce, type Routes } from './closures'
import type { ClosureRecord, OutageRecord, RouteRecord, Seconds } from './record'
import type { Scenario, ScenarioClosure } from './scenario'
import { timeOf } from './time'

/** Facts about a decision that the service's outlook does not contain. */
export interface ReportedDecision {
  /** The destination of the decision, or of a departure that followed none. */
  to?: string
  departs?: Seconds
  hasDeparted: boolean
  landed?: Seconds
  /** Where it landed, if the report names the vertiport. */
  landedAt?: string
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
  /** By aircraft and time of the decision, in order. */
  readonly #decisions = new Map<number, Map<Seconds, ReportedDecision>>()
  /** Decisions that no longer hold, which an older trace may contain. */
  readonly #undone = new Set<string>()
  /** When the latest decision of each aircraft was taken. */
  readonly #latest = new Map<number, Seconds>()

  constructor(scenario: Scenario) {
    this.#aircraft = indexed(scenario.aircraft)
    this.#vertiports = indexed(scenario.vertiports)
    this.periods = scenario.periods.map(timeOf)
    this.#now = timeOf(scenario.operations.start)
    const known = closuresOf(scenario, (one) => one.known === true)
    this.#closures = new Closures(scenario.vertiports.length, known)
  }

  /** The known facts about the decision of an aircraft at a time. */
  decision(aircraft: number, decided: Seconds): ReportedDecision | undefined {
    return this.#decisions.get(aircraft)?.get(decided)
  }

  /** The decisions of an aircraft after a time that were not undone. */
  decisionsAfter(aircraft: number, time: Seconds): [decided: Seconds, ReportedDecision][] {
    const all = [...(this.#decisions.get(aircraft) ?? [])]
    return all.slice(all.findLastIndex(([decided]) => decided <= time) + 1)
  }

  /** The closures so far, past ones and those known in advance among them. */
  get closures(): readonly ClosureRecord[] {
    return this.#closures.records
  }

  take({ seq, event }: TakenEvent): void {
    this.seq = seq
    if (event.type === 'corrected' || event.type === 'acknowledged') return
    const at = timeOf(event.time ?? 0)
    this.#now = Math.max(this.#now, at)
    if ('aircraft' in event) this.#takeOfAircraft(event, this.#aircraftAt(event.aircraft), at)
    else if (event.type === 'closed') {
      const until = event.until == null ? {} : { until: timeOf(event.until) }
      const reason = event.reason == null ? {} : { reason: event.reason }
      this.#closures.close(this.#routes(event.routes), { seq, at, ...until, ...reason }, this.#now)
    } else if (event.type === 'reopened') this.#closures.reopen(this.#routes(event.routes), this.#now)
    else this.#takeDemand(event, at)
  }

  #takeOfAircraft(event: Event & { aircraft: string }, aircraft: number, at: Seconds): void {
    const decided = this.#latest.get(aircraft) ?? at
    switch (event.type) {
      case 'decided':
        this.#latest.set(aircraft, at)
        this.#enter(aircraft, at, {
          to: event.to,
          hasDeparted: false,
          ...(event.policy == null ? {} : { policy: event.policy }),
        })
        break
      case 'undone':
        this.#undo(aircraft, decided)
        break
      case 'departed': {
        // A departure without a decision, or to another vertiport, is a new decision. The service
        // enters it at the day's clock.
        const known = this.decision(aircraft, decided)
        const isOther = event.to != null && event.to !== known?.to
        const isSent = known !== undefined && !known.hasDeparted && known.landed === undefined && !isOther
        if (!isSent && known?.hasDeparted === false) this.#undo(aircraft, decided)
        const time = isSent ? decided : this.#now
        const to = event.to ?? known?.to
        const base = isSent ? known : to === undefined ? {} : { to }
        this.#latest.set(aircraft, time)
        this.#enter(aircraft, time, { ...base, departs: at, hasDeparted: true })
        break
      }
      case 'landed': {
        const known = this.decision(aircraft, decided)
        // After its landing, an aircraft that is reported elsewhere has been moved.
        if (known === undefined || known.landed !== undefined) break
        known.landed = at
        if (event.at != null) known.landedAt = event.at
        if (event.charge_kwh != null) known.lands_with_kwh = event.charge_kwh
        break
      }
      case 'delayed': {
        const known = this.decision(aircraft, decided)
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

  /** Whether a decision was taken back, or replaced by a departure to another vertiport. */
  isUndone(aircraft: number, decided: Seconds): boolean {
    return this.#undone.has(`${aircraft} ${decided}`)
  }

  #undo(aircraft: number, decided: Seconds): void {
    this.#decisions.get(aircraft)?.delete(decided)
    this.#undone.add(`${aircraft} ${decided}`)
  }

  #enter(aircraft: number, decided: Seconds, report: ReportedDecision): void {
    const all = this.#decisions.get(aircraft) ?? new Map<Seconds, ReportedDecision>()
    this.#decisions.set(aircraft, all.set(decided, report))
    this.#undone.delete(`${aircraft} ${decided}`)
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

  #aircraftAt(id: string): number {
    return known(this.#aircraft, id)
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
