import { expect, it } from 'vitest'
import type { Event, TakenEvent } from '../api/types'
import { Whereabouts } from './whereabouts'

function placesOf(...events: Event[]): (string | undefined)[] {
  const whereabouts = new Whereabouts()
  const taken = events.map((event, at): TakenEvent => ({
    seq: at + 1,
    mark: `${at + 1}-00000000`,
    at_ms: 0,
    actor: '',
    event,
    notices: [],
  }))
  for (const one of taken) whereabouts.take(one)
  return taken.map((one) => whereabouts.placeOf(one))
}

it('a departure and its landing have the decided destination', () => {
  const [decided, departed, landed] = placesOf(
    { type: 'decided', aircraft: 'A01', to: 'East' },
    { type: 'departed', aircraft: 'A01' },
    { type: 'landed', aircraft: 'A01' },
  )
  expect([decided, departed, landed]).toEqual([undefined, 'East', 'East'])
})

it('a vertiport in the event takes precedence', () => {
  const places = placesOf(
    { type: 'decided', aircraft: 'A01', to: 'East' },
    { type: 'departed', aircraft: 'A01', to: 'South' },
    { type: 'landed', aircraft: 'A01' },
    { type: 'decided', aircraft: 'A02', to: 'East' },
    { type: 'landed', aircraft: 'A02', at: 'North' },
  )
  expect(places).toEqual([undefined, 'South', 'South', undefined, 'North'])
})

it('undone and missing decisions have no place', () => {
  const places = placesOf(
    { type: 'landed', aircraft: 'A02' },
    { type: 'decided', aircraft: 'A01', to: 'East' },
    { type: 'undone', aircraft: 'A01' },
    { type: 'departed', aircraft: 'A01' },
  )
  expect(places).toEqual([undefined, undefined, undefined, undefined])
})
