// Limits how often the address changes. Browsers reject more than about a hundred changes in half a
// minute, for example while a user drags the scrubber. So the wait for the next change grows with
// the number of recent ones; a few steps by key never wait.

const LATELY_MS = 10_000
/**
 * Each recent change adds this to the wait. After 30 changes in 10 s, about as many more are
 * allowed.
 */
const EACH_MS = 15

export class AddressPace {
  #changes_ms: number[] = []

  /** The remaining wait before the next change; 0 if there is none. */
  wait(now_ms: number): number {
    this.#changes_ms = this.#changes_ms.filter((change_ms) => now_ms - change_ms < LATELY_MS)
    const latest_ms = this.#changes_ms.at(-1)
    return latest_ms === undefined ? 0 : Math.max(0, latest_ms + EACH_MS * this.#changes_ms.length - now_ms)
  }

  changed(now_ms: number): void {
    this.#changes_ms.push(now_ms)
  }
}
