// The data shape that all views share: a day that is live, over, or simulated. Maps and timelines
// take a record and a time and do not depend on the service, so that reports can embed them.

/** Seconds since midnight of the day; may exceed 24 hours. */
export type Seconds = number

/** A day for display: past and expected events. */
export interface DayRecord {
  name: string
  /** When operations start, and the latest time for a decision. Flights may land later. */
  start: Seconds
  end: Seconds
  /** The time that every flight spends on take-off and on landing, in addition to the cruise. */
  takeoff_s: number
  landing_s: number
  /** How long passengers who were not carried in their period wait into the next one. */
  passenger_wait_s: Seconds
  /** Whether aircraft decide whatever their charge, and take off when it suffices. */
  chargesAsNeeded?: boolean
  vertiports: VertiportRecord[]
  aircraft: AircraftRecord[]
  /** Every flight and hold, by the time of its decision. */
  legs: LegRecord[]
  closures: ClosureRecord[]
  outages: OutageRecord[]
  /** Beginnings of the demand periods. */
  periods: Seconds[]
  demand?: DemandRecord
}

export interface VertiportRecord {
  id: string
  place: Place
  stands: number
  /** The number of chargers, if it is separate from the number of stands. */
  chargers?: number
  /** The most power that a charger delivers, if it limits the aircraft. */
  charger_kw?: number
}

/**
 * The position of a vertiport: miles east and north, and degrees if the network has coordinates.
 */
export interface Place {
  x_mi: number
  y_mi: number
  latitude?: number
  longitude?: number
}

export interface AircraftRecord {
  id: string
  type: string
  seats: number
  battery_kwh: number
  charge_kw: number
  charge_curve?: [share: number, kw: number][]
  /** A full battery if absent. */
  start_charge_kwh?: number
  /** Index of the vertiport where it begins the day. */
  begins_at: number
}

/**
 * A flight or a hold; a hold has `from` equal to `to`. Times are the best known: actual if
 * reported, otherwise expected.
 */
export interface LegRecord {
  /** Indices into the record's aircraft and vertiports. */
  aircraft: number
  from: number
  to: number
  decided: Seconds
  departs: Seconds
  arrives: Seconds
  ready: Seconds
  /** When the charge suffices for the flight; only on days that charge as needed. */
  charged?: Seconds
  /** What the flight takes from the battery: by the trace, or by the rule in `nominal.ts`. */
  energy_kwh?: number
  /** What the battery holds at the decision and at the landing, if that is known. */
  charge_kwh?: number
  lands_with_kwh?: number
  /** The plan at the time of the decision, if the flight went differently. */
  planned?: { departs: Seconds; arrives: Seconds; ready: Seconds }
  /**
   * The report that a live day awaits next, and when it is due; absent once the aircraft has
   * landed.
   */
  awaited?: { report: 'departure' | 'landing'; due: Seconds }
  passengers: number
  profit_usd: number
  /** Whether the decision has not been taken yet: the leg is part of an outlook. */
  is_expected: boolean
  /** The policy that decided; absent if a person did, or if it is unknown. */
  policy?: string
}

/**
 * Routes that are closed to new flights: one route between two vertiports, or all routes of a
 * vertiport.
 */
export type ClosureRecord = (RouteRecord | { vertiport: number }) & {
  since: Seconds
  /** Absent if it is not known. */
  until?: Seconds
  reason?: string
}

export interface RouteRecord {
  from: number
  to: number
}

/** A period in which an aircraft cannot fly. */
export interface OutageRecord {
  aircraft: number
  since: Seconds
  until?: Seconds
  reason?: string
}

/** Demand by period, origin and destination; the passengers carried are in the legs. */
export interface DemandRecord {
  passengers: number[][][]
}

/** Whether a leg is a hold. */
export function isHold(leg: LegRecord): boolean {
  return leg.from === leg.to
}
