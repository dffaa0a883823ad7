// When something was done, on the clock of the reader, with the time zone of that clock: a day has another one.

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

/** The time zone by its name in the IANA database. */
export const ownTimeZone = moment.resolvedOptions().timeZone

/** `Nov 23, 2026, 15:04 GMT+1`. */
export function wallClock(at_ms: number): string {
  return moment.format(at_ms)
}
