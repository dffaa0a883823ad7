import { expect, it } from 'vitest'
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

it('going back gives the same as going on', () => {
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

it('gives the same list while nothing changes', () => {
  const waiting = new Waiting(record)
  expect(waiting.pairs(timeOf('07:05:00'))).toBe(waiting.pairs(timeOf('07:06:00')))
})
