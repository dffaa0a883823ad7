import { expect, it } from 'vitest'
import { whoDecided, whoDid, whyNoName } from './who'

it('names the person by the token, and the policy whose advice was accepted', () => {
  expect(whoDecided({ actor: 'anna', policy: 'prices' })).toBe('anna · prices')
  expect(whoDecided({ actor: 'anna', policy: undefined, isOwn: true })).toBe('anna')
})

it('names no person if the service knows none', () => {
  expect(whoDecided({ actor: '', policy: 'prices' })).toBe('as prices advised')
  expect(whyNoName({ actor: '', policy: 'prices' })).toMatch(/^Without tokens/)
})

it('marks actions at this console', () => {
  expect(whoDecided({ actor: '', policy: 'prices', isOwn: true })).toBe('you · prices')
  expect(whoDecided({ actor: '', policy: undefined, isOwn: true })).toBe('you')
  expect(whyNoName({ actor: '', isOwn: true })).toBeUndefined()
})

it('attributes a decision without a policy to a person', () => {
  expect(whoDecided({ actor: '' })).toBe('a person')
  expect(whoDid({ actor: '' })).toBe('')
})
