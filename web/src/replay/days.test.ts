import { describe, expect, it } from 'vitest'
import { greedyTrace, pricesTrace, scenario, scenarioText } from '../model/fixtures/tiny'
import { FilesError } from '../model/traces'
import { chosenPlays, dayOfFiles, embeddedDays, playedOf, type Play, type ReplayDay } from './days'

const files = {
  scenario: { name: 'tiny-1.json', text: scenarioText },
  greedy: { name: 'tiny-1-greedy.csv', text: greedyTrace },
  prices: { name: 'C:\\days\\tiny-1-prices.csv', text: pricesTrace },
}

describe('files', () => {
  it('make a day whose plays are named after their files', () => {
    const day = dayOfFiles([files.prices, files.scenario, files.greedy])
    expect(day.name).toBe('tiny-1')
    expect(day.plays.map(({ policy }) => policy)).toEqual(['prices', 'greedy'])
  })

  it('add traces to an existing day', () => {
    const former = dayOfFiles([files.scenario, files.greedy])
    expect(dayOfFiles([files.prices], former).plays.map(({ policy }) => policy)).toEqual(['greedy', 'prices'])
    expect(dayOfFiles([files.scenario, files.prices], former).plays.map(({ policy }) => policy)).toEqual([
      'prices',
    ])
  })

  it('keep the scenario and the end of the day to which they are added', () => {
    const former = { ...dayOfFiles([files.scenario, files.greedy]), until: 30_000 }
    const day = dayOfFiles([files.prices], former)
    expect(day.until).toBe(30_000)
    expect(day.scenario).toBe(former.scenario)
    expect(dayOfFiles([files.scenario, files.prices], former).until).toBeUndefined()
  })
})

describe('files that cannot be shown', () => {
  const faultsOf = (given: readonly { name: string; text: string }[], former?: ReplayDay) => {
    try {
      dayOfFiles(given, former)
    } catch (error) {
      if (error instanceof FilesError) return error.faults.map(({ file, fault }) => [file, fault.what])
      throw error
    }
    return []
  }
  const notes = { name: 'notes.csv', text: 'a,b\n1,2\n' }
  const hello = { name: 'hello.json', text: '{"hello": 1}' }
  const wrong = { name: 'wrong.csv', text: greedyTrace.replace('A02', 'B02') }

  it('are listed with their faults, without the valid ones', () => {
    expect(faultsOf([notes])).toEqual([['notes.csv', 'no-trace']])
    expect(faultsOf([hello])).toEqual([['hello.json', 'no-scenario']])
    expect(faultsOf([notes, hello, files.greedy])).toEqual([
      ['hello.json', 'no-scenario'],
      ['notes.csv', 'no-trace'],
    ])
    expect(faultsOf([files.scenario, notes, wrong])).toEqual([
      ['notes.csv', 'no-trace'],
      ['wrong.csv', 'unknown-id'],
    ])
    expect(faultsOf([files.scenario, { ...files.scenario, name: 'again.json' }, files.greedy])).toEqual([
      ['again.json', 'second-scenario'],
    ])
  })

  it('with a broken scenario, traces are not checked against the existing day', () => {
    const former = dayOfFiles([files.scenario, files.greedy])
    expect(faultsOf([hello, wrong], former)).toEqual([['hello.json', 'no-scenario']])
  })

  it('missing files are reported if the others are valid', () => {
    expect(faultsOf([files.greedy])).toEqual([[undefined, 'scenario-missing']])
    expect(faultsOf([files.scenario])).toEqual([[undefined, 'trace-missing']])
  })
})

it('a file with the same name replaces the earlier one', () => {
  const former = dayOfFiles([files.scenario, files.greedy])
  expect(dayOfFiles([files.greedy], former).plays).toHaveLength(1)
})

describe('with several plays', () => {
  const play = (policy: string, profit_usd: number): Play => ({ policy, trace: '', profit_usd })
  const plays = [play('random', 1), play('prices', 3), play('greedy', 2)]
  const chosen = (policy?: string, other?: string) => {
    const found = chosenPlays(plays, policy, other)
    return [found.play?.policy, found.other?.policy]
  }

  it('the best two are shown first', () => {
    expect(chosen()).toEqual(['prices', 'greedy'])
  })

  it('the plays named in an address are shown', () => {
    expect(chosen('random', 'prices')).toEqual(['random', 'prices'])
    expect(chosen('greedy')).toEqual(['greedy', 'prices'])
    expect(chosen('gone', 'gone')).toEqual(['prices', 'greedy'])
  })

  it('one play is shown alone if an address requires it, or if there is no other', () => {
    expect(chosen('greedy', '')).toEqual(['greedy', undefined])
    expect(chosenPlays(plays.slice(0, 1), undefined, undefined).other).toBeUndefined()
  })

  it('the first ones are shown if profits are unknown', () => {
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

  it('without a report has none', () => {
    expect(embeddedDays(' \n')).toEqual([])
  })
})
