// The alerts for a dispatcher, each listed once: overdue reports, full vertiports, closures,
// outages, flights that land with little charge, and notices that came with events.

import type { DayState, TakenEvent } from '../api/types'
import { minutesOverdue } from './awaited'
import { joined } from './closures'
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
  | { kind: 'closed'; what: string; until: Seconds | undefined; underWay: readonly string[] }
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
/**
 * Which of equally severe alerts comes first: a flight that may not reach its vertiport before a
 * route that others cannot take.
 */
const ORDER: readonly Matter['kind'][] = [
  'notice',
  'low_charge',
  'overdue',
  'over_full',
  'out_of_service',
  'closed',
  'full',
]
/** Notices about a flight that cannot be flown with the energy on board. */
const WITHOUT_ENERGY = 'without_energy'
/** Notices that another alert of the console has, by their aircraft or vertiport. */
const COVERED = { overdue: 'overdue', more_than_stands: 'over_full', below_reserve: 'low_charge' } as const
/** The service counts whole milliwatt-hours. */
const ROUNDING_KWH = 1e-5

interface Sources {
  scenario: Scenario
  state: DayState
  record: DayRecord
  events: readonly TakenEvent[]
  time: Seconds
}

/** All alerts at one time, the most severe first; equally severe ones by kind and age. */
export function alertsOf(sources: Sources): Alert[] {
  const legs = sources.record.legs.filter((leg) => !leg.is_expected)
  const lacking = withoutEnergy(sources.state)
  const found = [
    ...legs.flatMap((leg) => overdue(leg, sources.record)),
    ...crowded(legs, sources),
    ...closed(legs, sources),
    ...outOfService(sources),
    ...legs.flatMap((leg) => lowCharge(leg, sources, lacking)),
  ]
  const all = new Map([...found, ...notices(sources, found, lacking)].map((alert) => [alert.key, alert]))
  const rank = ({ severity }: Alert) => SEVERITIES.indexOf(severity)
  return [...all.values()].sort(
    (one, other) =>
      rank(one) - rank(other) ||
      ORDER.indexOf(one.matter.kind) - ORDER.indexOf(other.matter.kind) ||
      (one.since ?? Infinity) - (other.since ?? Infinity),
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

function crowded(legs: LegRecord[], { state, record }: Sources): Alert[] {
  return state.vertiports.flatMap(({ id, taken, stands }, vertiport): Alert[] => {
    if (taken < stands) return []
    const kind = taken > stands ? 'over_full' : 'full'
    // Since the latest aircraft was sent there; the same for every console.
    const since = legs.findLast((leg) => leg.to === vertiport && !isHold(leg))?.decided ?? record.start
    return [
      {
        key: `${kind} ${id} ${since}`,
        severity: kind === 'full' ? 'notice' : 'critical',
        matter: { kind, vertiport: id, taken, stands },
        since,
        target: { kind: 'vertiport', vertiport },
      },
    ]
  })
}

/** Closed routes, and closed vertiports, which also separate reports about all routes can close. */
function closed(legs: LegRecord[], { record, time }: Sources): Alert[] {
  const id = (vertiport: number) => record.vertiports[vertiport]?.id ?? ''
  const closures = joined(record.closures.filter(isNow(time)), record.vertiports.length)
  return closures.map((closure): Alert => {
    const vertiport = 'vertiport' in closure ? closure.vertiport : closure.to
    const isMeant = ({ from, to }: LegRecord) =>
      'vertiport' in closure ? to === vertiport : from === closure.from && to === closure.to
    const what = 'vertiport' in closure ? id(vertiport) : `${id(closure.from)} → ${id(vertiport)}`
    const underWay = legs
      .filter((leg) => leg.awaited !== undefined && isMeant(leg))
      .map((leg) => record.aircraft[leg.aircraft]?.id ?? '')
    return {
      key: `closed ${what} ${closure.since}`,
      severity: underWay.length > 0 ? 'critical' : 'warning',
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

/** A flight that lacks the energy to land at all has an alert of the service's notice. */
function lowCharge(
  leg: LegRecord,
  { record, scenario }: Sources,
  lacking: ReadonlySet<string | null | undefined>,
): Alert[] {
  const aircraft = record.aircraft[leg.aircraft]
  if (leg.awaited === undefined || isHold(leg) || aircraft === undefined) return []
  if (lacking.has(aircraft.id)) return []
  if (record.chargesAsNeeded === true && !isBelowReserve(leg, aircraft, scenario)) return []
  const left_kwh = leg.lands_with_kwh ?? aircraft.battery_kwh - (leg.energy_kwh ?? 0)
  const left = left_kwh / aircraft.battery_kwh
  if (record.chargesAsNeeded !== true && left >= LOW_CHARGE) return []
  const [to, percent] = [record.vertiports[leg.to]?.id ?? '', Math.max(0, Math.round(100 * left))]
  return [
    {
      key: `charge ${aircraft.id} ${leg.decided}`,
      // Below its reserve a flight is an emergency; on days that charge to full, it is as planned.
      severity: record.chargesAsNeeded === true || left_kwh < 0 ? 'critical' : 'warning',
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
 * covers. A lack of energy is a notice of its report and of its flight; it is one alert, whose key
 * stays the same after the landing.
 */
function notices(
  { state, events, record }: Sources,
  found: readonly Alert[],
  lacking: ReadonlySet<string | null | undefined>,
): Alert[] {
  const covered = new Set(found.map(({ matter }) => aboutOf(matter)))
  const legs = record.legs.filter((leg) => !leg.is_expected && !isHold(leg))
  return state.notices.flatMap(({ seq, code, text, aircraft, vertiport }): Alert[] => {
    const about = aircraft ?? vertiport ?? undefined
    if (seq == null && covered.has(`${COVERED[code as keyof typeof COVERED]} ${about}`)) return []
    const isEnergy = code === WITHOUT_ENERGY
    if (seq != null && isEnergy && lacking.has(aircraft)) return []
    const event = events.find((taken) => taken.seq === seq)?.event
    const since = event?.time == null ? undefined : timeOf(event.time)
    const place = record.aircraft.findIndex(({ id }) => id === aircraft)
    const isIts = (leg: LegRecord) => leg.aircraft === place && leg.decided <= (since ?? Infinity)
    const flight = isEnergy || seq == null ? legs.findLast(isIts)?.decided : undefined
    return [
      {
        key: `notice ${code} ${about ?? ''} ${flight ?? seq ?? ''}`,
        // Once the aircraft has landed, its report was wrong and no one is in danger.
        severity: isEnergy && seq == null ? 'critical' : 'warning',
        matter: { kind: 'notice', text },
        since,
        target: place < 0 ? undefined : { kind: 'aircraft', aircraft: place },
      },
    ]
  })
}

/** The aircraft under way that lack the energy for their flight. */
function withoutEnergy({ notices }: DayState): Set<string | null | undefined> {
  const now = notices.filter(({ seq, code }) => seq == null && code === WITHOUT_ENERGY)
  return new Set(now.map(({ aircraft }) => aircraft))
}

/** The kind and subject of an alert that the service has a notice about too. */
function aboutOf(matter: Matter): string {
  if (matter.kind === 'overdue' || matter.kind === 'low_charge') return `${matter.kind} ${matter.aircraft}`
  return 'vertiport' in matter ? `${matter.kind} ${matter.vertiport}` : matter.kind
}

export interface ListedAlert extends Alert {
  /** Who acknowledged it; empty without tokens, undefined if it is open. */
  acknowledgedBy: string | undefined
}

/** The alerts with their acknowledgements, open ones first. The service has these for all users. */
export function listed(alerts: readonly Alert[], acknowledged: DayState['acknowledged']): ListedAlert[] {
  const by = new Map(acknowledged.map(({ alert, actor }) => [alert, actor]))
  const all = alerts.map((alert) => ({ ...alert, acknowledgedBy: by.get(alert.key) }))
  const rank = ({ acknowledgedBy }: ListedAlert) => Number(acknowledgedBy !== undefined)
  return all.sort((one, other) => rank(one) - rank(other))
}

/** The headline. A full vertiport is in the list only, because it is an everyday state. */
export function headlineOf(alerts: readonly ListedAlert[]): ListedAlert | undefined {
  return alerts.find(({ acknowledgedBy, matter }) => acknowledgedBy === undefined && matter.kind !== 'full')
}

function isNow(time: Seconds): (one: { since: Seconds; until?: Seconds }) => boolean {
  return ({ since, until }) => since <= time && (until === undefined || time < until)
}
