// The passengers who are waiting now, as counted by the service, read while a view shows them.

import type { Service } from '../api/client'
import { ProblemError } from '../api/problem'
import type { PeriodDemand } from '../api/types'
import { indexed, known } from '../model/reports'
import type { Scenario } from '../model/scenario'
import type { WaitingPair } from '../model/waiting'
import { Refresher } from './refresher'

const PACE = { soon_ms: 120, least_ms: 1_000, share: 4 }

export class WaitingPassengers {
  #demand = $state.raw<PeriodDemand>()
  readonly #refresher = new Refresher(PACE, () => this.#read())

  constructor(
    private readonly day: string,
    private readonly service: Service,
  ) {}

  stop(): void {
    this.#refresher.stop()
  }

  /** The day has advanced, so the waiting passengers may have changed. */
  moveOn(seq: number): void {
    if (this.#demand === undefined || seq > this.#demand.seq) this.#refresher.request()
  }

  /** The pairs with waiting passengers; undefined until the service has answered. */
  pairs({ vertiports }: Scenario): WaitingPair[] | undefined {
    const places = indexed(vertiports)
    return this.#demand?.pairs.map(({ from, to, passengers }) => ({
      from: known(places, from),
      to: known(places, to),
      passengers,
    }))
  }

  async #read(): Promise<void> {
    try {
      this.#demand = await this.service.demand(this.day)
    } catch (problem) {
      // The record of the day replaces the answer; the connection mark shows that the connection is
      // lost.
      if (!(problem instanceof ProblemError)) throw problem
      this.#demand = undefined
    }
  }
}
