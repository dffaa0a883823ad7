// Times of a day. Internally a time is seconds since midnight; users see HH:MM:SS.

import type { Seconds } from './record'

/** The service's limit: times are before 100:00:00. */
const MOST_S = 100 * 3600

/** Reads `HH:MM:SS`, `H:MM` or seconds since midnight; undefined if it is none of these. */
export function parseTime(text: string | number): Seconds | undefined {
  if (typeof text === 'number') return Number.isInteger(text) && text >= 0 && text < MOST_S ? text : undefined
  const parts = /^\s*(\d{1,2}):([0-5]\d)(?::([0-5]\d))?\s*$/.exec(text)
  if (!parts) return undefined
  return Number(parts[1]) * 3600 + Number(parts[2]) * 60 + Number(parts[3] ?? 0)
}

/** Parses a time from the service, which is always valid. */
export function timeOf(moment: string | number): Seconds {
  const time = parseTime(moment)
  if (time === undefined) throw new Error(`the service writes times as HH:MM:SS, and this is "${moment}"`)
  return time
}

/** Writes `HH:MM:SS`. */
export function clock(time: Seconds): string {
  const whole = Math.max(0, Math.floor(time))
  return `${pad(Math.floor(whole / 3600))}:${pad(Math.floor(whole / 60) % 60)}:${pad(whole % 60)}`
}

/** Formats `HH:MM`, for axes and lists that need no seconds. */
export function clockMinutes(time: Seconds): string {
  return clock(time).slice(0, 5)
}

/** Formats a duration in at most two units: `45 s`, `12 min`, `1 h 05 min`. */
export function duration(seconds: number): string {
  const whole = Math.round(Math.abs(seconds))
  if (whole < 90) return `${whole} s`
  const minutes = Math.round(whole / 60)
  if (minutes < 60) return `${minutes} min`
  return `${Math.floor(minutes / 60)} h ${pad(minutes % 60)} min`
}

function pad(number: number): string {
  return String(number).padStart(2, '0')
}
