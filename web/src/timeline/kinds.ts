// The two timelines of a day, which one Gantt draws. The fleet has a row for each aircraft; the
// stands have a row for each stand of every vertiport.

import type { DayRecord, Seconds } from '../model/record'
import type { Target } from '../model/target'
import { rowsOfFleet, rowsOfStands, type GanttRow } from './rows'

export type TimelineKind = 'fleet' | 'stands'

export interface TimelineShape {
  rowsOf: (record: DayRecord) => GanttRow[]
  /** The minimum and maximum height of a row, pixels. */
  heights: readonly [number, number]
}

/** A timeline in the page. */
export interface ShownTimeline {
  /** Scrolls a row to the middle, and optionally a time into view. */
  show: (target: Target, at?: Seconds) => void
}

/**
 * If two timelines are side by side, each has half the space and lower rows, so that more of the
 * fleet is visible.
 */
export const DENSE_PX = 14

export const shapes: Readonly<Record<TimelineKind, TimelineShape>> = {
  fleet: { rowsOf: rowsOfFleet, heights: [18, 30] },
  stands: { rowsOf: rowsOfStands, heights: [15, 24] },
}
