import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { Clock } from './clock.svelte'

let frame: (now: number) => void

beforeEach(() => {
  vi.useFakeTimers({ toFake: ['performance'] })
  vi.stubGlobal('matchMedia', () => ({ matches: false }))
  vi.stubGlobal('requestAnimationFrame', (next: (now: number) => void) => {
    frame = next
    return 1
  })
})

afterEach(() => {
  vi.useRealTimers()
  vi.unstubAllGlobals()
})

it('is never before a known event, although aircraft move without a jump', () => {
  const clock = new Clock()
  clock.run()
  for (let second = 0; second <= 10; second++) {
    clock.observe(21_600 + 60 * second)
    frame(performance.now())
    if (second < 10) vi.advanceTimersByTime(1000)
  }
  // Earlier than expected, and between two frames.
  vi.advanceTimersByTime(100)
  clock.observe(22_260)
  expect(clock.time).toBe(22_260)
  frame(performance.now())
  expect(clock.time).toBeGreaterThanOrEqual(22_260)
  expect(clock.motion).toBeLessThan(22_260)
  for (let more = 0; more < 200; more++) {
    const before = clock.time
    vi.advanceTimersByTime(1000 / 60)
    frame(performance.now())
    expect(clock.time).toBeGreaterThanOrEqual(before)
  }
  expect(clock.motion).toBe(clock.time)
})
