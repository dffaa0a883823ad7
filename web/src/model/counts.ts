// How many aircraft hold the stands of each vertiport, fly, and are overdue. The map and the lists beside it all count with this.

import { at } from './arrays'
import { NONE, Phase, type FleetFrame } from './motion'
import type { DayRecord } from './record'

/** What holds a stand, in the order in which the pieces of a ring follow each other. */
export const StandState = {
  waiting: 0,
  holding: 1,
  charging: 2,
  out: 3,
  promised: 4,
  free: 5,
  over: 6,
} as const
export type StandState = (typeof StandState)[keyof typeof StandState]
/** States that are counted; the others follow from these. */
export const COUNTED = 5

const STATE_OF_PHASE: Record<Phase, StandState> = {
  [Phase.waiting]: StandState.waiting,
  [Phase.charging]: StandState.charging,
  [Phase.holding]: StandState.holding,
  [Phase.out]: StandState.out,
  [Phase.delayed]: StandState.promised,
  [Phase.flying]: StandState.promised,
}

/** Where an aircraft flies to, or would if it were not delayed; NONE for one that stands. */
export function destinationOf({ legs }: DayRecord, frame: FleetFrame, aircraft: number): number {
  const phase = at(frame.phases, aircraft)
  if (phase !== Phase.flying && phase !== Phase.delayed) return NONE
  return at(legs, at(frame.legs, aircraft)).to
}

/** The vertiport of which an aircraft holds a stand: where it stands, or where it is sent. */
export function holdingOf(
  record: DayRecord,
  frame: FleetFrame,
  aircraft: number,
): { vertiport: number; state: StandState } {
  const destination = destinationOf(record, frame, aircraft)
  const state = STATE_OF_PHASE[at(frame.phases, aircraft) as Phase]
  return { vertiport: destination === NONE ? at(frame.stands, aircraft) : destination, state }
}

/** The aircraft of a moment, counted; one object counts moment after moment. */
export class Counts {
  inTheAir = 0
  overdue = 0
  /** Rises when a number of a vertiport has changed. */
  revision = 0
  /** So many hold stands of each vertiport in each counted state. */
  held: Uint16Array
  /** So many that are sent to each vertiport are overdue. */
  #overdueTo: Uint16Array
  #formerHeld: Uint16Array
  #formerOverdueTo: Uint16Array

  constructor(private readonly record: DayRecord) {
    const vertiports = record.vertiports.length
    this.held = new Uint16Array(COUNTED * vertiports)
    this.#formerHeld = new Uint16Array(COUNTED * vertiports)
    this.#overdueTo = new Uint16Array(vertiports)
    this.#formerOverdueTo = new Uint16Array(vertiports)
  }

  count(frame: FleetFrame): void {
    ;[this.held, this.#formerHeld] = [this.#formerHeld, this.held]
    ;[this.#overdueTo, this.#formerOverdueTo] = [this.#formerOverdueTo, this.#overdueTo]
    ;[this.inTheAir, this.overdue] = [0, 0]
    this.held.fill(0)
    this.#overdueTo.fill(0)
    for (let aircraft = 0; aircraft < frame.size; aircraft++) this.#add(aircraft, frame)
    if (differ(this.held, this.#formerHeld) || differ(this.#overdueTo, this.#formerOverdueTo)) this.revision++
  }

  #add(aircraft: number, frame: FleetFrame): void {
    const { vertiport, state } = holdingOf(this.record, frame, aircraft)
    const slot = COUNTED * vertiport + state
    this.held[slot] = at(this.held, slot) + 1
    if (at(frame.phases, aircraft) === Phase.flying) this.inTheAir++
    if (at(frame.overdue_min, aircraft) === 0) return
    this.overdue++
    this.#overdueTo[vertiport] = at(this.#overdueTo, vertiport) + 1
  }

  /** Aircraft that stand at a vertiport, those that are promised a stand there, and how many of these are overdue. */
  standsOf(vertiport: number): { taken: number; promised: number; overdue: number } {
    const promised = at(this.held, COUNTED * vertiport + StandState.promised)
    let all = 0
    for (let state = 0; state < COUNTED; state++) all += at(this.held, COUNTED * vertiport + state)
    return { taken: all - promised, promised, overdue: at(this.#overdueTo, vertiport) }
  }
}

function differ(one: Uint16Array, other: Uint16Array): boolean {
  return one.some((number, index) => number !== other[index])
}
