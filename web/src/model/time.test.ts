import { describe, expect, it } from 'vitest'
import { clock, clockMinutes, duration, instantOf, isoOf, parseTime, timeOf, timeOfInstant } from './time'

describe('times of a day', () => {
  it('are read as hours, minutes and seconds, which may pass midnight', () => {
    expect(parseTime('07:10:05')).toBe(25_805)
    expect(parseTime('7:10')).toBe(25_800)
    expect(parseTime('25:00:00')).toBe(90_000)
    expect(parseTime(3600)).toBe(3600)
  })

  it('are refused if they are no times', () => {
    for (const wrong of ['', '7', '07:60:00', '07:10:60', '-1:00:00', 'noon', '100:00:00']) {
      expect(parseTime(wrong), wrong).toBeUndefined()
    }
    expect(parseTime(-1)).toBeUndefined()
    expect(parseTime(1.5)).toBeUndefined()
    expect(() => timeOf('noon')).toThrow('noon')
  })

  it('are written as they are read', () => {
    for (const time of [0, 59, 3600, 86_399, 90_000, 359_999]) expect(parseTime(clock(time))).toBe(time)
    expect(clockMinutes(25_859)).toBe('07:10')
  })

  it('last for words that fit a line', () => {
    expect([duration(45), duration(600), duration(3900), duration(-300)]).toEqual([
      '45 s',
      '10 min',
      '1 h 05 min',
      '5 min',
    ])
  })
})

describe('times of a day with a date', () => {
  const zone = 'America/New_York'

  it('carry the offset of the place', () => {
    expect(isoOf(timeOf('07:10:00'), '2026-11-23', zone)).toBe('2026-11-23T07:10:00-05:00')
    expect(isoOf(timeOf('07:10:00'), '2026-07-01', zone)).toBe('2026-07-01T07:10:00-04:00')
    expect(isoOf(timeOf('25:10:00'), '2026-11-23', zone)).toBe('2026-11-24T01:10:00-05:00')
  })

  it('mean ten past seven on the clocks of the place also when these change', () => {
    expect(isoOf(timeOf('07:10:00'), '2026-03-08', zone)).toBe('2026-03-08T07:10:00-04:00')
    expect(isoOf(timeOf('07:10:00'), '2026-11-01', zone)).toBe('2026-11-01T07:10:00-05:00')
  })

  it('come back from the instant that they are', () => {
    const time = timeOf('18:30:15')
    const instant = new Date(instantOf(time, '2026-03-08', zone))
    expect(timeOfInstant(instant, '2026-03-08', zone)).toBe(time)
  })
})
