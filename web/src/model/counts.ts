// Counts the aircraft that hold stands of each vertiport, that fly, and that are overdue. The map
// and the lists next to it share these counts.

import { at } from './arrays'
import { NONE, Phase, type FleetFrame } from './motion'
import type { DayRecord } from './record'

/** The states of a stand, in the order of the pieces of a ring. */
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
/** The number of states that are counted; the others follow from these. */
export const COUNTED = 5

const STATE_OF_PHASE: Record<Phase, StandState> = {
  [Phase.waiting]: StandState.waiting,
  [Phase.charging]: StandState.charging,
  [Phase.holding]: StandState.holding,
  [Phase.out]: StandState.out,
  [Phase.delayed]: StandState.promised,
  [Phase.flying]: StandState.promised,
}

/** The destination of an aircraft, also if its flight is delayed; NONE if it stands. */
export function destinationOf({ legs }: DayRecord, frame: FleetFrame, aircraft: number): number {
  const phase = at(frame.phases, aircraft)
  if (phase !== Phase.flying && phase !== Phase.delayed) return NONE
  return at(legs, at(frame.legs, aircraft)).to
}

/** The vertiport whose stand an aircraft holds: where it stands, or its destination. */
export function holdingOf(
  record: DayRecord,
  frame: FleetFrame,
  aircraft: number,
): { vertiport: number; state: StandState } {
  const destination = destinationOf(record, frame, aircraft)
  const state = STATE_OF_PHASE[at(frame.phases, aircraft) as Phase]
  return { vertiport: destination === NONE ? at(frame.stands, aircraft) : destination, state }
}

/** Counts of the aircraft at one time. One object is updated for every frame. */
export class Counts {
  inTheAir = 0
  overdue = 0
  /**
   * Increases when a number has changed. A take-off changes only that of aircraft in the air, since
   * the stand at the destination is promised before it.
   */
  revision = 0
  /** The number of stands held at each vertiport, by counted state. */
  held: Uint16Array
  /** The number of overdue aircraft on their way to each vertiport. */
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
    const formerInTheAir = this.inTheAir
    ;[this.inTheAir, this.overdue] = [0, 0]
    this.held.fill(0)
    this.#overdueTo.fill(0)
    for (let aircraft = 0; aircraft < frame.size; aircraft++) this.#add(aircraft, frame)
    const isSame =
      this.inTheAir === formerInTheAir &&
      !differ(this.held, this.#formerHeld) &&
      !differ(this.#overdueTo, this.#formerOverdueTo)
    if (!isSame) this.revision++
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

  /**
   * The number of aircraft that stand at a vertiport, of those with a promised stand there, and of
   * the overdue among these.
   */
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
