// The results of a study in text and pictures. Statistics come from the service. The exception is
// the difference of two studies, which the service does not compare.

import type { PolicyResult, StudyResult } from '../api/types'
import { total } from './arrays'
import { dollarDifference, dollars, percent } from './money'

/** The best policy and its lead over another one. */
export interface Headline {
  policy: string
  profit: string
  /** Its share of the proven bound. */
  share: string | undefined
  lead: Lead | undefined
}

export interface Lead {
  other: string
  difference: string
  /** The 95 % interval of the difference; undefined with one day. */
  interval: string | undefined
  p: string
  /** Whether the difference is significant at the 5 % level. */
  isSignificant: boolean
}

const SIGNIFICANCE = 0.05
/** Smaller values are not written out. */
const LEAST_P = 0.001

/** A reference uses the days in advance and is not a policy. */
export function isReference({ sees }: PolicyResult): boolean {
  return sees === 'whole-day'
}

export function headlineOf({ policies }: StudyResult): Headline | undefined {
  const ranked = policies
    .filter((policy) => !isReference(policy))
    .toSorted((one, other) => other.profit_usd.mean - one.profit_usd.mean)
  const best = ranked[0]
  if (best === undefined) return undefined
  return {
    policy: best.name,
    profit: dollars(best.profit_usd.mean),
    share: best.bound_share == null ? undefined : percent(best.bound_share.mean, 1),
    lead: leadOf(policies, best, ranked[1]),
  }
}

/**
 * The lead over the first policy, or the lead of the first over the next best one. Differences are
 * relative to the first policy, so the latter has its sign reversed.
 */
function leadOf(
  policies: PolicyResult[],
  best: PolicyResult,
  second: PolicyResult | undefined,
): Lead | undefined {
  const first = policies[0]
  const isFirst = best === first
  const difference = isFirst ? second?.minus_first : best.minus_first
  const other = isFirst ? second : first
  if (difference == null || other === undefined) return undefined
  const mean = isFirst ? -difference.profit_usd.mean : difference.profit_usd.mean
  const half = difference.profit_usd.half_width_95
  return {
    other: other.name,
    difference: dollarDifference(mean),
    interval:
      half == null ? undefined : `${dollarDifference(mean - half)} to ${dollarDifference(mean + half)}`,
    p: pStatement(difference.p_value),
    isSignificant: difference.p_value != null && difference.p_value < SIGNIFICANCE,
  }
}

/** `p = 0.021`, or `p < 0.001` for smaller values. */
export function pStatement(p: number | null | undefined): string {
  if (p == null) return 'p unknown'
  return p < LEAST_P ? `p ${pValue(p)}` : `p = ${pValue(p)}`
}

/** The value without `p`, for a column with that heading. */
export function pValue(p: number | null | undefined): string {
  if (p == null) return '–'
  return p < LEAST_P ? `< ${LEAST_P}` : p.toFixed(3)
}

/** A mean with half of its interval: `$37,149 ± 320`. */
export function estimate({ mean, half_width_95 }: PolicyResult['profit_usd'], isDifference = false): string {
  const text = isDifference ? dollarDifference(mean) : dollars(mean)
  return half_width_95 == null ? text : `${text} ± ${Math.round(half_width_95).toLocaleString('en-US')}`
}

/** A mean with half of its 95 % interval, which is null for one day. */
export interface Interval {
  mean: number
  half_width_95: number | null
}

/**
 * The difference in daily profit between two studies with days of the same seeds, which pair them;
 * undefined if the numbers of days differ. The t factor for this number of days is taken from the
 * service's result: its half width divided by its standard deviation.
 */
export function pairedDifference(one: PolicyResult, other: PolicyResult): Interval | undefined {
  const differences = one.daily_profit_usd.map((profit, day) => profit - (other.daily_profit_usd[day] ?? NaN))
  if (one.daily_profit_usd.length !== other.daily_profit_usd.length || differences.length === 0)
    return undefined
  const mean = total(differences) / differences.length
  const squares = differences.reduce((sum, each) => sum + (each - mean) ** 2, 0)
  const deviation = Math.sqrt(squares / (differences.length - 1))
  const factor = studentsFactor(one) ?? studentsFactor(other)
  return { mean, half_width_95: factor === undefined ? null : factor * deviation }
}

function studentsFactor({
  profit_usd: { half_width_95, standard_deviation },
}: PolicyResult): number | undefined {
  if (half_width_95 == null || standard_deviation == null || standard_deviation === 0) return undefined
  return half_width_95 / standard_deviation
}

/** Whether a mean differs significantly from 0 (5 % level). */
export function isMoreThanChance({ mean, half_width_95 }: Interval): boolean {
  return half_width_95 !== null && Math.abs(mean) > half_width_95
}

/**
 * The difference in profit between two policies on each day, the best day first. Days are numbered
 * from 0.
 */
export function dailyDifferences(
  policy: PolicyResult,
  first: PolicyResult,
): { day: number; difference_usd: number }[] {
  const differences = policy.daily_profit_usd.map((profit, day) => ({
    day,
    difference_usd: profit - (first.daily_profit_usd[day] ?? 0),
  }))
  return differences.toSorted((one, other) => other.difference_usd - one.difference_usd)
}

/** An axis of dollars: its ends and round ticks between them. */
export interface Axis {
  from: number
  to: number
  ticks: number[]
}

/** An axis around values, with about this number of ticks. */
export function axisAround(values: readonly number[], ticks: number): Axis {
  const [least, most] = [Math.min(...values), Math.max(...values)]
  const span = most - least || Math.max(1, Math.abs(most))
  const step = roundStep(span / Math.max(1, ticks - 1))
  const first = Math.floor(least / step)
  const last = Math.max(first + 1, Math.ceil(most / step))
  return {
    from: first * step,
    to: last * step,
    ticks: Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step),
  }
}

function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least))
  return ([1, 2, 5].find((one) => one * power >= least * (1 - 1e-9)) ?? 10) * power
}
