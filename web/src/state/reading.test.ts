import { expect, it } from 'vitest'
import { ProblemError } from '../api/problem'
import { Reading } from './reading.svelte'

it('keeps the last value when a later read fails, with the problem', async () => {
  const answers = [['a'], new ProblemError(0, '', 'away', undefined), ['b']]
  const list = new Reading(() => {
    const answer = answers.shift()
    return answer instanceof Error ? Promise.reject(answer) : Promise.resolve(answer)
  })
  await list.read()
  expect(list.value).toEqual(['a'])
  await list.read()
  expect([list.value, list.problem?.detail]).toEqual([['a'], 'away'])
  await list.read()
  expect([list.value, list.problem]).toEqual([['b'], undefined])
})

it('throws errors that are bugs', async () => {
  await expect(new Reading(() => Promise.reject(new TypeError('a slip'))).read()).rejects.toThrow('a slip')
})
