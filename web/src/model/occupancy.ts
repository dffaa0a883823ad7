// Who stands where, and how many stands are taken and promised. A stand is promised at the decision to fly towards a vertiport
// and free again at the decision to leave it (Eq. 16), so each stay of an aircraft holds one stand without a gap.

import { at, countUpTo } from './arrays'
import { NONE } from './motion'
import type { DayRecord, Seconds } from './record'
import { isHold } from './record'

/** The time in which an aircraft holds a stand. */
export interface Stay {
  aircraft: number
  vertiport: number
  /** The stand is promised from here on, taken from `arrives` on, charged until `ready`, free from `leaves` on. */
  promised: Seconds
  arrives: Seconds
  ready: Seconds
  /** Infinity for the last stay of the day. */
  leaves: Seconds
  /** Position in the record's legs of the flight that led here; NONE at the start of the day. */
  leg: number
}

/** All stays in the order in which they begin; those of the start of the day come first. */
export function staysOf(record: DayRecord): Stay[] {
  const first = record.aircraft.map((one, aircraft) => stayAtStart(aircraft, one.begins_at))
  const stays = [...first]
  const current = [...first]
  record.legs.forEach((leg, index) => {
    if (isHold(leg)) return
    const { aircraft, decided, arrives, ready } = leg
    at(current, aircraft).leaves = decided
    const stay = {
      aircraft,
      vertiport: leg.to,
      promised: decided,
      arrives,
      ready,
      leaves: Infinity,
      leg: index,
    }
    current[aircraft] = stay
    stays.push(stay)
  })
  return stays
}

function stayAtStart(aircraft: number, vertiport: number): Stay {
  const begin = -Infinity
  return { aircraft, vertiport, promised: begin, arrives: begin, ready: begin, leaves: Infinity, leg: NONE }
}

/** How many aircraft a vertiport has room for. */
export function roomOf({ stands, chargers }: { stands: number; chargers?: number }): number {
  return stands + (chargers ?? 0)
}

/** The number of aircraft at every vertiport and on their way to it, at any moment. */
export class Occupancy {
  readonly #promised: Float64Array[]
  readonly #arrived: Float64Array[]
  readonly #left: Float64Array[]

  constructor(record: DayRecord, stays: readonly Stay[] = staysOf(record)) {
    const times = (of: (stay: Stay) => Seconds) => {
      const lists: Seconds[][] = record.vertiports.map(() => [])
      for (const stay of stays) at(lists, stay.vertiport).push(of(stay))
      return lists.map((list) => Float64Array.from(list).sort())
    }
    this.#promised = times((stay) => stay.promised)
    this.#arrived = times((stay) => stay.arrives)
    this.#left = times((stay) => stay.leaves)
  }

  /** Aircraft that stand at a vertiport. */
  taken(vertiport: number, time: Seconds): number {
    return countUpTo(at(this.#arrived, vertiport), time) - countUpTo(at(this.#left, vertiport), time)
  }

  /** Aircraft that are on their way to it, for which a stand is kept. */
  promised(vertiport: number, time: Seconds): number {
    return countUpTo(at(this.#promised, vertiport), time) - countUpTo(at(this.#arrived, vertiport), time)
  }
}
