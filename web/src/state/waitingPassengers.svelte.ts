// Who waits for a flight at this moment, as the service counts them, for as long as something shows it.

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

  /** The day has moved on, so others may wait. */
  moveOn(seq: number): void {
    if (this.#demand === undefined || seq > this.#demand.seq) this.#refresher.want()
  }

  /** The pairs with passengers who wait; undefined until the service has said who does. */
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
      // What the record of the day says takes its place; that the connection is away is said elsewhere.
      if (!(problem instanceof ProblemError)) throw problem
      this.#demand = undefined
    }
  }
}
