import { expect, it } from 'vitest'
import { firstDifference } from './differ'
import { greedy, prices } from './fixtures/tiny'

it('finds the first decision in which two days differ, and its worth', () => {
  const difference = firstDifference(greedy(), prices())
  expect(difference).toBeDefined()
  const { one, other, index, atDecision_usd, atEnd_usd } = difference ?? {}
  expect(one?.aircraft).toBe(other?.aircraft)
  expect(one?.to).not.toBe(other?.to)
  expect(
    greedy()
      .legs.slice(0, index)
      .map((leg) => leg.to),
  ).toEqual(
    prices()
      .legs.slice(0, index)
      .map((leg) => leg.to),
  )
  expect(atDecision_usd).toBeCloseTo((one?.profit_usd ?? 0) - (other?.profit_usd ?? 0), 9)
  expect(atEnd_usd).toBeCloseTo(3142.4 - 2860.02, 1)
})

it('finds nothing between a day and itself', () => {
  expect(firstDifference(prices(), prices())).toBeUndefined()
})

it('takes the end of one day as a difference', () => {
  const whole = prices()
  const cut = { ...whole, legs: whole.legs.slice(0, 5) }
  expect(firstDifference(cut, whole)).toMatchObject({
    index: 5,
    one: undefined,
    time: whole.legs[5]?.decided,
  })
})
