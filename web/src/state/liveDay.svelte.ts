// A live day in the console: read once, then kept up to date by its event stream. The service knows
// the rules, so after events its state, trace and outlook are read again, at a limited rate.

import type { Service } from '../api/client'
import { ProblemError, UNAUTHORIZED } from '../api/problem'
import { follow, type Connection } from '../api/stream'
import type { AircraftState, DayInfo, DayState, Outlook, TakenEvent } from '../api/types'
import { alertsOf, listed, type Alert, type ListedAlert } from '../model/alerts'
import { aircraftAt, endOfMinute, recordAt } from '../model/awaited'
import { canBeTakenBack, decidedSince } from '../model/decisions'
import { liveRecord } from '../model/live'
import { canBeDecidedAgain, isOver } from '../model/over'
import { WINDOW_MS } from '../model/pace'
import type { DayRecord, LegRecord, Seconds } from '../model/record'
import { withoutCorrected } from '../model/corrected'
import { Reports } from '../model/reports'
import type { Scenario, ScenarioAircraftType } from '../model/scenario'
import type { Target } from '../model/target'
import { timeOf } from '../model/time'
import { recordOf } from '../model/traces'
import { Whereabouts } from '../model/whereabouts'
import { Clock } from './clock.svelte'
import { OwnDecisions } from './ownDecisions.svelte'
import { Refresher } from './refresher'

/**
 * The number of events kept for the log. Earlier ones remain in the service, so a long day does not
 * fill the memory.
 */
export const MOST_KEPT_EVENTS = 20_000

/** How soon after an event the state is read, and the pause between two reads. */
const STATE_PACE = { soon_ms: 60, least_ms: 500, share: 3 }
/**
 * An outlook is expensive for the service, so it is read less often and takes at most a quarter of
 * its time.
 */
const OUTLOOK_PACE = { soon_ms: 250, least_ms: 1_500, share: 4 }

/** A plan that is behind the state for this long is shown as being computed. */
const PLAN_LATE_MS = 2_000
/** The answers of a service that is busy or away for the moment. */
const PASSING = [0, 408, 429, 503, 504]

const SECOND_MS = 1_000

export class LiveDay {
  info = $state.raw<DayInfo>()
  state = $state.raw<DayState>()
  outlook = $state.raw<Outlook>()
  events = $state.raw<TakenEvent[]>([])
  /** The events that were not taken back. */
  readonly valid: readonly TakenEvent[] = $derived(withoutCorrected(this.events))
  connection = $state<Connection>('connecting')
  /** Seconds since the service last sent anything on the stream. */
  silent_s = $state(0)
  /** Why the day cannot be read or followed; undefined if it can. */
  problem = $state.raw<ProblemError>()
  /** Whether the plan for the rest of the day is missing, or has been behind for a while. */
  isPlanAwaited = $state(true)
  #planBehindSince: number | undefined
  /** Why there is no outlook; undefined if there is one or will be. */
  outlookProblem = $state.raw<ProblemError>()
  readonly clock = new Clock()
  #scenario = $state.raw<Scenario>()
  /** Whether events have changed what earlier ones led to, so that all are to be read again. */
  #isOutdated = false
  /** Counts the events applied to the reports, so that derived values are computed again. */
  #reported = $state(0)
  #reports: Reports | undefined
  /** The decided legs, of the trace that was read last. */
  #decided = $state.raw<readonly LegRecord[]>([])
  readonly #service: Service
  readonly #stateRefresher = new Refresher(STATE_PACE, () => this.#readState())
  readonly #outlookRefresher = new Refresher(OUTLOOK_PACE, () => this.#readOutlook())
  #heardAt = performance.now()
  readonly #listening = setInterval(() => this.#listen(), SECOND_MS)
  #stopFollowing: (() => void) | undefined
  #stopClock: (() => void) | undefined
  #isClosed = false

  constructor(
    readonly id: string,
    service: Service,
  ) {
    this.#service = service
    this.ownDecisions = new OwnDecisions(id)
  }

  get scenario(): Scenario | undefined {
    return this.#scenario
  }

  /** The day as reported and expected; undefined until its state is known. */
  readonly #reportedRecord: DayRecord | undefined = $derived.by(() => {
    const [scenario, reports, state] = [this.#scenario, this.#reports, this.state]
    if (scenario === undefined || reports === undefined || state === undefined || this.#reported < 0)
      return undefined
    return liveRecord({ scenario, reports, state, outlook: this.outlook, decided: this.#decided })
  })

  /** The end of the current minute: up to here, unreported events have not happened. */
  readonly #minute: Seconds = $derived(endOfMinute(this.clock.time))

  /** The record of the day in the current minute. */
  readonly record: DayRecord | undefined = $derived(
    this.#reportedRecord && recordAt(this.#reportedRecord, this.#minute),
  )

  /** Every aircraft in the current minute. */
  readonly aircraft: readonly AircraftState[] = $derived(
    this.state === undefined || this.record === undefined ? [] : aircraftAt(this.state, this.record),
  )

  readonly #alertsNow: readonly Alert[] = $derived.by(() => {
    const { state, record } = this
    if (state === undefined || record === undefined || this.#scenario === undefined) return []
    return alertsOf({ scenario: this.#scenario, state, record, events: this.valid, time: this.#minute })
  })

  /** The alerts, unacknowledged ones first. */
  readonly alerts: readonly ListedAlert[] = $derived.by(() =>
    listed(this.#alertsNow, this.state?.acknowledged ?? []),
  )

  /** Acknowledges alerts for all users; they stay in the list. */
  async acknowledge(keys: readonly string[]): Promise<void> {
    await this.#service.report(
      this.id,
      keys.map((alert) => ({ type: 'acknowledged', alert })),
    )
    await this.readNow()
  }

  /** Takes an event back: the day is then as if it had not been reported. */
  async correct(seq: number, reason: string): Promise<void> {
    const given = reason === '' ? {} : { reason }
    await this.#service.report(this.id, { type: 'corrected', event: seq, ...given })
    this.refresh()
  }

  /** The reported part of the day, without expected legs, for pictures of one time. */
  readonly happened: DayRecord | undefined = $derived.by(() => {
    const record = this.#reportedRecord
    return record === undefined
      ? undefined
      : { ...record, legs: record.legs.filter((leg) => !leg.is_expected) }
  })

  /** Whether there are no decisions left and every aircraft is on the ground. */
  readonly isOver: boolean = $derived.by(() => {
    const { state, end } = this
    return state !== undefined && end !== undefined && isOver(state, end)
  })

  /** When operations end. */
  get end(): Seconds | undefined {
    return this.#scenario === undefined ? undefined : timeOf(this.#scenario.operations.end)
  }

  /** Aircraft that were decided after the known state. */
  readonly decidedSince: ReadonlySet<string> = $derived(decidedSince(this.valid, this.state?.seq ?? 0))

  /** The decisions taken at this console, so that it can mark them and undo them. */
  readonly ownDecisions: OwnDecisions

  /** The places of departures and landings. */
  whereabouts = new Whereabouts()

  /** Reads the day and follows it until it is closed. */
  async open(): Promise<void> {
    try {
      const [info, scenario] = await Promise.all([
        this.#service.day(this.id),
        this.#service.scenario(this.id),
      ])
      this.info = info
      this.#scenario = scenario
      await this.#readAll()
    } catch (problem) {
      this.#fail(problem)
    }
  }

  close(): void {
    this.#isClosed = true
    clearInterval(this.#listening)
    this.#stopFollowing?.()
    this.#stopClock?.()
    this.#stateRefresher.stop()
    this.#outlookRefresher.stop()
  }

  /** Reads the state and the outlook now, after an action at this console. */
  refresh(): void {
    this.#stateRefresher.request()
    this.#outlookRefresher.request()
  }

  /**
   * Follows the day again after the stream was refused, for example because a token had been
   * revoked.
   */
  resume(): void {
    if (this.state === undefined) void this.open()
    else {
      this.#follow(this.events.at(-1)?.mark)
      this.refresh()
    }
  }

  /** Reads the state now and the outlook soon, for a user who has just decided and continues. */
  async readNow(): Promise<void> {
    this.#outlookRefresher.request()
    await this.#readState()
  }

  /** Whether an aircraft's latest decision can be replaced by another. */
  canBeDecidedAgain(aircraft: AircraftState): boolean {
    const { state, end, info } = this
    if (state === undefined || end === undefined || info?.archived === true) return false
    return canBeDecidedAgain(state, aircraft, end)
  }

  /** Whether, to the console's knowledge, an aircraft's decision from an event can be undone. */
  canBeTakenBack(aircraft: string, seq: number): boolean {
    const known = this.state?.aircraft.find((one) => one.id === aircraft)
    // An aircraft that is missing in the state was decided only now.
    const isPossible = known === undefined || known.needs_decision || this.canBeDecidedAgain(known)
    return isPossible && !this.isOver && canBeTakenBack(this.valid, aircraft, seq)
  }

  /** Undoes the latest decision of an aircraft. */
  async takeBack(aircraft: string): Promise<void> {
    await this.#service.report(this.id, { type: 'undone', aircraft })
    this.refresh()
  }

  /** The leg of an aircraft under way, with the report that it awaits. */
  awaitedLeg(aircraft: string): LegRecord | undefined {
    const { record } = this
    return record?.legs.find(
      (leg) => leg.awaited !== undefined && record.aircraft[leg.aircraft]?.id === aircraft,
    )
  }

  /** The number of an aircraft of the day. */
  indexOf(aircraft: string | undefined): number | undefined {
    const index = this.#scenario?.aircraft.findIndex((one) => one.id === aircraft) ?? -1
    return index < 0 ? undefined : index
  }

  /** An aircraft as a selection target. */
  targetOf(aircraft: string | undefined): Target | undefined {
    const index = this.indexOf(aircraft)
    return index === undefined ? undefined : { kind: 'aircraft', aircraft: index }
  }

  /** Whether aircraft decide whatever their charge. */
  get chargesAsNeeded(): boolean {
    return this.#scenario?.operations.charging === 'as_needed'
  }

  /** The type of an aircraft; undefined if there is none of this id. */
  typeOf(aircraft: string | undefined): ScenarioAircraftType | undefined {
    const one = this.#scenario?.aircraft.find(({ id }) => id === aircraft)
    return this.#scenario?.aircraft_types.find(({ id }) => id === one?.type)
  }

  /** When an aircraft is or was ready. */
  readyOf(aircraft: string): Seconds {
    return timeOf(this.aircraft.find((one) => one.id === aircraft)?.ready ?? 0)
  }

  async #readAll(): Promise<void> {
    const [state, events, trace] = await Promise.all([
      this.#service.state(this.id),
      this.#service.events(this.id, 0),
      this.#service.trace(this.id),
    ])
    if (this.#isClosed || this.#scenario === undefined) return
    this.#isOutdated = false
    this.#decided = recordOf(this.#scenario, trace).legs
    this.#reports = new Reports(this.#scenario)
    this.whereabouts = new Whereabouts()
    this.events = []
    this.#take(events)
    this.ownDecisions.forgetAfter(events.at(-1)?.seq ?? 0)
    if (timeOf(state.now) < this.clock.time) this.clock.goBack(timeOf(state.now))
    this.#takeState(state)
    this.#outlookRefresher.request()
    this.#stopClock ??= this.clock.run()
    this.#follow(events.at(-1)?.mark)
  }

  #follow(after: string | undefined): void {
    this.#stopFollowing?.()
    this.#stopFollowing = follow({
      url: this.#service.streamUrl(this.id),
      headers: () => this.#service.headers(),
      after,
      onEvents: (events) => {
        // A correction changes what earlier events have led to.
        this.#isOutdated ||= events.some(({ event }) => event.type === 'corrected')
        if (!this.#isOutdated) this.#take(events)
        this.refresh()
      },
      onConnection: (connection, problem) => this.#connect(connection, problem),
      onSign: () => this.#hearSign(),
      onRewound: () => {
        // Event numbers now refer to other events.
        this.ownDecisions.forgetAfter(0)
        this.#isOutdated = true
        this.refresh()
      },
    })
  }

  #hearSign(): void {
    this.#heardAt = performance.now()
    this.silent_s = 0
  }

  /** Notes since when the plan has been behind the state. */
  #notePlan(): void {
    const isBehind = (this.outlook?.seq ?? -1) < (this.state?.seq ?? 0)
    if (!isBehind) this.#planBehindSince = undefined
    else this.#planBehindSince ??= performance.now()
    const since = this.#planBehindSince
    this.isPlanAwaited =
      this.outlook === undefined || (since !== undefined && performance.now() - since >= PLAN_LATE_MS)
  }

  #listen(): void {
    this.#notePlan()
    this.silent_s = Math.floor((performance.now() - this.#heardAt) / SECOND_MS)
  }

  #connect(connection: Connection, problem: ProblemError | undefined): void {
    const heals =
      this.connection !== 'connecting' && this.connection !== 'connected' && connection === 'connected'
    this.connection = connection
    if (connection === 'connected') this.#hearSign()
    this.clock.hold(connection !== 'connected')
    this.problem = connection === 'connected' ? undefined : problem
    // A request that is refused for lack of a token makes the console ask for one.
    if (heals || problem?.status === UNAUTHORIZED) this.refresh()
  }

  #take(events: TakenEvent[]): void {
    for (const event of withoutCorrected(events)) {
      this.#reports?.take(event)
      this.whereabouts.take(event)
    }
    const all = [...this.events, ...events]
    this.events = all.length > MOST_KEPT_EVENTS ? all.slice(-MOST_KEPT_EVENTS) : all
    this.#reported += events.length
    this.#observe(events)
  }

  /** Events from before the page was opened still show how fast the day passes. */
  #observe(events: TakenEvent[]): void {
    const now = Date.now()
    for (const { event, at_ms } of events) {
      const age_ms = Math.max(0, now - at_ms)
      if (age_ms < WINDOW_MS) this.clock.observe(timeOf(event.time ?? 0), age_ms)
    }
  }

  async #readState(): Promise<void> {
    try {
      if (this.#isOutdated) {
        await this.#readAll()
        return
      }
      this.#takeState(await this.#service.state(this.id))
      // The trace is read after the state, so it has every leg of it.
      const trace = await this.#service.trace(this.id)
      if (this.#scenario !== undefined) this.#decided = recordOf(this.#scenario, trace).legs
    } catch (problem) {
      // A service that is busy is asked again; no event may follow for a while.
      if (problem instanceof ProblemError && problem.status !== 0 && isPassing(problem))
        this.#stateRefresher.request()
      else this.#fail(problem)
    }
  }

  #takeState(state: DayState): void {
    this.state = state
    this.#notePlan()
    const now = timeOf(state.now)
    this.clock.setAwaited(state.aircraft.some((one) => one.needs_decision))
    if (this.isOver) this.clock.end(now)
    else this.clock.observe(now)
  }

  async #readOutlook(): Promise<void> {
    try {
      this.outlook = await this.#service.outlook(this.id)
      this.outlookProblem = undefined
      this.#notePlan()
    } catch (problem) {
      if (!(problem instanceof ProblemError)) throw problem
      // A service that is busy is asked again; no event may follow for a while.
      if (isPassing(problem)) this.#outlookRefresher.request()
      else this.outlookProblem = problem
    }
  }

  #fail(problem: unknown): void {
    if (!(problem instanceof ProblemError)) throw problem
    // The stream shows that the connection is lost and triggers a read when it is back.
    if (problem.status !== 0 || this.state === undefined) this.problem = problem
  }
}

function isPassing({ status }: ProblemError): boolean {
  return PASSING.includes(status)
}
