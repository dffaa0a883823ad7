// The visible part of the day in a timeline. Spans are values: moving one returns another.

import type { Seconds } from '../model/record'

export interface Span {
  readonly from: Seconds
  readonly to: Seconds
}

/** The minimum span, at which bars of seconds are lines. */
const SHORTEST_S = 300

/** Steps of the axis, from minutes to half days, each a divisor of the day. */
const STEPS_S = [60, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200]

/** Zooms by a factor around a time, within the whole day. */
export function zoomSpan(span: Span, factor: number, around: Seconds, whole: Span): Span {
  const length = Math.max(SHORTEST_S, Math.min((span.to - span.from) / factor, whole.to - whole.from))
  const share = (around - span.from) / (span.to - span.from)
  return within({ from: around - share * length, to: around + (1 - share) * length }, whole)
}

export function panSpan(span: Span, seconds: Seconds, whole: Span): Span {
  return within({ from: span.from + seconds, to: span.to + seconds }, whole)
}

/** A span of the same length that contains a time, with some context. */
export function showTime(span: Span, time: Seconds, whole: Span): Span {
  const margin = 0.1 * (span.to - span.from)
  if (time < span.from + margin) return panSpan(span, time - span.from - margin, whole)
  if (time > span.to - margin) return panSpan(span, time - span.to + margin, whole)
  return span
}

/** The minimum width of an hour when the whole day is shown, and its width when only a part is. */
const HOUR_PX = { least: 75, good: 90 }

/**
 * The default span of a live day: the whole day if there is room for it, otherwise the hours around
 * now, most of them ahead. For the whole day it returns the very object `whole`.
 */
export function liveSpan(time: Seconds, width: number, whole: Span): Span {
  if (HOUR_PX.least * (whole.to - whole.from) <= 3600 * width) return whole
  const length = (3600 * Math.max(1, width)) / HOUR_PX.good
  return within({ from: time - 0.25 * length, to: time + 0.75 * length }, whole)
}

/** Whether two spans are equal, to the second. */
export function isSameSpan(one: Span, other: Span): boolean {
  return Math.abs(one.from - other.from) < 1 && Math.abs(one.to - other.to) < 1
}

/**
 * Moves the span with a time that was visible and is about to leave it, so that the now line stays
 * visible.
 */
export function follow(span: Span, former: Seconds, time: Seconds, whole: Span): Span {
  const length = span.to - span.from
  const wasInView = former >= span.from && former <= span.to
  const edge = span.from + 0.8 * length
  if (!wasInView || time <= former || time <= edge) return span
  const moved = panSpan(span, time - edge, whole)
  return isSameSpan(moved, span) ? span : moved
}

/** Moves a span that exceeds the whole back into it. */
function within(span: Span, whole: Span): Span {
  const length = span.to - span.from
  if (span.from < whole.from) return { from: whole.from, to: Math.min(whole.to, whole.from + length) }
  if (span.to > whole.to) return { from: Math.max(whole.from, whole.to - length), to: whole.to }
  return span
}

/** The labelled times: round steps that are at least this many pixels apart. */
export function ticks(span: Span, width: number, least_px: number): Seconds[] {
  const perPixel = (span.to - span.from) / Math.max(1, width)
  const step = STEPS_S.find((one) => one >= least_px * perPixel) ?? 86_400
  const first = Math.ceil(span.from / step)
  const count = Math.max(0, Math.floor(span.to / step) - first + 1)
  return Array.from({ length: count }, (_, index) => (first + index) * step)
}

export function pixelOf(span: Span, width: number, time: Seconds): number {
  return ((time - span.from) / (span.to - span.from)) * width
}

export function timeAt(span: Span, width: number, px: number): Seconds {
  return span.from + (px / Math.max(1, width)) * (span.to - span.from)
}
