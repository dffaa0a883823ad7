// The grid of the base map: cells of a few degrees, which are drawn, and sectors of many cells,
// which are loaded.

/** The side of a cell in degrees. */
export const CELL = 5
export const SECTOR = 30

/** The shapes of a cell, as `encoding.ts` writes them. */
export interface CellText {
  land?: string[]
  lakes?: string[]
  borders?: string[]
}

/** A part of the world in degrees. East is above 180 if the part crosses the antimeridian. */
export interface Bounds {
  west: number
  south: number
  east: number
  north: number
}

/** The south-western corners of all grid squares that intersect a part of the world. */
export function squares(bounds: Bounds, size: number): [west: number, south: number][] {
  const corners: [number, number][] = []
  for (let south = floorTo(bounds.south, size); south < bounds.north; south += size) {
    for (let west = floorTo(bounds.west, size); west < bounds.east; west += size) corners.push([west, south])
  }
  return corners
}

/**
 * The name of the sector or cell with a corner; longitudes are normalised to between -180 and 180.
 */
export function squareName([west, south]: readonly [number, number], separator: string): string {
  return `${((((west + 180) % 360) + 360) % 360) - 180}${separator}${south}`
}

function floorTo(value: number, size: number): number {
  return Math.floor(value / size) * size
}
