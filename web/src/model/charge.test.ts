import { expect, it } from 'vitest'
import { chargeOf } from './charge'
import { timeOf } from './time'

const flight = { from: 'V2', to: 'V1', decided: '08:06:10', passengers: 4 }

it('is unknown on a day that charges to full', () => {
  const nothing = { now_kwh: undefined, lands_with_kwh: undefined, takeoff: undefined }
  expect(chargeOf({ phase: 'sent_off', flight })).toEqual(nothing)
  expect(chargeOf({ phase: 'standing', charge_kwh: null, lands_with_kwh: null, flight: null })).toEqual(
    nothing,
  )
})

it('has a take-off while the aircraft waits for charge', () => {
  const known = { charge_kwh: 24.9, lands_with_kwh: 0.1, flight: { ...flight, takeoff: '08:37:36' } }
  expect(chargeOf({ phase: 'sent_off', ...known })).toEqual({
    now_kwh: 24.9,
    lands_with_kwh: 0.1,
    takeoff: timeOf('08:37:36'),
  })
  expect(chargeOf({ phase: 'in_the_air', ...known }).takeoff).toBeUndefined()
  const atOnce = { ...known, flight: { ...flight, takeoff: '08:06:10' } }
  expect(chargeOf({ phase: 'sent_off', ...atOnce }).takeoff).toBeUndefined()
})
