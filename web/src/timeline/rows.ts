// The rows of a timeline. Rows of the fleet and rows of stands have the same shape, so that one
// Gantt draws both.

import { at, countUpTo } from '../model/arrays'
import { fleetRows, standRows, type Bar, type Plan } from '../model/bars'
import { NONE } from '../model/motion'
import type { DayRecord, Seconds } from '../model/record'
import type { Target } from '../model/target'
import type { Span } from './span'

export interface GanttRow {
  label: string
  /** The vertiport, on the row of its first stand. */
  group?: string | undefined
  /** The target that a click on the label selects. */
  target: Target
  /** Ordered by their beginnings, without overlap. */
  bars: Bar[]
  begins: Float64Array
  /** Drawn over the bars. */
  outages: Bar[]
  plans: Plan[]
  /** A row beyond the existing stands: more aircraft are here than there is room for. */
  isOver: boolean
}

export function rowsOfFleet(record: DayRecord): GanttRow[] {
  return fleetRows(record).map(({ aircraft, bars, outages, plans }) => ({
    label: at(record.aircraft, aircraft).id,
    target: { kind: 'aircraft', aircraft },
    ...{ bars, begins: beginsOf(bars), outages, plans, isOver: false },
  }))
}

export function rowsOfStands(record: DayRecord): GanttRow[] {
  return standRows(record).map(({ vertiport, stand, isOver, bars, outages }) => ({
    label: String(stand + 1),
    group: stand === 0 ? at(record.vertiports, vertiport).id : undefined,
    target: { kind: 'vertiport', vertiport },
    ...{ bars, begins: beginsOf(bars), outages, plans: [], isOver },
  }))
}

function beginsOf(bars: readonly Bar[]): Float64Array {
  return Float64Array.from(bars, (bar) => bar.begins)
}

/** From the start of operations until the last aircraft is ready. */
export function wholeDay(record: DayRecord): Span {
  const last = record.legs.reduce((latest, leg) => Math.max(latest, leg.ready), record.end)
  return { from: record.start, to: Math.max(last, record.start + 600) }
}

/** The bars of a row that overlap a span, as the first position and the one after the last. */
export function barsWithin({ bars, begins }: GanttRow, { from, to }: Span): [first: number, end: number] {
  const end = countUpTo(begins, to)
  // Bars do not overlap, so only the one that begins before the span can reach into it.
  const first = Math.max(0, countUpTo(begins, from) - 1)
  return bars.length === 0 ? [0, 0] : [first, end]
}

/** The bar of a row at a time; an outage only if there is no other. */
export function barAt(row: GanttRow, time: Seconds): Bar | undefined {
  const bar = row.bars[countUpTo(row.begins, time) - 1]
  if (bar !== undefined && time < bar.ends) return bar
  return row.outages.find((outage) => outage.begins <= time && time < outage.ends)
}

/** The target that a click on a bar selects: its leg, or the aircraft if there is none. */
export function targetOf(bar: Bar, record: DayRecord): Target {
  if (bar.leg === NONE) return { kind: 'aircraft', aircraft: bar.aircraft }
  return { kind: 'leg', aircraft: bar.aircraft, decided: at(record.legs, bar.leg).decided }
}
