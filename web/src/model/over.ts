// The service's rule for the end of a day (`LiveDay::is_over` in crates/sim/src/live.rs): there are
// no decisions left, and every aircraft is on the ground.

import type { AircraftState, DayState } from '../api/types'
import type { Seconds } from './record'
import { timeOf } from './time'

type Known = Pick<DayState, 'now' | 'aircraft'>

/** Whether a day whose operations end at a time is over. */
export function isOver({ now, aircraft }: Known, end: Seconds): boolean {
  const isPast = timeOf(now) > end
  return aircraft.every((one) => one.phase === 'standing' && (isPast || timeOf(one.ready) > end))
}

/**
 * Whether an aircraft's latest decision can be replaced by another. A flight that has not departed
 * can be cancelled at any time. If a hold were undone after the end of operations, the aircraft
 * could no longer be decided.
 */
export function canBeDecidedAgain(state: Known, aircraft: AircraftState, end: Seconds): boolean {
  if (aircraft.needs_decision || isOver(state, end)) return false
  return aircraft.phase !== 'standing' || timeOf(state.now) <= end
}
