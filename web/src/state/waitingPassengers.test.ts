import { beforeEach, describe, expect, it, vi } from 'vitest'
import type { Service } from '../api/client'
import { ProblemError } from '../api/problem'
import type { PeriodDemand } from '../api/types'
import type { Scenario } from '../model/scenario'
import { WaitingPassengers } from './waitingPassengers.svelte'

const scenario = { vertiports: [{ id: 'North' }, { id: 'East' }] } as unknown as Scenario

let asked: number
let answer: () => Promise<PeriodDemand>
let waiting: WaitingPassengers

function demandOf(seq: number, passengers: number): PeriodDemand {
  return { seq, period: '06:00:00', has_begun: true, pairs: [{ from: 'East', to: 'North', passengers }] }
}

beforeEach(() => {
  vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout', 'performance'] })
  asked = 0
  answer = () => Promise.resolve(demandOf(4, 9))
  const service = {
    demand: () => {
      asked += 1
      return answer()
    },
  }
  waiting = new WaitingPassengers('day', service as unknown as Service)
})

async function moveOn(seq: number): Promise<void> {
  waiting.moveOn(seq)
  await vi.advanceTimersByTimeAsync(5000)
}

describe('waiting passengers', () => {
  it('are unknown before the service has answered', async () => {
    expect(waiting.pairs(scenario)).toBeUndefined()
    await moveOn(4)
    expect(waiting.pairs(scenario)).toEqual([{ from: 1, to: 0, passengers: 9 }])
  })

  it('are requested again only when the day has advanced', async () => {
    await moveOn(4)
    await moveOn(4)
    expect(asked).toBe(1)
    answer = () => Promise.resolve(demandOf(5, 5))
    await moveOn(5)
    expect(asked).toBe(2)
    expect(waiting.pairs(scenario)).toEqual([{ from: 1, to: 0, passengers: 5 }])
  })

  it('are unknown while the service does not answer', async () => {
    await moveOn(4)
    answer = () => Promise.reject(new ProblemError(503, 'V600', 'busy', undefined))
    await moveOn(5)
    expect(waiting.pairs(scenario)).toBeUndefined()
  })
})
