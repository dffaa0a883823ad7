// Passengers who want to fly, have not been carried yet, and still can be.

import { at, countUpTo } from './arrays'
import { Boarding } from './boarding'
import type { DayRecord, Seconds } from './record'

/** Passengers who wait for a flight between two vertiports. */
export interface WaitingPair {
  from: number
  to: number
  passengers: number
}

/** Follows a day. Moving forward is cheap; moving back recounts from the beginning of the day. */
export class Waiting {
  readonly #decided: Float64Array
  #boarding: Boarding
  /** The number of legs counted so far. */
  #counted = 0
  /** The periods whose passengers the pairs contain. */
  #periods = ''
  #pairs: WaitingPair[] = []

  constructor(readonly record: DayRecord) {
    this.#decided = Float64Array.from(record.legs, (leg) => leg.decided)
    this.#boarding = new Boarding(record)
  }

  /** The pairs with passengers at a time. The list is the same object while nothing changes. */
  pairs(time: Seconds): readonly WaitingPair[] {
    const periods = this.#boarding.periodsAt(time).join()
    const taken = countUpTo(this.#decided, time)
    if (periods === this.#periods && taken === this.#counted) return this.#pairs
    if (taken < this.#counted) {
      this.#boarding = new Boarding(this.record)
      this.#counted = 0
    }
    for (; this.#counted < taken; this.#counted++) this.#boarding.board(at(this.record.legs, this.#counted))
    const pairs: WaitingPair[] = []
    this.#boarding.forEachWaiting(time, (from, to, passengers) => pairs.push({ from, to, passengers }))
    this.#periods = periods
    this.#pairs = pairs
    return pairs
  }
}
