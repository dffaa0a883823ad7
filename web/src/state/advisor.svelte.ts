// Advice for one aircraft, as a user reads and accepts it. The displayed advice never changes while
// the user works with it. If the day advances meanwhile, the newer advice waits until the user asks
// for it.

import { PRECONDITION_FAILED, refusal, ProblemError } from '../api/problem'
import type { Service } from '../api/client'
import type { Proposal, TakenDecision } from '../api/types'
import { isSameAdvice } from '../model/decisions'
import { Refresher } from './refresher'

/** How often an acceptance is retried if the day advances while the advice stays the same. */
const TRIES = 6
const PACE = { soon_ms: 80, least_ms: 700, share: 3 }
/**
 * Advice can be accepted only after it has been visible this long, so that a double key press does
 * not also decide for the next aircraft.
 */
const SEEN_MS = 350
/** A decision without an answer after this time is shown as unanswered. */
const ANSWER_MS = 2_000

/** The result of a decision. */
export type Outcome = { kind: 'taken'; taken: TakenDecision } | { kind: 'changed' } | { kind: 'none' }

export class Advisor {
  /** The aircraft of the advice. */
  aircraft = $state<string>()
  /** The policy that gives the advice; the day's own if absent. */
  policy = $state<string>()
  proposal = $state.raw<Proposal>()
  /** Newer advice that differs from the displayed one and waits. */
  newer = $state.raw<Proposal>()
  /** Why there is no advice. */
  problem = $state.raw<ProblemError>()
  isBusy = $state(false)
  /** Whether a decision was sent a while ago and has no answer yet. */
  isUnanswered = $state(false)
  /** Whether the user points at the advice or has the focus in it. */
  isEngaged = $state(false)
  /** Whether the advice has been visible for long enough that an acceptance is intentional. */
  #isSeen = $state(false)
  #seeing: ReturnType<typeof setTimeout> | undefined
  #asked = 0
  readonly #refresher = new Refresher(PACE, () => this.#refresh())

  constructor(
    private readonly day: string,
    private readonly service: Service,
  ) {}

  stop(): void {
    this.#refresher.stop()
    clearTimeout(this.#seeing)
  }

  /** Asks for advice about an aircraft, replacing the displayed advice. */
  async ask(aircraft: string | undefined, policy = this.policy): Promise<void> {
    if (aircraft !== this.aircraft) this.proposal = undefined
    this.aircraft = aircraft
    this.policy = policy
    this.newer = undefined
    this.problem = undefined
    if (aircraft === undefined) return
    const asked = ++this.#asked
    try {
      const proposal = await this.service.propose(this.day, aircraft, policy)
      if (asked === this.#asked) this.#show(proposal)
    } catch (problem) {
      if (asked === this.#asked) this.#fail(problem)
    }
  }

  /** The day has advanced, so the displayed advice may be out of date. */
  moveOn(seq: number): void {
    const known = this.newer ?? this.proposal
    if (known !== undefined && seq > known.seq) this.#refresher.request()
  }

  showNewer(): void {
    if (this.newer !== undefined) this.#show(this.newer)
  }

  get canAccept(): boolean {
    return this.proposal !== undefined && this.#isSeen && !this.isBusy && this.newer === undefined
  }

  /**
   * Accepts the displayed advice and no other. If the policy's advice has changed, the new advice
   * is offered instead.
   */
  async accept(): Promise<Outcome> {
    const shown = this.proposal
    if (shown === undefined || !this.canAccept) return { kind: 'none' }
    return this.#busy(async () => {
      let seq = shown.seq
      for (let left = TRIES; left > 0; left--) {
        const asked = {
          aircraft: shown.aircraft,
          ...(this.policy === undefined ? {} : { policy: this.policy }),
        }
        let refused: ProblemError
        try {
          return { kind: 'taken', taken: await this.service.decide(this.day, asked, seq) }
        } catch (problem) {
          if (!(problem instanceof ProblemError) || problem.status !== PRECONDITION_FAILED) throw problem
          refused = problem
        }
        const now = await this.#proposeAfter(refused, shown.aircraft)
        if (now.to !== shown.to) {
          this.newer = now
          return { kind: 'changed' }
        }
        seq = now.seq
      }
      const last = { aircraft: shown.aircraft, to: shown.to }
      return { kind: 'taken', taken: await this.service.decide(this.day, last) }
    })
  }

  /** Asks again after a refusal, which tells what came first if the aircraft no longer waits. */
  async #proposeAfter(refused: ProblemError, aircraft: string): Promise<Proposal> {
    try {
      return await this.service.propose(this.day, aircraft, this.policy)
    } catch (problem) {
      throw refused.happened === undefined ? problem : refused
    }
  }

  /** Decides for an aircraft as the policy advises at present, whatever advice is displayed. */
  acceptFor(aircraft: string): Promise<TakenDecision> {
    const policy = this.policy === undefined ? {} : { policy: this.policy }
    return this.service.decide(this.day, { aircraft, ...policy })
  }

  /** Decides differently from the advice, with a reason. */
  async override(to: string, reason: string): Promise<Outcome> {
    const aircraft = this.aircraft
    if (aircraft === undefined || this.isBusy) return { kind: 'none' }
    return this.#busy(async () => ({
      kind: 'taken',
      taken: await this.service.decide(this.day, { aircraft, to, reason }),
    }))
  }

  async #busy(work: () => Promise<Outcome>): Promise<Outcome> {
    this.isBusy = true
    const waiting = setTimeout(() => (this.isUnanswered = true), ANSWER_MS)
    try {
      return await work()
    } finally {
      clearTimeout(waiting)
      this.isBusy = false
      this.isUnanswered = false
    }
  }

  async #refresh(): Promise<void> {
    const [aircraft, shown] = [this.aircraft, this.proposal]
    if (aircraft === undefined || shown === undefined) return
    try {
      const fresh = await this.service.propose(this.day, aircraft, this.policy)
      if (this.proposal !== shown || this.isBusy) return
      if (isSameAdvice(shown, fresh)) this.#update(fresh)
      else if (this.isEngaged) this.newer = fresh
      else this.#show(fresh)
    } catch (problem) {
      // The state of the day shows that the aircraft no longer waits; the connection shows that
      // there was no answer.
      if (!(problem instanceof ProblemError)) throw problem
    }
  }

  /** The same advice with newer numbers is updated in place. */
  #update(proposal: Proposal): void {
    this.proposal = proposal
    this.newer = undefined
  }

  #show(proposal: Proposal): void {
    this.#update(proposal)
    this.#isSeen = false
    clearTimeout(this.#seeing)
    this.#seeing = setTimeout(() => (this.#isSeen = true), SEEN_MS)
  }

  #fail(problem: unknown): void {
    this.problem = refusal(problem)
  }
}
