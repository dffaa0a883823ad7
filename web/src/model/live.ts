// A live day as a record, made from its scenario, its events, and the service's outlook.

import type { AircraftState, DayState, Leg, Outlook } from '../api/types'
import { grouped } from './arrays'
import { nominal, withTakeoff } from './nominal'
import type { AircraftRecord, DayRecord, DemandRecord, LegRecord, Seconds, VertiportRecord } from './record'
import { indexed, known, type Reports } from './reports'
import type { Scenario, ScenarioAircraft } from './scenario'
import { timeOf } from './time'

/** The inputs of a record. The outlook may be older than the state, or not available yet. */
export interface LiveSources {
  scenario: Scenario
  reports: Reports
  state: DayState
  outlook: Outlook | undefined
  /** Legs flown before the day was opened, used until there is an outlook. */
  flown: readonly LegRecord[]
}

export function liveRecord({ scenario, reports, state, outlook, flown }: LiveSources): DayRecord {
  const known = outlook === undefined ? flown : legsOf(outlook, scenario)
  const legs = new Legs(scenario, reports, known).updatedTo(state)
  const frame = frameOf(scenario)
  const vertiports = frame.vertiports.map((one, at) => withStandsOf(one, state.vertiports[at]))
  return { ...frame, vertiports, legs, ...conditionsOf(scenario, reports, legs) }
}

/** A vertiport with its current stands, which a report may have changed. */
function withStandsOf(
  one: VertiportRecord,
  now: DayState['vertiports'][number] | undefined,
): VertiportRecord {
  if (now === undefined) return one
  return one.chargers === undefined ? { ...one, stands: now.stands } : { ...one, chargers: now.stands }
}

/** The parts of a record that depend only on its scenario. */
export function frameOf(scenario: Scenario): Omit<DayRecord, 'legs' | 'closures' | 'outages' | 'demand'> {
  const vertiports = indexed(scenario.vertiports)
  return {
    name: scenario.name,
    start: timeOf(scenario.operations.start),
    end: timeOf(scenario.operations.end),
    takeoff_s: scenario.operations.takeoff_s,
    landing_s: scenario.operations.landing_s,
    passenger_wait_s: scenario.operations.passenger_wait_s ?? 0,
    vertiports: scenario.vertiports.map(vertiportOf),
    aircraft: scenario.aircraft.map((one) => aircraftOf(scenario, one, known(vertiports, one.at))),
    periods: scenario.periods.map(timeOf),
    ...(scenario.operations.charging === 'as_needed' ? { chargesAsNeeded: true } : {}),
  }
}

function vertiportOf({ id, x_mi, y_mi, stands, ...more }: Scenario['vertiports'][number]): VertiportRecord {
  const { latitude, longitude, chargers, charger_kw } = more
  const degrees = latitude === undefined || longitude === undefined ? {} : { latitude, longitude }
  return {
    ...{ id, place: { x_mi, y_mi, ...degrees }, stands },
    ...(chargers === undefined ? {} : { chargers }),
    ...(charger_kw === undefined ? {} : { charger_kw }),
  }
}

function aircraftOf(
  scenario: Scenario,
  { id, type, start_charge_kwh }: ScenarioAircraft,
  begins_at: number,
): AircraftRecord {
  const kind = scenario.aircraft_types.find((one) => one.id === type)
  if (kind === undefined) throw new Error(`the scenario has no aircraft type "${type}"`)
  const { seats, battery_kwh, charge_kw, charge_curve, energy_kwh_per_mi } = kind
  return {
    ...{ id, type, seats, battery_kwh, charge_kw, energy_kwh_per_mi, begins_at },
    ...(charge_curve === undefined ? {} : { charge_curve }),
    ...(start_charge_kwh === undefined ? {} : { start_charge_kwh }),
  }
}

function conditionsOf(
  scenario: Scenario,
  reports: Reports,
  legs: LegRecord[],
): Pick<DayRecord, 'closures' | 'outages' | 'demand'> {
  const [closures, outages] = [
    reports.closures.map((one) => ({ ...one })),
    reports.outages.map((one) => ({ ...one })),
  ]
  return { closures, outages, demand: demandOf(scenario, reports, legs) }
}

/** The legs of outlooks, converted once, because a day is drawn many times with one outlook. */
const readLegs = new WeakMap<Outlook, LegRecord[]>()

/** The legs of an outlook in order of decision, as in the outlook. */
export function legsOf(outlook: Outlook, scenario: Scenario): LegRecord[] {
  const former = readLegs.get(outlook)
  if (former !== undefined) return former
  const [aircraft, vertiports] = [indexed(scenario.aircraft), indexed(scenario.vertiports)]
  const legs = outlook.legs.map((leg) => withTakeoff(scenario, legOf(leg, aircraft, vertiports), leg.takeoff))
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

/** The legs of an outlook, updated with reports and the state. */
class Legs {
  #legs: LegRecord[]
  /** The latest decision of each aircraft. */
  readonly #latest = new Map<number, LegRecord>()

  constructor(
    private readonly scenario: Scenario,
    private readonly reports: Reports,
    legs: readonly LegRecord[],
  ) {
    this.#legs = legs.map((leg) => (leg.is_expected ? leg : this.#reported(leg)))
    for (const leg of this.#legs) if (!leg.is_expected) this.#latest.set(leg.aircraft, leg)
  }

  /** Applies the state of every aircraft, which may be newer than the outlook. */
  updatedTo(state: DayState): LegRecord[] {
    const more: LegRecord[] = []
    const [ids, places] = [indexed(this.scenario.aircraft), indexed(this.scenario.vertiports)]
    for (const one of state.aircraft) {
      const aircraft = known(ids, one.id)
      const times = { arrives: timeOf(one.arrival), ready: timeOf(one.ready) }
      const latest = this.#latest.get(aircraft)
      if (one.flight == null) {
        this.#stands(one, latest, times)
        continue
      }
      const { passengers, takeoff } = one.flight
      const charge = one.lands_with_kwh == null ? {} : { lands_with_kwh: one.lands_with_kwh }
      const decided = timeOf(one.flight.decided)
      if (latest?.decided === decided)
        Object.assign(
          latest,
          this.#awaiting(one, this.#reported({ ...latest, ...times, ...charge, passengers })),
        )
      else {
        const [from, to] = [known(places, one.flight.from), known(places, one.flight.to)]
        const flight = { aircraft, from, to, decided, departs: decided, ...times, passengers }
        const leg = { ...flight, ...charge, profit_usd: 0, is_expected: false }
        const whole = this.#reported(withTakeoff(this.scenario, leg, takeoff))
        more.push(this.#awaiting(one, whole))
      }
    }
    return more.length === 0 ? this.#legs : this.#with(more)
  }

  /**
   * An aircraft that stands has landed. If it has stood there since before its latest flight was
   * decided, that decision was undone.
   */
  #stands(
    one: AircraftState,
    latest: LegRecord | undefined,
    times: { arrives: Seconds; ready: Seconds },
  ): void {
    if (latest === undefined || latest.from === latest.to) return
    if (times.arrives <= latest.decided) this.#legs = this.#legs.filter((leg) => leg !== latest)
    else if (!one.out_of_service) Object.assign(latest, times)
  }

  /**
   * The leg of an aircraft under way, with the report that it awaits. Reports may be newer than the
   * state.
   */
  #awaiting({ phase }: AircraftState, leg: LegRecord): LegRecord {
    const report = this.reports.decision(leg.aircraft, leg.decided)
    if (report?.landed !== undefined) {
      const ready = report.landed + leg.ready - leg.arrives
      return { ...leg, arrives: report.landed, ready }
    }
    const hasDeparted = phase === 'in_the_air' || report?.hasDeparted === true
    return {
      ...leg,
      awaited: hasDeparted
        ? { report: 'landing', due: leg.arrives }
        : { report: 'departure', due: leg.departs },
    }
  }

  /**
   * Adds legs that the outlook does not contain yet. They replace the expected legs of these
   * aircraft up to the time when they are ready.
   */
  #with(more: LegRecord[]): LegRecord[] {
    const readyAt = new Map(more.map((leg) => [leg.aircraft, leg.ready]))
    const isVoid = (leg: LegRecord) => leg.is_expected && leg.decided < (readyAt.get(leg.aircraft) ?? 0)
    const legs = [...this.#legs.filter((leg) => !isVoid(leg)), ...more]
    return legs.sort((one, other) => one.decided - other.decided || one.aircraft - other.aircraft)
  }

  /** A leg with its reported departure, who decided it, and the plan if it went differently. */
  #reported(leg: LegRecord): LegRecord {
    const report = this.reports.decision(leg.aircraft, leg.decided)
    const policy = report?.policy === undefined ? {} : { policy: report.policy }
    if (leg.from === leg.to) return { ...leg, ...policy }
    const charged = leg.charged ?? leg.decided
    const departs = report?.departs ?? charged
    const arrives = charged + nominal(this.scenario, leg).flight_s
    const charge = report?.lands_with_kwh === undefined ? {} : { lands_with_kwh: report.lands_with_kwh }
    const known = { ...leg, ...policy, ...charge, departs }
    if (departs === charged && leg.arrives === arrives) return known
    const planned = { departs: charged, arrives, ready: arrives + leg.ready - leg.arrives }
    return { ...known, planned }
  }
}

/** The demand: the forecast, updated by events. */
function demandOf(scenario: Scenario, reports: Reports, legs: LegRecord[]): DemandRecord {
  const passengers = (scenario.forecast ?? scenario.demand).map((table) => table.map((row) => [...row]))
  const carried = new Carried(legs, reports.periods)
  for (const { period, from, to, left, more } of reports.demand) {
    const row = passengers[period]?.[from]
    if (row === undefined) continue
    const known =
      left === undefined ? (row[to] ?? 0) : left.passengers + carried.before(left.at, period, from, to)
    row[to] = Math.max(0, known + more)
  }
  return { passengers }
}

/**
 * The passengers carried, by period and pair. A report of demand counts only those who are left.
 */
class Carried {
  readonly #legs: Map<string, LegRecord[]>

  constructor(legs: LegRecord[], periods: Seconds[]) {
    const carried = legs.filter((leg) => !leg.is_expected && leg.passengers > 0)
    this.#legs = grouped(carried, ({ decided, from, to }) => {
      const period = periods.findLastIndex((begins) => begins <= decided)
      return `${period} ${from} ${to}`
    })
  }

  before(time: Seconds, period: number, from: number, to: number): number {
    const legs = this.#legs.get(`${period} ${from} ${to}`) ?? []
    return legs.reduce((sum, leg) => (leg.decided < time ? sum + leg.passengers : sum), 0)
  }
}
