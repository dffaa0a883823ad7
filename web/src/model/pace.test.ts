import { describe, expect, it } from 'vitest'
import { Pace } from './pace'

/** Reads the clock sixty times a second from one instant to another. */
function frames(pace: Pace, from_ms: number, to_ms: number): number[] {
  const shown: number[] = []
  for (let at = from_ms; at <= to_ms; at += 1000 / 60) shown.push(pace.at(at))
  return shown
}

describe('the clock of a day', () => {
  it('stands still while only one time is known', () => {
    const pace = new Pace()
    pace.observe(21_600, 0)
    expect(pace.at(0)).toBe(21_600)
    expect(pace.at(60_000)).toBe(21_600)
  })

  it('runs between events at the observed speed', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + 60 * second, 1000 * second)
    expect(pace.speed).toBeCloseTo(60)
    pace.at(10_000)
    expect(pace.at(10_500)).toBeCloseTo(22_230, -1)
  })

  it('stands still on a simulated day while aircraft wait for decisions', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + 60 * second, 1000 * second)
    expect(pace.at(10_900)).toBeGreaterThan(22_200)
    pace.isAwaited = true
    expect(pace.at(11_000)).toBe(22_200)
    expect(pace.at(30_000)).toBe(22_200)
    pace.isAwaited = false
    pace.observe(22_260, 30_500)
    expect(pace.at(30_500)).toBeGreaterThan(22_200)
  })

  it('runs on while aircraft wait on a real day', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + second, 1000 * second)
    pace.isAwaited = true
    expect(pace.at(11_000)).toBeCloseTo(21_611, 0)
  })

  it('neither jumps nor runs back when events come in bursts', () => {
    const pace = new Pace()
    const shown: number[] = []
    let before = 0
    for (const at of [0, 900, 2100, 2900, 4300, 5000, 6200, 7000, 8300, 9000, 10_100]) {
      shown.push(...frames(pace, before, at))
      pace.observe(21_600 + Math.round(at * 0.06), at)
      before = at
    }
    const steps = shown.slice(240).map((time, index, all) => time - (all[index - 1] ?? time))
    expect(Math.min(...steps)).toBeGreaterThanOrEqual(0)
    expect(Math.max(...steps)).toBeLessThan(4)
  })

  it('waits when no news comes', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + second, 1000 * second)
    pace.at(10_000)
    frames(pace, 10_000, 20_000)
    const late = pace.at(20_000)
    frames(pace, 20_000, 60_000)
    expect(pace.at(60_000)).toBeCloseTo(late)
    expect(late).toBeLessThan(21_610 + 2)
    expect(pace.isStill(60_000)).toBe(false)
  })

  it('goes back to the latest known time if a simulated day falls silent', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + 60 * second, 1000 * second)
    pace.at(10_000)
    frames(pace, 10_000, 13_000)
    expect(pace.at(13_000)).toBeGreaterThan(22_200)
    expect(pace.at(13_000)).toBeLessThan(22_200 + 60 * 2)
    expect(pace.isStill(13_000)).toBe(false)
    expect(pace.at(15_100)).toBe(22_200)
    expect(pace.isStill(15_100)).toBe(true)
    pace.observe(22_260, 20_000)
    expect(pace.isStill(20_000)).toBe(false)
    expect(pace.at(20_000)).toBeGreaterThan(22_200)
  })

  it('never runs far ahead of a simulated day that waits for decisions', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + 500 * second, 1000 * second)
    pace.at(10_000)
    frames(pace, 10_000, 20_000)
    expect(pace.at(20_000)).toBeLessThanOrEqual(21_600 + 500 * 10 + 120)
  })

  it('stops when the day is over', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + 60 * second, 1000 * second)
    pace.at(10_500)
    pace.end(22_200, 10_600)
    expect([pace.at(10_700), pace.at(60_000)]).toEqual([22_200, 22_200])
    expect(pace.speed).toBe(0)
  })

  it('jumps when the user returns to a suspended page', () => {
    const pace = new Pace()
    for (let second = 0; second <= 10; second++) pace.observe(21_600 + second, 1000 * second)
    pace.at(10_000)
    pace.observe(25_200, 3_600_000)
    expect(pace.at(3_600_000)).toBeGreaterThanOrEqual(25_200)
  })
})

describe('a jump of the clock', () => {
  it('is no measure of the speed', () => {
    const pace = new Pace()
    pace.observe(21_600, 0)
    pace.observe(21_660, 60_000)
    pace.observe(32_460, 63_000)
    expect(pace.speed).toBe(0)
    expect(pace.latest).toBe(32_460)
    pace.observe(32_462, 65_000)
    expect(pace.speed).toBeCloseTo(1, 5)
  })

  it('may be as short as a few minutes', () => {
    const pace = new Pace()
    for (let second = 0; second <= 60; second += 10) pace.observe(21_600 + second, 1_000 * second)
    pace.observe(22_200, 61_500)
    expect(pace.speed).toBe(0)
    pace.observe(22_210, 71_500)
    expect(pace.speed).toBeCloseTo(1, 5)
  })

  it('is the speed of a fast day if another follows', () => {
    const pace = new Pace()
    for (let second = 0; second < 5; second++) pace.observe(21_600 + 240 * second, 1_000 * second)
    expect(pace.speed).toBeCloseTo(240, 5)
  })

  it('differs from a fast day in its speed so far', () => {
    const pace = new Pace()
    for (let at = 0; at < 30; at++) pace.observe(21_600 + 60 * at, 100 * at)
    pace.observe(24_300, 4_500)
    expect(pace.speed).toBeCloseTo(600, 5)
  })
})
