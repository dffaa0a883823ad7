import { describe, expect, it } from 'vitest'
import { Geography } from './geography'

function place(x_mi: number, y_mi: number, latitude?: number, longitude?: number) {
  return {
    place: {
      x_mi,
      y_mi,
      ...(latitude === undefined || longitude === undefined ? {} : { latitude, longitude }),
    },
  }
}

function along(geography: Geography, share: number): { place: number[]; heading: number } {
  const [places, headings] = [new Float64Array(2), new Float32Array(1)]
  geography.along(0, 1, share, places, headings, 0)
  return { place: [...places], heading: headings[0] ?? NaN }
}

describe('in the plane', () => {
  const geography = new Geography([place(0, 0), place(30, 40)])

  it('routes are straight lines', () => {
    expect(geography.isGlobe).toBe(false)
    expect(geography.distance(0, 1)).toBe(50)
    expect(along(geography, 0.5).place).toEqual([15, 20])
    expect(along(geography, 0.5).heading).toBeCloseTo(36.87, 2)
  })
})

describe('on the globe', () => {
  // Newark and Kennedy airports; the distance is in the network file of New York.
  const near = new Geography([place(0, 0, 40.69, -74.17), place(0, 0, 40.64, -73.78)])
  // New York to London: the great circle begins far more to the north than the map suggests.
  const far = new Geography([place(0, 0, 40.64, -73.78), place(0, 0, 51.47, -0.46)])

  it('distances are great circles', () => {
    expect(near.distance(0, 1)).toBeCloseTo(20.74, 1)
    expect(far.distance(0, 1)).toBeCloseTo(3442.3, 1)
  })

  it('routes begin and end at their vertiports', () => {
    expect(along(near, 0).place[0]).toBeCloseTo(-74.17, 9)
    expect(along(near, 1).place[1]).toBeCloseTo(40.64, 9)
  })

  it('the direction turns along a great circle', () => {
    expect(along(far, 0).heading).toBeCloseTo(51.4, 0)
    expect(along(far, 1).heading).toBeCloseTo(108, 0)
    expect(along(far, 0.5).place[1]).toBeGreaterThan(51.47)
  })

  it('a route to the same place has no length', () => {
    const same = new Geography([place(0, 0, 40, -74), place(0, 0, 40, -74)])
    expect(along(same, 0.5).place[0]).toBeCloseTo(-74, 9)
  })
})

it('needs coordinates of all vertiports to be on the globe', () => {
  expect(new Geography([place(0, 0, 40, -74), place(1, 1)]).isGlobe).toBe(false)
  expect(new Geography([]).isGlobe).toBe(false)
})
