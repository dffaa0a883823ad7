// The rows of the Gantt charts. For every aircraft: flights, charging, holds and outages, with the
// plan. For every stand of a vertiport: the aircraft that hold it.

import { at } from './arrays'
import { minutesOverdue } from './awaited'
import { Charges } from './charges'
import { NONE } from './motion'
import { roomOf, staysOf, type Stay } from './occupancy'
import type { DayRecord, LegRecord, Seconds } from './record'
import { isHold } from './record'

export type BarKind = 'flight' | 'charge' | 'hold' | 'delay' | 'outage' | 'promised' | 'standing'

export interface Bar {
  kind: BarKind
  begins: Seconds
  /** Infinity if unknown. */
  ends: Seconds
  aircraft: number
  /** Position in the record's legs, or NONE: an outage, or a stand before the first flight. */
  leg: number
  /** The load factor of a flight. */
  load: number
  isExpected: boolean
  /** The charge at its beginning and end, as shares; only on days that charge as needed. */
  charge?: { begins: number; ends: number }
  /** When the missing report of the bar's end was due; absent if it is not overdue. */
  overdueSince?: Seconds
}

/** The plan of a flight that went differently. */
export interface Plan {
  departs: Seconds
  arrives: Seconds
  ready: Seconds
  leg: number
}

export interface FleetRow {
  aircraft: number
  /** Ordered by their beginnings. */
  bars: Bar[]
  /**
   * Drawn over the bars, because an aircraft may be charging or waiting while it is out of service.
   */
  outages: Bar[]
  plans: Plan[]
}

export interface StandRow {
  vertiport: number
  /** From 0; rows beyond the vertiport's stands hold aircraft that have no stand. */
  stand: number
  isOver: boolean
  bars: Bar[]
  /** Times in which the aircraft on the stand is out of service. */
  outages: Bar[]
}

/** A row for each aircraft. */
export function fleetRows(record: DayRecord): FleetRow[] {
  const rows = record.aircraft.map((_, aircraft): FleetRow => ({
    aircraft,
    bars: [],
    outages: [],
    plans: [],
  }))
  const charges = chargesOf(record)
  record.legs.forEach((leg, index) => addLeg(at(rows, leg.aircraft), record, leg, index, charges))
  for (const { aircraft, since, until } of record.outages) {
    const outage = { kind: 'outage', begins: since, ends: until ?? Infinity } as const
    at(rows, aircraft).outages.push({ ...outage, aircraft, leg: NONE, load: 0, isExpected: false })
  }
  return rows
}

/** The charges of a day that charges as needed; on other days bars have none. */
function chargesOf(record: DayRecord): Charges | undefined {
  return record.chargesAsNeeded === true ? new Charges(record) : undefined
}

function addLeg(
  row: FleetRow,
  record: DayRecord,
  leg: LegRecord,
  index: number,
  charges: Charges | undefined,
): void {
  const { aircraft, decided, departs, arrives, ready } = leg
  const load = Math.min(1, leg.passengers / at(record.aircraft, aircraft).seats)
  const common = { aircraft, leg: index, load, isExpected: leg.is_expected }
  const add = (kind: BarKind, begins: Seconds, ends: Seconds, more: Partial<Bar> = {}) => {
    if (ends > begins) row.bars.push({ kind, begins, ends, ...common, ...more })
  }
  const shades = (side: 'before' | 'after', begins: Seconds, ends: Seconds) =>
    charges === undefined ? {} : { charge: charges.span(side, index, begins, ends) }
  if (isHold(leg)) {
    add('hold', decided, ready, shades('before', decided, ready))
    return
  }
  const isDeparture = leg.awaited?.report === 'departure'
  const charged = leg.charged === undefined ? decided : Math.min(leg.charged, departs)
  add('charge', decided, charged, shades('before', decided, charged))
  add('delay', charged, departs, isDeparture ? overdueOf(leg) : {})
  add('flight', departs, arrives, isDeparture ? {} : overdueOf(leg))
  add('charge', arrives, ready, shades('after', arrives, ready))
  if (leg.planned !== undefined) row.plans.push({ ...leg.planned, leg: index })
}

function overdueOf(leg: LegRecord | undefined): { overdueSince?: Seconds } {
  if (leg?.awaited === undefined || minutesOverdue(leg) === 0) return {}
  return { overdueSince: leg.awaited.due }
}

/** A row for each stand, vertiport by vertiport. */
export function standRows(record: DayRecord): StandRow[] {
  const charges = chargesOf(record)
  const byVertiport: Stay[][] = record.vertiports.map(() => [])
  for (const stay of staysOf(record)) at(byVertiport, stay.vertiport).push(stay)
  return record.vertiports.flatMap((one, vertiport) => {
    const room = roomOf(one)
    const lanes = assignStands(at(byVertiport, vertiport), room)
    return lanes.map((stays, stand): StandRow => {
      const bars = stays.flatMap((stay) => barsOf(stay, record, charges))
      const outages = stays.flatMap((stay) => outagesOf(stay, record))
      return { vertiport, stand, isOver: stand >= room, bars, outages }
    })
  })
}

/**
 * Assigns each stay the first free stand. Rows beyond the existing stands are added only if reports
 * place more aircraft there.
 */
function assignStands(stays: readonly Stay[], room: number): Stay[][] {
  const lanes: Stay[][] = Array.from({ length: room }, () => [])
  for (const stay of stays) {
    const free = lanes.find((lane) => (lane.at(-1)?.leaves ?? -Infinity) <= stay.promised)
    if (free === undefined) lanes.push([stay])
    else free.push(stay)
  }
  return lanes
}

function barsOf(stay: Stay, record: DayRecord, charges: Charges | undefined): Bar[] {
  const { aircraft, leg } = stay
  const flight = record.legs[leg]
  const common = { aircraft, leg, load: 0, isExpected: flight?.is_expected ?? false }
  // On days that charge as needed, an aircraft charges as long as it stays and is not full.
  const charged = charges === undefined ? stay.ready : Math.ceil(charges.fullAfter(leg, aircraft))
  const begin = charges === undefined ? -Infinity : record.start
  const shades = (begins: Seconds, ends: Seconds) =>
    charges === undefined ? {} : { charge: charges.spanOfStay(leg, aircraft, begins, ends) }
  const spans: [BarKind, Seconds, Seconds][] = [
    ['promised', stay.promised, Math.min(stay.arrives, stay.leaves)],
    ['charge', Math.max(stay.arrives, begin), Math.min(charged, stay.leaves)],
    ['standing', Math.max(charged, record.start), stay.leaves],
  ]
  const there = spans.filter(([, begins, ends]) => ends > begins)
  return there.map(([kind, begins, ends]) => {
    const overdue = kind === 'promised' ? overdueOf(flight) : {}
    const charge = kind === 'charge' ? shades(begins, ends) : {}
    return { kind, begins, ends, ...common, ...overdue, ...charge }
  })
}

/** The outages of an aircraft during its stay. */
function outagesOf({ aircraft, arrives, leaves, leg }: Stay, record: DayRecord): Bar[] {
  const own = record.outages.filter((outage) => outage.aircraft === aircraft)
  const within = own.map(({ since, until }) => ({
    begins: Math.max(since, arrives),
    ends: Math.min(until ?? Infinity, leaves),
  }))
  const common = { kind: 'outage', aircraft, leg, load: 0, isExpected: false } as const
  return within.filter(({ begins, ends }) => ends > begins).map((times) => ({ ...common, ...times }))
}
