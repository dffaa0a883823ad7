// The log of a day and its filter.

import type { Event, TakenEvent } from '../api/types'

export const eventTypes = [
  'decided',
  'undone',
  'departed',
  'landed',
  'charging',
  'ready',
  'delayed',
  'out_of_service',
  'back_in_service',
  'closed',
  'reopened',
  'demand',
  'booked',
  'cancelled',
  'stands',
  'clock',
  'corrected',
  'acknowledged',
] as const satisfies readonly Event['type'][]

/** The filter; an empty text matches everything. */
export interface LogFilter {
  text: string
  type: string
  aircraft: string
  vertiport: string
  actor: string
}

export const everything: LogFilter = { text: '', type: '', aircraft: '', vertiport: '', actor: '' }

/**
 * The text of an event, and the vertiport of a departure or a landing, which its event may not
 * name.
 */
export interface EventText {
  words: string
  place?: string | undefined
}

/** Whether an event matches the filter. */
export function isWanted(
  taken: TakenEvent,
  filter: LogFilter,
  textOf: (taken: TakenEvent) => EventText,
): boolean {
  const { event, actor } = taken
  if (filter.type !== '' && event.type !== filter.type) return false
  if (filter.actor !== '' && actor !== filter.actor) return false
  if (filter.aircraft !== '' && !('aircraft' in event && event.aircraft === filter.aircraft)) return false
  if (
    filter.vertiport !== '' &&
    textOf(taken).place !== filter.vertiport &&
    !vertiportsOf(event).includes(filter.vertiport)
  )
    return false
  if (filter.text === '') return true
  const searched =
    `${textOf(taken).words} ${actor} ${taken.notices.map((notice) => notice.text).join(' ')} ${taken.seq}`.toLowerCase()
  return filter.text
    .toLowerCase()
    .split(/\s+/)
    .every((word) => searched.includes(word))
}

/** The vertiports that an event names. */
export function vertiportsOf(event: Event): string[] {
  switch (event.type) {
    case 'decided':
      return [event.to]
    case 'departed':
      return event.to == null ? [] : [event.to]
    case 'landed':
      return event.at == null ? [] : [event.at]
    case 'closed':
    case 'reopened':
      return 'vertiport' in event.routes ? [event.routes.vertiport] : [event.routes.from, event.routes.to]
    case 'demand':
      return [...new Set(event.pairs.flatMap(({ from, to }) => [from, to]))]
    case 'booked':
    case 'cancelled':
      return [event.from, event.to]
    case 'stands':
      return [event.vertiport]
    default:
      return []
  }
}
