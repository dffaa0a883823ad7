import { describe, expect, it } from 'vitest'
import { greedyTrace, pricesTrace, scenario, scenarioText } from '../model/fixtures/tiny'
import { FileError } from '../model/traces'
import { dayOfFiles, embeddedDays, playedOf } from './days'

const files = {
  scenario: { name: 'tiny-1.json', text: scenarioText },
  greedy: { name: 'tiny-1-greedy.csv', text: greedyTrace },
  prices: { name: 'C:\\days\\tiny-1-prices.csv', text: pricesTrace },
}

describe('files', () => {
  it('make a day whose plays are called by what their names add', () => {
    const day = dayOfFiles([files.prices, files.scenario, files.greedy])
    expect(day.name).toBe('tiny-1')
    expect(day.plays.map(({ policy }) => policy)).toEqual(['prices', 'greedy'])
  })

  it('add traces to the day that is there', () => {
    const former = dayOfFiles([files.scenario, files.greedy])
    expect(dayOfFiles([files.prices], former).plays.map(({ policy }) => policy)).toEqual(['greedy', 'prices'])
    expect(dayOfFiles([files.scenario, files.prices], former).plays.map(({ policy }) => policy)).toEqual([
      'prices',
    ])
  })

  it('that are missing or wrong are said to be', () => {
    expect(() => dayOfFiles([files.greedy])).toThrow(FileError)
    expect(() => dayOfFiles([files.scenario])).toThrow(FileError)
    expect(() => dayOfFiles([files.scenario, files.scenario, files.greedy])).toThrow(FileError)
    expect(() =>
      dayOfFiles([files.scenario, { ...files.greedy, text: greedyTrace.replace('A02', 'B02') }]),
    ).toThrow(FileError)
  })
})

describe('a page', () => {
  it('carries its days', () => {
    const plays = [{ policy: 'prices', trace: pricesTrace, profit_usd: 2860.02 }]
    const days = embeddedDays(JSON.stringify({ days: [{ name: 'tiny-1', scenario: scenario(), plays }] }))
    const [day] = days
    const [play] = day?.plays ?? []
    if (day === undefined || play === undefined) throw new Error('the page has a day')
    expect(playedOf(day, play).earnings.total_usd).toBeCloseTo(play.profit_usd ?? 0, 2)
  })

  it('of no report has none', () => {
    expect(embeddedDays(' \n')).toEqual([])
  })
})
