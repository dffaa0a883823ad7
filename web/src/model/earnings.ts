// The profit of a day over time, and the demand and passengers of each period: the curves above a
// scrubber.

import { at, countUpTo, total } from './arrays'
import { Boarding } from './boarding'
import type { DayRecord, Seconds } from './record'
import { isHold } from './record'

/** The sums of a day up to a time. */
export interface Sums {
  profit_usd: number
  passengers: number
  flights: number
  repositioning_flights: number
  holds: number
}

/**
 * The sums of a day at any time. Flights count from their decision on, as in the program's ledger.
 */
export class Earnings {
  readonly times: Float64Array
  /** After each leg, the cost of the fleet subtracted. */
  readonly profits: Float64Array
  readonly #passengers: Float64Array
  readonly #flights: Float64Array
  readonly #repositioning: Float64Array
  /** Before the first leg. */
  readonly #first_usd: number

  constructor(record: DayRecord, fixedCost_usd = 0) {
    const { legs } = record
    this.#first_usd = 0 - fixedCost_usd
    this.times = Float64Array.from(legs, (leg) => leg.decided)
    this.profits = summed(
      legs.map((leg) => leg.profit_usd),
      this.#first_usd,
    )
    this.#passengers = summed(legs.map((leg) => leg.passengers))
    this.#flights = summed(legs.map((leg) => Number(!isHold(leg))))
    this.#repositioning = summed(legs.map((leg) => Number(!isHold(leg) && leg.passengers === 0)))
  }

  at(time: Seconds): Sums {
    const taken = countUpTo(this.times, time)
    const flights = taken === 0 ? 0 : at(this.#flights, taken - 1)
    return {
      profit_usd: taken === 0 ? this.#first_usd : at(this.profits, taken - 1),
      passengers: taken === 0 ? 0 : at(this.#passengers, taken - 1),
      flights,
      repositioning_flights: taken === 0 ? 0 : at(this.#repositioning, taken - 1),
      holds: taken - flights,
    }
  }

  /** The profit of the whole day. */
  get total_usd(): number {
    return this.profits.at(-1) ?? this.#first_usd
  }

  /** The lowest and highest profit of the day; the range includes 0. */
  get range(): [number, number] {
    const extremes: [number, number] = [Math.min(0, this.#first_usd), 0]
    for (const profit of this.profits) {
      extremes[0] = Math.min(extremes[0], profit)
      extremes[1] = Math.max(extremes[1], profit)
    }
    return extremes
  }
}

function summed(amounts: readonly number[], first = 0): Float64Array {
  let sum = first
  return Float64Array.from(amounts, (amount) => (sum += amount))
}

/** Passengers of a period: the demand, and those carried by flights. */
export interface PeriodSums {
  begins: Seconds
  ends: Seconds
  wanted: number
  carried: number
}

/**
 * Demand by period, up to the end of operations. Passengers count in the period in which they
 * wanted to fly.
 */
export function demandByPeriod(record: DayRecord): PeriodSums[] {
  const sums = record.periods.map((begins, index): PeriodSums => {
    const table = record.demand?.passengers[index] ?? []
    const wanted = total(table.flat())
    return { begins, ends: record.periods[index + 1] ?? record.end, wanted, carried: 0 }
  })
  const boarding = new Boarding(record)
  for (const leg of record.legs) {
    for (const { period, passengers } of boarding.board(leg)) at(sums, period).carried += passengers
  }
  return sums.filter((one) => one.ends > one.begins)
}
