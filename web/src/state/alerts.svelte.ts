// The alerts of a live day with their acknowledgements: acknowledged ones stay in the list, behind
// the others. Acknowledgements are kept in the tab's session storage, so they survive a reload.

import { SvelteMap } from 'svelte/reactivity'
import type { Alert } from '../model/alerts'
import { Occurrences } from '../model/occurrences'
import type { Seconds } from '../model/record'

const KEY = 'vertifleet-acknowledged'

export interface ListedAlert extends Alert {
  isAcknowledged: boolean
}

export class Alerts {
  /** For each key, when the acknowledged occurrence was first observed. */
  readonly #acknowledged: SvelteMap<string, Seconds>
  readonly #occurrences = new Occurrences()
  readonly #key: string

  constructor(
    day: string,
    private readonly storage: Pick<Storage, 'getItem' | 'setItem'> = sessionStorage,
  ) {
    this.#key = `${KEY} ${day}`
    this.#acknowledged = new SvelteMap(entriesIn(storage.getItem(this.#key)))
  }

  /**
   * The alerts at one time, unacknowledged ones first. An alert that ended and comes back is a new
   * one.
   */
  listed(alerts: readonly Alert[], time: Seconds): ListedAlert[] {
    this.#occurrences.update(
      alerts.map(({ key }) => key),
      time,
    )
    const listed = alerts.map((alert) => {
      const since = alert.since ?? this.#occurrences.firstSeen(alert.key)
      return { ...alert, since, isAcknowledged: this.#isAcknowledged(alert) }
    })
    return listed.sort((one, other) => Number(one.isAcknowledged) - Number(other.isAcknowledged))
  }

  acknowledge(keys: readonly string[]): void {
    for (const key of keys) {
      const seen = this.#occurrences.firstSeen(key)
      if (seen !== undefined) this.#acknowledged.set(key, seen)
    }
    try {
      this.storage.setItem(this.#key, JSON.stringify([...this.#acknowledged]))
    } catch {
      // If the storage is full or forbidden, acknowledgements are lost on a reload.
    }
  }

  /**
   * An alert from an event began with that event. For other alerts an earlier occurrence may have
   * been acknowledged.
   */
  #isAcknowledged({ key, matter }: Alert): boolean {
    const acknowledged = this.#acknowledged.get(key)
    if (acknowledged === undefined) return false
    return matter.kind === 'notice' || acknowledged === this.#occurrences.firstSeen(key)
  }
}

/** The stored entries; none if the content is invalid. */
function entriesIn(kept: string | null): [string, Seconds][] {
  if (kept === null) return []
  try {
    const entries: unknown = JSON.parse(kept)
    return Array.isArray(entries) ? entries.filter(isEntry) : []
  } catch {
    return []
  }
}

function isEntry(entry: unknown): entry is [string, Seconds] {
  return Array.isArray(entry) && typeof entry[0] === 'string' && typeof entry[1] === 'number'
}
