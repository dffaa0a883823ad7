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
  /** Where a flight goes or has landed, if that differs from its decision; empty if it does not. */
  place?: string
  /** Passengers on board, if they are not those expected. */
  passengers?: number | null | undefined
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
  /** Whether another vertiport than the decided one may be given. */
  place: boolean
  /** Whether the passengers on board may be given. */
  passengers: boolean
  /** Whether the charge may be given, on a day that charges as needed. */
  charge: boolean
  until: 'no' | 'may' | 'must'
}

/**
 * The kinds of events that users report by hand, with their fields. Other events come from
 * decisions and from systems that count passengers.
 */
const fields = {
  departed: { aircraft: true, place: true, passengers: true },
  landed: { aircraft: true, place: true, charge: true },
  charging: { aircraft: true, until: 'must' },
  ready: { aircraft: true },
  delayed: { aircraft: true, until: 'must' },
  out_of_service: { aircraft: true, until: 'may' },
  back_in_service: { aircraft: true },
  closed: { from: true, to: 'all', until: 'may' },
  reopened: { from: true, to: 'all' },
  booked: { from: true, to: 'one', number: true, until: 'must' },
  cancelled: { from: true, to: 'one', number: true, until: 'must' },
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
    place: false,
    passengers: false,
    charge: false,
    until: 'no',
    ...fields[kind],
  }
}

/** An empty form, with a usual end for kinds that have one. */
export function emptyFields(kind: ReportKind, usualEnd: string): EventFields {
  const { until } = fieldsOf(kind)
  return { aircraft: '', from: '', to: '', until: until === 'no' ? '' : usualEnd, number: 1, place: '' }
}

/** The event from the form; undefined if its time is invalid. */
export function eventOf(kind: ReportKind, typedIn: EventFields): Event | undefined {
  const { aircraft, from, to, number, charge_kwh, place = '', passengers } = typedIn
  const typed = typedIn.until.trim()
  const time = typed === '' ? undefined : parseTime(typed)
  const { until } = fieldsOf(kind)
  if (until !== 'no' && time === undefined && (until === 'must' || typed !== '')) return undefined
  const at = time === undefined ? '' : clock(time)
  const end = time === undefined ? {} : { until: at }
  switch (kind) {
    case 'landed':
      return {
        ...{ type: kind, aircraft },
        ...(place === '' ? {} : { at: place }),
        ...(charge_kwh == null ? {} : { charge_kwh }),
      }
    case 'departed':
      return {
        ...{ type: kind, aircraft },
        ...(place === '' ? {} : { to: place }),
        ...(passengers == null ? {} : { passengers }),
      }
    case 'charging':
      return { type: kind, aircraft, ready: at }
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
    case 'cancelled':
      return { type: kind, from, to, passengers: number, period: at }
    case 'stands':
      return { type: kind, vertiport: from, stands: number }
    case 'clock':
      return { type: kind }
  }
}
