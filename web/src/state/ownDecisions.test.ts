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

it('what was decided here is known after a reload, and on this day only', () => {
  new OwnDecisions('d1', storage).add(7)
  const again = new OwnDecisions('d1', storage)
  expect([again.has(7), again.has(8)]).toEqual([true, false])
  expect(new OwnDecisions('d2', storage).has(7)).toBe(false)
})

it('numbers that a day has lost belong to no user', () => {
  const own = new OwnDecisions('d1', storage)
  for (const seq of [3, 9]) own.add(seq)
  own.forgetAfter(5)
  const again = new OwnDecisions('d1', storage)
  expect([again.has(3), again.has(9)]).toEqual([true, false])
})

it('what is kept under the same name and is no list of numbers is not read', () => {
  for (const other of ['{', '{"7":1}', '"7"', '["7"]']) {
    kept.set('vertifleet-decided d1', other)
    expect(new OwnDecisions('d1', storage).has(7)).toBe(false)
  }
})

it('a storage that is full does not keep anybody from deciding', () => {
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
