// Where two policies first decide differently on the same day, and what that was worth. Up to there both days are the same, so
// the first difference is a choice between two legs from one situation.

import type { DayRecord, LegRecord, Seconds } from './record'

export interface FirstDifference {
  /** Position in both records' legs. */
  index: number
  time: Seconds
  /** What each day did there; undefined if its trace has ended. */
  one: LegRecord | undefined
  other: LegRecord | undefined
  /** The first day's profit of this leg less the other's. */
  atDecision_usd: number
  /** The first day's profit of the whole day less the other's: the worth of this and of all that followed. */
  atEnd_usd: number
}

/** The first decision in which two plays of the same day differ; undefined if they are the same to the end. */
export function firstDifference(one: DayRecord, other: DayRecord): FirstDifference | undefined {
  const longest = Math.max(one.legs.length, other.legs.length)
  for (let index = 0; index < longest; index++) {
    const [a, b] = [one.legs[index], other.legs[index]]
    if (a !== undefined && b !== undefined && isSameDecision(a, b)) continue
    return {
      index,
      time: Math.min(a?.decided ?? Infinity, b?.decided ?? Infinity),
      one: a,
      other: b,
      atDecision_usd: (a?.profit_usd ?? 0) - (b?.profit_usd ?? 0),
      atEnd_usd: sumOf(one) - sumOf(other),
    }
  }
  return undefined
}

function isSameDecision(one: LegRecord, other: LegRecord): boolean {
  return one.decided === other.decided && one.aircraft === other.aircraft && one.to === other.to
}

function sumOf(record: DayRecord): number {
  return record.legs.reduce((sum, leg) => sum + leg.profit_usd, 0)
}
