import { describe, expect, it } from 'vitest'
import { eventOf, fieldsOf, reportKinds, type EventFields } from './reporting'

const fields: EventFields = { aircraft: 'A01', from: 'V1', to: '', until: '12:30', number: 3 }

describe('an event from the form', () => {
  it('has exactly the fields of its kind', () => {
    expect(eventOf('departed', fields)).toEqual({ type: 'departed', aircraft: 'A01' })
    expect(eventOf('delayed', fields)).toEqual({ type: 'delayed', aircraft: 'A01', until: '12:30:00' })
    expect(eventOf('closed', fields)).toEqual({
      type: 'closed',
      routes: { vertiport: 'V1' },
      until: '12:30:00',
    })
    expect(eventOf('closed', { ...fields, to: 'V2', until: '' })).toEqual({
      type: 'closed',
      routes: { from: 'V1', to: 'V2' },
    })
    expect(eventOf('stands', fields)).toEqual({ type: 'stands', vertiport: 'V1', stands: 3 })
  })

  it('has the charge of a landing if it is given', () => {
    const landed = { type: 'landed', aircraft: 'A01' }
    expect(eventOf('landed', { ...fields, charge_kwh: null })).toEqual(landed)
    expect(eventOf('landed', { ...fields, charge_kwh: 41.5 })).toEqual({ ...landed, charge_kwh: 41.5 })
    expect(eventOf('ready', { ...fields, charge_kwh: 41.5 })).toEqual({ type: 'ready', aircraft: 'A01' })
  })

  it('has a diversion and the passengers if they are given', () => {
    const given = { ...fields, place: 'V3', passengers: 0 }
    expect(eventOf('departed', given)).toEqual({ type: 'departed', aircraft: 'A01', to: 'V3', passengers: 0 })
    expect(eventOf('landed', given)).toEqual({ type: 'landed', aircraft: 'A01', at: 'V3' })
    expect(eventOf('ready', given)).toEqual({ type: 'ready', aircraft: 'A01' })
  })

  it('is undefined if a required time is missing or invalid', () => {
    expect(eventOf('delayed', { ...fields, until: '' })).toBeUndefined()
    expect(eventOf('out_of_service', { ...fields, until: 'noon' })).toBeUndefined()
    expect(eventOf('out_of_service', { ...fields, until: '' })).toEqual({
      type: 'out_of_service',
      aircraft: 'A01',
    })
  })

  it('can be of every kind', () => {
    for (const kind of reportKinds) {
      expect(eventOf(kind, { ...fields, to: 'V2' })?.type).toBe(kind)
      expect(Object.keys(fieldsOf(kind))).toHaveLength(8)
    }
  })
})
