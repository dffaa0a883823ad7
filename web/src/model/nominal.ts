// The duration of an undelayed flight and of the time on the ground after it
// (docs/src/concepts/model.md). Traces and the service's legs contain only the outcome of a flight,
// so the plan for comparison is computed here.

import type { Leg } from '../api/types'
import { ChargeRate } from './rate'
import type { LegRecord, Seconds } from './record'
import type { Scenario } from './scenario'
import { timeOf } from './time'

export interface Nominal {
  flight_s: Seconds
  /** From landing until the aircraft is ready. */
  ground_s: Seconds
  /** What the flight takes from the battery, self-discharge included. */
  energy_kwh: number
}

/**
 * Cruise between take-off and landing; then the turnaround, and charging to full unless the day
 * charges as needed.
 */
export function nominal(
  { operations, aircraft, aircraft_types, distance_mi, vertiports }: Scenario,
  leg: Pick<LegRecord, 'aircraft' | 'from' | 'to'>,
): Nominal {
  const type = aircraft_types.find(({ id }) => id === aircraft[leg.aircraft]?.type)
  if (type === undefined) return { flight_s: 0, ground_s: 0, energy_kwh: 0 }
  if (leg.from === leg.to) return { flight_s: 0, ground_s: 0, energy_kwh: 0 }
  const miles = distance_mi[leg.from]?.[leg.to] ?? 0
  const { takeoff_s, landing_s } = operations
  const flight_s = takeoff_s + Math.round((3600 * miles) / type.speed_mph) + landing_s
  const lost_kwh = (type.battery_kwh * (type.self_discharge_per_h ?? 0) * flight_s) / 3600
  const energy_kwh = type.energy_kwh_per_mi * miles + lost_kwh
  const turnaround_s = type.turnaround_s ?? 0
  if (operations.charging === 'as_needed') return { flight_s, ground_s: turnaround_s, energy_kwh }
  const rate = new ChargeRate(type, vertiports[leg.to]?.charger_kw)
  const ground_s = Math.max(turnaround_s, Math.round(rate.secondsToRefill(energy_kwh)))
  return { flight_s, ground_s, energy_kwh }
}

/** A leg with the take-off that the service has of flights on days that charge as needed. */
export function withTakeoff(leg: LegRecord, takeoff: Leg['takeoff']): LegRecord {
  if (takeoff == null) return leg
  const charged = timeOf(takeoff)
  return { ...leg, departs: charged, charged }
}
