import { describe, expect, it } from 'vitest'
import { greedyTrace, pricesTrace, scenario, scenarioText } from '../model/fixtures/tiny'
import { FileError } from '../model/traces'
import { chosenPlays, dayOfFiles, embeddedDays, playedOf, type Play } from './days'

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

it('the error of a file has its name, unless it is of all of them', () => {
  const fileOf = (...given: { name: string; text: string }[]) => {
    try {
      dayOfFiles(given)
    } catch (error) {
      if (error instanceof FileError) return error.file
    }
    return undefined
  }
  const wrong = { name: 'wrong.csv', text: greedyTrace.replace('A02', 'B02') }
  expect(fileOf(files.scenario, files.prices, wrong)).toBe('wrong.csv')
  expect(fileOf({ name: 'notes.txt', text: 'buy milk' }, files.prices)).toBe('notes.txt')
  expect(fileOf(files.prices)).toBeUndefined()
})

it('a file that is given again takes the place of what it was', () => {
  const former = dayOfFiles([files.scenario, files.greedy])
  expect(dayOfFiles([files.greedy], former).plays).toHaveLength(1)
})

describe('of several plays', () => {
  const play = (policy: string, profit_usd: number): Play => ({ policy, trace: '', profit_usd })
  const plays = [play('random', 1), play('prices', 3), play('greedy', 2)]
  const chosen = (policy?: string, other?: string) => {
    const found = chosenPlays(plays, policy, other)
    return [found.play?.policy, found.other?.policy]
  }

  it('the best two are looked at first', () => {
    expect(chosen()).toEqual(['prices', 'greedy'])
  })

  it('those are that an address names', () => {
    expect(chosen('random', 'prices')).toEqual(['random', 'prices'])
    expect(chosen('greedy')).toEqual(['greedy', 'prices'])
    expect(chosen('gone', 'gone')).toEqual(['prices', 'greedy'])
  })

  it('one is alone if an address wants that, or if there is no other', () => {
    expect(chosen('greedy', '')).toEqual(['greedy', undefined])
    expect(chosenPlays(plays.slice(0, 1), undefined, undefined).other).toBeUndefined()
  })

  it('the first ones are where nobody knows what they earned', () => {
    const unknown = ['as-it-was', 'greedy'].map((policy) => ({ policy, trace: '' }))
    expect(chosenPlays(unknown, undefined, undefined).play?.policy).toBe('as-it-was')
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
