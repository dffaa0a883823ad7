import { expect, it } from 'vitest'
import { deciderText, actorText, anonymityHint } from './actors'

it('names the person by the token, and the policy whose advice was accepted', () => {
  expect(deciderText({ actor: 'anna', policy: 'prices' })).toBe('anna · prices')
  expect(deciderText({ actor: 'anna', policy: undefined, isOwn: true })).toBe('anna')
})

it('names no person if the service knows none', () => {
  expect(deciderText({ actor: '', policy: 'prices' })).toBe('as prices advised')
  expect(anonymityHint({ actor: '', policy: 'prices' })).toMatch(/^Without tokens/)
})

it('marks actions at this console', () => {
  expect(deciderText({ actor: '', policy: 'prices', isOwn: true })).toBe('you · prices')
  expect(deciderText({ actor: '', policy: undefined, isOwn: true })).toBe('you')
  expect(anonymityHint({ actor: '', isOwn: true })).toBeUndefined()
})

it('attributes a decision without a policy to a person', () => {
  expect(deciderText({ actor: '' })).toBe('a person')
  expect(actorText({ actor: '' })).toBe('')
})
