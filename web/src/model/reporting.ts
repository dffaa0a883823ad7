// The event form: the fields of each kind of event, and the event made from them.

import type { Event } from '../api/types'
import { routesOf } from './whatif'
import { clock, parseTime } from './time'

export interface EventFields {
  aircraft: string
  /** A vertiport, or the origin of a route. */
  from: string
  /** The destination of a route; empty for all routes of a vertiport. */
  to: string
  /** A time, as typed. */
  until: string
  number: number
  /** What the battery holds after a landing, if it is not what was expected. */
  charge_kwh?: number | null | undefined
}

/** The fields of a kind of event. */
interface FieldsOf {
  aircraft: boolean
  from: boolean
  /** Whether there is a destination; `all` means that it is optional. */
  to: 'no' | 'one' | 'all'
  number: boolean
  /** Whether the charge may be given, on a day that charges as needed. */
  charge: boolean
  until: 'no' | 'may' | 'must'
}

/**
 * The kinds of events that users report by hand, with their fields. Other events come from
 * decisions and from systems that count passengers.
 */
const fields = {
  departed: { aircraft: true },
  landed: { aircraft: true, charge: true },
  ready: { aircraft: true },
  delayed: { aircraft: true, until: 'must' },
  out_of_service: { aircraft: true, until: 'may' },
  back_in_service: { aircraft: true },
  closed: { from: true, to: 'all', until: 'may' },
  reopened: { from: true, to: 'all' },
  booked: { from: true, to: 'one', number: true, until: 'must' },
  stands: { from: true, number: true },
  clock: {},
} as const satisfies Partial<Record<Event['type'], Partial<FieldsOf>>>

export type ReportKind = keyof typeof fields
export const reportKinds = Object.keys(fields) as ReportKind[]

export function fieldsOf(kind: ReportKind): FieldsOf {
  return {
    aircraft: false,
    from: false,
    to: 'no',
    number: false,
    charge: false,
    until: 'no',
    ...fields[kind],
  }
}

/** The event from the form; undefined if its time is invalid. */
export function eventOf(kind: ReportKind, typedIn: EventFields): Event | undefined {
  const { aircraft, from, to, number, charge_kwh } = typedIn
  const typed = typedIn.until.trim()
  const time = typed === '' ? undefined : parseTime(typed)
  const { until } = fieldsOf(kind)
  if (until !== 'no' && time === undefined && (until === 'must' || typed !== '')) return undefined
  const at = time === undefined ? '' : clock(time)
  const end = time === undefined ? {} : { until: at }
  switch (kind) {
    case 'landed':
      return { type: kind, aircraft, ...(charge_kwh == null ? {} : { charge_kwh }) }
    case 'departed':
    case 'ready':
    case 'back_in_service':
      return { type: kind, aircraft }
    case 'delayed':
      return { type: kind, aircraft, until: at }
    case 'out_of_service':
      return { type: kind, aircraft, ...end }
    case 'closed':
      return { type: kind, routes: routesOf(from, to), ...end }
    case 'reopened':
      return { type: kind, routes: routesOf(from, to) }
    case 'booked':
      return { type: kind, from, to, passengers: number, period: at }
    case 'stands':
      return { type: kind, vertiport: from, stands: number }
    case 'clock':
      return { type: kind }
  }
}
