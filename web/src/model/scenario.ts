// A scenario as in its file (vertifleet-scenario/1): the members that the console displays.
// docs/src/reference/files.md describes all of them.

/** A table by origin and destination. */
export type Table = number[][]

export interface Scenario {
  format: string
  name: string
  operations: {
    start: string
    end: string
    takeoff_s: number
    landing_s: number
    hold_s: number
    passenger_wait_s?: number
    /** When an aircraft that has landed decides again; `to_full` if absent. */
    charging?: Charging
  }
  vertiports: ScenarioVertiport[]
  aircraft_types: ScenarioAircraftType[]
  aircraft: ScenarioAircraft[]
  distance_mi: Table
  /** A table, or one per period. */
  fare: Table | Table[]
  passenger_cost: Table
  periods: string[]
  /**
   * Passengers by period, origin and destination; the actual ones, if they differ from the
   * forecast.
   */
  demand: Table[]
  forecast?: Table[]
  energy_price: number[]
  flight_cost?: Table
  aircraft_cost?: number
  closures?: ScenarioClosure[]
  outages?: { aircraft: string; start: string; end: string }[]
}

/**
 * `to_full`: an aircraft decides when its battery is full again. `as_needed`: it decides whatever
 * its charge, and takes off when the charge suffices.
 */
export type Charging = 'to_full' | 'as_needed'

export interface ScenarioAircraft {
  id: string
  type: string
  at: string
  /** A full battery if absent. */
  start_charge_kwh?: number
}

export interface ScenarioVertiport {
  id: string
  x_mi: number
  y_mi: number
  stands: number
  chargers?: number
  /** The most power that a charger delivers; only the aircraft limits it if absent. */
  charger_kw?: number
  /** Dollars a day for each stand, and each charger, whether or not it is used. */
  stand_cost?: number
  charger_cost?: number
  latitude?: number
  longitude?: number
}

export interface ScenarioAircraftType {
  id: string
  seats: number
  speed_mph: number
  battery_kwh: number
  energy_kwh_per_mi: number
  charge_kw: number
  /** Share of the capacity that is lost per hour from take-off to arrival; 0 if absent. */
  self_discharge_per_h?: number
  /** Energy that a flight leaves in the battery; 0 if absent. */
  reserve_kwh?: number
  /** Seconds after a landing before which it is not ready; 0 if absent. */
  turnaround_s?: number
  /** Charging power by charge: pairs of a share of the battery and kW, linear between them. */
  charge_curve?: [share: number, kw: number][]
}

export interface ScenarioClosure {
  from: string
  to: string
  both_ways?: boolean
  start: string
  end: string
  known?: boolean
}
