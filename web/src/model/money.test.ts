import { expect, it } from 'vitest'
import {
  count,
  countDifference,
  dollarDifference,
  dollars,
  dollarsAndCents,
  percent,
  pointDifference,
  tenths,
} from './money'

it('formats sums in whole dollars and flights with cents', () => {
  expect(dollars(37_149.4)).toBe('$37,149')
  expect(dollars(-12.6)).toBe('−\u2060$13')
  expect(dollarsAndCents(96.018)).toBe('$96.02')
  expect(dollarsAndCents(-31.744)).toBe('−\u2060$31.74')
})

it('allows no line break between a sign and its dollars', () => {
  expect([dollars(-6573), dollarDifference(-6573)]).toEqual(['−\u2060$6,573', '−\u2060$6,573'])
})

it('never formats a negative zero', () => {
  expect(dollars(-0.2)).toBe('$0')
  expect(dollarsAndCents(-0.001)).toBe('$0.00')
})

it('shows the sign of every difference', () => {
  expect([dollarDifference(120.2), dollarDifference(-85), dollarDifference(0.3)]).toEqual([
    '+\u2060$120',
    '−\u2060$85',
    '±\u2060$0',
  ])
  expect([pointDifference(0.0149), pointDifference(-0.014), pointDifference(0.0001)]).toEqual([
    '+1.5',
    '−1.4',
    '±0.0',
  ])
  expect([countDifference(3), countDifference(-1204), countDifference(0)]).toEqual(['+3', '−1,204', '±0'])
})

it('formats counts and shares', () => {
  expect(count(25_892)).toBe('25,892')
  expect([tenths(841.72), tenths(-3.44)]).toEqual(['841.7', '−3.4'])
  expect(percent(0.8449)).toBe('84 %')
  expect(percent(0.8449, 1)).toBe('84.5 %')
})
