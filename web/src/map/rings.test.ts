import { describe, expect, it } from 'vitest'
import { COUNTED, StandState } from '../model/counts'
import { piecesOf, radiusOf } from './rings'

const RADIUS = 16

function states(counts: Partial<Record<StandState, number>>, room: number): StandState[] {
  const all = Array.from({ length: COUNTED }, (_, state) => counts[state as StandState] ?? 0)
  return piecesOf(all, 0, room, RADIUS).map(({ state }) => state)
}

describe('the ring of a vertiport', () => {
  it('has a piece for each stand, in the order of their states', () => {
    const { charging, promised, waiting, free } = StandState
    expect(states({ [charging]: 2, [promised]: 1, [waiting]: 1 }, 6)).toEqual([
      waiting,
      charging,
      charging,
      promised,
      free,
      free,
    ])
  })

  it('goes once around', () => {
    const pieces = piecesOf([1, 0, 2, 0, 1], 0, 5, RADIUS)
    const covered = pieces.reduce((sum, { begin, end }) => sum + end - begin, 0)
    expect(covered).toBeLessThan(2 * Math.PI)
    expect(covered).toBeGreaterThan(2 * Math.PI * 0.85)
    pieces.forEach(({ begin }, index) => expect(begin).toBeGreaterThanOrEqual(pieces[index - 1]?.end ?? 0))
  })

  it('shows aircraft without a stand', () => {
    const { charging, over } = StandState
    expect(states({ [charging]: 3 }, 2)).toEqual([charging, charging, over])
  })

  it('has arcs if pieces would be too small to count', () => {
    const { charging, free } = StandState
    expect(states({ [charging]: 10 }, 100)).toEqual([charging, free])
  })

  it('is smaller if vertiports are close together', () => {
    const network = { room: [10, 10], nearest_mi: [2, 200] }
    expect(radiusOf(network, 0, 10)).toBeLessThan(radiusOf(network, 1, 10))
    expect(radiusOf(network, 0, 0.001)).toBe(4)
  })
})
