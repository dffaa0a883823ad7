import { describe, expect, it } from 'vitest'
import { Geography } from '../model/geography'
import { boxOf, Plane } from './plane'

const degrees = (latitude: number, longitude: number) => ({
  place: { x_mi: 0, y_mi: 0, latitude, longitude },
})

describe('a plane of coordinates', () => {
  const geography = new Geography([degrees(40.69, -74.17), degrees(40.64, -73.78)])
  const plane = new Plane(geography)

  it('has the middle of the network as its origin', () => {
    const box = boxOf(plane.vertiports)
    expect(box.west + box.east).toBeCloseTo(0, 9)
    expect(box.south + box.north).toBeCloseTo(0, 2)
  })

  it('is measured in miles at its origin', () => {
    const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = plane.vertiports
    expect(Math.hypot(x1 - x0, y1 - y0)).toBeCloseTo(geography.distance(0, 1), 2)
  })

  it('converts back to degrees', () => {
    expect(plane.longitude(plane.x(-73.5))).toBeCloseTo(-73.5, 9)
    expect(plane.latitude(plane.y(41.3))).toBeCloseTo(41.3, 9)
  })

  it('stretches to the north, as Mercator does', () => {
    expect(plane.milesAt(0)).toBeCloseTo(1, 9)
    expect(plane.milesAt(500)).toBeLessThan(0.95)
  })

  it('ends before the poles, which are infinitely far away', () => {
    expect(plane.y(90)).toBe(plane.y(85))
  })
})

describe('a plane of miles', () => {
  const places = [{ place: { x_mi: 0, y_mi: 0 } }, { place: { x_mi: 40, y_mi: 10 } }]
  const plane = new Plane(new Geography(places))

  it('keeps the coordinates, relative to its middle', () => {
    expect([...plane.vertiports]).toEqual([-20, -5, 20, 5])
    expect([plane.longitude(-20), plane.latitude(5)]).toEqual([0, 10])
    expect(plane.milesAt(123)).toBe(1)
  })
})
