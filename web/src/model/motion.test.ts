import { describe, expect, it } from 'vitest'
import { prices } from './fixtures/tiny'
import { Fleet, NONE, Phase, shareOfWay } from './motion'
import { timeOf } from './time'

const record = prices()
const fleet = new Fleet(record)

function at(clock: string, aircraft: number) {
  const frame = fleet.frame()
  fleet.show(timeOf(clock), frame)
  const { phases, stands, charges, legs, lifts, headings, places } = frame
  return {
    phase: phases[aircraft],
    stands: stands[aircraft],
    charge: charges[aircraft],
    leg: legs[aircraft],
    lift: lifts[aircraft],
    heading: headings[aircraft],
    place: [...places.subarray(2 * aircraft, 2 * aircraft + 2)],
  }
}

describe('an aircraft', () => {
  it('waits where it begins the day, with a full battery', () => {
    expect(at('06:00:00', 1)).toMatchObject({
      phase: Phase.waiting,
      stands: 1,
      charge: 1,
      leg: NONE,
      lift: 0,
    })
  })

  it('flies between departure and arrival', () => {
    const midway = at('07:05:26', 0)
    expect(midway).toMatchObject({ phase: Phase.flying, stands: NONE, leg: 0, lift: 1 })
    expect(midway.place[0]).toBeCloseTo((-74.05 - 73.75) / 2, 3)
    expect(midway.heading).toBeCloseTo(66, 0)
  })

  it('stands until a delayed flight may take off', () => {
    expect(at('07:04:00', 1)).toMatchObject({ phase: Phase.delayed, stands: 1, charge: 1 })
    expect(at('07:04:34', 1).phase).toBe(Phase.flying)
  })

  it('recharges the energy of the flight after arrival, and is full when it is ready', () => {
    const arrived = at('07:10:52', 0)
    expect(arrived).toMatchObject({ phase: Phase.charging, stands: 1 })
    expect(arrived.charge).toBeCloseTo(1 - 24.05 / 140, 3)
    expect(at('07:15:00', 0).charge).toBeGreaterThan(arrived.charge ?? 1)
    expect(at('07:19:20', 0).charge).toBeCloseTo(1, 2)
  })

  it('holds until its next decision', () => {
    expect(at('07:50:00', 0)).toMatchObject({ phase: Phase.holding, stands: 2 })
    expect(at('07:50:00', 0).charge).toBeCloseTo(1, 3)
  })

  it('is out of service after it has landed, not in the air', () => {
    expect(at('07:45:00', 1).phase).toBe(Phase.flying)
    expect(at('07:56:00', 1).phase).toBe(Phase.out)
  })

  it('waits after its last leg', () => {
    expect(at('12:00:00', 2)).toMatchObject({ phase: Phase.waiting, stands: 2 })
  })
})

describe('a frame', () => {
  it('does not depend on the frame before it', () => {
    const [fresh, used] = [fleet.frame(), fleet.frame()]
    for (const time of ['08:50:00', '07:05:00', '07:50:00', '07:30:00']) fleet.show(timeOf(time), used)
    fleet.show(timeOf('07:30:00'), fresh)
    expect(used).toEqual(fresh)
  })

  it('changes little in a second', () => {
    const [before, after] = [fleet.frame(), fleet.frame()]
    for (let time = record.start; time < record.end; time++) {
      fleet.show(time, before)
      fleet.show(time + 1, after)
      before.places.forEach((place, index) =>
        expect(Math.abs((after.places[index] ?? NaN) - place)).toBeLessThan(0.001),
      )
    }
  })
})

describe('the share of the way', () => {
  it('begins and ends slowly', () => {
    const total = 600
    const shares = [0, 60, 120, 300, 480, 540, 600].map((flown) => shareOfWay(flown, total - flown, 120, 120))
    expect(shares).toEqual([0, 1 / 32, 1 / 8, 1 / 2, 7 / 8, 31 / 32, 1])
  })

  it('is defined for flights shorter than take-off and landing', () => {
    expect(shareOfWay(0, 0, 120, 120)).toBe(1)
    expect(shareOfWay(50, 50, 120, 120)).toBe(0.5)
    expect(shareOfWay(30, 70, 0, 0)).toBe(0.3)
  })
})

it('returns the legs of an aircraft in chronological order', () => {
  const decided = [...fleet.legsOf(0)].map((leg) => record.legs[leg]?.decided)
  expect(decided).toHaveLength(8)
  expect(decided).toEqual([...decided].sort((one, other) => (one ?? 0) - (other ?? 0)))
})
