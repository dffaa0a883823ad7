import { describe, expect, it } from 'vitest'
import type { TakenEvent } from '../api/types'
import { everything, eventTypes, isWanted, vertiportsOf, type LogFilter } from './log'
import { events } from './fixtures/liveDay'

const textOf = ({ seq, event }: TakenEvent) => ({
  words: `${event.type} ${'reason' in event ? (event.reason ?? '') : ''}`,
  place: seq === 12 ? 'East' : undefined,
})
const wanted = (filter: Partial<LogFilter>) =>
  events.filter((one) => isWanted(one, { ...everything, ...filter }, textOf)).map((one) => one.seq)

describe('the log', () => {
  it('contains everything without a filter', () => {
    expect(wanted({})).toHaveLength(events.length)
  })

  it('is filtered by type, aircraft and vertiport', () => {
    expect(wanted({ type: 'undone' })).toEqual([7])
    expect(wanted({ aircraft: 'A04' })).toEqual([9])
    expect(wanted({ vertiport: 'South' })).toEqual([3, 10, 11, 14, 15])
    expect(wanted({ vertiport: 'South', type: 'closed' })).toEqual([10, 15])
    expect(wanted({ vertiport: 'East', type: 'landed' })).toEqual([12])
    expect(wanted({ actor: 'another' })).toEqual([])
  })

  it('finds all words of a text in any order', () => {
    expect(wanted({ text: 'FOG closed' })).toEqual([10])
    expect(wanted({ text: 'fog' })).toEqual([8, 10])
  })
})

it('every type of event can be textOf, with its vertiports', () => {
  for (const { event } of events) {
    expect(eventTypes).toContain(event.type)
    expect(Array.isArray(vertiportsOf(event))).toBe(true)
  }
})
