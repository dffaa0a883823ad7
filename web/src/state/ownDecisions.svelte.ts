// The decisions taken at this console, by event number. Without tokens the service cannot identify
// users, so only the console can show "you". They are kept in the tab's session storage, so they
// survive a reload; other tabs and users do not have them.

import { SvelteSet } from 'svelte/reactivity'

const KEY = 'vertifleet-decided'
/** More decisions than a user undoes or looks for. */
const MOST_KEPT = 2_000

export class OwnDecisions {
  readonly #numbers: SvelteSet<number>
  readonly #key: string

  constructor(
    day: string,
    private readonly storage: Pick<Storage, 'getItem' | 'setItem'> = sessionStorage,
  ) {
    this.#key = `${KEY} ${day}`
    this.#numbers = new SvelteSet(numbersIn(storage.getItem(this.#key)))
  }

  has(seq: number): boolean {
    return this.#numbers.has(seq)
  }

  add(seq: number): void {
    this.#numbers.add(seq)
    this.#keep()
  }

  /**
   * Forgets numbers after the latest event of a restored day, because other events will get them.
   */
  forgetAfter(latest: number): void {
    const gone = [...this.#numbers].filter((seq) => seq > latest)
    for (const seq of gone) this.#numbers.delete(seq)
    if (gone.length > 0) this.#keep()
  }

  #keep(): void {
    const latest = [...this.#numbers].slice(-MOST_KEPT)
    try {
      this.storage.setItem(this.#key, JSON.stringify(latest))
    } catch {
      // If the storage is full or forbidden, these are lost on a reload.
    }
  }
}

/** The stored numbers; none if the content is invalid. */
function numbersIn(kept: string | null): number[] {
  if (kept === null) return []
  try {
    const numbers: unknown = JSON.parse(kept)
    return Array.isArray(numbers) ? numbers.filter((one) => typeof one === 'number') : []
  } catch {
    return []
  }
}
