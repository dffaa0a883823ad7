// Since when things have been so that a console sees from time to time: what has ended and comes back is another occurrence.

import type { Seconds } from './record'

export class Occurrences {
  #seen = new Map<string, Seconds>()

  /** Takes what there is at a time. */
  see(keys: readonly string[], time: Seconds): void {
    this.#seen = new Map(keys.map((key) => [key, this.#seen.get(key) ?? time]))
  }

  /** When this occurrence of something was seen first. */
  firstSeen(key: string): Seconds | undefined {
    return this.#seen.get(key)
  }
}
