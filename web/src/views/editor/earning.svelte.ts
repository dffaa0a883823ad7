// The profit of a day of the edited network, and of the network it was made from on days of the
// same seeds. It outlives the view, like the network.

import { untrack } from 'svelte'
import { NOT_FOUND, refusal, type ProblemError } from '../../api/problem'
import type { PolicyResult, StudyInfo } from '../../api/types'
import { session } from '../../state/session.svelte'
import { toasts } from '../../state/toasts.svelte'
import { follow, hasEnded } from '../studies/follow'
import type { NetworkText } from './editor.svelte'

const SEED = 1

/** A request: days of the same seeds, by one policy. */
interface StudyRequest {
  policy: string
  days: number
}

/** A study of one network. */
class Played {
  study = $state.raw<StudyInfo>()
  readonly id: string

  private constructor(
    readonly network: NetworkText,
    readonly request: StudyRequest,
    study: StudyInfo,
  ) {
    this.study = study
    this.id = study.id
  }

  static async begin(network: NetworkText, request: StudyRequest): Promise<Played> {
    const { policy, days } = request
    const body = { toml: network.toml, policies: [policy], days, seed: SEED }
    return new Played(network, request, await session.service.makeStudy(body))
  }

  get isPlaying(): boolean {
    return this.study !== undefined && !hasEnded(this.study)
  }

  get result(): PolicyResult | undefined {
    return this.study?.result?.policies[0]
  }

  /** Whether the result is for these days, so that it can be compared day by day. */
  isResultOf({ policy, days }: StudyRequest): boolean {
    return this.result !== undefined && this.request.policy === policy && this.request.days === days
  }
}

class Earning {
  /** The edited network. */
  now = $state.raw<Played>()
  /**
   * The comparison: the network it was made from or, for a new one, its version before the latest
   * change.
   */
  before = $state.raw<Played>()
  problem = $state.raw<ProblemError>()
  isAsking = $state(false)

  get isPlaying(): boolean {
    return this.now?.isPlaying === true || this.before?.isPlaying === true
  }

  forget(): void {
    this.now = undefined
    this.before = undefined
    this.problem = undefined
  }

  /** Plays the edited network, then the one it was made from unless its result is already known. */
  async play(network: NetworkText, origin: NetworkText | undefined, request: StudyRequest): Promise<void> {
    const former = [this.now, this.before].filter((one) => one !== undefined)
    const known = former.filter((one) => one.isResultOf(request) && one.network.toml !== network.toml)
    this.isAsking = true
    this.problem = undefined
    try {
      this.now = await Played.begin(network, request)
      this.before = known.find((one) => origin === undefined || one.network.toml === origin.toml)
      if (this.before === undefined && origin !== undefined && origin.toml !== network.toml)
        this.before = await Played.begin(origin, request)
    } catch (cause) {
      this.problem = refusal(cause)
    } finally {
      this.isAsking = false
    }
  }

  /** Follows running studies until the returned function is called. */
  follow(): () => void {
    const played = [this.now, this.before].filter((one) => one !== undefined)
    // An answer must not start this effect again.
    const playing = untrack(() => played.filter((one) => one.isPlaying))
    const stops = playing.map((one) => this.#followOne(one))
    return () => stops.forEach((stop) => stop())
  }

  /** Stops running studies; finished results stay. */
  async stop(): Promise<void> {
    const ended = [this.now, this.before].filter((one) => one?.isPlaying === true)
    if (this.now?.isPlaying === true) this.now = undefined
    if (this.before?.isPlaying === true) this.before = undefined
    try {
      for (const one of ended) if (one !== undefined) await session.service.endStudy(one.id)
    } catch (cause) {
      toasts.fail(cause)
    }
  }

  #followOne(played: Played): () => void {
    return follow(
      played.id,
      (study) => (played.study = study),
      (problem) => {
        this.problem = problem
        if (problem.status === NOT_FOUND) played.study = undefined
      },
    )
  }
}

export const earning = new Earning()
