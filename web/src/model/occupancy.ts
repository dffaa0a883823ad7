// The stays of aircraft at stands. A stand is promised at the decision to fly towards a vertiport.
// It is freed at the decision to leave it (Eq. 16), so each stay holds one stand without a gap.

import { at } from './arrays'
import { NONE } from './motion'
import type { DayRecord, Seconds } from './record'
import { isHold } from './record'

/** The time during which an aircraft holds a stand. */
export interface Stay {
  aircraft: number
  vertiport: number
  /**
   * The stand is promised from `promised`, taken from `arrives`, and free again from `leaves`; the
   * aircraft charges until `ready`.
   */
  promised: Seconds
  arrives: Seconds
  ready: Seconds
  /** Infinity for the last stay of the day. */
  leaves: Seconds
  /** Position in the record's legs of the flight to this stand; NONE at the start of the day. */
  leg: number
}

/** All stays in the order in which they begin; those of the start of the day come first. */
export function staysOf(record: DayRecord): Stay[] {
  const first = record.aircraft.map((one, aircraft) => stayAtStart(aircraft, one.begins_at))
  const stays = [...first]
  const current = [...first]
  record.legs.forEach((leg, index) => {
    const { aircraft, decided, arrives, ready } = leg
    // A hold elsewhere is an aircraft that was moved there.
    if (isHold(leg) && at(current, aircraft).vertiport === leg.to) return
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

/** The number of aircraft that fit at a vertiport. */
export function roomOf({ stands, chargers }: { stands: number; chargers?: number }): number {
  return stands + (chargers ?? 0)
}
