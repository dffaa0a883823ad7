// The sentence for an event, without its time. `place` is the destination of a departure or the
// vertiport of a landing, if the event does not contain it.

import type { Event, RouteNames } from '../api/types'
import { tenths } from '../model/money'
import { clock, timeOf } from '../model/time'
import { text } from './text'

export function sentence(event: Event, place?: string): string {
  const texts = text.events
  switch (event.type) {
    case 'decided':
      return texts.decided(event.aircraft, event.to, event.instead_of ?? undefined)
    case 'undone':
      return texts.undone(event.aircraft)
    case 'departed':
      return texts.departed(event.aircraft, event.to ?? place, event.passengers ?? undefined)
    case 'landed':
      return texts.landed(
        event.aircraft,
        event.at ?? place,
        event.charge_kwh == null ? undefined : tenths(event.charge_kwh),
      )
    case 'charging':
      return texts.charging(event.aircraft, clock(timeOf(event.ready)))
    case 'ready':
      return texts.ready(event.aircraft)
    case 'delayed':
      return texts.delayed(event.aircraft, clock(timeOf(event.until)))
    case 'out_of_service':
      return texts.outOfService(event.aircraft, until(event.until))
    case 'back_in_service':
      return texts.backInService(event.aircraft)
    case 'closed':
      return texts.closed(routes(event.routes), until(event.until))
    case 'reopened':
      return texts.reopened(routes(event.routes))
    case 'demand':
      return texts.demand(event.pairs.length, clock(timeOf(event.period)))
    case 'booked':
      return texts.booked(event.passengers, event.from, event.to, clock(timeOf(event.period)))
    case 'cancelled':
      return texts.cancelled(event.passengers, event.from, event.to, clock(timeOf(event.period)))
    case 'stands':
      return texts.stands(event.vertiport, event.stands)
    case 'corrected':
      return texts.corrected(event.event)
    case 'acknowledged':
      return texts.acknowledged(event.alert)
    case 'clock':
      return texts.clock
  }
}

/** The reason for an event, if one was given. */
export function reasonOf(event: Event): string | undefined {
  return 'reason' in event ? (event.reason ?? undefined) : undefined
}

function until(moment: string | number | null | undefined): string | undefined {
  return moment == null ? undefined : clock(timeOf(moment))
}

function routes(names: RouteNames): string {
  return 'vertiport' in names ? text.events.allOf(names.vertiport) : text.events.route(names.from, names.to)
}
