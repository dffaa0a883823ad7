// Formats times on the user's clock, with its time zone, because a day may have a different one.

import { text } from './text'

const moment = new Intl.DateTimeFormat(text.language, {
  year: 'numeric',
  month: 'short',
  day: 'numeric',
  hour: '2-digit',
  minute: '2-digit',
  hourCycle: 'h23',
  timeZoneName: 'short',
})

const time = new Intl.DateTimeFormat(text.language, {
  hour: '2-digit',
  minute: '2-digit',
  second: '2-digit',
  hourCycle: 'h23',
  timeZoneName: 'short',
})

/** The name of the user's time zone in the IANA database. */
export const ownTimeZone = moment.resolvedOptions().timeZone

/** `Nov 23, 2026, 15:04 GMT+1`. */
export function wallClock(at_ms: number): string {
  return moment.format(at_ms)
}

/** `15:04:05 GMT+1`. */
export function wallTime(at_ms: number): string {
  return time.format(at_ms)
}
