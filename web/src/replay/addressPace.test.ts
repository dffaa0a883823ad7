import { expect, it } from 'vitest'
import { AddressPace } from './addressPace'

/** The number of changes allowed if one is requested every `every_ms` for a time. */
function changesIn(length_ms: number, every_ms: number): number {
  const pace = new AddressPace()
  let changes = 0
  for (let now_ms = 0; now_ms < length_ms; now_ms += every_ms) {
    if (pace.wait(now_ms) > 0) continue
    pace.changed(now_ms)
    changes += 1
  }
  return changes
}

it('allows steps by key at once', () => {
  expect(changesIn(2_000, 200)).toBe(10)
  expect(changesIn(30, 15)).toBe(2)
})

it('allows changes by dragging as often as browsers do', () => {
  expect(changesIn(30_000, 16)).toBeGreaterThan(60)
  expect(changesIn(30_000, 16)).toBeLessThan(100)
})

it('allows changes again after a pause', () => {
  const pace = new AddressPace()
  for (let change = 0; change < 30; change++) pace.changed(change)
  expect(pace.wait(30)).toBeGreaterThan(200)
  expect(pace.wait(20_000)).toBe(0)
})
