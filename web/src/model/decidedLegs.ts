// The decided legs of a live day. The service's trace has them all, and its state has the latest of
// each aircraft. Trace, state and events are read one after the other: decisions that the trace
// lacks come from the events, and the state is right about places.

import type { AircraftState, DayState } from '../api/types'
import { grouped } from './arrays'
import { nominal, withTakeoff } from './nominal'
import { isHold, type LegRecord, type Seconds } from './record'
import { indexed, known, type ReportedDecision, type Reports } from './reports'
import type { Scenario } from './scenario'
import { timeOf } from './time'

/** The decided legs, in order of decision, each beginning where the one before it has ended. */
export function decidedLegs(
  scenario: Scenario,
  reports: Reports,
  state: DayState,
  trace: readonly LegRecord[],
): LegRecord[] {
  const [ids, places] = [indexed(scenario.aircraft), indexed(scenario.vertiports)]
  const valid = trace.filter((leg) => !reports.isUndone(leg.aircraft, leg.decided))
  const legs = grouped(valid.map(reported), ({ aircraft }) => aircraft)
  for (const one of state.aircraft) {
    const aircraft = known(ids, one.id)
    const before = [...(legs.get(aircraft) ?? []), ...reportedSince(aircraft, legs.get(aircraft) ?? [])]
    const now =
      one.flight == null ? standing(one, aircraft, before) : underWay(one, one.flight, aircraft, before)
    const end = { place: known(places, one.place), at: timeOf(one.arrival) }
    const begins_at = known(places, scenario.aircraft[aircraft]?.at ?? '')
    legs.set(aircraft, joined(now, aircraft, begins_at, end))
  }
  const all = [...legs.values()].flat()
  return all.sort((one, other) => one.decided - other.decided || one.aircraft - other.aircraft)

  /** The legs of an aircraft under way: the last is its flight. */
  function underWay(
    one: AircraftState,
    flight: NonNullable<AircraftState['flight']>,
    aircraft: number,
    before: LegRecord[],
  ): LegRecord[] {
    const decided = timeOf(flight.decided)
    const times = { arrives: timeOf(one.arrival), ready: timeOf(one.ready) }
    const charge = one.lands_with_kwh == null ? {} : { lands_with_kwh: one.lands_with_kwh }
    const [from, to] = [known(places, flight.from), known(places, flight.to)]
    const same = before.find((leg) => leg.decided === decided && !isHold(leg))
    const now = { aircraft, from, to, decided, ...times, ...charge, passengers: flight.passengers }
    const base = same ?? { ...now, departs: decided, profit_usd: 0, is_expected: false }
    const whole = withTakeoff({ ...base, ...now }, flight.takeoff)
    return [...before.filter((leg) => leg.decided < decided), awaiting(one, reported(whole))]
  }

  /** The legs of an aircraft that stands: the last flight has ended. */
  function standing(one: AircraftState, aircraft: number, before: LegRecord[]): LegRecord[] {
    const [place, arrived] = [known(places, one.place), timeOf(one.arrival)]
    // A flight that was decided later was undone, or is newer than the state.
    const isPast = (leg: LegRecord) =>
      isHold(leg) || leg.decided < arrived || (leg.decided === arrived && leg.to === place)
    const legs = before.filter(isPast)
    const latest = legs.findLast((leg) => !isHold(leg))
    if (latest === undefined) return legs
    const landed = reports.decision(aircraft, latest.decided)?.landed
    const isIts = landed === undefined ? latest.to === place : landed === arrived
    if (!isIts) return legs
    const ready = one.out_of_service ? {} : { ready: timeOf(one.ready) }
    const isLast = legs.at(-1) === latest
    const now = {
      ...latest,
      to: place === latest.from ? latest.to : place,
      arrives: arrived,
      ...(isLast ? ready : {}),
    }
    return legs.map((leg) => (leg === latest ? now : leg))
  }

  /**
   * Where a flight ends: a diverted one elsewhere. One that came back to its origin keeps its
   * destination, because it would be a hold otherwise; `joined` then moves its aircraft back.
   */
  function landingOf({ from, to }: LegRecord, report: ReportedDecision | undefined): number {
    const at = report?.landedAt === undefined ? to : known(places, report.landedAt)
    return at === from ? to : at
  }

  /** Legs that were reported after those of the trace. */
  function reportedSince(aircraft: number, traced: LegRecord[]): LegRecord[] {
    let from = traced.at(-1)?.to ?? known(places, scenario.aircraft[aircraft]?.at ?? '')
    const since = reports.decisionsAfter(aircraft, traced.at(-1)?.decided ?? -Infinity)
    return since.map(([decided, { to: destination, landed, landedAt }]) => {
      const to = destination === undefined ? from : known(places, destination)
      const leg = {
        aircraft,
        from,
        to,
        decided,
        departs: decided,
        passengers: 0,
        profit_usd: 0,
        is_expected: false,
      }
      const { flight_s, ground_s } = nominal(scenario, leg)
      const isFlight = from !== to
      const arrives = isFlight ? (landed ?? decided + flight_s) : decided
      const ready = isFlight ? arrives + ground_s : decided + scenario.operations.hold_s
      from = landedAt === undefined ? to : known(places, landedAt)
      return reported({ ...leg, arrives, ready })
    })
  }

  /**
   * The leg of an aircraft under way, with the report that it awaits. Reports may be newer than the
   * state.
   */
  function awaiting({ phase }: AircraftState, leg: LegRecord): LegRecord {
    const report = reports.decision(leg.aircraft, leg.decided)
    if (report?.landed !== undefined) {
      const ready = report.landed + leg.ready - leg.arrives
      return { ...leg, arrives: report.landed, ready }
    }
    const hasDeparted = phase === 'in_the_air' || report?.hasDeparted === true
    return {
      ...leg,
      awaited: hasDeparted
        ? { report: 'landing', due: leg.arrives }
        : { report: 'departure', due: leg.departs },
    }
  }

  /** A leg with its reported departure, who decided it, and the plan if it went differently. */
  function reported(plan: LegRecord): LegRecord {
    const report = reports.decision(plan.aircraft, plan.decided)
    const leg = { ...plan, to: landingOf(plan, report) }
    const policy = report?.policy === undefined ? {} : { policy: report.policy }
    if (isHold(leg)) return { ...leg, ...policy }
    const charged = leg.charged ?? leg.decided
    const departs = report?.departs ?? charged
    const { flight_s, energy_kwh } = nominal(scenario, leg)
    const arrives = charged + flight_s
    const charge = report?.lands_with_kwh === undefined ? {} : { lands_with_kwh: report.lands_with_kwh }
    const rest = { ...leg }
    delete rest.planned
    const known = { energy_kwh, ...rest, ...policy, ...charge, departs }
    if (departs === charged && leg.arrives === arrives) return known
    const planned = { departs: charged, arrives, ready: arrives + leg.ready - leg.arrives }
    return { ...known, planned }
  }
}

/**
 * Legs that each begin where the one before has ended. An aircraft that was reported at another
 * vertiport without a flight has been moved there, which is a hold without a duration.
 */
function joined(
  legs: LegRecord[],
  aircraft: number,
  begins_at: number,
  end: { place: number; at: Seconds },
): LegRecord[] {
  const all: LegRecord[] = []
  let place = begins_at
  const moveTo = (to: number, at: Seconds) => {
    const times = { decided: at, departs: at, arrives: at, ready: at }
    if (to !== place)
      all.push({ aircraft, from: to, to, ...times, passengers: 0, profit_usd: 0, is_expected: false })
    place = to
  }
  for (const leg of legs) {
    moveTo(leg.from, leg.decided)
    all.push(leg)
    place = leg.to
  }
  moveTo(end.place, Math.max(end.at, all.at(-1)?.decided ?? 0))
  return all
}
