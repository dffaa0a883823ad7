import { expect, it } from 'vitest'
import { ProblemError } from '../api/problem'
import { problemText, sentenceOf } from './problems'

it('explains a missing object, with a link to its list', () => {
  const problem = new ProblemError(404, 'V602', 'there is no study "zzz"', undefined)
  const { title, code, way } = problemText(problem)
  expect([title, code, way]).toEqual([
    'There is no study “zzz” here.',
    undefined,
    { href: '#/studies', title: 'All studies' },
  ])
})

it('omits hints for programs', () => {
  const hint = 'GET /v1/policies lists them; PUT /v1/policies/NAME keeps weights under a name'
  const policy = problemText(new ProblemError(404, 'V602', 'there is no policy "zzz"', hint))
  expect(policy.title).toBe('There is no policy “zzz”.')
  expect(policy.hint).not.toContain('/v1')
  expect(policy.way).toBeUndefined()
  const archived = new ProblemError(
    409,
    'V608',
    'day "d" is archived',
    'POST /v1/days/d/unarchive opens it again',
  )
  expect(problemText(archived)).toEqual({ title: 'Day “d” is archived.', code: 'V608' })
})

it('shows other messages of the service as sentences with the code', () => {
  const problem = new ProblemError(412, 'V605', 'the day has gone on', 'read the day again, and decide again')
  expect(problemText(problem)).toEqual({
    title: 'The day has gone on.',
    hint: 'Read the day again, and decide again.',
    code: 'V605',
  })
  expect(problemText(new ProblemError(404, 'V602', 'there is no path "/x"', undefined)).code).toBe('V602')
})

it('makes a sentence of a message, but keeps a path', () => {
  expect(sentenceOf('aircraft "A01" is out')).toBe('Aircraft “A01” is out.')
  expect(sentenceOf('small.toml: stands must be at least 1')).toBe('small.toml: stands must be at least 1.')
  expect(sentenceOf('HTTP 502')).toBe('HTTP 502.')
})
