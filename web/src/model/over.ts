// When a day is over, by the service's rule (`LiveDay::is_over` in crates/sim/src/live.rs): nothing is left to decide, and every
// aircraft is on the ground.

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
 * Whether something else could be decided in the place of an aircraft's latest decision. A flight that has not departed can be called
 * off at any time; a hold that is taken back after the end of operations would leave an aircraft that can no longer be decided.
 */
export function canBeDecidedAnew(state: Known, aircraft: AircraftState, end: Seconds): boolean {
  if (aircraft.needs_decision || isOver(state, end)) return false
  return aircraft.phase !== 'standing' || timeOf(state.now) <= end
}
