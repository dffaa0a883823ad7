// The two timelines of a day, which one Gantt draws: what the fleet does, with a row for each aircraft, and who holds the stands,
// with a row for each of every vertiport.

import type { DayRecord, Seconds } from '../model/record'
import type { Target } from '../model/target'
import { rowsOfFleet, rowsOfStands, type GanttRow } from './rows'

export type TimelineKind = 'fleet' | 'stands'

export interface TimelineShape {
  rowsOf: (record: DayRecord) => GanttRow[]
  /** The least and greatest height of a row, pixels. */
  heights: readonly [number, number]
}

/** A timeline that is in the page. */
export interface ShownTimeline {
  /** Brings a row into the middle, and a time into view if one is given. */
  show: (target: Target, at?: Seconds) => void
}

/** Where two timelines are side by side, each has half of the room and lower rows, so that more of the fleet is in view. */
export const DENSE_PX = 14

export const shapes: Readonly<Record<TimelineKind, TimelineShape>> = {
  fleet: { rowsOf: rowsOfFleet, heights: [18, 30] },
  stands: { rowsOf: rowsOfStands, heights: [15, 24] },
}
