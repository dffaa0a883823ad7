// The mean passengers of each pair and period in a demand model, as defined in
// docs/src/reference/files.md. The service draws days from them; here they are only displayed.

import { at, total } from '../arrays'
import type { DemandDraft, Draft } from './draft'

/** Mean passengers of one pair in one period. */
export type MeanDemand = (period: number, from: number, to: number) => number

export function meanDemand(draft: Draft): MeanDemand {
  const { demand } = draft
  switch (demand?.model) {
    case undefined:
      return () => 0
    case 'daily':
      return (period, from, to) => ((demand.shares[period] ?? 0) / 100) * (demand.passengers[from]?.[to] ?? 0)
    case 'gravity':
      return gravity(demand)
    case 'hourly':
      return hourly(draft, demand)
    case 'equation1':
      return equation1(draft, demand)
    case 'uniform':
      return (_, from, to) => (from === to ? 0 : (demand.least + demand.most) / 2)
  }
}

/** Passengers of a whole day, [from][to]. */
export function byPair(draft: Draft): number[][] {
  const mean = meanDemand(draft)
  const size = draft.vertiports.length
  const periods = draft.periods.length
  return table(size, (from, to) => sum(periods, (period) => mean(period, from, to)))
}

/** Passengers of all pairs in each period. */
export function byPeriod(draft: Draft): number[] {
  const mean = meanDemand(draft)
  const size = draft.vertiports.length
  return draft.periods.map((_, period) => sum(size, (from) => sum(size, (to) => mean(period, from, to))))
}

/**
 * The same demand as a table of daily passengers with shares of the periods, for users who want to
 * change single pairs.
 */
export function asDaily(draft: Draft): { shares: number[]; passengers: number[][] } {
  const { demand } = draft
  if (demand?.model === 'daily') return demand
  if (demand?.model === 'gravity') {
    const { shares } = demand
    const whole = meanDemand({ ...draft, demand: { ...demand, shares: [100] } })
    return {
      shares,
      passengers: table(draft.vertiports.length, (from, to) => rounded(whole(0, from, to), 2)),
    }
  }
  const perPeriod = byPeriod(draft)
  const all = total(perPeriod)
  const shares = perPeriod.map((one) => rounded(all === 0 ? 0 : (100 * one) / all, 3))
  return { shares, passengers: byPair(draft).map((row) => row.map((one) => rounded(one, 2))) }
}

export function rounded(value: number, digits: number): number {
  return Number(value.toFixed(digits))
}

/** The product of two vertiports' weights, scaled so that the sum over all pairs is the total. */
function gravity({
  shares,
  total: passengers,
  weights,
}: Extract<DemandDraft, { model: 'gravity' }>): MeanDemand {
  const weight = sum(weights.length, (one) => at(weights, one))
  const squares = sum(weights.length, (one) => at(weights, one) ** 2)
  const all = weight ** 2 - squares
  const scale = all > 0 ? passengers / all : 0
  return (period, from, to) =>
    from === to ? 0 : ((shares[period] ?? 0) / 100) * scale * (weights[from] ?? 0) * (weights[to] ?? 0)
}

function hourly(draft: Draft, { pairs }: Extract<DemandDraft, { model: 'hourly' }>): MeanDemand {
  const byIds = new Map(pairs.map((pair) => [JSON.stringify([pair.from, pair.to]), pair.passengers]))
  const ids = draft.vertiports.map(({ id }) => id)
  return (period, from, to) => byIds.get(JSON.stringify([ids[from], ids[to]]))?.[period] ?? 0
}

/** Eq. 1: the first row that applies. */
function equation1(draft: Draft, model: Extract<DemandDraft, { model: 'equation1' }>): MeanDemand {
  const busy = draft.vertiports.map((one) => one.busy)
  return (period, from, to) => {
    if (from === to) return 0
    const [isFromBusy, isToBusy] = [busy[from] === true, busy[to] === true]
    const [isMorning, isEvening] = [period === model.morning, period === model.evening]
    const isPeak =
      (isFromBusy && isToBusy && (isMorning || isEvening)) ||
      (isToBusy && isMorning) ||
      (isFromBusy && isEvening)
    if (isPeak) return model.peak.mean
    return isFromBusy && isToBusy ? model.busyPairs.mean : model.otherwise.mean
  }
}

function table(size: number, cell: (from: number, to: number) => number): number[][] {
  return Array.from({ length: size }, (_, from) =>
    Array.from({ length: size }, (_, to) => (from === to ? 0 : cell(from, to))),
  )
}

function sum(count: number, of: (index: number) => number): number {
  let all = 0
  for (let index = 0; index < count; index++) all += of(index)
  return all
}
