// The data of a dispatcher's decision: the waiting aircraft, the value of each choice, and the
// latest decisions.

import type { AircraftState, Alternative, DayState, Proposal, TakenEvent } from '../api/types'
import type { DayRecord, LegRecord, Seconds } from './record'
import { timeOf } from './time'

/** An aircraft that waits for a decision, or will soon. */
export interface Waiting {
  id: string
  at: string
  ready: Seconds
  isFull: boolean
  /** What its battery holds; only on days that charge as needed. */
  charge_kwh?: number
}

/**
 * Aircraft that need a decision, those that have waited longest first. Ties go to the aircraft that
 * occupies the last stand of a vertiport.
 */
export function waitingOf(state: DayState): Waiting[] {
  const waiting = state.aircraft.filter((one) => one.needs_decision).map((one) => waitingAt(state, one))
  return waiting.sort((one, other) => one.ready - other.ready || Number(other.isFull) - Number(one.isFull))
}

/**
 * Aircraft that were decided after an event. For these, a state or an outlook of that event is out
 * of date.
 */
export function decidedSince(events: readonly TakenEvent[], seq: number): Set<string> {
  const since = new Set<string>()
  for (let at = events.length - 1; (events[at]?.seq ?? 0) > seq; at--) {
    const event = events[at]?.event
    if (event?.type === 'decided') since.add(event.aircraft)
  }
  return since
}

/**
 * The aircraft that will be ready next: undecided and flying or charging. An aircraft that stands
 * ready and does not wait has no further decisions on this day.
 */
export function nextOf(state: DayState, most: number, decided: ReadonlySet<string> = new Set()): Waiting[] {
  const now = timeOf(state.now)
  const isDone = (one: AircraftState) => one.phase === 'standing' && timeOf(one.ready) <= now
  const later = state.aircraft.filter(
    (one) => !one.needs_decision && !one.out_of_service && !isDone(one) && !decided.has(one.id),
  )
  const waiting = later.map((one) => waitingAt(state, one)).sort((one, other) => one.ready - other.ready)
  return waiting.slice(0, most)
}

function waitingAt(state: DayState, { id, place, ready, charge_kwh }: AircraftState): Waiting {
  const vertiport = state.vertiports.find((one) => one.id === place)
  const isFull = vertiport !== undefined && vertiport.taken >= vertiport.stands
  return { id, at: place, ready: timeOf(ready), isFull, ...(charge_kwh == null ? {} : { charge_kwh }) }
}

/** An expected decision of the policy. */
export interface Expected {
  id: string
  leg: LegRecord
}

/**
 * The next decisions in the outlook, the earliest first, except for aircraft that have been decided
 * since.
 */
export function expectedNext(
  { legs, aircraft }: DayRecord,
  time: Seconds,
  most: number,
  decided: ReadonlySet<string> = new Set(),
): Expected[] {
  const isNext = (leg: LegRecord) =>
    leg.is_expected && leg.decided >= time && !decided.has(aircraft[leg.aircraft]?.id ?? '')
  const next = legs.filter(isNext).slice(0, most)
  return next.map((leg) => ({ id: `${leg.aircraft} ${leg.decided}`, leg }))
}

/**
 * A list that keeps its order while a user points at it: missing entries stay, new ones come last.
 */
export class Steady<T extends { id: string }> {
  #shown: readonly T[] = []

  of(fresh: readonly T[], isHeld: boolean): readonly T[] {
    const byId = new Map(fresh.map((one) => [one.id, one]))
    const kept = isHeld ? this.#shown.map((one) => byId.get(one.id) ?? one) : []
    for (const { id } of kept) byId.delete(id)
    this.#shown = isHeld ? [...kept, ...byId.values()] : fresh
    return this.#shown
  }
}

/**
 * The possible choices in the order of what the policy compares, the advised one first, and the
 * impossible ones. Choices that the policy does not consider follow by their worth.
 */
export function ranked(proposal: Proposal): { possible: Alternative[]; impossible: Alternative[] } {
  const possible = proposal.alternatives.filter((one) => one.impossible == null)
  const isAdvised = (one: Alternative) => Number(one.to === proposal.to)
  possible.sort(
    (one, other) =>
      isAdvised(other) - isAdvised(one) ||
      compare(other.value ?? -Infinity, one.value ?? -Infinity) ||
      compare(other.worth_usd ?? -Infinity, one.worth_usd ?? -Infinity) ||
      one.to.localeCompare(other.to),
  )
  return { possible, impossible: proposal.alternatives.filter((one) => one.impossible != null) }
}

function compare(one: number, other: number): number {
  return one === other ? 0 : one - other
}

/**
 * The displayed number of a choice: the value that the policy compares. Policies with prices have a
 * worth at these for choices too that they do not consider.
 */
export function numberOf({ worth_usd, value }: Alternative): number | undefined {
  return value ?? worth_usd ?? undefined
}

/** How far the advised choice is ahead of the next; undefined if it is alone. */
export interface Lead {
  of: string
  by: number
  /** The part of the worth that differs most, if the policy has prices. */
  part: { name: 'flight' | 'onward' | 'stand'; by_usd: number } | undefined
}

export function leadOf(proposal: Proposal): Lead | undefined {
  // A choice that the policy does not consider may be worth more, and is no rival.
  const [first, second] = ranked(proposal).possible.filter(
    ({ to, value }) => to === proposal.to || value != null,
  )
  const [mine, other] = [first && numberOf(first), second && numberOf(second)]
  if (first === undefined || second === undefined || mine === undefined || other === undefined)
    return undefined
  if (mine < other) return undefined
  const [own, next] = [worthOf(first), worthOf(second)]
  const parts =
    own === undefined || next === undefined
      ? []
      : [
          { name: 'flight' as const, by_usd: own.flight_usd - next.flight_usd },
          { name: 'onward' as const, by_usd: own.onward_usd - next.onward_usd },
          { name: 'stand' as const, by_usd: own.stand_usd - next.stand_usd },
        ]
  const [part] = parts.sort((one, another) => another.by_usd - one.by_usd)
  return { of: second.to, by: mine - other, part: part !== undefined && part.by_usd > 0 ? part : undefined }
}

/** The kind of the displayed number; `none` is the score of a neural network, which has no unit. */
export function kindOfNumber({ policy, alternatives }: Proposal): 'worth' | 'dollars_per_hour' | 'none' {
  if (policy === 'greedy') return 'dollars_per_hour'
  return alternatives.some(({ worth_usd }) => worth_usd != null) ? 'worth' : 'none'
}

/**
 * Whether two proposals give the same advice: the same choice, and the same order of the other
 * possible ones.
 */
export function isSameAdvice(one: Proposal, other: Proposal): boolean {
  if (one.aircraft !== other.aircraft || one.at !== other.at || one.to !== other.to) return false
  const order = (proposal: Proposal) => {
    const { possible, impossible } = ranked(proposal)
    return [...possible, ...impossible]
      .map(({ to, impossible: reason }) => `${to}:${reason?.rule ?? ''}`)
      .join()
  }
  return order(one) === order(other)
}

/**
 * The worth of a choice at the bid prices, in parts that add up. The flight itself pays no price
 * for its passengers.
 */
export interface Worth {
  flight_usd: number
  /** The value of the aircraft's later flights from there. */
  onward_usd: number
  stand_usd: number
  worth_usd: number
  /** The policy's own value of the choice, if it compares by more than prices. */
  value_usd: number | undefined
}

/** The parts of a worth; undefined if the policy has no prices. */
export function worthOf(alternative: Alternative): Worth | undefined {
  const { worth_usd, stand_price_usd, flight_profit_usd, value } = alternative
  if (worth_usd == null) return undefined
  const stand_usd = -(stand_price_usd ?? 0)
  const onward_usd = worth_usd - flight_profit_usd - stand_usd
  const value_usd = value == null || Math.abs(value - worth_usd) < 0.01 ? undefined : value
  return { flight_usd: flight_profit_usd, onward_usd, stand_usd, worth_usd, value_usd }
}

/** When a flight takes off that waits for charge, and what its battery needs. */
export interface ChargeWait {
  takeoff: Seconds
  needs_kwh: number
}

/** The wait for charge of a choice; undefined if it takes off at the decision. */
export function waitOf(
  { takeoff, needs_kwh }: Pick<Alternative, 'takeoff' | 'needs_kwh'>,
  decided: Seconds,
): ChargeWait | undefined {
  if (takeoff == null || needs_kwh == null || timeOf(takeoff) <= decided) return undefined
  return { takeoff: timeOf(takeoff), needs_kwh }
}

/** A decision that was taken, and whether it can still be undone. */
export interface Decided {
  seq: number
  aircraft: string
  to: string
  at: Seconds
  actor: string
  policy: string | undefined
  insteadOf: string | undefined
  reason: string | undefined
  canBeUndone: boolean
}

/**
 * The latest decisions, newest first. A decision can be undone until the next event of its
 * aircraft.
 */
export function decidedLately(events: readonly TakenEvent[], most: number): Decided[] {
  const decided: Decided[] = []
  const goneOn = new Set<string>()
  for (let at = events.length - 1; at >= 0 && decided.length < most; at--) {
    const taken = events[at]
    if (taken === undefined || !('aircraft' in taken.event)) continue
    const { event } = taken
    if (event.type === 'decided' && !goneOn.has(`undone ${event.aircraft}`))
      decided.push(decidedOf(taken, event, goneOn))
    if (event.type === 'undone') goneOn.add(`undone ${event.aircraft}`)
    else if (event.type === 'decided') goneOn.delete(`undone ${event.aircraft}`)
    if (event.type === 'decided' || event.type === 'departed' || event.type === 'landed')
      goneOn.add(event.aircraft)
  }
  return decided
}

/** The events after which a decision can no longer be undone. */
const AFTERWARDS = ['decided', 'undone', 'departed', 'landed']

/**
 * Whether the known events still allow undoing the decision of an event. That event itself may not
 * have arrived yet.
 */
export function canBeTakenBack(events: readonly TakenEvent[], aircraft: string, seq: number): boolean {
  const latest = events.findLast(
    ({ event }) => 'aircraft' in event && event.aircraft === aircraft && AFTERWARDS.includes(event.type),
  )
  return latest === undefined || latest.seq <= seq
}

type DecidedEvent = Extract<TakenEvent['event'], { type: 'decided' }>

function decidedOf({ seq, actor }: TakenEvent, event: DecidedEvent, goneOn: Set<string>): Decided {
  return {
    seq,
    aircraft: event.aircraft,
    to: event.to,
    at: timeOf(event.time ?? 0),
    actor,
    policy: event.policy ?? undefined,
    insteadOf: event.instead_of ?? undefined,
    reason: event.reason ?? undefined,
    canBeUndone: !goneOn.has(event.aircraft),
  }
}
