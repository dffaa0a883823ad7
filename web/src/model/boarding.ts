// Assigns the passengers of a day's flights to demand periods. Passengers who were not carried in
// their period wait into the next one for `passenger_wait_s`. A flight carries those who have
// waited first (docs/src/concepts/model.md).

import { at, countUpTo } from './arrays'
import type { DayRecord, LegRecord, Seconds } from './record'

/** The number of a flight's passengers from each period. */
export type Boarded = { period: number; passengers: number }[]

/** Follows the flights of a day in the order of their decisions. */
export class Boarding {
  readonly #size: number
  /** Passengers who have not been carried, by period, then by origin and destination. */
  readonly #left: Float64Array[]

  constructor(readonly record: DayRecord) {
    this.#size = record.vertiports.length
    this.#left = record.periods.map((_, period) => {
      const left = new Float64Array(this.#size ** 2)
      const table = record.demand?.passengers[period] ?? []
      table.forEach((row, from) => left.set(row, from * this.#size))
      return left
    })
  }

  /** Boards the passengers of the next decision, and returns the periods they come from. */
  board({ decided, from, to, passengers }: LegRecord): Boarded {
    const pair = from * this.#size + to
    const boarded: Boarded = []
    let room = passengers
    const periods = this.periodsAt(decided)
    periods.forEach((period, index) => {
      const left = at(this.#left, period)
      // A day that is not over may have carried more passengers than the forecast has.
      const taken = index === periods.length - 1 ? room : Math.min(room, at(left, pair))
      left[pair] = Math.max(0, at(left, pair) - taken)
      room -= taken
      if (taken > 0) boarded.push({ period, passengers: taken })
    })
    return boarded
  }

  /**
   * The periods whose passengers can be carried at a time, the earlier first; none before the first
   * period.
   */
  periodsAt(time: Seconds): number[] {
    const period = countUpTo(this.record.periods, time) - 1
    if (period < 0) return []
    const gone = at(this.record.periods, period) + this.record.passenger_wait_s
    return period > 0 && time < gone ? [period - 1, period] : [period]
  }

  /** Calls a function for each pair with waiting passengers at a time, with their number. */
  forEachWaiting(time: Seconds, call: (from: number, to: number, passengers: number) => void): void {
    const tables = this.periodsAt(time).map((period) => at(this.#left, period))
    for (let pair = 0; pair < this.#size ** 2; pair++) {
      const passengers = tables.reduce((sum, table) => sum + at(table, pair), 0)
      if (passengers > 0) call(Math.floor(pair / this.#size), pair % this.#size, passengers)
    }
  }
}
