import { expect, it } from 'vitest'
import { isCharacter, keyOf, Sequence } from './keys'

const plain = { ctrlKey: false, metaKey: false, altKey: false }

it('names keys in text form', () => {
  expect(keyOf({ ...plain, key: 'a' })).toBe('a')
  expect(keyOf({ ...plain, key: '?' })).toBe('?')
  expect(keyOf({ ...plain, key: ' ' })).toBe('Space')
  expect(keyOf({ ...plain, key: 'K', metaKey: true })).toBe('Mod+k')
  expect(keyOf({ ...plain, key: 'Shift' })).toBeUndefined()
})

it('distinguishes characters from other keys', () => {
  expect(['a', '?', 'g n'].every(isCharacter)).toBe(true)
  expect(['Enter', 'Mod+k', 'Space'].some(isCharacter)).toBe(false)
})

it('combines two keys within a short time', () => {
  const sequence = new Sequence()
  expect(sequence.press('g', 0)).toEqual(['g'])
  expect(sequence.press('n', 500)).toEqual(['g n', 'n'])
  sequence.forget()
  expect(sequence.press('n', 600)).toEqual(['n'])
  expect(sequence.press('n', 3000)).toEqual(['n'])
})
