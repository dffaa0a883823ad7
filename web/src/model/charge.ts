// What the battery of an aircraft holds on a live day that charges as needed. The service knows it;
// on days that charge to full, it does not answer any of these.

import type { AircraftState } from '../api/types'
import type { Seconds } from './record'
import { timeOf } from './time'

export interface Charge {
  /** What it holds now; only on the ground. */
  now_kwh: number | undefined
  /** What it will land with; only if it was dispatched. */
  lands_with_kwh: number | undefined
  /** When the charge suffices for its flight; only if it waits for that. */
  takeoff: Seconds | undefined
}

type Known = Pick<AircraftState, 'phase' | 'charge_kwh' | 'lands_with_kwh' | 'flight'>

export function chargeOf({ phase, charge_kwh, lands_with_kwh, flight }: Known): Charge {
  const isWaiting =
    phase === 'sent_off' && flight?.takeoff != null && timeOf(flight.takeoff) > timeOf(flight.decided)
  return {
    now_kwh: charge_kwh ?? undefined,
    lands_with_kwh: lands_with_kwh ?? undefined,
    takeoff: isWaiting && flight.takeoff != null ? timeOf(flight.takeoff) : undefined,
  }
}
