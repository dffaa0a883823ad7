// The labels of a row's bars: origin and destination of a flight (only the destination if there is
// less room), or the aircraft that holds a stand.
//
// The bars of one leg are consecutive and belong to the same aircraft, so a name without room on
// its bar continues over them. A name that still does not fit is cut off, but never so short that
// it could be mistaken for another. Otherwise only the bar's tooltip shows the name.

import { at } from '../model/arrays'
import type { Bar } from '../model/bars'
import type { DayRecord } from '../model/record'
import type { GanttRow } from './rows'

/** Consecutive bars of one leg of an aircraft, or of its stay at the start of the day. */
export type Run = readonly [Bar, ...Bar[]]

/** A name and its available pixels. */
export interface Label {
  text: string
  left: number
  right: number
  /** The labelled bar. */
  bar: Bar
  /** Whether the name is longer than its bar and continues over the next ones. */
  isLonger: boolean
}

/** A name that is cut off keeps at least this number of letters. */
const LEAST_LETTERS = 3

/** Minimum distance between a name and either end of its bar, pixels. */
const MARGIN_PX = 1

/** The runs of a row's bars between two positions, the second excluded. */
export function runsOf(bars: readonly Bar[], first: number, end: number): Run[] {
  const runs: [Bar, ...Bar[]][] = []
  for (const bar of bars.slice(first, end)) {
    const run = runs.at(-1)
    if (run?.[0].leg === bar.leg && run[0].aircraft === bar.aircraft) run.push(bar)
    else runs.push([bar])
  }
  return runs
}

/** Fits names into bars, depending on the width of the letters and the positions of the bars. */
export class Labels {
  readonly #widths = new Map<string, number>()
  readonly #shortest = new Map<string, number>()

  constructor(
    private readonly record: DayRecord,
    private readonly width: (text: string) => number,
    /** The visible part of a bar. */
    private readonly place: (bar: Bar) => readonly [left: number, right: number],
  ) {}

  /** The label of a run; undefined if it has none, or no room for one. */
  of(run: Run, row: GanttRow): Label | undefined {
    const isFleet = row.target.kind !== 'vertiport'
    const named: readonly Bar[] = isFleet ? run.filter((bar) => bar.kind === 'flight') : run
    const [first] = named
    if (first === undefined) return undefined
    const texts = isFleet ? this.#routeOf(first) : [at(this.record.aircraft, first.aircraft).id]
    for (const text of texts) {
      const own = named.find((bar) => this.#fits(text, ...this.place(bar)))
      if (own !== undefined) return { text, ...this.#room(...this.place(own)), bar: own, isLonger: false }
    }
    const text = texts.at(-1) ?? ''
    const [left] = this.place(first)
    const [, right] = this.place(run.at(-1) ?? first)
    const fitting = this.#shortened(text, right - left - 2 * MARGIN_PX, isFleet)
    if (fitting === undefined) return undefined
    return { text: fitting, ...this.#room(left, right), bar: first, isLonger: true }
  }

  widthOf(text: string): number {
    const known = this.#widths.get(text)
    if (known !== undefined) return known
    const width = this.width(text)
    this.#widths.set(text, width)
    return width
  }

  /** The longest text first. */
  #routeOf({ leg }: Bar): string[] {
    const { from, to } = at(this.record.legs, leg)
    const [origin, destination] = [at(this.record.vertiports, from).id, at(this.record.vertiports, to).id]
    return [`${origin} → ${destination}`, `→ ${destination}`, destination]
  }

  #fits(text: string, left: number, right: number): boolean {
    return this.widthOf(text) <= right - left - 2 * MARGIN_PX
  }

  #room(left: number, right: number) {
    return { left: left + MARGIN_PX, right: right - MARGIN_PX }
  }

  #shortened(text: string, room: number, isVertiport: boolean): string | undefined {
    if (this.widthOf(text) <= room) return text
    const names = isVertiport ? this.record.vertiports : this.record.aircraft
    const least = this.#shortestOf(text, names)
    for (let end = text.length - 2; end >= least; end--) {
      const cut = `${text.slice(0, end)}…`
      if (this.widthOf(cut) <= room) return cut
    }
    return undefined
  }

  /** The number of letters that distinguishes a name from all others. */
  #shortestOf(text: string, names: readonly { id: string }[]): number {
    const known = this.#shortest.get(text)
    if (known !== undefined) return known
    const others = names.filter(({ id }) => id !== text)
    let length = LEAST_LETTERS
    while (length < text.length && others.some(({ id }) => id.startsWith(text.slice(0, length)))) length++
    this.#shortest.set(text, length)
    return length
  }
}
