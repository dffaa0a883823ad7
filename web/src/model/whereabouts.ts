// Where departures lead and landings are. Such events name a vertiport only if it is another one than was decided, so it is taken from
// what was said of the aircraft before.

import type { TakenEvent } from '../api/types'

export class Whereabouts {
  /** Where each aircraft was sent last. */
  readonly #sent = new Map<string, string>()
  /** Kept beside the events, and gone with them. */
  readonly #places = new WeakMap<TakenEvent, string>()

  /** Takes the events of a day, each once and in their order. */
  take(taken: TakenEvent): void {
    const { event } = taken
    if (event.type === 'undone') this.#sent.delete(event.aircraft)
    else if (event.type === 'decided') this.#sent.set(event.aircraft, event.to)
    else if (event.type === 'departed' || event.type === 'landed') {
      const said = event.type === 'departed' ? event.to : event.at
      const place = said ?? this.#sent.get(event.aircraft)
      if (place === undefined) return
      this.#sent.set(event.aircraft, place)
      this.#places.set(taken, place)
    }
  }

  /** The vertiport of a departure or a landing; undefined for other events, and if nothing was said of it. */
  placeOf(taken: TakenEvent): string | undefined {
    return this.#places.get(taken)
  }
}
