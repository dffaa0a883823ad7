import { describe, expect, it } from 'vitest'
import { prices } from '../model/fixtures/tiny'
import { timeOf } from '../model/time'
import { barAt, barsWithin, rowsOfFleet, rowsOfStands, targetOf, wholeDay } from './rows'
import { selectedLeg, stepFrom } from './steps'

const record = prices()
const fleet = rowsOfFleet(record)

describe('rows', () => {
  it('are named after aircraft, or after vertiport and stand', () => {
    expect(fleet.map(({ label }) => label)).toEqual(['A01', 'A02', 'A03'])
    expect(rowsOfStands(record).map(({ group, label }) => group ?? label)).toEqual([
      'North, shore',
      '2',
      'East',
      '2',
      'South',
      '2',
    ])
  })

  it('find the bar at a time', () => {
    const row = fleet[1]
    if (row === undefined) throw new Error('there are three aircraft')
    expect(barAt(row, timeOf('07:02:00'))?.kind).toBe('delay')
    expect(barAt(row, timeOf('07:10:00'))?.kind).toBe('flight')
    expect(barAt(row, timeOf('06:00:00'))).toBeUndefined()
  })

  it('return only the bars that overlap a span', () => {
    const row = fleet[0]
    if (row === undefined) throw new Error('there are three aircraft')
    const [first, end] = barsWithin(row, { from: timeOf('07:15:00'), to: timeOf('07:30:00') })
    expect(row.bars.slice(first, end).map(({ kind }) => kind)).toEqual(['charge', 'delay', 'flight'])
    expect(barsWithin({ ...row, bars: [], begins: new Float64Array() }, { from: 0, to: 1 })).toEqual([0, 0])
  })

  it('map to selection targets', () => {
    const bar = fleet[0]?.bars[0]
    if (bar === undefined) throw new Error('the first aircraft flies')
    expect(targetOf(bar, record)).toEqual({ kind: 'leg', aircraft: 0, decided: timeOf('07:00:00') })
    expect(targetOf({ ...bar, leg: -1 }, record)).toEqual({ kind: 'aircraft', aircraft: 0 })
  })

  it('reach until the last aircraft is ready', () => {
    expect(wholeDay(record)).toEqual({ from: timeOf('07:00:00'), to: timeOf('09:06:01') })
  })
})

describe('steps with keys', () => {
  const time = timeOf('07:25:00')

  it('begin with the first aircraft at the displayed time', () => {
    expect(stepFrom(record, undefined, time, 'next')).toEqual({
      kind: 'leg',
      aircraft: 0,
      decided: timeOf('07:19:21'),
    })
  })

  it('move along the legs of an aircraft and stop at both ends', () => {
    const first = stepFrom(record, { kind: 'aircraft', aircraft: 1 }, time, 'first')
    expect(selectedLeg(record, first)?.decided).toBe(timeOf('07:00:00'))
    expect(selectedLeg(record, stepFrom(record, first, time, 'next'))?.decided).toBe(timeOf('07:23:29'))
    expect(stepFrom(record, first, time, 'former')).toEqual(first)
    const last = stepFrom(record, first, time, 'last')
    expect(stepFrom(record, last, time, 'next')).toEqual(last)
  })

  it('move to the next aircraft at the same time', () => {
    const from = { kind: 'leg', aircraft: 1, decided: timeOf('07:23:29') } as const
    expect(stepFrom(record, from, time, 'above')).toEqual({
      kind: 'leg',
      aircraft: 0,
      decided: timeOf('07:19:21'),
    })
    expect(stepFrom(record, from, time, 'below')).toEqual({
      kind: 'leg',
      aircraft: 2,
      decided: timeOf('07:19:37'),
    })
    expect(stepFrom(record, { kind: 'aircraft', aircraft: 2 }, time, 'below')).toEqual({
      kind: 'aircraft',
      aircraft: 2,
    })
  })

  it('select the aircraft on a day without legs', () => {
    expect(stepFrom({ ...record, legs: [] }, undefined, time, 'next')).toEqual({
      kind: 'aircraft',
      aircraft: 0,
    })
    expect(stepFrom({ ...record, legs: [], aircraft: [] }, undefined, time, 'next')).toBeUndefined()
  })
})
