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
  }
  vertiports: ScenarioVertiport[]
  aircraft_types: ScenarioAircraftType[]
  aircraft: { id: string; type: string; at: string }[]
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

export interface ScenarioVertiport {
  id: string
  x_mi: number
  y_mi: number
  stands: number
  chargers?: number
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
}

export interface ScenarioClosure {
  from: string
  to: string
  both_ways?: boolean
  start: string
  end: string
  known?: boolean
}
