import { beforeEach, describe, expect, it, vi } from 'vitest'
import type { Service } from '../api/client'
import { ProblemError } from '../api/problem'
import type { NewDecision, Proposal } from '../api/types'
import { problemText } from '../text/problems'
import { Advisor } from './advisor.svelte'

/**
 * A service that gives the advice set by the test, and takes decisions at the day's current event.
 */
class FakeService {
  to = 'V2'
  seq = 1
  decisions: (NewDecision & { seq: number | undefined })[] = []

  propose(_day: string, aircraft: string): Promise<Proposal> {
    const alternatives = ['V1', 'V2', 'V3'].map((to) => ({
      to,
      value: to === this.to ? 10 : 1,
      flight_profit_usd: 5,
      passengers: 4,
      arrival: '07:00:00',
      ready: '07:30:00',
      stands: 6,
      stands_taken: 1,
    }))
    return Promise.resolve({
      aircraft,
      at: 'V1',
      time: '06:00:00',
      seq: this.seq,
      to: this.to,
      policy: 'prices',
      took_us: 1,
      alternatives,
    })
  }

  decide(_day: string, body: NewDecision, seq?: number): Promise<{ seq: number; to: string }> {
    this.decisions.push({ ...body, seq })
    if (seq !== undefined && seq !== this.seq) {
      return Promise.reject(new ProblemError(412, 'V605', 'the day has gone on', undefined))
    }
    return Promise.resolve({ seq: this.seq + 1, to: body.to ?? this.to })
  }
}

let service: FakeService
let advisor: Advisor

beforeEach(async () => {
  vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout', 'performance'] })
  service = new FakeService()
  advisor = new Advisor('day', service as unknown as Service)
  await advisor.ask('A01')
})

async function dayMovesOn(to = service.to): Promise<void> {
  service.seq += 1
  service.to = to
  advisor.moveOn(service.seq)
  await vi.advanceTimersByTimeAsync(2000)
}

describe('advice', () => {
  it('is replaced by newer advice while the user does not work with it', async () => {
    await dayMovesOn('V3')
    expect(advisor.proposal?.to).toBe('V3')
    expect(advisor.newer).toBeUndefined()
  })

  it('stays while the user works with it, and offers newer advice', async () => {
    advisor.isEngaged = true
    await dayMovesOn('V3')
    expect(advisor.proposal?.to).toBe('V2')
    expect(advisor.newer?.to).toBe('V3')
    expect(advisor.canAccept).toBe(false)
    advisor.showNewer()
    expect(advisor.proposal?.to).toBe('V3')
  })

  it('is updated in place if it is the same', async () => {
    advisor.isEngaged = true
    await dayMovesOn()
    expect(advisor.proposal?.seq).toBe(2)
    expect(advisor.newer).toBeUndefined()
  })
})

describe('an acceptance', () => {
  it('accepts the displayed advice', async () => {
    await vi.advanceTimersByTimeAsync(500)
    expect(await advisor.accept()).toMatchObject({ kind: 'taken', taken: { to: 'V2' } })
    expect(service.decisions).toEqual([{ aircraft: 'A01', seq: 1 }])
  })

  it('is ignored for advice that has only just appeared', async () => {
    expect(advisor.canAccept).toBe(false)
    expect(await advisor.accept()).toEqual({ kind: 'none' })
    expect(service.decisions).toEqual([])
  })

  it('is retried when the day has advanced and the advice is the same', async () => {
    await vi.advanceTimersByTimeAsync(500)
    service.seq = 7
    expect((await advisor.accept()).kind).toBe('taken')
    expect(service.decisions.map((one) => one.seq)).toEqual([1, 7])
  })

  it('accepts nothing that was not displayed', async () => {
    await vi.advanceTimersByTimeAsync(500)
    service.seq = 7
    service.to = 'V3'
    expect(await advisor.accept()).toEqual({ kind: 'changed' })
    expect(advisor.proposal?.to).toBe('V2')
    expect(advisor.newer?.to).toBe('V3')
  })
})

it('an override has a destination and a reason', async () => {
  await advisor.override('V3', 'the crew lives there')
  expect(service.decisions).toEqual([
    { aircraft: 'A01', to: 'V3', reason: 'the crew lives there', seq: undefined },
  ])
})

it('the loser of a race is told what came first', async () => {
  const first = new ProblemError(412, 'V605', 'the day has gone on', undefined, 'A01 was sent to V3 by anna')
  vi.advanceTimersByTime(1_000)
  service.decide = () => Promise.reject(first)
  service.propose = () => Promise.reject(new ProblemError(422, 'V604', 'it is on its way', undefined))
  await expect(advisor.accept()).rejects.toBe(first)
  expect(problemText(first).title).toBe('A01 was sent to V3 by anna.')
})
