// A finished day as a record, from a scenario file and a policy's trace of it.
// docs/src/reference/files.md describes both.

import { parseCsv } from './csv'
import { frameOf } from './live'
import { nominal, type Nominal } from './nominal'
import type { DayRecord, LegRecord, OutageRecord } from './record'
import { closuresOf, indexed } from './reports'
import type { Scenario } from './scenario'
import { parseTime, timeOf } from './time'

/** Why a file was rejected. The view has a text for each. */
export type FileFault =
  | { what: 'no-json' }
  | { what: 'no-scenario'; format: string | undefined }
  | { what: 'second-scenario'; first: string }
  | { what: 'scenario-missing' }
  | { what: 'no-trace'; begins: string }
  | { what: 'trace-missing' }
  | { what: 'missing-column'; column: string }
  | { what: 'columns'; line: number; found: number; wanted: number }
  | { what: 'unknown-id'; line: number; column: string; value: string }
  | { what: 'unreadable'; line: number; column: string; value: string }
  | { what: 'out-of-order'; line: number }

/** User files that cannot be shown, with the fault of each. */
export class FilesError extends Error {
  constructor(readonly faults: readonly FileError[]) {
    super(faults.map(({ message }) => message).join('; '))
    this.name = 'FilesError'
  }
}

/** A user file that cannot be shown. */
export class FileError extends Error {
  constructor(
    readonly fault: FileFault,
    /** The name of the file, if it is one of several. */
    readonly file?: string,
  ) {
    super(JSON.stringify(fault))
    this.name = 'FileError'
  }
}

/** The number of characters quoted from a wrong file. */
const MOST_QUOTED = 40

const COLUMNS = [
  'time',
  'aircraft',
  'from',
  'to',
  'passengers',
  'revenue',
  'passenger_cost',
  'energy_cost',
  'arrival',
  'ready',
]

/** Whether a text looks like a scenario file, valid or not. */
export function isJson(text: string): boolean {
  return /^\uFEFF?\s*[{[]/.test(text)
}

/** Whether a text begins like a trace. */
export function isTrace(text: string): boolean {
  return /^\uFEFF?"?time"?,"?aircraft"?,/.test(text)
}

/** The fault of a text that is not a trace: how it begins. */
export function noTrace(text: string): FileError {
  const [line = ''] = text.replace(/^\uFEFF/, '').split(/\r?\n/)
  const begins = line.length > MOST_QUOTED ? `${line.slice(0, MOST_QUOTED)}…` : line
  return new FileError({ what: 'no-trace', begins })
}

/**
 * Parses a scenario file. Only the members that pictures need are checked; the program validates
 * scenarios.
 */
export function parseScenario(text: string): Scenario {
  let scenario: unknown
  try {
    scenario = JSON.parse(text.replace(/^\uFEFF/, ''))
  } catch {
    throw new FileError({ what: 'no-json' })
  }
  if (!isScenario(scenario)) throw new FileError({ what: 'no-scenario', format: formatOf(scenario) })
  return scenario
}

/** The format that a file declares. */
function formatOf(value: unknown): string | undefined {
  const format = (value as { format?: unknown } | null)?.format
  return typeof format === 'string' ? format : undefined
}

function isScenario(value: unknown): value is Scenario {
  const one = value as Partial<Scenario> | null
  return (
    typeof one === 'object' &&
    String(one?.format).startsWith('vertifleet-scenario/') &&
    [one?.vertiports, one?.aircraft, one?.aircraft_types, one?.periods, one?.demand].every(Array.isArray)
  )
}

/** The day as recorded in the trace. */
export function recordOf(scenario: Scenario, trace: string, policy?: string): DayRecord {
  return {
    ...frameOf(scenario),
    legs: new TraceReader(scenario, policy).read(trace),
    closures: closuresOf(scenario),
    outages: outagesOf(scenario),
    demand: { passengers: scenario.demand },
  }
}

/**
 * The daily cost of the fleet, stands and chargers in dollars. It does not depend on flights, so it
 * is part of the day's profit but not of any leg's.
 */
export function fixedCost(scenario: Scenario): number {
  const sites = scenario.vertiports.map(
    (vertiport) =>
      (vertiport.stand_cost ?? 0) * vertiport.stands +
      (vertiport.charger_cost ?? 0) * (vertiport.chargers ?? 0),
  )
  return sites.reduce((sum, cost) => sum + cost, (scenario.aircraft_cost ?? 0) * scenario.aircraft.length)
}

function outagesOf(scenario: Scenario): OutageRecord[] {
  const aircraft = indexed(scenario.aircraft)
  return (scenario.outages ?? []).flatMap((one) => {
    const position = aircraft.get(one.aircraft)
    if (position === undefined) return []
    return [{ aircraft: position, since: timeOf(one.start), until: timeOf(one.end) }]
  })
}

class TraceReader {
  readonly #aircraft: Map<string, number>
  readonly #vertiports: Map<string, number>
  #columns = new Map<string, number>()

  constructor(
    private readonly scenario: Scenario,
    private readonly policy: string | undefined,
  ) {
    this.#aircraft = indexed(scenario.aircraft)
    this.#vertiports = indexed(scenario.vertiports)
  }

  read(trace: string): LegRecord[] {
    const [names, ...rows] = parseCsv(trace)
    if (names === undefined || !isTrace(trace)) throw noTrace(trace)
    this.#columns = new Map(names.map((name, index) => [name, index]))
    const missing = COLUMNS.find((column) => !this.#columns.has(column))
    if (missing !== undefined) throw new FileError({ what: 'missing-column', column: missing })
    const broken = rows.findIndex((row) => row.length !== names.length)
    const found = rows[broken]?.length
    if (found !== undefined)
      throw new FileError({ what: 'columns', line: broken + 2, found, wanted: names.length })
    const legs = rows.map((row, index) => this.#leg(row, index + 2))
    const late = legs.findIndex((leg, index) => leg.decided < (legs[index - 1]?.decided ?? 0))
    if (late !== -1) throw new FileError({ what: 'out-of-order', line: late + 2 })
    return legs
  }

  #leg(row: string[], line: number): LegRecord {
    const aircraft = this.#id(this.#aircraft, row, 'aircraft', line)
    const [from, to] = [
      this.#id(this.#vertiports, row, 'from', line),
      this.#id(this.#vertiports, row, 'to', line),
    ]
    const number = (column: string) => this.#number(row, column, line)
    const time = (column: string) => this.#time(row, column, line)
    const [decided, arrives, ready] = [time('time'), time('arrival'), time('ready')]
    const costs =
      number('passenger_cost') +
      number('energy_cost') +
      (this.#columns.has('flight_cost') ? number('flight_cost') : 0)
    const leg: LegRecord = {
      ...{ aircraft, from, to, decided, departs: decided, arrives, ready },
      passengers: number('passengers'),
      profit_usd: number('revenue') - costs,
      is_expected: false,
      ...(this.policy === undefined ? {} : { policy: this.policy }),
    }
    if (this.#columns.has('charge_kwh')) leg.charge_kwh = number('charge_kwh')
    if (from === to) return leg
    const plan = nominal(this.scenario, leg)
    leg.energy_kwh = this.#columns.has('energy_kwh') ? number('energy_kwh') : plan.energy_kwh
    if (this.#columns.has('takeoff')) leg.charged = time('takeoff')
    this.#compareWithPlan(leg, plan)
    return leg
  }

  /**
   * A flight that arrives late was delayed on the ground (docs/src/concepts/model.md, take-off
   * delays).
   */
  #compareWithPlan(leg: LegRecord, { flight_s, ground_s }: Nominal): void {
    const departs = leg.charged ?? leg.decided
    const arrives = departs + flight_s
    const planned = { departs, arrives, ready: arrives + ground_s }
    leg.departs = departs + Math.max(0, leg.arrives - arrives)
    if (leg.arrives !== planned.arrives || leg.ready !== planned.ready) leg.planned = planned
  }

  #field(row: string[], column: string): string {
    return row[this.#columns.get(column) ?? -1] ?? ''
  }

  #id(known: Map<string, number>, row: string[], column: string, line: number): number {
    const value = this.#field(row, column)
    const index = known.get(value)
    if (index === undefined) throw new FileError({ what: 'unknown-id', line, column, value })
    return index
  }

  #number(row: string[], column: string, line: number): number {
    const value = this.#field(row, column)
    const number = value.trim() === '' ? NaN : Number(value)
    if (!Number.isFinite(number)) throw new FileError({ what: 'unreadable', line, column, value })
    return number
  }

  #time(row: string[], column: string, line: number): number {
    const value = this.#field(row, column)
    const time = parseTime(value)
    if (time === undefined) throw new FileError({ what: 'unreadable', line, column, value })
    return time
  }
}
