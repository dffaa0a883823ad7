import { describe, expect, it } from 'vitest'
import { linesByCell, ringsByCell, type Point } from './clip'

function area(ring: Point[]): number {
  return (
    ring.reduce((sum, [x, y], index) => {
      const [nextX, nextY] = ring[(index + 1) % ring.length] ?? [0, 0]
      return sum + x * nextY - nextX * y
    }, 0) / 2
  )
}

describe('rings', () => {
  const ring: Point[] = [
    [-3, -2],
    [8, 1],
    [6, 12],
    [1, 7],
    [-3, -2],
  ]

  it('are cut without losing any of their area', () => {
    const pieces = [...ringsByCell([ring], 5).values()].flat()
    const total = pieces.reduce((sum, piece) => sum + area(piece), 0)
    expect(total).toBeCloseTo(area(ring.slice(0, -1)), 9)
  })

  it('stay within their cells', () => {
    for (const [cell, pieces] of ringsByCell([ring], 5)) {
      const [west = 0, south = 0] = cell.split(',').map(Number)
      for (const [x, y] of pieces.flat()) {
        expect(x).toBeGreaterThanOrEqual(west)
        expect(x).toBeLessThanOrEqual(west + 5)
        expect(y).toBeGreaterThanOrEqual(south)
        expect(y).toBeLessThanOrEqual(south + 5)
      }
    }
  })
})

describe('lines', () => {
  it('are cut where they leave a cell, with one point beyond it on both sides', () => {
    const cells = linesByCell(
      [
        [
          [1, 1],
          [2, 1],
          [6, 1],
          [7, 1],
        ],
      ],
      5,
    )
    expect(cells.get('0,0')).toEqual([
      [
        [1, 1],
        [2, 1],
        [6, 1],
      ],
    ])
    expect(cells.get('5,0')).toEqual([
      [
        [2, 1],
        [6, 1],
        [7, 1],
      ],
    ])
  })
})
