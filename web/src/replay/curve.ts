// The curves above the scrubber: demand and passengers carried by period, and the profit of each
// play over time.

import { at } from '../model/arrays'
import type { Earnings, PeriodSums } from '../model/earnings'
import type { Seconds } from '../model/record'
import { css, type ColourName, type Rgb } from '../parts/colours'
import type { Size } from '../parts/sheet'

export interface CurvePicture {
  span: { from: Seconds; to: Seconds }
  size: Size
  colours: Record<ColourName, Rgb>
  periods: readonly PeriodSums[]
  /** One play, or two for comparison. */
  earnings: readonly Earnings[]
}

export function paintCurves(context: CanvasRenderingContext2D, picture: CurvePicture): void {
  paintPeriods(context, picture)
  const [one, other] = picture.earnings
  if (one !== undefined && other !== undefined) paintDifference(context, picture, one, other)
  else if (one !== undefined) paintEarnings(context, picture, one)
}

/** The profits, or differences of profits, at the bottom and top edges of the curves. */
export function edges([one, other]: readonly Earnings[]): { low: number; high: number } {
  if (one === undefined) return { low: 0, high: 0 }
  if (other === undefined) {
    const [low, high] = one.range
    return { low, high }
  }
  const behind = (time: Seconds) => Math.abs(one.at(time).profit_usd - other.at(time).profit_usd)
  const most = [-Infinity, ...one.times, ...other.times].reduce(
    (most, time) => Math.max(most, behind(time)),
    0,
  )
  return { low: -most, high: most }
}

function xOf({ span, size }: CurvePicture, time: Seconds): number {
  return ((time - span.from) / (span.to - span.from)) * size.width
}

function paintPeriods(context: CanvasRenderingContext2D, picture: CurvePicture): void {
  const { periods, size, colours } = picture
  const most = Math.max(1e-9, ...periods.map(({ wanted, begins, ends }) => wanted / (ends - begins)))
  for (const { begins, ends, wanted, carried } of periods) {
    const [left, right] = [Math.max(0, xOf(picture, begins)), Math.min(size.width, xOf(picture, ends))]
    const height = (passengers: number) => (passengers / (ends - begins) / most) * (size.height - 4)
    context.fillStyle = css(colours.demand, 0.16)
    context.fillRect(left, size.height - height(wanted), Math.max(0, right - left - 1), height(wanted))
    context.fillStyle = css(colours.demand, 0.3)
    context.fillRect(left, size.height - height(carried), Math.max(0, right - left - 1), height(carried))
  }
}

/** The profit so far. It changes at decisions and is constant in between. */
function paintEarnings(context: CanvasRenderingContext2D, picture: CurvePicture, earnings: Earnings): void {
  const { size, colours } = picture
  const { low, high } = edges([earnings])
  const y = (amount: number) =>
    size.height - 2 - ((amount - low) / Math.max(high - low, 1e-9)) * (size.height - 6)
  if (low < 0) paintLevel(context, picture, y(0))
  context.strokeStyle = css(colours.accent)
  context.lineWidth = 2
  context.lineJoin = 'round'
  context.beginPath()
  context.moveTo(0, y(earnings.at(-Infinity).profit_usd))
  let formerX = -Infinity
  earnings.times.forEach((time, leg) => {
    const x = xOf(picture, time)
    // Decisions that share a pixel are one step of the line.
    if (x - formerX < 0.5) return
    context.lineTo(x, y(at(earnings.profits, leg)))
    formerX = x
  })
  context.lineTo(size.width, y(earnings.total_usd))
  context.stroke()
}

/** The lead of one play over the other: above the middle if it led, below if it trailed. */
function paintDifference(
  context: CanvasRenderingContext2D,
  picture: CurvePicture,
  one: Earnings,
  other: Earnings,
): void {
  const { span, size, colours } = picture
  const columns = Array.from({ length: Math.ceil(size.width) + 1 }, (_, x) => {
    const time = span.from + (x / size.width) * (span.to - span.from)
    return one.at(time).profit_usd - other.at(time).profit_usd
  })
  const most = Math.max(1, edges([one, other]).high)
  const middle = size.height / 2
  const y = (amount: number) => middle - (amount / most) * (middle - 3)
  columns.forEach((amount, x) => {
    context.fillStyle = css(amount >= 0 ? colours.accent : colours.warn, 0.35)
    context.fillRect(x, Math.min(middle, y(amount)), 1, Math.abs(y(amount) - middle))
  })
  paintLevel(context, picture, middle)
  context.strokeStyle = css(colours.ink)
  context.lineWidth = 1.25
  context.beginPath()
  columns.forEach((amount, x) => context.lineTo(x, y(amount)))
  context.stroke()
}

function paintLevel(context: CanvasRenderingContext2D, { size, colours }: CurvePicture, y: number): void {
  context.fillStyle = css(colours['line-strong'], 0.6)
  context.fillRect(0, Math.round(y), size.width, 1)
}
