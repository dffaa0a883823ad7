// The content of the map at one time, in the plane and without pixels or colours, for painters to
// draw. Moving parts are updated every time. Parts that change only with decisions have a revision,
// so painters redraw them only then.

import { at } from '../model/arrays'
import { Counts, destinationOf, holdingOf, type StandState } from '../model/counts'
import { Fleet, NONE, Phase, type FleetFrame } from '../model/motion'
import { roomOf } from '../model/occupancy'
import type { ClosureRecord, DayRecord, Seconds } from '../model/record'
import { Waiting, type WaitingPair } from '../model/waiting'
import { Plane } from './plane'

/** More arcs would hide each other, so the arcs with the fewest passengers are left out. */
const MOST_ARCS = 24

export class Scene {
  readonly fleet: Fleet
  readonly plane: Plane
  readonly frame: FleetFrame
  /** Where aircraft are in the plane, two numbers each. */
  readonly aircraft: Float64Array
  readonly counts: Counts
  /** Stands and chargers of each vertiport. */
  readonly room: number[]
  /** Miles to the nearest other vertiport. */
  readonly nearest_mi: number[]
  /** All waiting passengers, and the pairs with most of them, which are drawn. */
  allPairs: readonly WaitingPair[] = []
  pairs: readonly WaitingPair[] = []
  closures: readonly ClosureRecord[] = []
  /** Increases when rings, arcs or closures have changed. */
  revision = 0
  readonly #waiting: Waiting

  constructor(readonly record: DayRecord) {
    this.fleet = new Fleet(record)
    this.plane = new Plane(this.fleet.geography)
    this.frame = this.fleet.frame()
    this.aircraft = new Float64Array(2 * record.aircraft.length)
    this.counts = new Counts(record)
    this.room = record.vertiports.map(roomOf)
    this.nearest_mi = nearestOf(this.plane.vertiports)
    this.#waiting = new Waiting(record)
  }

  /** Updates everything to a time. `demand` replaces the record's waiting passengers. */
  show(time: Seconds, demand?: readonly WaitingPair[]): void {
    this.fleet.show(time, this.frame)
    this.plane.write(this.frame.places, this.aircraft)
    this.#count()
    this.#showClosures(time)
    this.#showWaiting(demand ?? this.#waiting.pairs(time))
  }

  /** The destination of an aircraft, also if its flight is delayed; NONE if it stands. */
  destination(aircraft: number): number {
    return destinationOf(this.record, this.frame, aircraft)
  }

  /** The origin of the flight; NONE if the aircraft stands. */
  origin(aircraft: number): number {
    if (at(this.frame.phases, aircraft) !== Phase.flying) return NONE
    return at(this.record.legs, at(this.frame.legs, aircraft)).from
  }

  /** The load factor of the flight; 0 if the aircraft stands. */
  load(aircraft: number): number {
    if (this.destination(aircraft) === NONE) return 0
    const { passengers } = at(this.record.legs, at(this.frame.legs, aircraft))
    return Math.min(1, passengers / at(this.record.aircraft, aircraft).seats)
  }

  /** The place of an aircraft in the plane. */
  placeOf(aircraft: number): { x: number; y: number } {
    return { x: at(this.aircraft, 2 * aircraft), y: at(this.aircraft, 2 * aircraft + 1) }
  }

  /** Whether the departure or the landing of an aircraft is overdue. */
  isOverdue(aircraft: number): boolean {
    return at(this.frame.overdue_min, aircraft) > 0
  }

  /** The aircraft that hold stands of a vertiport, including those on their way to it. */
  aircraftAt(vertiport: number): { aircraft: number; state: StandState }[] {
    return this.record.aircraft.flatMap((_, aircraft) => {
      const holding = holdingOf(this.record, this.frame, aircraft)
      return holding.vertiport === vertiport ? [{ aircraft, state: holding.state }] : []
    })
  }

  #count(): void {
    const former = this.counts.revision
    this.counts.count(this.frame)
    if (this.counts.revision !== former) this.revision++
  }

  #showClosures(time: Seconds): void {
    const closures = this.record.closures.filter((one) => one.since <= time && time < (one.until ?? Infinity))
    const isSame =
      closures.length === this.closures.length && closures.every((one, index) => one === this.closures[index])
    if (isSame) return
    this.closures = closures
    this.revision++
  }

  #showWaiting(pairs: readonly WaitingPair[]): void {
    if (pairs === this.allPairs) return
    this.allPairs = pairs
    this.pairs = [...pairs].sort((one, other) => other.passengers - one.passengers).slice(0, MOST_ARCS)
    this.revision++
  }
}

function nearestOf(places: Float64Array): number[] {
  return Array.from({ length: places.length / 2 }, (_, one) => {
    let nearest = Infinity
    for (let other = 0; other < places.length / 2; other++) {
      if (other === one) continue
      const dx = at(places, 2 * one) - at(places, 2 * other)
      const dy = at(places, 2 * one + 1) - at(places, 2 * other + 1)
      nearest = Math.min(nearest, Math.hypot(dx, dy))
    }
    return nearest
  })
}
