import { describe, expect, it } from 'vitest'
import { ChargeRate, type Battery } from './rate'

const plain: Battery = { battery_kwh: 100, charge_kw: 200 }
const curved: Battery = {
  ...plain,
  charge_curve: [
    [0, 300],
    [0.5, 300],
    [0.9, 50],
    [1, 50],
  ],
}

/** The charge after some time, in small steps. */
function stepped({ charge_curve = [] }: Battery, most_kw: number, kwh: number, seconds: number): number {
  const powerAt = (share: number) => {
    const next = charge_curve.findIndex(([one]) => one > share)
    const [begin, end] = [charge_curve[next - 1] ?? [0, 0], charge_curve[next] ?? [1, 50]]
    return Math.min(
      most_kw,
      begin[1] + ((end[1] - begin[1]) * (share - begin[0])) / Math.max(1e-9, end[0] - begin[0]),
    )
  }
  let charge = kwh
  for (let step = 0; step < 100 * seconds; step++)
    charge = Math.min(100, charge + powerAt(charge / 100) / 360_000)
  return charge
}

describe('charging', () => {
  it('without a curve has the same power throughout, at most that of the charger', () => {
    expect(new ChargeRate(plain).after(20, 900)).toBeCloseTo(70)
    expect(new ChargeRate(plain, 80).after(20, 900)).toBeCloseTo(40)
    expect(new ChargeRate(plain, 500).seconds(20, 70)).toBeCloseTo(900)
    expect(new ChargeRate(plain).secondsToRefill(33.3)).toBe((3600 * 33.3) / 200)
  })

  it('follows the curve up to the limit', () => {
    for (const charger_kw of [undefined, 120]) {
      const rate = new ChargeRate(curved, charger_kw)
      for (const [kwh, seconds] of [
        [0, 300],
        [40, 700],
        [60, 1500],
        [95, 100],
      ] as const) {
        const after = rate.after(kwh, seconds)
        expect(after).toBeCloseTo(stepped(curved, charger_kw ?? 200, kwh, seconds), 2)
        expect(rate.seconds(kwh, after)).toBeCloseTo(seconds, 4)
      }
    }
  })

  it('ends with a full battery', () => {
    expect(new ChargeRate(plain).after(99, 3600)).toBe(100)
    expect(new ChargeRate(curved).after(20, 36_000)).toBe(100)
    expect(new ChargeRate(curved).after(100, 60)).toBe(100)
  })
})
