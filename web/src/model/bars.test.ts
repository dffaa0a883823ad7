import { describe, expect, it } from 'vitest'
import { fleetRows, standRows, type Bar } from './bars'
import { greedy, prices } from './fixtures/tiny'
import { roomOf, staysOf } from './occupancy'
import type { DayRecord } from './record'
import { clock, timeOf } from './time'

/** The numbers of aircraft that stand at a vertiport, and of those with a promised stand there. */
function occupancyOf(record: DayRecord) {
  const stays = staysOf(record)
  const count = (is: (stay: (typeof stays)[number]) => boolean) => stays.filter(is).length
  return {
    taken: (vertiport: number, time: number) =>
      count((stay) => stay.vertiport === vertiport && stay.arrives <= time && time < stay.leaves),
    promised: (vertiport: number, time: number) =>
      count((stay) => stay.vertiport === vertiport && stay.promised <= time && time < stay.arrives),
  }
}

function shown({ kind, begins, ends }: Bar): string {
  return `${kind} ${clock(begins)}-${clock(ends)}`
}

describe('rows of the fleet', () => {
  const rows = fleetRows(prices())

  it('show the activity of an aircraft without a gap', () => {
    expect(rows[1]?.bars.slice(0, 4).map(shown)).toEqual([
      'delay 07:00:00-07:04:33',
      'flight 07:04:33-07:15:14',
      'charge 07:15:14-07:23:29',
      'flight 07:23:29-07:34:28',
    ])
    expect(rows[0]?.bars.filter((bar) => bar.kind === 'hold').map(shown)[0]).toBe('hold 07:47:28-07:57:28')
  })

  it('show outages separately, and plans of flights that went differently', () => {
    expect(rows[1]?.outages.map(shown)).toEqual(['outage 07:40:21-08:11:55'])
    expect(rows[1]?.plans.map((plan) => clock(plan.ready))).toEqual(['07:18:56', '08:02:43'])
  })

  it('show the load factor of a flight', () => {
    expect(rows[1]?.bars.filter((bar) => bar.kind === 'flight').map((bar) => bar.load)).toEqual([
      1, 0.25, 0.5, 0.75, 1,
    ])
  })
})

describe('rows of stands', () => {
  const record = greedy()
  const rows = standRows(record)

  it('include every stand', () => {
    expect(rows.map(({ vertiport, stand }) => `${vertiport}.${stand}`)).toEqual([
      '0.0',
      '0.1',
      '1.0',
      '1.1',
      '2.0',
      '2.1',
    ])
    expect(rows.some((row) => row.isOver)).toBe(false)
  })

  it('hold one aircraft at a time', () => {
    for (const { bars } of rows) {
      bars.forEach((bar, index) => expect(bar.begins).toBeGreaterThanOrEqual(bars[index - 1]?.ends ?? 0))
    }
  })

  it('agree with the occupancy at every minute', () => {
    const occupancy = occupancyOf(record)
    for (let time = record.start; time <= record.end; time += 60) {
      record.vertiports.forEach((one, vertiport) => {
        const bars = rows.filter((row) => row.vertiport === vertiport).flatMap((row) => row.bars)
        const now = bars.filter((bar) => bar.begins <= time && time < bar.ends)
        const promised = now.filter((bar) => bar.kind === 'promised').length
        expect(occupancy.promised(vertiport, time)).toBe(promised)
        expect(occupancy.taken(vertiport, time)).toBe(now.length - promised)
        expect(now.length).toBeLessThanOrEqual(roomOf(one))
      })
    }
  })

  it('show the outage of an aircraft at its stand', () => {
    const outages = standRows(prices()).flatMap((row) => row.outages)
    expect(outages.map(shown)).toContain('outage 07:54:05-08:11:55')
  })

  it('exceed the stands if more aircraft are there', () => {
    const crowded = { ...record, vertiports: record.vertiports.map((one) => ({ ...one, stands: 1 })) }
    expect(standRows(crowded).some((row) => row.isOver)).toBe(true)
  })
})

it('counts chargers separately from stands', () => {
  expect(roomOf({ stands: 2, chargers: 3 })).toBe(5)
})

it('counts no aircraft twice', () => {
  const record = prices()
  const occupancy = occupancyOf(record)
  const time = timeOf('08:20:00')
  const all = record.vertiports.map((_, one) => occupancy.taken(one, time) + occupancy.promised(one, time))
  expect(all.reduce((sum, number) => sum + number)).toBe(record.aircraft.length)
})
