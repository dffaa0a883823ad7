// The position, phase and approximate charge of every aircraft at a time. A fleet is prepared once
// per record. After that a frame only searches the legs of each aircraft and allocates nothing.

import { at, countUpTo, NONE } from './arrays'
import { latenessOf, minutesOverdue } from './awaited'
import { Charges } from './charges'
import { Geography } from './geography'
import type { DayRecord, LegRecord, Seconds } from './record'
import { isHold } from './record'

export { NONE }

/** The phase of an aircraft. */
export const Phase = {
  /** It is ready, and its next flight is not decided. */
  waiting: 0,
  charging: 1,
  holding: 2,
  /** It is to fly, but may not take off yet. */
  delayed: 3,
  flying: 4,
  /** It is out of service. */
  out: 5,
} as const
export type Phase = (typeof Phase)[keyof typeof Phase]

/** The fleet at one time, with one element for each aircraft. */
export class FleetFrame {
  time: Seconds = NaN
  /** Degrees or miles east and north, two numbers for each aircraft. */
  readonly places: Float64Array
  /** Degrees clockwise from north; 0 while the aircraft stands. */
  readonly headings: Float32Array
  /** 0 on the ground, 1 at cruise. */
  readonly lifts: Float32Array
  readonly phases: Uint8Array
  /** An estimate of the share of the battery that is charged, 0 to 1. */
  readonly charges: Float32Array
  /** Position in the record's legs of the aircraft's current leg, or NONE before the first. */
  readonly legs: Int32Array
  /** The vertiport where it stands, or NONE in the air. */
  readonly stands: Int32Array
  /** Whole minutes by which its departure or landing is overdue; 0 if it is not. */
  readonly overdue_min: Int32Array

  constructor(readonly size: number) {
    this.places = new Float64Array(2 * size)
    this.headings = new Float32Array(size)
    this.lifts = new Float32Array(size)
    this.phases = new Uint8Array(size)
    this.charges = new Float32Array(size)
    this.legs = new Int32Array(size)
    this.stands = new Int32Array(size)
    this.overdue_min = new Int32Array(size)
  }
}

/** The legs of all aircraft as numbers, one aircraft after the other. */
export class Fleet {
  readonly geography: Geography
  /** Where the legs of each aircraft begin; it has one more element than there are aircraft. */
  readonly #begins: Int32Array
  readonly #legs: Int32Array
  readonly #decided: Float64Array
  /** The charge of every aircraft along its legs. */
  readonly charges: Charges

  constructor(readonly record: DayRecord) {
    const { aircraft, legs } = record
    this.geography = new Geography(record.vertiports)
    this.#begins = new Int32Array(aircraft.length + 1)
    this.#legs = new Int32Array(legs.length)
    this.#decided = new Float64Array(legs.length)
    this.#sortByAircraft()
    this.charges = new Charges(record)
  }

  /** A counting sort, which keeps the order of time. */
  #sortByAircraft(): void {
    const { legs } = this.record
    for (const leg of legs) this.#begins[leg.aircraft + 1] = at(this.#begins, leg.aircraft + 1) + 1
    for (let one = 1; one < this.#begins.length; one++) {
      this.#begins[one] = at(this.#begins, one) + at(this.#begins, one - 1)
    }
    const next = this.#begins.slice()
    legs.forEach((leg, index) => {
      const slot = at(next, leg.aircraft)
      next[leg.aircraft] = slot + 1
      this.#legs[slot] = index
      this.#decided[slot] = leg.decided
    })
  }

  /** A frame of the right size, which `show` can fill repeatedly. */
  frame(): FleetFrame {
    return new FleetFrame(this.record.aircraft.length)
  }

  /** The legs of an aircraft as positions in the record's legs, in chronological order. */
  legsOf(aircraft: number): Int32Array {
    return this.#legs.subarray(at(this.#begins, aircraft), at(this.#begins, aircraft + 1))
  }

  /** Writes the fleet at a time to a frame. */
  show(time: Seconds, frame: FleetFrame): void {
    frame.time = time
    for (let one = 0; one < frame.size; one++) this.#showAircraft(one, time, frame)
    for (const outage of this.record.outages) {
      const isOut = time >= outage.since && time < (outage.until ?? Infinity)
      if (isOut && this.#isDocked(frame, outage.aircraft)) frame.phases[outage.aircraft] = Phase.out
    }
  }

  /** Whether an aircraft stands and keeps its stand: one that was sent off has another promised. */
  #isDocked({ phases, stands }: FleetFrame, aircraft: number): boolean {
    return at(stands, aircraft) !== NONE && at(phases, aircraft) !== Phase.delayed
  }

  #showAircraft(one: number, time: Seconds, frame: FleetFrame): void {
    const begin = at(this.#begins, one)
    const taken = countUpTo(this.#decided, time, begin, at(this.#begins, one + 1) - begin)
    if (taken === 0) this.#showAtStart(one, time, frame)
    else this.#showOnLeg(one, begin + taken - 1, time, frame)
  }

  #showAtStart(one: number, time: Seconds, frame: FleetFrame): void {
    const aircraft = at(this.record.aircraft, one)
    this.#stand(one, aircraft.begins_at, frame)
    frame.legs[one] = NONE
    frame.charges[one] = this.charges.atStart(one, time)
    frame.phases[one] = Phase.waiting
    frame.overdue_min[one] = 0
  }

  #showOnLeg(one: number, slot: number, time: Seconds, frame: FleetFrame): void {
    const position = at(this.#legs, slot)
    const leg = at(this.record.legs, position)
    frame.legs[one] = position
    frame.overdue_min[one] = minutesOverdue(leg, time)
    const isOnGround = time < leg.departs || leg.awaited?.report === 'departure'
    if (isOnGround || (isHold(leg) && time < leg.ready)) {
      this.#stand(one, leg.from, frame)
      frame.phases[one] = isHold(leg) ? Phase.holding : Phase.delayed
      frame.charges[one] = this.charges.before(position, time)
    } else if (time < leg.arrives || leg.awaited !== undefined) {
      this.#fly(one, leg, time, frame)
      const [before, after] = [this.charges.departing(position), this.charges.arriving(position)]
      frame.charges[one] = before + (after - before) * shareOfTime(leg, time)
    } else {
      this.#stand(one, leg.to, frame)
      frame.phases[one] = time < leg.ready ? Phase.charging : Phase.waiting
      // Where aircraft charge to full, one that is ready is full.
      const isFull = time >= leg.ready && this.record.chargesAsNeeded !== true
      frame.charges[one] = isFull ? 1 : this.charges.after(position, time)
    }
  }

  #stand(one: number, vertiport: number, frame: FleetFrame): void {
    frame.places[2 * one] = at(this.geography.places, 2 * vertiport)
    frame.places[2 * one + 1] = at(this.geography.places, 2 * vertiport + 1)
    frame.headings[one] = 0
    frame.lifts[one] = 0
    frame.stands[one] = vertiport
  }

  #fly(one: number, leg: LegRecord, time: Seconds, frame: FleetFrame): void {
    const { takeoff_s, landing_s } = this.record
    // A flight whose landing is due and not reported goes back out to its approach and stays there.
    const whole_s = leg.arrives - leg.departs
    const left_s = Math.max(leg.arrives - time, Math.min(latenessOf(leg, time), landing_s / 2, whole_s / 2))
    const flown_s = whole_s - left_s
    const share = shareOfWay(flown_s, left_s, takeoff_s, landing_s)
    this.geography.along(leg.from, leg.to, share, frame.places, frame.headings, one)
    frame.lifts[one] = Math.min(1, ramp(flown_s, takeoff_s), ramp(left_s, landing_s))
    frame.phases[one] = Phase.flying
    frame.stands[one] = NONE
  }
}

/**
 * The share of the route that is flown: speed rises linearly during take-off and falls linearly
 * during landing.
 */
export function shareOfWay(flown_s: number, left_s: number, takeoff_s: number, landing_s: number): number {
  const total_s = flown_s + left_s
  if (total_s <= 0) return 1
  // If a flight is shorter than its take-off and landing, both are shortened in proportion.
  const fit = Math.min(1, total_s / Math.max(takeoff_s + landing_s, 1e-9))
  const [up_s, down_s] = [takeoff_s * fit, landing_s * fit]
  const whole = total_s - (up_s + down_s) / 2
  if (flown_s < up_s) return flown_s ** 2 / (2 * up_s) / whole
  if (left_s < down_s) return 1 - left_s ** 2 / (2 * down_s) / whole
  return (flown_s - up_s / 2) / whole
}

function ramp(passed_s: number, whole_s: number): number {
  return whole_s <= 0 ? 1 : passed_s / whole_s
}

function shareOfTime(leg: LegRecord, time: Seconds): number {
  return Math.min(1, (time - leg.departs) / Math.max(leg.arrives - leg.departs, 1e-9))
}
