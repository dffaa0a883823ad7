// Records when each condition was first observed in a series of observations. If a condition ends
// and comes back, that is a new occurrence.

import type { Seconds } from './record'

export class Occurrences {
  #seen = new Map<string, Seconds>()

  /** Records the conditions that hold at a time. */
  update(keys: readonly string[], time: Seconds): void {
    this.#seen = new Map(keys.map((key) => [key, this.#seen.get(key) ?? time]))
  }

  /** When the current occurrence of a condition was first observed. */
  firstSeen(key: string): Seconds | undefined {
    return this.#seen.get(key)
  }
}
