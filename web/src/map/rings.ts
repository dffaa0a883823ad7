// The ring of a vertiport: one piece per stand, coloured by its state. It reads like a gauge,
// clockwise from the top: taken, promised, free.

import { at } from '../model/arrays'
import { COUNTED, StandState } from '../model/counts'

/**
 * With more stands than this, each state is one arc, because separate pieces would be too small to
 * count.
 */
const MOST_PIECES = 24
export const TURN = 2 * Math.PI
/** Pixels between two pieces. */
const GAP = 2

export interface Piece {
  begin: number
  end: number
  state: StandState
}

/**
 * The radius of a ring in pixels: larger with more stands, smaller where vertiports are close
 * together.
 */
function ringRadius(room: number, nearest_px: number): number {
  const wanted = Math.min(28, 11 + 2.4 * Math.sqrt(room))
  return Math.max(4, Math.min(wanted, 0.42 * nearest_px))
}

/** The radius of the ring of a vertiport at a scale in pixels a mile. */
export function radiusOf(
  { room, nearest_mi }: { room: number[]; nearest_mi: number[] },
  vertiport: number,
  scale: number,
): number {
  return ringRadius(at(room, vertiport), at(nearest_mi, vertiport) * scale)
}

export function ringWidth(radius: number): number {
  return Math.max(2.5, Math.min(5, radius * 0.3))
}

/**
 * The pieces of a ring; `counts` holds the number of aircraft in each counted state from `offset`
 * on.
 */
export function piecesOf(counts: ArrayLike<number>, offset: number, room: number, radius: number): Piece[] {
  const states = inOrder(counts, offset, room)
  const all = states.reduce((sum, { number }) => sum + number, 0)
  if (all === 0) return []
  const gap = Math.min(GAP / radius, TURN / all / 3)
  return all <= MOST_PIECES ? countable(states, all, gap) : arcs(states, all, gap)
}

interface Counted {
  state: StandState
  number: number
}

/** The number of stands in each state, in order. Aircraft without a stand come last. */
function inOrder(counts: ArrayLike<number>, offset: number, room: number): Counted[] {
  const order: Counted[] = []
  let left = room
  let over = 0
  for (let state = 0; state < COUNTED; state++) {
    const number = at(counts, offset + state)
    order.push({ state: state as StandState, number: Math.min(number, left) })
    over += Math.max(0, number - left)
    left = Math.max(0, left - number)
  }
  order.push({ state: StandState.free, number: left }, { state: StandState.over, number: over })
  return order.filter(({ number }) => number > 0)
}

function countable(states: Counted[], all: number, gap: number): Piece[] {
  const each = states.flatMap(({ state, number }) => Array.from({ length: number }, () => state))
  return each.map((state, index) => ({
    state,
    begin: (index / all) * TURN + gap / 2,
    end: ((index + 1) / all) * TURN - gap / 2,
  }))
}

function arcs(states: Counted[], all: number, gap: number): Piece[] {
  let before = 0
  return states.map(({ state, number }) => {
    const begin = (before / all) * TURN + gap / 2
    before += number
    return { state, begin, end: (before / all) * TURN - gap / 2 }
  })
}
