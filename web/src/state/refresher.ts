// Asks for something again after it has changed: soon, one request at a time, and never so often that asking is all there is.

export interface RefreshPace {
  /** How long to wait after the first change: others often follow at once. */
  soon_ms: number
  /** The least time between two requests. */
  least_ms: number
  /** How many times as long as an answer took to wait before the next request. */
  share: number
}

export class Refresher {
  #isWanted = false
  #isAsking = false
  #isStopped = false
  #notBefore = 0
  #timer: ReturnType<typeof setTimeout> | undefined

  constructor(
    private readonly pace: RefreshPace,
    private readonly ask: () => Promise<void>,
  ) {}

  /** Says that what is known is no longer new. */
  want(): void {
    this.#isWanted = true
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
    this.#isWanted = false
    this.#isAsking = true
    const asked = performance.now()
    try {
      await this.ask()
    } finally {
      const took_ms = performance.now() - asked
      this.#notBefore = asked + Math.max(this.pace.least_ms, this.pace.share * took_ms)
      this.#isAsking = false
    }
    // eslint-disable-next-line @typescript-eslint/no-unnecessary-condition -- it may have been wanted while it was asked.
    if (this.#isWanted) this.want()
  }
}
