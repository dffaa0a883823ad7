import { beforeEach, expect, it } from 'vitest'
import { OwnDecisions } from './ownDecisions.svelte'

let kept: Map<string, string>
const storage = {
  getItem: (key: string) => kept.get(key) ?? null,
  setItem: (key: string, value: string) => void kept.set(key, value),
}

beforeEach(() => {
  kept = new Map()
})

it('own decisions survive a reload, and belong to one day', () => {
  new OwnDecisions('d1', storage).add(7)
  const again = new OwnDecisions('d1', storage)
  expect([again.has(7), again.has(8)]).toEqual([true, false])
  expect(new OwnDecisions('d2', storage).has(7)).toBe(false)
})

it('numbers after the end of a restored log are forgotten', () => {
  const own = new OwnDecisions('d1', storage)
  for (const seq of [3, 9]) own.add(seq)
  own.forgetAfter(5)
  const again = new OwnDecisions('d1', storage)
  expect([again.has(3), again.has(9)]).toEqual([true, false])
})

it('invalid content of the storage is ignored', () => {
  for (const other of ['{', '{"7":1}', '"7"', '["7"]']) {
    kept.set('vertifleet-decided d1', other)
    expect(new OwnDecisions('d1', storage).has(7)).toBe(false)
  }
})

it('a full storage does not prevent decisions', () => {
  const full = {
    ...storage,
    setItem: () => {
      throw new Error('the storage is full')
    },
  }
  const own = new OwnDecisions('d1', full)
  own.add(7)
  expect(own.has(7)).toBe(true)
})
