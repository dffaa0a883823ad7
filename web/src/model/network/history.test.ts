import { expect, it } from 'vitest'
import { History } from './history'

it('undoes and redoes', () => {
  const one = History.of('a').then('b', 'x', 0).then('c', 'y', 10)
  expect(one.undo().text).toBe('b')
  expect(one.undo().undo().text).toBe('a')
  expect(one.undo().undo().undo().text).toBe('a')
  expect(one.undo().undo().redo().redo().text).toBe('c')
  expect(one.undo().then('d', 'z', 20).canRedo).toBe(false)
})

it('merges quick edits of one field into one step', () => {
  const one = History.of('1').then('12', 'stands', 0).then('123', 'stands', 400)
  expect(one.undo().text).toBe('1')
  expect(one.then('1234', 'stands', 5000).undo().text).toBe('123')
  expect(History.of('1').then('1', 'stands', 0).canUndo).toBe(false)
  expect(History.of('1').then('12', '', 0).then('123', '', 1).undo().text).toBe('12')
})
