import { describe, expect, it } from 'vitest'
import { decode, encode } from './encoding'
import { squareName, squares } from './grid'
import { digitsOf, multiples, roundDown, roundUp } from './steps'

describe('the base map as text', () => {
  it('survives a round trip, to a thousandth of a degree', () => {
    const points: [number, number][] = [
      [-74.123, 40.001],
      [-74.12, 40.5],
      [-70, 45],
      [-75, 40],
    ]
    expect([...decode(encode(points, [-75, 40]), [-75, 40])].map((one) => Math.round(one * 1000))).toEqual(
      points.flat().map((one) => Math.round(one * 1000)),
    )
  })

  it('omits points equal to the previous one', () => {
    const text = encode(
      [
        [0, 0],
        [0.0001, 0.0001],
        [1, 1],
      ],
      [0, 0],
    )
    expect(decode(text, [0, 0])).toHaveLength(4)
  })

  it('needs no escaping in a page', () => {
    const text = encode(
      [
        [-4.9, 3.3],
        [4.7, -2.2],
      ],
      [0, 0],
    )
    expect(text).toMatch(/^[\w-]+$/)
  })
})

describe('the grid of cells', () => {
  it('returns every square that intersects', () => {
    expect(squares({ west: -76, south: 39, east: -73, north: 41 }, 5)).toEqual([
      [-80, 35],
      [-75, 35],
      [-80, 40],
      [-75, 40],
    ])
  })

  it('continues across the antimeridian', () => {
    const names = squares({ west: 178, south: 1, east: 182, north: 2 }, 5).map((one) => squareName(one, ','))
    expect(names).toEqual(['175,0', '-180,0'])
  })
})

describe('round steps', () => {
  it('are 1, 2 or 5 times a power of ten', () => {
    expect([0.3, 1, 1.1, 4, 7, 60].map(roundUp)).toEqual([0.5, 1, 2, 5, 10, 100])
    expect([0.3, 1, 1.9, 4, 7, 60].map(roundDown)).toEqual([0.2, 1, 1, 2, 5, 50])
  })

  it('have as many digits as they need', () => {
    expect([10, 1, 0.5, 0.02].map(digitsOf)).toEqual([0, 0, 1, 2])
    expect(multiples(-1.2, 1.2, 0.5)).toEqual([-1, -0.5, 0, 0.5, 1])
  })
})
