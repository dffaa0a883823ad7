// The decisions of a fleet as events tell of them: in the order of each aircraft, without those
// that were taken back.

import type { Event } from '../api/types'
import type { Seconds } from './record'
import { timeOf } from './time'

/** A decision, and what was reported of it. A hold goes from a vertiport to itself. */
export interface ReportedDecision {
  /** The number of its event. */
  seq: number
  decided: Seconds
  /** Vertiports, by position. */
  from: number
  to: number
  policy?: string
  departs?: Seconds
  hasDeparted: boolean
  landed?: Landing
}

export interface Landing {
  time: Seconds
  /** Where, which is elsewhere after a diversion. */
  at: number
  charge_kwh?: number
}

/** An event of an aircraft, its time, and the day's clock with it. */
interface Reported {
  seq: number
  event: Event & { aircraft: string }
  at: Seconds
  now: Seconds
}

export class ReportedDecisions {
  readonly #all: ReportedDecision[][]
  /** Where each aircraft stands or stood last. */
  readonly #places: number[]
  /** When the decisions were taken that no longer hold; an older trace may contain them. */
  readonly #undone: Set<Seconds>[]

  constructor(
    places: number[],
    private readonly vertiport: (id: string) => number,
  ) {
    this.#places = [...places]
    this.#all = places.map(() => [])
    this.#undone = places.map(() => new Set())
  }

  /** The decisions of an aircraft that hold, in their order. */
  of(aircraft: number): readonly ReportedDecision[] {
    return this.#all[aircraft] ?? []
  }

  /** Whether an aircraft took back a decision of this time, and took no other at that time. */
  isUndone(aircraft: number, decided: Seconds): boolean {
    return this.#undone[aircraft]?.has(decided) === true
  }

  take(aircraft: number, { seq, event, at, now }: Reported): void {
    const last = this.of(aircraft).at(-1)
    const underWay = last !== undefined && isUnderWay(last) ? last : undefined
    switch (event.type) {
      case 'decided': {
        const policy = event.policy == null ? {} : { policy: event.policy }
        this.#enter(aircraft, { seq, decided: at, ...this.#way(aircraft, event.to), ...policy })
        break
      }
      case 'undone':
        this.#undo(aircraft)
        break
      case 'departed': {
        const to = event.to == null ? underWay?.to : this.vertiport(event.to)
        if (to !== underWay?.to) {
          // A departure to another vertiport, or without a decision, is a new decision. The service
          // enters it at the day's clock.
          if (underWay !== undefined) this.#undo(aircraft)
          this.#enter(aircraft, { seq, decided: now, ...this.#way(aircraft, event.to ?? '') })
        }
        Object.assign(this.#all[aircraft]?.at(-1) ?? {}, { departs: at, hasDeparted: true })
        break
      }
      case 'landed': {
        const place = event.at == null ? underWay?.to : this.vertiport(event.at)
        if (place === undefined) break
        this.#places[aircraft] = place
        // An aircraft that did not fly has been moved.
        if (underWay === undefined) break
        const charge = event.charge_kwh == null ? {} : { charge_kwh: event.charge_kwh }
        underWay.landed = { time: at, at: place, ...charge }
        break
      }
      case 'delayed':
        if (underWay?.hasDeparted === false) underWay.departs = timeOf(event.until)
        break
      default:
    }
  }

  #way(aircraft: number, to: string): { from: number; to: number } {
    return { from: this.#places[aircraft] ?? 0, to: this.vertiport(to) }
  }

  #enter(aircraft: number, one: Omit<ReportedDecision, 'hasDeparted'>): void {
    this.#all[aircraft]?.push({ ...one, hasDeparted: false })
    this.#undone[aircraft]?.delete(one.decided)
  }

  #undo(aircraft: number): void {
    const one = this.#all[aircraft]?.pop()
    if (one !== undefined) this.#undone[aircraft]?.add(one.decided)
  }
}

function isUnderWay({ from, to, landed }: ReportedDecision): boolean {
  return from !== to && landed === undefined
}
