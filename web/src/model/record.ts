// The one shape that all views share: a day as it is shown, whether it happens now, is over, or was only simulated. Maps and
// timelines take a record and a time and know nothing of the service, so that reports can embed them.

/** Seconds since midnight of the day; may pass 24 hours. */
export type Seconds = number

/** A day as it is shown: what has happened and what is expected to. */
export interface DayRecord {
  name: string
  /** When operations start, and the last time at which an aircraft may decide. Flights may land later. */
  start: Seconds
  end: Seconds
  /** How long every flight spends on take-off and on landing, beside its way. */
  takeoff_s: number
  landing_s: number
  /** How long passengers who were not carried in their period wait into the next one. */
  passenger_wait_s: Seconds
  vertiports: VertiportRecord[]
  aircraft: AircraftRecord[]
  /** Every flight and hold, by the time of its decision. */
  legs: LegRecord[]
  closures: ClosureRecord[]
  outages: OutageRecord[]
  /** Beginnings of the periods of demand. */
  periods: Seconds[]
  demand?: DemandRecord
}

export interface VertiportRecord {
  id: string
  place: Place
  stands: number
  /** Chargers, where they are counted apart from stands. */
  chargers?: number
}

/** Where a vertiport is: miles east and north, and degrees where the network has coordinates. */
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
  energy_kwh_per_mi: number
  /** Index of the vertiport where it begins the day. */
  begins_at: number
}

/** A flight or a hold; a hold has `from` equal to `to`. Times are the best known: actual where reported, else expected. */
export interface LegRecord {
  /** Indices into the record's aircraft and vertiports. */
  aircraft: number
  from: number
  to: number
  decided: Seconds
  departs: Seconds
  arrives: Seconds
  ready: Seconds
  /** What was planned when it was decided, where something else has come of it. */
  planned?: { departs: Seconds; arrives: Seconds; ready: Seconds }
  /** The report that a live day waits for next, and when it is due; absent once the aircraft has landed. */
  awaited?: { report: 'departure' | 'landing'; due: Seconds }
  passengers: number
  profit_usd: number
  /** Whether the decision has not been taken yet: the leg is part of an outlook. */
  is_expected: boolean
  /** The policy that decided; absent if a person did, or if it is not known. */
  policy?: string
}

/** Routes that are closed to new flights: one way between two vertiports, or all of a vertiport. */
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

/** A time in which an aircraft cannot fly. */
export interface OutageRecord {
  aircraft: number
  since: Seconds
  until?: Seconds
  reason?: string
}

/** Passengers who want to fly, by period, origin and destination; those whom flights carried are in the legs. */
export interface DemandRecord {
  passengers: number[][][]
}

/** Whether a leg is a hold. */
export function isHold(leg: LegRecord): boolean {
  return leg.from === leg.to
}
