// How fast a battery is charged (docs/src/concepts/model.md, "Energy"): the power follows the curve
// of the aircraft type, which is linear between its points, and the type and the charger limit it.

import { at } from './arrays'
import type { Seconds } from './record'

/** What charging depends on: the members of an aircraft type. */
export interface Battery {
  battery_kwh: number
  charge_kw: number
  charge_curve?: readonly (readonly [share: number, kw: number])[] | undefined
}

const HOUR_S = 3600

export class ChargeRate {
  readonly #battery_kwh: number
  /** The power at increasing charges; it is linear between two of them. */
  readonly #points: { kwh: number; kw: number }[]

  /** `charger_kw` is the most that the charger delivers. */
  constructor({ battery_kwh, charge_kw, charge_curve }: Battery, charger_kw = Infinity) {
    this.#battery_kwh = battery_kwh
    const most_kw = Math.min(charge_kw, charger_kw)
    const curve = charge_curve ?? [
      [0, most_kw],
      [1, most_kw],
    ]
    this.#points = curve.flatMap(([share, kw], index) => {
      const point = { kwh: share * battery_kwh, kw: Math.min(kw, most_kw) }
      const former = curve[index - 1]
      if (former === undefined || former[1] > most_kw === kw > most_kw) return [point]
      // Between these points the curve reaches the limit.
      const part = (most_kw - former[1]) / (kw - former[1])
      return [{ kwh: (former[0] + part * (share - former[0])) * battery_kwh, kw: most_kw }, point]
    })
  }

  /** How long it takes to charge from one charge to another. */
  seconds(from_kwh: number, to_kwh: number): number {
    let hours = 0
    for (let index = 1; index < this.#points.length; index++) {
      const [begin, end] = [at(this.#points, index - 1), at(this.#points, index)]
      const [low, high] = [Math.max(from_kwh, begin.kwh), Math.min(to_kwh, end.kwh)]
      if (high > low) hours += hoursOf(high - low, this.#powerAt(index, low), this.#powerAt(index, high))
    }
    return HOUR_S * hours
  }

  /** How long it takes until the battery is full again from which an energy was taken. */
  secondsToRefill(energy_kwh: number): number {
    const { kw } = at(this.#points, 0)
    if (this.#points.every((point) => point.kw === kw)) return (HOUR_S * energy_kwh) / kw
    return this.seconds(this.#battery_kwh - energy_kwh, this.#battery_kwh)
  }

  /** The charge after some time, at most a full battery. */
  after(kwh: number, seconds: Seconds): number {
    let [charge, left_h] = [kwh, Math.max(0, seconds) / HOUR_S]
    for (let index = 1; index < this.#points.length && left_h > 0; index++) {
      const [begin, end] = [at(this.#points, index - 1), at(this.#points, index)]
      if (charge >= end.kwh) continue
      const kw = this.#powerAt(index, charge)
      const whole_h = hoursOf(end.kwh - charge, kw, end.kw)
      const slope = (end.kw - begin.kw) / (end.kwh - begin.kwh)
      if (whole_h <= left_h) charge = end.kwh
      else charge += slope === 0 ? kw * left_h : (kw / slope) * Math.expm1(slope * left_h)
      left_h -= whole_h
    }
    return Math.min(this.#battery_kwh, charge)
  }

  /** The power at a charge between a point and the one before it. */
  #powerAt(index: number, kwh: number): number {
    const [begin, end] = [at(this.#points, index - 1), at(this.#points, index)]
    return begin.kw + ((end.kw - begin.kw) * (kwh - begin.kwh)) / (end.kwh - begin.kwh)
  }
}

/** How long an energy takes whose power is linear in the charge. */
function hoursOf(kwh: number, from_kw: number, to_kw: number): number {
  const ratio = (to_kw - from_kw) / from_kw
  // The logarithm of a ratio close to 1 has too few digits.
  if (Math.abs(ratio) < 1e-9) return kwh / from_kw
  return (kwh / from_kw) * (Math.log1p(ratio) / ratio)
}
