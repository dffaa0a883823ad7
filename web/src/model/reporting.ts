// Events as a person fills them in: which fields each kind has, and the event that comes of them.

import type { Event } from '../api/types'
import { routesOf } from './whatif'
import { clock, parseTime } from './time'

/** What a person reports by hand; the rest comes from decisions and from systems that count passengers. */
export const reportKinds = [
  'departed',
  'landed',
  'ready',
  'delayed',
  'out_of_service',
  'back_in_service',
  'closed',
  'reopened',
  'booked',
  'stands',
  'clock',
] as const

export type ReportKind = (typeof reportKinds)[number]

export interface EventFields {
  aircraft: string
  /** A vertiport, or where a route begins. */
  from: string
  /** Where a route ends; empty for all routes of a vertiport. */
  to: string
  /** A time as it was typed. */
  until: string
  number: number
}

/** Which fields a kind of event has. */
export interface FieldsOf {
  aircraft: boolean
  from: boolean
  /** A destination; `all` if it may be left open. */
  to: 'no' | 'one' | 'all'
  number: boolean
  until: 'no' | 'may' | 'must'
}

export function fieldsOf(kind: ReportKind): FieldsOf {
  const none: FieldsOf = { aircraft: false, from: false, to: 'no', number: false, until: 'no' }
  switch (kind) {
    case 'departed':
    case 'landed':
    case 'ready':
    case 'back_in_service':
      return { ...none, aircraft: true }
    case 'delayed':
      return { ...none, aircraft: true, until: 'must' }
    case 'out_of_service':
      return { ...none, aircraft: true, until: 'may' }
    case 'closed':
      return { ...none, from: true, to: 'all', until: 'may' }
    case 'reopened':
      return { ...none, from: true, to: 'all' }
    case 'booked':
      return { ...none, from: true, to: 'one', number: true, until: 'must' }
    case 'stands':
      return { ...none, from: true, number: true }
    case 'clock':
      return none
  }
}

/** The event that was filled in; undefined if its time is none. */
export function eventOf(kind: ReportKind, fields: EventFields): Event | undefined {
  const { aircraft, from, to, number } = fields
  const typed = fields.until.trim()
  const time = typed === '' ? undefined : parseTime(typed)
  const { until } = fieldsOf(kind)
  if (until !== 'no' && time === undefined && (until === 'must' || typed !== '')) return undefined
  const at = time === undefined ? '' : clock(time)
  const end = time === undefined ? {} : { until: at }
  switch (kind) {
    case 'departed':
    case 'landed':
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
