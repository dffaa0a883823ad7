// Cuts shapes into the cells of a grid of degrees, so that a page loads only the cells that it
// shows.

export type Point = [longitude: number, latitude: number]

/**
 * Rings of polygons, by the cell that they are in (`west,south`). Edges along the cell's bounds
 * come from the cut.
 */
export function ringsByCell(rings: Iterable<Point[]>, size: number): Map<string, Point[][]> {
  const cells = new Map<string, Point[][]>()
  for (const ring of rings) {
    for (const [west, column] of slices(open(ring), 0, size)) {
      for (const [south, piece] of slices(column, 1, size)) append(cells, `${west},${south}`, piece)
    }
  }
  return cells
}

/**
 * Parts of lines, by the cell that they are in. A line that crosses from one cell to another is in
 * both.
 */
export function linesByCell(lines: Iterable<Point[]>, size: number): Map<string, Point[][]> {
  const cells = new Map<string, Point[][]>()
  const cellOf = ([x, y]: Point) => `${floorTo(x, size)},${floorTo(y, size)}`
  for (const line of lines) {
    let part: Point[] = []
    line.forEach((point, index) => {
      part.push(point)
      const next = line[index + 1]
      if (next === undefined || cellOf(next) !== cellOf(point)) {
        append(cells, cellOf(point), next === undefined ? part : [...part, next])
        part = [point]
      }
    })
  }
  return cells
}

function append(cells: Map<string, Point[][]>, cell: string, piece: Point[]): void {
  const pieces = cells.get(cell)
  if (pieces === undefined) cells.set(cell, [piece])
  else pieces.push(piece)
}

/** A ring without the repetition of its first point at its end. */
function open(ring: Point[]): Point[] {
  const [first, last] = [ring[0], ring.at(-1)]
  return first !== undefined && first[0] === last?.[0] && first[1] === last[1] ? ring.slice(0, -1) : ring
}

/**
 * Cuts a ring into slices of a width along an axis. Each slice comes with the bound where it
 * begins.
 */
function* slices(ring: Point[], axis: 0 | 1, size: number): Generator<[number, Point[]]> {
  const values = ring.map((point) => point[axis])
  const [least, most] = [Math.min(...bounds(values)), Math.max(...bounds(values))]
  let rest = ring
  for (let begin = floorTo(least, size); begin < most && rest.length >= 3; begin += size) {
    const slice = half(rest, axis, begin + size, -1)
    if (slice.length >= 3) yield [begin, slice]
    rest = half(rest, axis, begin + size, 1)
  }
}

/** The minimum and maximum, without passing all values to a function as arguments. */
function bounds(values: number[]): [number, number] {
  return values.reduce<[number, number]>(
    ([low, high], one) => [Math.min(low, one), Math.max(high, one)],
    [Infinity, -Infinity],
  )
}

/** The part of a ring on one side of a bound (Sutherland and Hodgman, 1974). */
function half(ring: Point[], axis: 0 | 1, bound: number, side: 1 | -1): Point[] {
  const kept: Point[] = []
  const isInside = (point: Point) => side * (point[axis] - bound) >= 0
  ring.forEach((point, index) => {
    const former = ring.at(index - 1) ?? point
    if (isInside(point) !== isInside(former)) kept.push(crossing(former, point, axis, bound))
    if (isInside(point)) kept.push(point)
  })
  return kept
}

function crossing(from: Point, to: Point, axis: 0 | 1, bound: number): Point {
  const share = (bound - from[axis]) / (to[axis] - from[axis])
  const across = from[(1 - axis) as 0 | 1] + share * (to[(1 - axis) as 0 | 1] - from[(1 - axis) as 0 | 1])
  return axis === 0 ? [bound, across] : [across, bound]
}

function floorTo(value: number, size: number): number {
  return Math.floor(value / size) * size
}
