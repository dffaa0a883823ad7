import { describe, expect, it } from 'vitest'
import { clock, clockMinutes, duration, parseTime, timeOf } from './time'

describe('times of a day', () => {
  it('are read as hours, minutes and seconds, which may pass midnight', () => {
    expect(parseTime('07:10:05')).toBe(25_805)
    expect(parseTime('7:10')).toBe(25_800)
    expect(parseTime('25:00:00')).toBe(90_000)
    expect(parseTime(3600)).toBe(3600)
  })

  it('are rejected if invalid', () => {
    for (const wrong of ['', '7', '07:60:00', '07:10:60', '-1:00:00', 'noon', '100:00:00']) {
      expect(parseTime(wrong), wrong).toBeUndefined()
    }
    expect(parseTime(-1)).toBeUndefined()
    expect(parseTime(1.5)).toBeUndefined()
    expect(() => timeOf('noon')).toThrow('noon')
  })

  it('are formatted as they are parsed', () => {
    for (const time of [0, 59, 3600, 86_399, 90_000, 359_999]) expect(parseTime(clock(time))).toBe(time)
    expect(clockMinutes(25_859)).toBe('07:10')
  })

  it('have short durations in words', () => {
    expect([duration(45), duration(600), duration(3900), duration(-300)]).toEqual([
      '45 s',
      '10 min',
      '1 h 05 min',
      '5 min',
    ])
  })
})
