// The alerts for a dispatcher, each listed once: overdue reports, full vertiports, closures,
// outages, flights that land with little charge, and notices that came with events.

import type { DayState, TakenEvent } from '../api/types'
import { minutesOverdue } from './awaited'
import type { AircraftRecord, DayRecord, LegRecord, Seconds } from './record'
import { isHold } from './record'
import type { Scenario } from './scenario'
import type { Target } from './target'
import { timeOf } from './time'

/** The most severe first. */
export const SEVERITIES = ['critical', 'warning', 'notice'] as const
export type Severity = (typeof SEVERITIES)[number]

/** The subject of an alert. Ids are those of the day. */
export type Matter =
  | { kind: 'overdue'; aircraft: string; to: string; report: 'departure' | 'landing'; due: Seconds }
  | { kind: 'over_full' | 'full'; vertiport: string; taken: number; stands: number }
  | { kind: 'closed'; what: string; until: Seconds | undefined; underWay: number }
  | { kind: 'out_of_service'; aircraft: string; until: Seconds | undefined }
  | { kind: 'low_charge'; aircraft: string; to: string; percent: number }
  | { kind: 'notice'; text: string }

export interface Alert {
  /** The same for every alert about the same subject, so that it is acknowledged only once. */
  key: string
  severity: Severity
  matter: Matter
  /** The time since which the alert holds, if known. */
  since: Seconds | undefined
  /** The object that the alert selects. */
  target: Target | undefined
}

/** A report that has been missing for this long is critical. */
const LONG_OVERDUE_MIN = 15
/** A flight that lands with a smaller share of its battery raises an alert. */
const LOW_CHARGE = 0.1
/** The service counts whole milliwatt-hours. */
const ROUNDING_KWH = 1e-5

interface Sources {
  scenario: Scenario
  state: DayState
  record: DayRecord
  events: readonly TakenEvent[]
  time: Seconds
}

/** All alerts at one time, the most severe first; equally severe ones by age, the oldest first. */
export function alertsOf(sources: Sources): Alert[] {
  const legs = sources.record.legs.filter((leg) => !leg.is_expected)
  const found = [
    ...legs.flatMap((leg) => overdue(leg, sources.record)),
    ...crowded(sources),
    ...closed(legs, sources),
    ...outOfService(sources),
    ...legs.flatMap((leg) => lowCharge(leg, sources)),
  ]
  const all = new Map([...found, ...notices(sources, found)].map((alert) => [alert.key, alert]))
  const rank = ({ severity }: Alert) => SEVERITIES.indexOf(severity)
  return [...all.values()].sort(
    (one, other) => rank(one) - rank(other) || (one.since ?? Infinity) - (other.since ?? Infinity),
  )
}

function overdue(leg: LegRecord, record: DayRecord): Alert[] {
  const minutes = minutesOverdue(leg)
  const { awaited } = leg
  if (awaited === undefined || minutes === 0) return []
  const aircraft = record.aircraft[leg.aircraft]?.id ?? ''
  const to = record.vertiports[leg.to]?.id ?? ''
  return [
    {
      key: `overdue ${aircraft} ${leg.decided} ${awaited.report}`,
      severity: minutes >= LONG_OVERDUE_MIN ? 'critical' : 'warning',
      matter: { kind: 'overdue', aircraft, to, ...awaited },
      since: awaited.due,
      target: { kind: 'aircraft', aircraft: leg.aircraft },
    },
  ]
}

function crowded({ state }: Sources): Alert[] {
  return state.vertiports.flatMap(({ id, taken, stands }, vertiport): Alert[] => {
    if (taken < stands) return []
    const kind = taken > stands ? 'over_full' : 'full'
    return [
      {
        key: `${kind} ${id}`,
        severity: kind === 'full' ? 'notice' : 'critical',
        matter: { kind, vertiport: id, taken, stands },
        since: undefined,
        target: { kind: 'vertiport', vertiport },
      },
    ]
  })
}

function closed(legs: LegRecord[], { record, time }: Sources): Alert[] {
  const id = (vertiport: number) => record.vertiports[vertiport]?.id ?? ''
  return record.closures.filter(isNow(time)).map((closure): Alert => {
    const vertiport = 'vertiport' in closure ? closure.vertiport : closure.to
    const isMeant = ({ from, to }: LegRecord) =>
      'vertiport' in closure ? to === vertiport : from === closure.from && to === closure.to
    const what = 'vertiport' in closure ? id(vertiport) : `${id(closure.from)} → ${id(vertiport)}`
    const underWay = legs.filter((leg) => leg.awaited !== undefined && isMeant(leg)).length
    return {
      key: `closed ${what} ${closure.since}`,
      severity: underWay > 0 ? 'critical' : 'warning',
      matter: { kind: 'closed', what, until: closure.until, underWay },
      since: closure.since,
      target: { kind: 'vertiport', vertiport },
    }
  })
}

function outOfService({ record, time }: Sources): Alert[] {
  return record.outages.filter(isNow(time)).map(({ aircraft, since, until }) => {
    const id = record.aircraft[aircraft]?.id ?? ''
    return {
      key: `out ${id} ${since}`,
      severity: 'warning',
      matter: { kind: 'out_of_service', aircraft: id, until },
      since,
      target: { kind: 'aircraft', aircraft },
    }
  })
}

function lowCharge(leg: LegRecord, { record, scenario }: Sources): Alert[] {
  const aircraft = record.aircraft[leg.aircraft]
  if (leg.awaited === undefined || isHold(leg) || aircraft === undefined) return []
  if (record.chargesAsNeeded === true && !isBelowReserve(leg, aircraft, scenario)) return []
  const left_kwh = leg.lands_with_kwh ?? aircraft.battery_kwh - (leg.energy_kwh ?? 0)
  const left = left_kwh / aircraft.battery_kwh
  if (record.chargesAsNeeded !== true && left >= LOW_CHARGE) return []
  const [to, percent] = [record.vertiports[leg.to]?.id ?? '', Math.max(0, Math.round(100 * left))]
  return [
    {
      key: `charge ${aircraft.id} ${leg.decided}`,
      severity: 'notice',
      matter: { kind: 'low_charge', aircraft: aircraft.id, to, percent },
      since: leg.departs,
      target: { kind: 'aircraft', aircraft: leg.aircraft },
    },
  ]
}

/**
 * Whether a flight lands with less than its reserve. Where aircraft charge as needed, a flight that
 * lands with no more than that is as planned.
 */
function isBelowReserve(
  { lands_with_kwh }: LegRecord,
  { type }: AircraftRecord,
  { aircraft_types }: Scenario,
): boolean {
  const reserve_kwh = aircraft_types.find(({ id }) => id === type)?.reserve_kwh ?? 0
  return lands_with_kwh !== undefined && lands_with_kwh < reserve_kwh - ROUNDING_KWH
}

/**
 * Notices of the service: all that came with events. Of the current ones, those that no other alert
 * covers.
 */
function notices({ state, events, record }: Sources, found: readonly Alert[]): Alert[] {
  const known = new Set(found.map(({ matter }) => aboutOf(matter)))
  return state.notices.flatMap(({ seq, text }): Alert[] => {
    const about = /^(?:aircraft|vertiport) "([^"]*)"/.exec(text)?.[1]
    if (seq == null && about !== undefined && known.has(about)) return []
    const event = events.find((taken) => taken.seq === seq)?.event
    const id = event !== undefined && 'aircraft' in event ? event.aircraft : undefined
    const aircraft = record.aircraft.findIndex((one) => one.id === id)
    return [
      {
        key: `notice ${seq ?? 'now'} ${text}`,
        severity: 'warning',
        matter: { kind: 'notice', text },
        since: event?.time == null ? undefined : timeOf(event.time),
        target: aircraft < 0 ? undefined : { kind: 'aircraft', aircraft },
      },
    ]
  })
}

/** The aircraft or vertiport of an overdue or over-full alert, which the service reports too. */
function aboutOf(matter: Matter): string | undefined {
  if (matter.kind === 'overdue') return matter.aircraft
  return matter.kind === 'over_full' ? matter.vertiport : undefined
}

function isNow(time: Seconds): (one: { since: Seconds; until?: Seconds }) => boolean {
  return ({ since, until }) => since <= time && (until === undefined || time < until)
}
