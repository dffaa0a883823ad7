// The duration of an undelayed flight and its charging (docs/src/concepts/model.md). Traces and the
// service's legs contain only the outcome of a flight, so the plan for comparison is computed here.

import type { LegRecord, Seconds } from './record'
import type { Scenario } from './scenario'

export interface Nominal {
  flight_s: Seconds
  charge_s: Seconds
}

/** Cruise between take-off and landing; then the battery is charged to full. */
export function nominal(
  { operations, aircraft, aircraft_types, distance_mi }: Scenario,
  leg: Pick<LegRecord, 'aircraft' | 'from' | 'to'>,
): Nominal {
  const type = aircraft_types.find(({ id }) => id === aircraft[leg.aircraft]?.type)
  if (type === undefined) return { flight_s: 0, charge_s: 0 }
  const miles = distance_mi[leg.from]?.[leg.to] ?? 0
  const { takeoff_s, landing_s } = operations
  const flight_s = takeoff_s + Math.round((3600 * miles) / type.speed_mph) + landing_s
  const lost_kwh = (type.battery_kwh * (type.self_discharge_per_h ?? 0) * flight_s) / 3600
  const energy_kwh = type.energy_kwh_per_mi * miles + lost_kwh
  return { flight_s, charge_s: Math.round((3600 * energy_kwh) / type.charge_kw) }
}
