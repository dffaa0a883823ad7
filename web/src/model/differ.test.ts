import { describe, expect, it } from 'vitest'
import { differences, firstDifference } from './differ'
import { greedy, prices } from './fixtures/tiny'
import type { DayRecord, LegRecord } from './record'

function changed(record: DayRecord, position: number, more: Partial<LegRecord>): DayRecord {
  return {
    ...record,
    legs: record.legs.map((leg, index) => (index === position ? { ...leg, ...more } : leg)),
  }
}

describe('the first difference', () => {
  it('is a decision, with its difference in profit', () => {
    const difference = firstDifference(greedy(), prices())
    expect(difference).toBeDefined()
    const { one, other, time = 0, atDecision_usd, atEnd_usd } = difference ?? {}
    expect(one?.aircraft).toBe(other?.aircraft)
    expect(one?.to).not.toBe(other?.to)
    const before = ({ legs }: DayRecord) => legs.filter((leg) => leg.decided < time).map((leg) => leg.to)
    expect(before(greedy())).toEqual(before(prices()))
    expect(atDecision_usd).toBeCloseTo((one?.profit_usd ?? 0) - (other?.profit_usd ?? 0), 9)
    expect(atEnd_usd).toBeCloseTo(3142.4 - 2860.02, 1)
  })

  it('is absent between a day and itself', () => {
    expect(firstDifference(prices(), prices())).toBeUndefined()
  })

  it('is the end of one day if it ends earlier', () => {
    const whole = prices()
    const cut = { ...whole, legs: whole.legs.slice(0, 5) }
    expect(firstDifference(cut, whole)).toMatchObject({ one: undefined, other: whole.legs[5] })
    expect(firstDifference(cut, whole)?.time).toBe(whole.legs[5]?.decided)
  })

  it('ignores later decisions and another order of decisions', () => {
    const record = prices()
    const [first, second, ...more] = changed(record, 0, { decided: 25_230 }).legs
    if (first === undefined || second === undefined) throw new Error('the day has legs')
    expect(firstDifference(record, { ...record, legs: [second, first, ...more] })).toBeUndefined()
  })
})

describe('differences', () => {
  it('are absent between a day and itself', () => {
    const { one, other, first } = differences(prices(), prices())
    expect([one.size, other.size, first]).toEqual([0, 0, undefined])
  })

  it('are the legs that the other day lacks, with their counterparts', () => {
    const record = prices()
    const [flight] = record.legs
    const { one, other, first } = differences(record, changed(record, 0, { to: flight?.from ?? 0 }))
    expect([...one.keys()]).toEqual([0])
    expect(one.get(0)).toMatchObject({ twin: { to: flight?.from }, isElsewhere: true })
    expect(other.get(0)).toEqual({ twin: flight, isElsewhere: true })
    expect(first).toMatchObject({ time: flight?.decided, one: flight })
  })

  it('include other times and loads, but not seconds', () => {
    const record = prices()
    const leg = record.legs[3]
    if (leg === undefined) throw new Error('the day has legs')
    const howTheyDiffer = (more: Partial<LegRecord>) =>
      differences(record, changed(record, 3, more)).one.get(3)
    expect(howTheyDiffer({ passengers: leg.passengers + 1 })?.isElsewhere).toBe(false)
    expect(howTheyDiffer({ decided: leg.decided + 600 })).toMatchObject({
      isElsewhere: false,
      twin: { decided: leg.decided + 600 },
    })
    expect(howTheyDiffer({ decided: leg.decided + 3600 })?.isElsewhere).toBe(true)
    const differing = (more: Partial<LegRecord>) => [
      ...differences(record, changed(record, 3, more)).one.keys(),
    ]
    expect(differing({ passengers: leg.passengers + 1 })).toEqual([3])
    expect(differing({ decided: leg.decided + 300 })).toEqual([3])
    expect(differing({ decided: leg.decided + 30 })).toEqual([])
  })

  it('of an aircraft on only one day have no counterpart', () => {
    const record = prices()
    const fewer = { ...record, legs: record.legs.filter((leg) => leg.aircraft !== 2) }
    const { one, other } = differences(record, fewer)
    expect([...one.values()].every(({ twin }) => twin === undefined)).toBe(true)
    expect(one.size).toBe(record.legs.filter((leg) => leg.aircraft === 2).length)
    expect(other.size).toBe(0)
  })
})
