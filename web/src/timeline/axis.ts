// The axis of a timeline, the names of its rows, and the now line with a veil over the future.

import { at } from '../model/arrays'
import type { Seconds } from '../model/record'
import { clock, clockMinutes } from '../model/time'
import { css, type ColourName, type Rgb } from '../parts/colours'
import type { Size } from '../parts/sheet'
import { TICK_PX } from './paint'
import type { GanttRow } from './rows'
import { pixelOf, ticks, type Span } from './span'

/** The width of the column of row names, which equals that of the four buttons above it. */
export const GUTTER_PX = 97

export interface AxisPicture {
  span: Span
  time: Seconds
  /** The size of the plot; the names of rows are to its left. */
  size: Size
  colours: Record<ColourName, Rgb>
  /** Whether the time is now, so that the future is only expected, and drawn accordingly. */
  isLive: boolean
}

/** The opacity of the veil over the future. */
const VEIL = { overKnown: 0.5, overExpected: 0.15 }

/** The width of the bar at the name of the followed aircraft. */
const FOLLOWED_PX = 4

/** Half the width of the flag with the time, for narrow letters, and its least margin. */
const FLAG_PX = 28
const FLAG_MARGIN_PX = 4

/** The times above the rows, and the current time in a flag. */
export function paintAxis(
  context: CanvasRenderingContext2D,
  { span, time, size, colours }: AxisPicture,
): void {
  const family = getComputedStyle(context.canvas).fontFamily
  context.textBaseline = 'middle'
  context.textAlign = 'center'
  const middle = size.height / 2
  const isInView = time >= span.from && time <= span.to
  const flag = `600 11px ${family}`
  const half = halfOfFlag(context, flag, clock(time))
  const now = Math.max(half, Math.min(size.width - half, pixelOf(span, size.width, time)))
  context.font = `500 11px ${family}`
  context.fillStyle = css(colours['ink-soft'])
  for (const tick of ticks(span, size.width, TICK_PX)) {
    const x = pixelOf(span, size.width, tick)
    const isFree = x > 18 && x < size.width - 18 && (!isInView || Math.abs(x - now) > half + 18)
    if (isFree) context.fillText(clockMinutes(tick), GUTTER_PX + x, middle)
  }
  if (!isInView) return
  const x = GUTTER_PX + now
  context.fillStyle = css(colours['accent-ground'])
  context.beginPath()
  context.roundRect(x - half, 3, 2 * half, size.height - 6, 4)
  context.fill()
  context.fillStyle = '#fff'
  context.font = flag
  context.fillText(clock(time), x, middle + 0.5)
}

/** Half the width of the flag; some fonts have wider digits than others. */
function halfOfFlag(context: CanvasRenderingContext2D, font: string, words: string): number {
  context.font = font
  return Math.max(FLAG_PX, context.measureText(words).width / 2 + FLAG_MARGIN_PX)
}

/** Draws the future paler, and now as a line. */
export function paintNow(
  context: CanvasRenderingContext2D,
  { span, time, size, colours, isLive }: AxisPicture,
): void {
  const x = GUTTER_PX + Math.max(0, Math.min(size.width, pixelOf(span, size.width, time)))
  context.fillStyle = css(colours.surface, isLive ? VEIL.overExpected : VEIL.overKnown)
  context.fillRect(x, 0, GUTTER_PX + size.width - x, size.height)
  if (time < span.from || time > span.to) return
  context.fillStyle = css(colours.accent)
  context.fillRect(Math.round(x) - 0.75, 0, 1.5, size.height)
}

export interface NamesPicture {
  rows: readonly GanttRow[]
  /** The aircraft whose name is marked. */
  followed: number | undefined
  rowHeight: number
  scrollTop: number
  size: Size
  colours: Record<ColourName, Rgb>
}

/** The names of rows. The name of a group is at its first visible row. */
export function paintNames(context: CanvasRenderingContext2D, picture: NamesPicture): void {
  const { rows, followed, rowHeight, scrollTop, size, colours } = picture
  const family = getComputedStyle(context.canvas).fontFamily
  context.fillStyle = css(colours.surface)
  context.fillRect(0, 0, GUTTER_PX, size.height)
  context.fillStyle = css(colours.line)
  context.fillRect(GUTTER_PX - 1, 0, 1, size.height)
  context.textBaseline = 'middle'
  const first = Math.max(0, Math.floor(scrollTop / rowHeight))
  const end = Math.min(rows.length, Math.ceil((scrollTop + size.height) / rowHeight))
  const px = Math.min(12, rowHeight * 0.62)
  for (let index = first; index < end; index++) {
    const row = at(rows, index)
    const top = index * rowHeight - scrollTop
    const hasGroups = row.target.kind === 'vertiport'
    context.fillStyle = css(row.isOver ? colours.bad : hasGroups ? colours['ink-soft'] : colours.ink)
    context.font = `${hasGroups ? 400 : 500} ${hasGroups ? px * 0.85 : px}px ${family}`
    context.textAlign = hasGroups ? 'right' : 'left'
    context.fillText(row.label, hasGroups ? GUTTER_PX - 6 : 8, top + rowHeight / 2 + 0.5)
    if (row.target.kind === 'aircraft' && row.target.aircraft === followed) {
      context.fillStyle = css(colours.accent)
      context.fillRect(0, top + 1, FOLLOWED_PX, rowHeight - 2)
    }
    if (row.group !== undefined) {
      context.fillStyle = css(colours.line)
      context.fillRect(0, Math.round(top), GUTTER_PX, 1)
    }
  }
  paintGroups(context, picture, first, end, `600 ${Math.min(12, px)}px ${family}`)
}

function paintGroups(
  context: CanvasRenderingContext2D,
  picture: NamesPicture,
  first: number,
  end: number,
  font: string,
): void {
  const { rows, rowHeight, scrollTop, colours } = picture
  context.font = font
  context.textAlign = 'left'
  context.fillStyle = css(colours.ink)
  let begin = first
  while (begin > 0 && rows[begin]?.target.kind === 'vertiport' && rows[begin]?.group === undefined) begin--
  for (let index = begin; index < end; index++) {
    const group = rows[index]?.group
    if (group === undefined) continue
    const next = rows.findIndex((row, other) => other > index && row.group !== undefined)
    const bottom = (next === -1 ? rows.length : next) * rowHeight - scrollTop
    const top = Math.min(Math.max(index * rowHeight - scrollTop, 0), bottom - rowHeight)
    context.fillText(shortened(context, group, GUTTER_PX - 28), 8, top + rowHeight / 2 + 0.5)
  }
}

function shortened(context: CanvasRenderingContext2D, name: string, width: number): string {
  if (context.measureText(name).width <= width) return name
  let end = name.length
  while (end > 1 && context.measureText(`${name.slice(0, end)}…`).width > width) end--
  return `${name.slice(0, end)}…`
}
