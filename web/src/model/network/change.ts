// Changes to the demand of a network: one pair, one period, one weight, or the whole model.

import { at, total } from '../arrays'
import { asDaily, byPeriod, rounded } from './demand'
import { demandMembers, draftOf, member, type DemandDraft, type Draft } from './draft'
import { addTable, append, apply, remove, set, type Splice } from './edits'
import type { Literal } from './literals'
import { TomlFile } from './toml'

const PASSENGER_DIGITS = 2
const PERCENT_DIGITS = 3

/** Whether single pairs of a model can be changed. */
export function hasPairs(demand: DemandDraft | undefined): boolean {
  return demand?.model === 'daily' || demand?.model === 'hourly'
}

/** Whether single periods of a model can be changed. */
export function hasShares(demand: DemandDraft | undefined): boolean {
  return demand !== undefined && demand.model !== 'equation1' && demand.model !== 'uniform'
}

/**
 * Sets the passengers of a pair per day. If they are given by period, all of its periods change by
 * the same factor.
 */
export function setPair(file: TomlFile, from: number, to: number, passengers: number): Splice[] {
  const draft = draftOf(file.value)
  const amount = rounded(Math.max(0, passengers), PASSENGER_DIGITS)
  if (draft.demand?.model === 'daily') return set(file, ['daily_demand', 'passengers', from, to], amount)
  return draft.demand?.model === 'hourly' ? setHourlyPair(file, draft, draft.demand, from, to, amount) : []
}

/** Sets the total passengers of a period. */
export function setPeriod(file: TomlFile, period: number, passengers: number): Splice[] {
  const draft = draftOf(file.value)
  const { demand } = draft
  const former = byPeriod(draft)[period] ?? 0
  if (demand?.model === 'hourly') return scalePeriod(file, demand, period, former, passengers)
  if (demand?.model !== 'daily' && demand?.model !== 'gravity') return []
  const share = demand.shares[period] ?? 0
  const perPercent = share > 0 ? former / share : passengersOfPercent(draft)
  const wanted = perPercent > 0 ? Math.max(0, passengers) / perPercent : 0
  return set(file, ['daily_demand', 'shares_percent', period], rounded(wanted, PERCENT_DIGITS))
}

/** The file with its demand converted to a table of pairs and shares of the day, from any model. */
export function withDailyDemand(file: TomlFile): string {
  const draft = draftOf(file.value)
  const { shares, passengers } = asDaily(draft)
  const former = draft.demand
  if (former === undefined || former.model === 'daily') return file.text
  if (former.model === 'gravity') {
    const without = new TomlFile(apply(file.text, remove(file, ['daily_demand', 'gravity'])))
    return apply(without.text, set(without, ['daily_demand', 'passengers'], passengers))
  }
  const table = demandMembers[former.model]
  const periods = member(file.value, [table, 'periods']) as Literal
  const added = { periods, shares_percent: shares, passengers }
  const both = new TomlFile(apply(file.text, addTable(file, ['daily_demand'], added, [table])))
  return apply(both.text, remove(both, [table]))
}

/** The passengers per percent of the shares over the whole day, for a period whose share is 0. */
function passengersOfPercent(draft: Draft): number {
  const all = draft.demand !== undefined && 'shares' in draft.demand ? draft.demand.shares : []
  const percent = total(all)
  const passengers = total(byPeriod(draft))
  return percent > 0 ? passengers / percent : 0
}

function setHourlyPair(
  file: TomlFile,
  draft: Draft,
  { pairs }: Extract<DemandDraft, { model: 'hourly' }>,
  from: number,
  to: number,
  amount: number,
): Splice[] {
  const [fromId, toId] = [draft.vertiports[from]?.id ?? '', draft.vertiports[to]?.id ?? '']
  const index = pairs.findIndex((pair) => pair.from === fromId && pair.to === toId)
  const former = index < 0 ? [] : at(pairs, index).passengers
  const spread = spreadLike(former, byPeriod(draft), amount)
  const path = ['hourly_demand', 'pairs']
  if (index >= 0) return set(file, [...path, index, 'passengers'], spread)
  return append(file, path, { from: fromId, to: toId, passengers: spread })
}

/**
 * Distributes an amount over the day like the pair's passengers, otherwise like all passengers,
 * otherwise evenly.
 */
function spreadLike(former: readonly number[], all: readonly number[], amount: number): number[] {
  const shape = total(former) > 0 ? former : total(all) > 0 ? all : all.map(() => 1)
  const unit = amount / Math.max(total(shape), Number.MIN_VALUE)
  return shape.map((one) => rounded(one * unit, PASSENGER_DIGITS))
}

function scalePeriod(
  file: TomlFile,
  { pairs }: Extract<DemandDraft, { model: 'hourly' }>,
  period: number,
  former: number,
  passengers: number,
): Splice[] {
  if (former <= 0) return []
  const factor = Math.max(0, passengers) / former
  return pairs.flatMap((pair, index) => {
    const amount = rounded((pair.passengers[period] ?? 0) * factor, PASSENGER_DIGITS)
    return set(file, ['hourly_demand', 'pairs', index, 'passengers', period], amount)
  })
}
