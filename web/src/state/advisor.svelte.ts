// Advice for one aircraft, as a person reads and takes it. What is shown never changes while the user works with it: if the
// day moves on meanwhile, the newer advice waits until it is asked for.

import { refusal, ProblemError } from '../api/problem'
import type { Service } from '../api/client'
import type { Proposal, TakenDecision } from '../api/types'
import { isSameAdvice } from '../model/decisions'
import { Refresher } from './refresher'

/** The day has gone on since what the request was made for. */
const GONE_ON = 412
/** How often an acceptance is tried again when the day goes on while the advice stays the same. */
const TRIES = 6
const PACE = { soon_ms: 80, least_ms: 700, share: 3 }
/** Advice can be taken once it has been seen: a key that is pressed twice must not decide for the next aircraft too. */
const SEEN_MS = 350
/** A decision that has no answer after this time is said to have none. */
const ANSWER_MS = 2_000

/** What came of taking a decision. */
export type Outcome = { kind: 'taken'; taken: TakenDecision } | { kind: 'changed' } | { kind: 'none' }

export class Advisor {
  /** For whom advice is asked. */
  aircraft = $state<string>()
  /** The policy that is asked; the day's own if absent. */
  policy = $state<string>()
  proposal = $state.raw<Proposal>()
  /** Advice that differs from what is shown, and waits. */
  newer = $state.raw<Proposal>()
  /** Why there is no advice. */
  problem = $state.raw<ProblemError>()
  isBusy = $state(false)
  /** Whether a decision was sent a while ago and has no answer yet. */
  isUnanswered = $state(false)
  /** Whether the user points at the advice or has the focus in it. */
  isEngaged = $state(false)
  /** Whether the advice has been shown for long enough to be meant by a user who takes it. */
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

  /** Asks for advice about an aircraft, in the place of what is shown. */
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

  /** The day has moved on, so what is shown may no longer hold. */
  moveOn(seq: number): void {
    const known = this.newer ?? this.proposal
    if (known !== undefined && seq > known.seq) this.#refresher.want()
  }

  showNewer(): void {
    if (this.newer !== undefined) this.#show(this.newer)
  }

  get canAccept(): boolean {
    return this.proposal !== undefined && this.#isSeen && !this.isBusy && this.newer === undefined
  }

  /** Takes the advice that is shown, and no other: if the policy has come to another by now, that is shown instead. */
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
        try {
          return { kind: 'taken', taken: await this.service.decide(this.day, asked, seq) }
        } catch (problem) {
          if (!(problem instanceof ProblemError) || problem.status !== GONE_ON) throw problem
        }
        const now = await this.service.propose(this.day, shown.aircraft, this.policy)
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

  /** Decides otherwise, for a reason. */
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
      // That the aircraft no longer waits is seen in the state of the day; that no answer came, in the connection.
      if (!(problem instanceof ProblemError)) throw problem
    }
  }

  /** The same advice with newer numbers changes in place. */
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
