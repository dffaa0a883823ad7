// What was decided at this console, by the numbers of events: without tokens the service knows no person, so only the console can
// say "you". It is kept for the life of the tab, as far as a reload; another tab, or another person, does not have it.

import { SvelteSet } from 'svelte/reactivity'

const KEY = 'vertifleet-decided'
/** More than a person takes back or looks for. */
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

  /** Forgets what lies after the latest event of a day that was put back: others will have these numbers. */
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
      // A storage that is full or forbidden only means that a reload forgets.
    }
  }
}

/** What was kept, or nothing if something else is there. */
function numbersIn(kept: string | null): number[] {
  if (kept === null) return []
  try {
    const numbers: unknown = JSON.parse(kept)
    return Array.isArray(numbers) ? numbers.filter((one) => typeof one === 'number') : []
  } catch {
    return []
  }
}
