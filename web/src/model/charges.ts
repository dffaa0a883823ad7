// An estimate of the charge of every aircraft along its legs, as shares of its battery. It begins
// with the charge of the morning. A flight takes its energy, and charging begins at arrival and
// ends at take-off. Charges that are known, by a trace or by the service, replace estimates.

import { at, NONE } from './arrays'
import { ChargeRate } from './rate'
import type { DayRecord, LegRecord, Seconds } from './record'

/** The charge at a time from which on an aircraft charges. */
interface Known {
  share: number
  since: Seconds
}

interface Span {
  begins: number
  ends: number
}

export class Charges {
  /** By position in the record's legs. */
  readonly #before: Known[] = []
  readonly #departs: Float32Array
  readonly #arrives: Float32Array
  /** By aircraft and vertiport. */
  readonly #rates: (ChargeRate | undefined)[] = []

  constructor(private readonly record: DayRecord) {
    this.#departs = new Float32Array(record.legs.length)
    this.#arrives = new Float32Array(record.legs.length)
    const latest = record.aircraft.map((_, aircraft) => this.#morning(aircraft))
    record.legs.forEach((leg, index) => {
      latest[leg.aircraft] = this.#estimate(leg, index, at(latest, leg.aircraft))
    })
  }

  /** The charge before the first leg of an aircraft. */
  atStart(aircraft: number, time: Seconds): number {
    const { begins_at } = at(this.record.aircraft, aircraft)
    return this.#charged(this.#morning(aircraft), aircraft, begins_at, time)
  }

  /** The charge on the ground before a leg departs. */
  before(leg: number, time: Seconds): number {
    const { aircraft, from } = at(this.record.legs, leg)
    return this.#charged(at(this.#before, leg), aircraft, from, time)
  }

  departing(leg: number): number {
    return at(this.#departs, leg)
  }

  arriving(leg: number): number {
    return at(this.#arrives, leg)
  }

  /** The charge on the ground after a leg has arrived, or during a hold. */
  after(leg: number, time: Seconds): number {
    const { aircraft, to, arrives } = at(this.record.legs, leg)
    return this.#charged({ share: at(this.#arrives, leg), since: arrives }, aircraft, to, time)
  }

  /** The charges at two times on the ground, before or after a leg. */
  span(side: 'before' | 'after', leg: number, begins: Seconds, ends: Seconds): Span {
    return { begins: this[side](leg, begins), ends: this[side](leg, ends) }
  }

  /** The charges at two times of a stay: after a leg, or NONE in the morning. */
  spanOfStay(leg: number, aircraft: number, begins: Seconds, ends: Seconds): Span {
    if (leg !== NONE) return this.span('after', leg, begins, ends)
    return { begins: this.atStart(aircraft, begins), ends: this.atStart(aircraft, ends) }
  }

  /** When the battery is full if the aircraft stays after a leg, or NONE in the morning. */
  fullAfter(leg: number, aircraft: number): Seconds {
    const { battery_kwh, begins_at } = at(this.record.aircraft, aircraft)
    const { share, since } =
      leg === NONE
        ? this.#morning(aircraft)
        : { share: at(this.#arrives, leg), since: at(this.record.legs, leg).arrives }
    const rate = this.#rate(aircraft, this.record.legs[leg]?.to ?? begins_at)
    return since + rate.seconds(share * battery_kwh, battery_kwh)
  }

  #morning(aircraft: number): Known {
    const { start_charge_kwh, battery_kwh } = at(this.record.aircraft, aircraft)
    const share = start_charge_kwh === undefined ? 1 : start_charge_kwh / battery_kwh
    return { share, since: this.record.start }
  }

  /** Enters a leg, and returns the charge after it. */
  #estimate(leg: LegRecord, index: number, latest: Known): Known {
    const { aircraft, from, decided, departs, arrives } = leg
    const { battery_kwh } = at(this.record.aircraft, aircraft)
    const known = leg.charge_kwh
    const before = known === undefined ? latest : { share: known / battery_kwh, since: decided }
    this.#before[index] = before
    const departing = this.#charged(before, aircraft, from, departs)
    this.#departs[index] = departing
    const arriving = Math.max(0, departing - (leg.energy_kwh ?? 0) / battery_kwh)
    const share = leg.lands_with_kwh === undefined ? arriving : leg.lands_with_kwh / battery_kwh
    this.#arrives[index] = share
    return { share, since: arrives }
  }

  #charged({ share, since }: Known, aircraft: number, vertiport: number, time: Seconds): number {
    if (share >= 1) return 1
    const { battery_kwh } = at(this.record.aircraft, aircraft)
    return this.#rate(aircraft, vertiport).after(share * battery_kwh, time - since) / battery_kwh
  }

  #rate(aircraft: number, vertiport: number): ChargeRate {
    const { vertiports } = this.record
    const place = aircraft * vertiports.length + vertiport
    const { charger_kw } = at(vertiports, vertiport)
    return (this.#rates[place] ??= new ChargeRate(at(this.record.aircraft, aircraft), charger_kw))
  }
}
