// Passengers who want to fly and have not been carried yet. They wait within the period of their demand and no longer: who is
// not carried in it is spilled.

import { at, countUpTo } from './arrays'
import type { DayRecord, Seconds } from './record'

/** Passengers who wait for a flight between two vertiports. */
export interface WaitingPair {
  from: number
  to: number
  passengers: number
}

/** Follows a day: going on is cheap, going back counts the period again. */
export class Waiting {
  readonly #decided: Float64Array
  readonly #size: number
  /** Passengers left, by origin and destination. */
  #left: Float64Array
  #period = -1
  /** How many legs have been counted. */
  #counted = 0
  #pairs: WaitingPair[] = []

  constructor(readonly record: DayRecord) {
    this.#decided = Float64Array.from(record.legs, (leg) => leg.decided)
    this.#size = record.vertiports.length
    this.#left = new Float64Array(this.#size ** 2)
  }

  /** The pairs with passengers at a time. The list is the same object as long as nothing has changed. */
  pairs(time: Seconds): readonly WaitingPair[] {
    const period = this.#periodAt(time)
    const taken = countUpTo(this.#decided, time)
    if (period === this.#period && taken === this.#counted) return this.#pairs
    if (period !== this.#period || taken < this.#counted) this.#begin(period)
    for (let leg = this.#counted; leg < taken; leg++) this.#carry(leg)
    this.#counted = taken
    this.#pairs = this.#list()
    return this.#pairs
  }

  #periodAt(time: Seconds): number {
    return countUpTo(this.record.periods, time) - 1
  }

  #begin(period: number): void {
    const begins = this.record.periods[period] ?? -Infinity
    const table = this.record.demand?.passengers[period] ?? []
    this.#left = new Float64Array(this.#size ** 2)
    table.forEach((row, from) => this.#left.set(row, from * this.#size))
    this.#period = period
    this.#counted = countUpTo(this.#decided, begins - 0.5)
  }

  #carry(index: number): void {
    const { from, to, passengers } = at(this.record.legs, index)
    const pair = from * this.#size + to
    this.#left[pair] = Math.max(0, at(this.#left, pair) - passengers)
  }

  #list(): WaitingPair[] {
    const pairs: WaitingPair[] = []
    this.#left.forEach((passengers, pair) => {
      if (passengers > 0)
        pairs.push({ from: Math.floor(pair / this.#size), to: pair % this.#size, passengers })
    })
    return pairs
  }
}
