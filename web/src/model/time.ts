// Times of a day. Inside, a time is seconds since midnight; a person sees HH:MM:SS, and ISO 8601 where the day has a date.

import type { Seconds } from './record'

/** The bound of the service: times are before 100:00:00. */
const MOST_S = 100 * 3600

/** Reads `HH:MM:SS`, `H:MM` or seconds since midnight; undefined if it is none of these. */
export function parseTime(text: string | number): Seconds | undefined {
  if (typeof text === 'number') return Number.isInteger(text) && text >= 0 && text < MOST_S ? text : undefined
  const parts = /^\s*(\d{1,2}):([0-5]\d)(?::([0-5]\d))?\s*$/.exec(text)
  if (!parts) return undefined
  return Number(parts[1]) * 3600 + Number(parts[2]) * 60 + Number(parts[3] ?? 0)
}

/** Reads a time that the service wrote, which is never wrong. */
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

/** Writes `HH:MM`, for axes and lists where seconds say nothing. */
export function clockMinutes(time: Seconds): string {
  return clock(time).slice(0, 5)
}

/** Writes a duration in words of two units at most: `45 s`, `12 min`, `1 h 05 min`. */
export function duration(seconds: number): string {
  const whole = Math.round(Math.abs(seconds))
  if (whole < 90) return `${whole} s`
  const minutes = Math.round(whole / 60)
  if (minutes < 60) return `${minutes} min`
  return `${Math.floor(minutes / 60)} h ${pad(minutes % 60)} min`
}

/** The seconds since midnight of an instant on a date in a time zone: midnight is twelve hours before noon, as in timetables. */
export function timeOfInstant(instant: Date, date: string, timeZone: string): Seconds {
  const noon = noonOf(date, timeZone)
  return Math.round((instant.getTime() - noon) / 1000) + 12 * 3600
}

/** The instant of a time of the day that has this date, in milliseconds of the Unix clock. */
export function instantOf(time: Seconds, date: string, timeZone: string): number {
  return noonOf(date, timeZone) + (time - 12 * 3600) * 1000
}

/** Writes the time in ISO 8601 with the offset of the place at that instant. */
export function isoOf(time: Seconds, date: string, timeZone: string): string {
  const instant = instantOf(time, date, timeZone)
  const offset = offsetMinutes(instant, timeZone)
  const local = new Date(instant + offset * 60_000).toISOString().slice(0, 19)
  const away = Math.abs(offset)
  return `${local}${offset < 0 ? '-' : '+'}${pad(Math.floor(away / 60))}:${pad(away % 60)}`
}

/** Noon of a date in a time zone. Clocks never change at noon, so guessing the offset once more is exact. */
function noonOf(date: string, timeZone: string): number {
  const asIfUtc = Date.parse(`${date}T12:00:00Z`)
  const guess = asIfUtc - offsetMinutes(asIfUtc, timeZone) * 60_000
  return asIfUtc - offsetMinutes(guess, timeZone) * 60_000
}

/** How far the clocks of a time zone are ahead of UTC at an instant. */
function offsetMinutes(instant: number, timeZone: string): number {
  const parts = new Intl.DateTimeFormat('en-CA', {
    timeZone,
    hourCycle: 'h23',
    year: 'numeric',
    month: '2-digit',
    day: '2-digit',
    hour: '2-digit',
    minute: '2-digit',
    second: '2-digit',
  }).formatToParts(instant)
  const part = (name: Intl.DateTimeFormatPartTypes) => parts.find((one) => one.type === name)?.value ?? '00'
  const local = `${part('year')}-${part('month')}-${part('day')}T${part('hour')}:${part('minute')}:${part('second')}Z`
  return Math.round((Date.parse(local) - instant) / 60_000)
}

function pad(number: number): string {
  return String(number).padStart(2, '0')
}
