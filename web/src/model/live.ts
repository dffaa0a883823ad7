// A live day as a record. The legs that were decided come from the service's trace, its state and
// the events. An outlook, which is late when the service is busy, only adds the expected legs.

import type { DayState, Outlook } from '../api/types'
import { grouped } from './arrays'
import { expectedLegs } from './expectedLegs'
import type { AircraftRecord, DayRecord, DemandRecord, LegRecord, Seconds, VertiportRecord } from './record'
import { decidedLegs } from './decidedLegs'
import { indexed, known, type Reports } from './reports'
import type { Scenario, ScenarioAircraft } from './scenario'
import { timeOf } from './time'

/** The inputs of a record. The outlook may be older than the state, or not available yet. */
export interface LiveSources {
  scenario: Scenario
  reports: Reports
  state: DayState
  outlook: Outlook | undefined
  /** The decided legs as the service had them lately, which may be before or after the state. */
  decided: readonly LegRecord[]
}

export function liveRecord({ scenario, reports, state, outlook, decided }: LiveSources): DayRecord {
  const taken = decidedLegs(scenario, reports, state, decided)
  const legs = outlook === undefined ? taken : withExpected(taken, expectedLegs(outlook, scenario, taken))
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
  const { seats, battery_kwh, charge_kw, charge_curve } = kind
  return {
    ...{ id, type, seats, battery_kwh, charge_kw, begins_at },
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

function withExpected(taken: LegRecord[], expected: LegRecord[]): LegRecord[] {
  return [...taken, ...expected].sort((one, other) => one.decided - other.decided)
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
