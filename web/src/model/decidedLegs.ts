// The decided legs of a live day. The service's trace has them all, and its state has the latest of
// each aircraft. Trace, state and events are read one after the other: decisions that the trace
// lacks come from the events, and the state is right about places.

import type { AircraftState, DayState } from '../api/types'
import { grouped } from './arrays'
import { nominal, withTakeoff } from './nominal'
import { isHold, type LegRecord, type Seconds } from './record'
import type { ReportedDecision } from './reportedDecisions'
import { indexed, known, type Reports } from './reports'
import type { Scenario } from './scenario'
import { timeOf } from './time'

/** A leg, and what was reported of its decision. */
interface Decided {
  leg: LegRecord
  report?: ReportedDecision | undefined
}

/**
 * The decided legs, in order of decision, each beginning where the one before it has ended. Those
 * of an aircraft that the state does not have are as in the trace.
 */
export function decidedLegs(
  scenario: Scenario,
  reports: Reports,
  state: DayState,
  trace: readonly LegRecord[],
): LegRecord[] {
  const places = indexed(scenario.vertiports)
  const traced = grouped([...trace], ({ aircraft }) => aircraft)
  const states = new Map(state.aircraft.map((one) => [one.id, one]))
  const all = scenario.aircraft.flatMap(({ id, at }, aircraft) => {
    const decided = decidedBy(aircraft)
    const one = states.get(id)
    if (one === undefined) return decided.map(({ leg }) => leg)
    const now = one.flight == null ? standing(one, decided) : underWay(one, one.flight, aircraft, decided)
    return joined(now, aircraft, known(places, at), {
      place: known(places, one.place),
      at: timeOf(one.arrival),
    })
  })
  return all.sort((one, other) => one.decided - other.decided || one.aircraft - other.aircraft)

  /** The decisions of an aircraft by its events, and by the trace where that is newer. */
  function decidedBy(aircraft: number): Decided[] {
    const rows = grouped(traced.get(aircraft) ?? [], ({ decided }) => decided)
    const told = reports.decisions.of(aircraft).map((report) => {
      const row = rows.get(report.decided)?.find(({ from, to }) => from === report.from && to === report.to)
      return { leg: reported(row ?? legOf(aircraft, report), report), report }
    })
    const times = new Set(told.map(({ report }) => report.decided))
    const isUntold = (decided: Seconds) =>
      !times.has(decided) && !reports.decisions.isUndone(aircraft, decided)
    const untold = [...rows].flatMap(([decided, those]) => (isUntold(decided) ? those : []))
    return [...told, ...untold.map((row) => ({ leg: reported(row) }))].sort(
      (one, other) => one.leg.decided - other.leg.decided,
    )
  }

  /** The legs of an aircraft under way: the last is its flight. */
  function underWay(
    one: AircraftState,
    flight: NonNullable<AircraftState['flight']>,
    aircraft: number,
    all: Decided[],
  ): LegRecord[] {
    const decided = timeOf(flight.decided)
    const times = { arrives: timeOf(one.arrival), ready: timeOf(one.ready) }
    const charge = one.lands_with_kwh == null ? {} : { lands_with_kwh: one.lands_with_kwh }
    const [from, to] = [known(places, flight.from), known(places, flight.to)]
    const same = all.findLast(({ leg }) => leg.decided === decided && leg.from === from && !isHold(leg))
    const before = same === undefined ? all.filter(({ leg }) => leg.decided <= decided) : all
    const past = before.slice(0, same === undefined ? undefined : all.indexOf(same))
    const now = { aircraft, from, to, decided, ...times, ...charge, passengers: flight.passengers }
    const base = same?.leg ?? { ...now, departs: decided, profit_usd: 0, is_expected: false }
    const whole = reported(withTakeoff({ ...base, ...now }, flight.takeoff), same?.report)
    return [...past.map(({ leg }) => leg), awaiting(one, whole, same?.report)]
  }

  /** The legs of an aircraft that stands: the last flight has ended. */
  function standing(one: AircraftState, all: Decided[]): LegRecord[] {
    const [place, arrived] = [known(places, one.place), timeOf(one.arrival)]
    // A flight that was decided later was undone, or is newer than the state.
    const isPast = ({ leg, report }: Decided) => {
      if (report !== undefined) return report.seq <= state.seq
      return isHold(leg) || leg.decided < arrived || (leg.decided === arrived && leg.to === place)
    }
    const past = all.filter(isPast)
    const legs = past.map(({ leg }) => leg)
    const latest = past.findLast(({ leg }) => !isHold(leg))
    const landed = latest?.report?.landed
    const isIts =
      landed === undefined ? latest?.leg.to === place : landed.time === arrived && landed.at === place
    if (latest === undefined || !isIts) return legs
    const ready = one.out_of_service ? {} : { ready: timeOf(one.ready) }
    const isLast = legs.at(-1) === latest.leg
    const now = { ...latest.leg, arrives: arrived, ...(isLast ? ready : {}) }
    return legs.map((leg) => (leg === latest.leg ? now : leg))
  }

  /** A decision that the trace does not have yet, as a leg. */
  function legOf(aircraft: number, { from, to, decided, landed }: ReportedDecision): LegRecord {
    const leg = { aircraft, from, to, decided, departs: decided }
    const { flight_s, ground_s } = nominal(scenario, leg)
    const isFlight = from !== to
    const arrives = isFlight ? (landed?.time ?? decided + flight_s) : decided
    const ready = isFlight ? arrives + ground_s : decided + scenario.operations.hold_s
    return { ...leg, arrives, ready, passengers: 0, profit_usd: 0, is_expected: false }
  }

  /**
   * The leg of an aircraft under way, with the report that it awaits. Reports may be newer than the
   * state.
   */
  function awaiting(
    { phase }: AircraftState,
    leg: LegRecord,
    report: ReportedDecision | undefined,
  ): LegRecord {
    if (report?.landed !== undefined) {
      const ready = report.landed.time + leg.ready - leg.arrives
      return { ...leg, arrives: report.landed.time, ready }
    }
    const hasDeparted = phase === 'in_the_air' || report?.hasDeparted === true
    return {
      ...leg,
      awaited: hasDeparted
        ? { report: 'landing', due: leg.arrives }
        : { report: 'departure', due: leg.departs },
    }
  }

  /**
   * A leg with its reported departure, who decided it, and the plan if it went differently. A
   * diverted flight ends elsewhere. One that came back to its origin keeps its destination, because
   * it would be a hold otherwise; `joined` then moves its aircraft back.
   */
  function reported(plan: LegRecord, report?: ReportedDecision): LegRecord {
    const landedAt = report?.landed?.at ?? plan.to
    const leg = { ...plan, to: landedAt === plan.from ? plan.to : landedAt }
    const policy = report?.policy === undefined ? {} : { policy: report.policy }
    if (isHold(leg)) return { ...leg, ...policy }
    const charged = leg.charged ?? leg.decided
    const departs = report?.departs ?? charged
    const { flight_s, energy_kwh } = nominal(scenario, leg)
    const arrives = charged + flight_s
    const charge_kwh = report?.landed?.charge_kwh
    const charge = charge_kwh === undefined ? {} : { lands_with_kwh: charge_kwh }
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
