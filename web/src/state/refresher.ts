// Repeats a request after changes: soon, one request at a time, and with pauses that limit the
// load.

export interface RefreshPace {
  /** The wait after the first change, because others often follow at once. */
  soon_ms: number
  /** The minimum time between two requests. */
  least_ms: number
  /** The pause before the next request, as a multiple of the duration of the last one. */
  share: number
}

export class Refresher {
  #isRequested = false
  #isAsking = false
  #isStopped = false
  #notBefore = 0
  #timer: ReturnType<typeof setTimeout> | undefined

  constructor(
    private readonly pace: RefreshPace,
    private readonly ask: () => Promise<void>,
  ) {}

  /** Requests a refresh, because the known value is out of date. */
  request(): void {
    this.#isRequested = true
    if (this.#timer !== undefined || this.#isAsking || this.#isStopped) return
    const wait_ms = Math.max(this.pace.soon_ms, this.#notBefore - performance.now())
    this.#timer = setTimeout(() => void this.#refresh(), wait_ms)
  }

  stop(): void {
    this.#isStopped = true
    clearTimeout(this.#timer)
  }

  async #refresh(): Promise<void> {
    this.#timer = undefined
    this.#isRequested = false
    this.#isAsking = true
    const asked = performance.now()
    try {
      await this.ask()
    } finally {
      const took_ms = performance.now() - asked
      this.#notBefore = asked + Math.max(this.pace.least_ms, this.pace.share * took_ms)
      this.#isAsking = false
    }
    // eslint-disable-next-line @typescript-eslint/no-unnecessary-condition -- set meanwhile.
    if (this.#isRequested) this.request()
  }
}
