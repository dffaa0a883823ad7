// The destinations of departures and the places of landings. Their events name a vertiport only if
// it differs from the decided one, so it is taken from earlier events of the aircraft.

import type { TakenEvent } from '../api/types'

export class Whereabouts {
  /** The latest destination of each aircraft. */
  readonly #sent = new Map<string, string>()
  /** Keyed by event, so that an entry is freed with its event. */
  readonly #places = new WeakMap<TakenEvent, string>()

  /** Applies an event of the day; each must be passed once and in order. */
  take(taken: TakenEvent): void {
    const { event } = taken
    if (event.type === 'undone') this.#sent.delete(event.aircraft)
    else if (event.type === 'decided') this.#sent.set(event.aircraft, event.to)
    else if (event.type === 'departed' || event.type === 'landed') {
      const named = event.type === 'departed' ? event.to : event.at
      const place = named ?? this.#sent.get(event.aircraft)
      if (place === undefined) return
      this.#sent.set(event.aircraft, place)
      this.#places.set(taken, place)
    }
  }

  /**
   * The vertiport of a departure or a landing; undefined for other events, and if it is unknown.
   */
  placeOf(taken: TakenEvent): string | undefined {
    return this.#places.get(taken)
  }
}
