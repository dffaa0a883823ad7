// Draws the visible rows of a timeline. The drawing depends on the record, the span and the
// selection, but not on the time: another layer veils the future.

import { at } from '../model/arrays'
import { minutesOverdue } from '../model/awaited'
import type { Bar, BarKind } from '../model/bars'
import type { DifferingLegs } from '../model/differ'
import type { DayRecord } from '../model/record'
import { aircraftMeant, vertiportMeant, type Target } from '../model/target'
import { css, type ColourName, type Rgb } from '../parts/colours'
import type { Size } from '../parts/sheet'
import { text } from '../text/text'
import { Labels, runsOf, type Label, type Run } from './labels'
import { barsWithin, type GanttRow } from './rows'
import { pixelOf, ticks, type Span } from './span'
import { isOfLeg } from './steps'

export interface GanttPicture {
  record: DayRecord
  rows: readonly GanttRow[]
  span: Span
  /** The size of the visible rows. */
  size: Size
  rowHeight: number
  scrollTop: number
  colours: Record<ColourName, Rgb>
  hovered: Target | undefined
  selected: Target | undefined
  /** The aircraft whose row is kept in view. */
  followed: number | undefined
  /** Legs that another play lacks; they are marked. */
  differing: DifferingLegs | undefined
}

/** Minimum distance between two labels on the axis, pixels. */
export const TICK_PX = 64
/** The opacity of expected bars, except for their text. */
const EXPECTED = 0.5
/** Dashes around narrower bars would be visual noise. */
const LEAST_DASHED_PX = 14
/** The width of the background behind letters that continue over several bars. */
const HALO_PX = 3
/**
 * The thickness of the line that marks differences, and its opacity if only the time or the
 * passengers differ.
 */
const MARK_PX = 2
const PALE_MARK = 0.35

/** The opacity of charging, of an empty battery and of a full one. */
const EMPTY_SHADE = 0.25
const FULL_SHADE = 1

interface Look {
  colour: ColourName
  /** The share of the row's height, and the position in it: 0 at the top, 1 at the bottom. */
  height: number
  place: number
  fill: number
  hasLine: boolean
}

const looks: Record<BarKind, Look> = {
  flight: { colour: 'flying', height: 0.72, place: 0.35, fill: 1, hasLine: true },
  charge: { colour: 'charging', height: 0.3, place: 0.68, fill: 0.85, hasLine: false },
  hold: { colour: 'holding', height: 0.2, place: 0.62, fill: 0.9, hasLine: false },
  delay: { colour: 'waiting', height: 0.3, place: 0.56, fill: 0.9, hasLine: false },
  outage: { colour: 'out', height: 1, place: 0, fill: 0.16, hasLine: true },
  promised: { colour: 'flying', height: 0.5, place: 0.5, fill: 0.18, hasLine: true },
  standing: { colour: 'holding', height: 0.6, place: 0.5, fill: 0.32, hasLine: false },
}

/** On stands, charging is the content of a bar and not a background. */
const chargingOnStand: Look = { colour: 'charging', height: 0.6, place: 0.5, fill: 0.85, hasLine: false }

export function paintRows(context: CanvasRenderingContext2D, picture: GanttPicture): void {
  const { rows, size, rowHeight, scrollTop } = picture
  const first = Math.max(0, Math.floor(scrollTop / rowHeight))
  const end = Math.min(rows.length, Math.ceil((scrollTop + size.height) / rowHeight))
  const painter = new RowPainter(context, picture)
  for (let row = first; row < end; row++) painter.paintGround(at(rows, row), row * rowHeight - scrollTop)
  paintGrid(context, picture)
  for (let row = first; row < end; row++) painter.paintRow(at(rows, row), row * rowHeight - scrollTop)
}

function paintGrid(context: CanvasRenderingContext2D, { span, size, colours }: GanttPicture): void {
  context.strokeStyle = css(colours.line, 0.7)
  context.lineWidth = 1
  context.beginPath()
  for (const tick of ticks(span, size.width, TICK_PX)) {
    const x = Math.round(pixelOf(span, size.width, tick)) + 0.5
    context.moveTo(x, 0)
    context.lineTo(x, size.height)
  }
  context.stroke()
}

class RowPainter {
  readonly #labels: Labels

  constructor(
    private readonly context: CanvasRenderingContext2D,
    private readonly picture: GanttPicture,
  ) {
    const px = Math.max(9, Math.min(11, picture.rowHeight * 0.5))
    context.textBaseline = 'middle'
    context.textAlign = 'left'
    context.font = `500 ${px}px ${getComputedStyle(context.canvas).fontFamily}`
    const { record, span, size } = picture
    const end = pixelOf(span, size.width, span.to)
    this.#labels = new Labels(
      record,
      (text) => context.measureText(text).width,
      (bar) => [Math.max(this.#x(bar.begins), 0), Math.min(this.#x(bar.overdueSince ?? bar.ends), end)],
    )
  }

  paintGround({ target, group, isOver }: GanttRow, top: number): void {
    const { context, picture } = this
    const { size, rowHeight, colours, hovered, selected } = picture
    const is = (one: Target | undefined) =>
      target.kind === 'vertiport'
        ? vertiportMeant(one) === target.vertiport
        : aircraftMeant(one) === aircraftMeant(target)
    const ground = is(selected) ? css(colours.chosen) : is(hovered) ? css(colours.hover) : undefined
    if (isOver || ground !== undefined) {
      context.fillStyle = ground ?? css(colours.bad, 0.1)
      context.fillRect(0, top, size.width, rowHeight)
    }
    context.fillStyle = css(colours.line, group === undefined ? 0.35 : 1)
    context.fillRect(0, Math.round(top), size.width, 1)
  }

  paintRow(row: GanttRow, top: number): void {
    const [first, end] = barsWithin(row, this.picture.span)
    for (let index = first; index < end; index++) this.#paintBar(at(row.bars, index), row, top)
    const runs = runsOf(row.bars, first, end)
    for (const run of runs) this.#paintLabel(run, row, top)
    this.#paintMarks(runs, top)
    for (const bar of row.bars.slice(first, end)) this.#paintOverdue(bar, row, top)
    for (const outage of row.outages) this.#paintBar(outage, row, top)
    for (const plan of row.plans) this.#paintPlan(plan.departs, plan.arrives, top)
  }

  #paintLabel(run: Run, row: GanttRow, top: number): void {
    const label = this.#labels.of(run, row)
    if (label === undefined) return
    const { place, height } = this.#lookOf(label.bar, row)
    const { rowHeight } = this.picture
    this.#write(label, top + 1 + (place + height / 2 - place * height) * (rowHeight - 2))
  }

  /**
   * Draws a line above each flight and hold that differs from another play. It is paler where the
   * aircraft flies the same route at another time or with other passengers. It ends in a bracket
   * where the routes diverge.
   */
  #paintMarks(runs: readonly Run[], top: number): void {
    const { context, picture } = this
    let wasElsewhere = false
    for (const run of runs) {
      const differing = picture.differing?.get(run[0].leg)
      const isElsewhere = differing?.isElsewhere === true
      if (differing !== undefined) this.#paintMark(run, top, isElsewhere, isElsewhere && !wasElsewhere)
      wasElsewhere = isElsewhere
    }
    context.globalAlpha = 1
  }

  #paintMark(run: Run, top: number, isElsewhere: boolean, parts: boolean): void {
    const { context, picture } = this
    const marked = run.find((bar) => bar.kind === 'flight' || bar.kind === 'hold') ?? run[0]
    const [left, right] = [this.#x(run[0].begins), this.#x(marked.ends)]
    context.globalAlpha = isElsewhere ? 1 : PALE_MARK
    context.fillStyle = css(picture.colours.ink)
    context.fillRect(left, top + 1, Math.max(1, right - left - 1), MARK_PX)
    if (parts) context.fillRect(left - 1, top + 1, MARK_PX, picture.rowHeight - 2)
  }

  #lookOf(bar: Bar, row: GanttRow): Look {
    return bar.kind === 'charge' && row.target.kind === 'vertiport' ? chargingOnStand : looks[bar.kind]
  }

  #paintBar(bar: Bar, row: GanttRow, top: number): void {
    const { context, picture } = this
    const { size, rowHeight, colours } = picture
    const [left, right] = [this.#x(bar.begins), this.#x(bar.ends)]
    if (right < 0 || left > size.width) return
    const look = this.#lookOf(bar, row)
    const height = Math.max(2, look.height * (rowHeight - 2))
    const y = top + 1 + look.place * (rowHeight - 2 - height)
    const width = Math.max(1, right - left - 0.5)
    const isChosen = isOfLeg(picture.record, bar.leg, picture.selected)
    const colour = colours[isChosen ? 'accent' : look.colour]
    context.globalAlpha = bar.isExpected ? EXPECTED : 1
    context.fillStyle =
      bar.kind === 'charge' && bar.charge !== undefined
        ? this.#shade(bar.charge, left, right, colour)
        : css(colour, look.fill * fillOfBar(bar))
    context.beginPath()
    context.roundRect(left, y, width, height, Math.min(2.5, width / 2))
    context.fill()
    if (look.hasLine && width > 2) this.#outline(bar, width, css(colour), isChosen)
    context.globalAlpha = 1
    if (bar.kind === 'outage') this.#hatch(left, y, width, height, css(colour, 0.5))
  }

  /** The darker, the more the battery holds. */
  #shade({ begins, ends }: NonNullable<Bar['charge']>, left: number, right: number, colour: Rgb) {
    const gradient = this.context.createLinearGradient(left, 0, Math.max(right, left + 1), 0)
    gradient.addColorStop(0, css(colour, EMPTY_SHADE + (FULL_SHADE - EMPTY_SHADE) * begins))
    gradient.addColorStop(1, css(colour, EMPTY_SHADE + (FULL_SHADE - EMPTY_SHADE) * ends))
    return gradient
  }

  /**
   * Hatches the time after an overdue aircraft should have departed or landed, with its minutes.
   */
  #paintOverdue(bar: Bar, row: GanttRow, top: number): void {
    const leg = this.picture.record.legs[bar.leg]
    if (bar.overdueSince === undefined || leg === undefined) return
    const { context, picture } = this
    const { rowHeight, colours } = picture
    const [left, right] = [this.#x(bar.overdueSince), this.#x(bar.ends)]
    const look = this.#lookOf(bar, row)
    const height = Math.max(4, look.height * (rowHeight - 2))
    const y = top + 1 + look.place * (rowHeight - 2 - height)
    context.fillStyle = css(colours.surface)
    context.fillRect(left, y, right - left, height)
    this.#hatch(left, y, right - left, height, css(colours.bad, 0.55))
    context.strokeStyle = css(colours.bad)
    context.lineWidth = 1.5
    context.strokeRect(left, y, right - left, height)
    const minutes = minutesOverdue(leg)
    const whole = text.map.late(minutes)
    const words = this.#labels.widthOf(whole) < right - left - 4 ? whole : text.timeline.late(minutes)
    this.#writeOver(words, right - this.#labels.widthOf(words) - 2, y + height / 2 + 0.5, colours.bad)
  }

  #outline(bar: Bar, width: number, colour: string, isChosen: boolean): void {
    const { context } = this
    context.strokeStyle = colour
    context.lineWidth = isChosen ? 2 : 1
    if (width > LEAST_DASHED_PX && (bar.isExpected || bar.kind === 'promised')) context.setLineDash([3, 2])
    context.stroke()
    context.setLineDash([])
  }

  /** Draws the plan as a thin line below the actual flight. */
  #paintPlan(departs: number, arrives: number, top: number): void {
    const { context, picture } = this
    const [left, right] = [this.#x(departs), this.#x(arrives)]
    const y = top + picture.rowHeight - 1.5
    context.fillStyle = css(picture.colours.ink, 0.65)
    context.fillRect(left, y, Math.max(1, right - left), 1)
    context.fillRect(left, y - 2, 1, 3)
    context.fillRect(right - 1, y - 2, 1, 3)
  }

  #hatch(left: number, top: number, width: number, height: number, colour: string): void {
    const { context, picture } = this
    const [from, to] = [Math.max(left, 0), Math.min(left + width, picture.size.width)]
    context.save()
    context.beginPath()
    context.rect(from, top, to - from, height)
    context.clip()
    context.strokeStyle = colour
    context.lineWidth = 1
    context.beginPath()
    for (let x = from - height; x < to; x += 5) {
      context.moveTo(x, top + height)
      context.lineTo(x + height, top)
    }
    context.stroke()
    context.restore()
  }

  /**
   * Writes in the middle of a bar, or from its left edge over the next ones, where letters need a
   * background.
   */
  #write({ text, left, right, bar, isLonger }: Label, y: number): void {
    const { context, picture } = this
    const { colours, size } = picture
    const isOnDark = bar.kind === 'flight' && bar.load > 0.6 && !bar.isExpected
    const onBar = css(isOnDark ? colours.surface : colours.ink)
    if (!isLonger) {
      context.fillStyle = onBar
      context.fillText(text, left + (right - left - this.#labels.widthOf(text)) / 2, y + 0.5)
      return
    }
    const end = this.#x(bar.ends)
    this.#within(0, end, () => {
      context.fillStyle = onBar
      context.fillText(text, left, y + 0.5)
    })
    this.#within(end, size.width, () => this.#writeOver(text, left, y + 0.5, colours.ink))
  }

  /** Writes on a background, over any content. */
  #writeOver(words: string, left: number, y: number, colour: Rgb): void {
    const { context, picture } = this
    context.strokeStyle = css(picture.colours.surface, 0.85)
    context.lineWidth = HALO_PX
    context.lineJoin = 'round'
    context.strokeText(words, left, y)
    context.fillStyle = css(colour)
    context.fillText(words, left, y)
  }

  /** Draws only between two pixels along the day. */
  #within(from: number, to: number, draw: () => void): void {
    const { context, picture } = this
    if (to <= from) return
    context.save()
    context.beginPath()
    context.rect(from, 0, to - from, picture.size.height)
    context.clip()
    draw()
    context.restore()
  }

  #x(time: number): number {
    const { span, size } = this.picture
    return pixelOf(span, size.width, Math.max(span.from - 3600, Math.min(span.to + 3600, time)))
  }
}

/** Flights are filled by their load factor, like aircraft on the map. */
function fillOfBar({ kind, load }: Bar): number {
  if (kind !== 'flight') return 1
  return load === 0 ? 0.06 : 0.35 + 0.65 * load
}
