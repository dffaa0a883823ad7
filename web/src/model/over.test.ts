import { describe, expect, it } from 'vitest'
import type { AircraftState } from '../api/types'
import { canBeDecidedAgain, isOver } from './over'
import { timeOf } from './time'

const end = timeOf('10:00:00')

function standing(ready: string, more: Partial<AircraftState> = {}): AircraftState {
  const [arrival, place] = ['09:00:00', 'North']
  const state = { id: 'A01', phase: 'standing', place, arrival, ready, out_of_service: false } as const
  return { ...state, needs_decision: false, notices: [], ...more } as AircraftState
}

describe('a day', () => {
  it('is over when operations have ended and every aircraft is on the ground', () => {
    expect(isOver({ now: '10:00:01', aircraft: [standing('09:30:00'), standing('10:20:00')] }, end)).toBe(
      true,
    )
    expect(isOver({ now: '10:00:00', aircraft: [standing('09:30:00')] }, end)).toBe(false)
  })

  it('is over before that if no aircraft will be ready in time', () => {
    expect(isOver({ now: '09:50:00', aircraft: [standing('10:00:01')] }, end)).toBe(true)
    expect(isOver({ now: '09:50:00', aircraft: [standing('10:00:00')] }, end)).toBe(false)
  })

  it('is not over while an aircraft is in the air', () => {
    for (const phase of ['sent_off', 'in_the_air'] as const)
      expect(isOver({ now: '10:30:00', aircraft: [standing('11:00:00', { phase })] }, end)).toBe(false)
  })
})

describe('a decision', () => {
  const flying = standing('11:00:00', { id: 'A02', phase: 'in_the_air' })

  it('can be replaced until the end of operations', () => {
    const held = standing('09:45:00')
    expect(canBeDecidedAgain({ now: '09:30:00', aircraft: [held, flying] }, held, end)).toBe(true)
    expect(canBeDecidedAgain({ now: '10:00:01', aircraft: [held, flying] }, held, end)).toBe(false)
  })

  it('to fly can be cancelled later too, until the aircraft departs', () => {
    const sentOff = standing('11:00:00', { phase: 'sent_off' })
    expect(canBeDecidedAgain({ now: '10:00:01', aircraft: [sentOff] }, sentOff, end)).toBe(true)
  })

  it('cannot be replaced when the day is over, nor while the aircraft waits', () => {
    const held = standing('10:05:00')
    expect(canBeDecidedAgain({ now: '09:50:00', aircraft: [held] }, held, end)).toBe(false)
    const waits = standing('09:30:00', { needs_decision: true })
    expect(canBeDecidedAgain({ now: '09:50:00', aircraft: [waits, flying] }, waits, end)).toBe(false)
  })
})
