import { describe, expect, it } from 'vitest'
import type { TakenEvent } from '../api/types'
import { aircraftAt, withAwaitedReports, minutesOverdue, recordAt } from './awaited'
import { fleetRows, standRows, type Bar } from './bars'
import { Counts } from './counts'
import { expectedNext, nextOf } from './decisions'
import { east, events, north, recordAfter as recordOf, south, state } from './fixtures/liveDay'
import { Fleet, NONE, Phase } from './motion'
import type { DayRecord, LegRecord } from './record'
import { clock, timeOf } from './time'

// At 06:47 A02 is in the air to South, due at 06:54:06. A03 has been sent from East to North and
// has not departed.
const [a02, a03, a05] = [1, 2, 4]
const late = timeOf('07:15:00')

function recordAfter(...more: object[]): DayRecord {
  return recordOf([...events, ...more.map((event, at) => ({ seq: 100 + at, event }) as TakenEvent)])
}

const record = recordAfter()
const happened = { ...record, legs: record.legs.filter((leg) => !leg.is_expected) }

function legsOf({ legs }: DayRecord, aircraft: number) {
  return legs.filter((leg) => leg.aircraft === aircraft)
}

/** The flight of an aircraft that has been decided and has not landed. */
function underWay(day: DayRecord, aircraft: number): LegRecord {
  return only(legsOf(day, aircraft).findLast((leg) => !leg.is_expected))
}

/** The route of each expected leg of an aircraft, and its departure relative to a time. */
function expectedOf(day: DayRecord, aircraft: number, since: number): number[][] {
  const expected = legsOf(day, aircraft).filter((leg) => leg.is_expected)
  return expected.map(({ to, decided }) => [to, decided - since])
}

function withoutReport(leg: LegRecord): LegRecord {
  const known = { ...leg }
  delete known.awaited
  return known
}

function only<T>(one: T | undefined): T {
  if (one === undefined) throw new Error('the day has one')
  return one
}

function distance(
  [x1 = NaN, y1 = NaN]: ArrayLike<number> & Iterable<number>,
  [x2 = NaN, y2 = NaN]: Iterable<number>,
): number {
  return Math.hypot(x2 - x1, y2 - y1)
}

/** The frame's values of one aircraft on the day as reported. */
function shown(time: number, aircraft: number, day = happened) {
  const fleet = new Fleet(day)
  const frame = fleet.frame()
  fleet.show(time, frame)
  const { phases, stands, overdue_min, lifts, places } = frame
  return {
    phase: phases[aircraft],
    stands: stands[aircraft],
    overdue_min: overdue_min[aircraft],
    lift: lifts[aircraft],
    place: [...places.subarray(2 * aircraft, 2 * aircraft + 2)],
    charge: frame.charges[aircraft] ?? NaN,
  }
}

describe('a landing that is not reported', () => {
  it('is awaited from the departure on', () => {
    expect(underWay(record, a02).awaited).toEqual({ report: 'landing', due: timeOf('06:54:06') })
    expect(record.legs.filter((leg) => leg.awaited !== undefined)).toHaveLength(2)
  })

  it('is at the later of planned and now, and delays the time when the aircraft is ready', () => {
    const early = recordAt(record, timeOf('06:50:00'))
    expect(underWay(early, a02)).toMatchObject({ arrives: timeOf('06:54:06'), ready: timeOf('07:18:48') })
    const leg = underWay(recordAt(record, late), a02)
    expect(leg).toMatchObject({ departs: timeOf('06:11:30'), arrives: late, ready: timeOf('07:39:42') })
    expect(leg.planned?.arrives).toBe(timeOf('06:42:36'))
  })

  it('leaves the aircraft in the air, at the approach of its destination', () => {
    const places = new Fleet(happened).geography.places
    const destination = places.slice(2 * south, 2 * south + 2)
    for (const time of ['06:54:07', '07:00:00', '07:15:00', '09:30:00']) {
      const { phase, stands, place } = shown(timeOf(time), a02)
      expect({ phase, stands }).toEqual({ phase: Phase.flying, stands: NONE })
      expect(distance(place, destination) / distance(places, destination)).toBeLessThan(0.15)
    }
    expect(shown(late, a02).lift).toBeGreaterThan(0.3)
  })

  it('moves the aircraft without a jump', () => {
    const place = (time: number) => shown(time, a02).place
    for (let time = timeOf('06:45:00'); time < timeOf('07:10:00'); time += 10) {
      expect(distance(place(time), place(time + 10))).toBeLessThan(0.25)
    }
  })

  it('is overdue more than five minutes after it was due, as in the service', () => {
    expect(shown(timeOf('06:58:00'), a02).overdue_min).toBe(0)
    expect(shown(timeOf('07:00:00'), a02).overdue_min).toBe(5)
    expect(shown(late, a02).overdue_min).toBe(20)
    expect(minutesOverdue(underWay(recordAt(record, late), a02))).toBe(20)
  })

  it('does not charge the aircraft', () => {
    expect(shown(timeOf('08:30:00'), a02).charge).toBeCloseTo(shown(timeOf('06:54:06'), a02).charge, 6)
  })

  it('ends with the report, even before the state is read again', () => {
    const landed = recordAfter({ type: 'landed', aircraft: 'A02', time: '07:12:00' })
    const leg = underWay(landed, a02)
    expect(leg.awaited).toBeUndefined()
    expect(leg).toMatchObject({ arrives: timeOf('07:12:00'), ready: timeOf('07:36:42') })
    const after = { ...landed, legs: landed.legs.filter((one) => !one.is_expected) }
    expect(shown(late, a02, after)).toMatchObject({ phase: Phase.charging, stands: south, overdue_min: 0 })
  })
})

describe('a departure that is not reported', () => {
  it('leaves the aircraft where it stands', () => {
    expect(underWay(record, a03).awaited).toEqual({ report: 'departure', due: timeOf('06:47:00') })
    expect(shown(timeOf('06:50:00'), a03)).toMatchObject({
      phase: Phase.delayed,
      stands: east,
      overdue_min: 0,
    })
    expect(shown(late, a03)).toMatchObject({ phase: Phase.delayed, stands: east, overdue_min: 28 })
    expect(underWay(recordAt(record, late), a03)).toMatchObject({
      departs: late,
      arrives: timeOf('07:56:40'),
      ready: timeOf('08:20:21'),
      planned: { departs: timeOf('06:47:00'), arrives: timeOf('07:28:40'), ready: timeOf('07:52:21') },
    })
  })

  it('ends with the report, after which the landing is awaited', () => {
    const departed = recordAfter({ type: 'departed', aircraft: 'A03', time: '06:48:00' })
    expect(underWay(departed, a03).awaited?.report).toBe('landing')
    const after = { ...departed, legs: departed.legs.filter((one) => !one.is_expected) }
    expect(shown(timeOf('06:55:00'), a03, after).phase).toBe(Phase.flying)
  })

  it('may be expected later, and is awaited from then on', () => {
    const delayed = recordAfter({ type: 'delayed', aircraft: 'A03', time: '06:48:00', until: '07:10:00' })
    expect(minutesOverdue(underWay(delayed, a03), timeOf('07:14:00'))).toBe(0)
    expect(minutesOverdue(underWay(delayed, a03), timeOf('07:16:00'))).toBe(6)
  })
})

describe('a day on which several reports are late', () => {
  const day = recordAt(record, late)

  it('is unchanged while nothing is due', () => {
    expect(recordAt(record, timeOf('06:47:00'))).toBe(record)
  })

  it('does not start expected legs before they can start', () => {
    for (const aircraft of [a02, a03]) {
      const { ready } = underWay(day, aircraft)
      // The same routes, at the same intervals.
      expect(expectedOf(day, aircraft, ready)).toEqual(
        expectedOf(record, aircraft, underWay(record, aircraft).ready),
      )
    }
    expect(legsOf(day, a05)[0]?.decided).toBe(timeOf('07:14:00'))
    expect(day.legs.map((leg) => leg.decided)).toEqual(
      day.legs.map((leg) => leg.decided).sort((a, b) => a - b),
    )
  })

  it('can be updated minute by minute', () => {
    expect(recordAt(recordAt(record, timeOf('07:05:00')), late).legs).toEqual(day.legs)
  })

  it('counts an overdue aircraft once, and in the air', () => {
    const [fleet, counts] = [new Fleet(happened), new Counts(happened)]
    const frame = fleet.frame()
    fleet.show(late, frame)
    counts.count(frame)
    expect(counts).toMatchObject({ inTheAir: 1, overdue: 2 })
    expect([north, east, south].map((one) => counts.standsOf(one))).toEqual([
      { taken: 0, promised: 1, overdue: 1 },
      { taken: 2, promised: 0, overdue: 0 },
      { taken: 1, promised: 1, overdue: 1 },
    ])
    const { revision } = counts
    counts.count(frame)
    expect(counts.revision).toBe(revision)
  })

  it('has no unreported events before now in its timelines', () => {
    const endOf = ({ kind, ends }: Bar) => `${kind} ${clock(ends)}`
    const rows = fleetRows(day)
    expect(rows[a02]?.bars.slice(1, 3).map(endOf)).toEqual(['flight 07:15:00', 'charge 07:39:42'])
    expect(rows[a02]?.bars[1]?.overdueSince).toBe(timeOf('06:54:06'))
    expect(rows[a03]?.bars.slice(1, 3).map(endOf)).toEqual(['delay 07:15:00', 'flight 07:56:40'])
    expect(rows[a03]?.bars[1]?.overdueSince).toBe(timeOf('06:47:00'))
    const stays = standRows(day).flatMap((row) => (row.vertiport === south ? row.bars : []))
    const promised = stays.filter((bar) => bar.kind === 'promised' && bar.aircraft === a02 && !bar.isExpected)
    expect(promised.map(endOf)).toEqual(['promised 07:15:00'])
    expect(promised[0]?.overdueSince).toBe(timeOf('06:54:06'))
  })

  it('has no overdue aircraft among those that are ready', () => {
    const now = { ...state, now: clock(late), aircraft: aircraftAt(state, day) }
    const ready = nextOf(now, 5).map(({ id, ready }) => `${id} ${clock(ready)}`)
    expect(ready).toEqual(['A02 07:39:42', 'A03 08:20:21'])
    expect(now.aircraft[a02]).toMatchObject({ phase: 'in_the_air', arrival: '07:15:00' })
    const next = expectedNext(day, late, 20).filter(({ leg }) => leg.aircraft === a02)
    expect(next[0]?.leg.decided).toBe(timeOf('07:39:42'))
  })

  it('has the same delays in another course of the day', () => {
    const course = { ...record, legs: record.legs.map(withoutReport) }
    expect(recordAt(withAwaitedReports(course, record), late)).toEqual(day)
  })
})
