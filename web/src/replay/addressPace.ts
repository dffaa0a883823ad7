// How soon the address may take another moment. Browsers refuse an address that changes more than about a hundred times in half a
// minute, as when a moment is dragged along the day. So the more often it has changed lately, the longer the next change waits; a
// few steps by key never wait.

const LATELY_MS = 10_000
/** Each change of late makes the next wait so much longer: with 30 changes in 10 s, about as many more are let through. */
const EACH_MS = 15

export class AddressPace {
  #changes_ms: number[] = []

  /** How long the next change has to wait; 0 if it need not. */
  wait(now_ms: number): number {
    this.#changes_ms = this.#changes_ms.filter((change_ms) => now_ms - change_ms < LATELY_MS)
    const latest_ms = this.#changes_ms.at(-1)
    return latest_ms === undefined ? 0 : Math.max(0, latest_ms + EACH_MS * this.#changes_ms.length - now_ms)
  }

  changed(now_ms: number): void {
    this.#changes_ms.push(now_ms)
  }
}
