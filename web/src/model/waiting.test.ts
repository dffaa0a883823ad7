import { describe, expect, it } from 'vitest'
import { at } from './arrays'
import { demandByPeriod } from './earnings'
import { prices } from './fixtures/tiny'
import { timeOf } from './time'
import { Waiting } from './waiting'

const record = prices()
const wanted = (period: number, from: number, to: number) =>
  record.demand?.passengers[period]?.[from]?.[to] ?? 0
const waitingFor = (waiting: Waiting, time: number, from: number, to: number) =>
  waiting.pairs(time).find((pair) => pair.from === from && pair.to === to)?.passengers ?? 0

it('passengers wait from the beginning of their period until a flight takes them', () => {
  const waiting = new Waiting(record)
  expect(waitingFor(waiting, timeOf('06:59:59'), 2, 1)).toBe(0)
  expect(waitingFor(waiting, timeOf('07:00:00'), 2, 1)).toBe(wanted(0, 2, 1) - 4)
  expect(waitingFor(waiting, timeOf('07:23:28'), 0, 2)).toBe(wanted(0, 0, 2))
  expect(waitingFor(waiting, timeOf('07:23:29'), 0, 2)).toBe(wanted(0, 0, 2) - 1)
})

it('passengers who were not carried in their period are gone', () => {
  const waiting = new Waiting(record)
  const before = timeOf('07:59:59')
  expect(waiting.pairs(before).length).toBeGreaterThan(0)
  expect(waitingFor(waiting, timeOf('08:00:00'), 2, 1)).toBe(wanted(1, 2, 1))
})

it('moving back gives the same result as moving forward', () => {
  const [onward, back] = [new Waiting(record), new Waiting(record)]
  const times = Array.from({ length: 24 }, (_, step) => record.start + step * 300)
  const seen = times.map((time) => onward.pairs(time))
  expect(
    [...times]
      .reverse()
      .map((time) => back.pairs(time))
      .reverse(),
  ).toEqual(seen)
})

it('returns the same list while nothing changes', () => {
  const waiting = new Waiting(record)
  expect(waiting.pairs(timeOf('07:05:00'))).toBe(waiting.pairs(timeOf('07:06:00')))
})

describe('passengers who wait into the next period', () => {
  const leg = (decided: string, passengers: number) => ({
    ...at(record.legs, 0),
    ...{ decided: timeOf(decided), from: 0, to: 1, passengers },
  })
  const table = (passengers: number) =>
    record.vertiports.map((_, from) =>
      record.vertiports.map((_, to) => (from === 0 && to === 1 ? passengers : 0)),
    )
  const day = {
    ...record,
    periods: [timeOf('07:00:00'), timeOf('08:00:00')],
    demand: { passengers: [table(5), table(3)] },
    passenger_wait_s: 1800,
    legs: [leg('07:10:00', 3), leg('08:05:00', 1), leg('08:10:00', 2)],
  }

  it('are carried first, until they are gone', () => {
    const waiting = new Waiting(day)
    expect(waitingFor(waiting, timeOf('07:59:59'), 0, 1)).toBe(2)
    expect(waitingFor(waiting, timeOf('08:00:00'), 0, 1)).toBe(5)
    expect(waitingFor(waiting, timeOf('08:29:59'), 0, 1)).toBe(2)
    expect(waitingFor(waiting, timeOf('08:05:00'), 0, 1)).toBe(4)
    const alone = new Waiting({ ...day, legs: day.legs.slice(0, 2) })
    expect(waitingFor(alone, timeOf('08:29:59'), 0, 1)).toBe(4)
    expect(waitingFor(alone, timeOf('08:30:00'), 0, 1)).toBe(3)
  })

  it('count as carried in the period in which they wanted to fly', () => {
    const carried = demandByPeriod(day).map((one) => one.carried)
    expect(carried).toEqual([5, 1])
    const gone = demandByPeriod({ ...day, passenger_wait_s: 60 }).map((one) => one.carried)
    expect(gone).toEqual([3, 3])
  })
})
