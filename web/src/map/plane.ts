// The plane of the maps: miles east and north of the middle of the network. With coordinates it is
// the Mercator projection, scaled for the middle's latitude, so directions on the map are those of
// flight.

import { at } from '../model/arrays'
import { RADIANS, type Geography } from '../model/geography'

/** Miles around the equator of the Mercator world, before the scale of a latitude. */
const AROUND_MI = 2 * Math.PI * 3958.7613
/** The Mercator map ends here; the poles are infinitely far away. */
const NORTHERNMOST = 85

export interface Box {
  west: number
  south: number
  east: number
  north: number
}

export class Plane {
  readonly isGlobe: boolean
  /** The vertiports, two numbers each. */
  readonly vertiports: Float64Array
  /** The middle of the network: degrees, or miles in the network's coordinates. */
  readonly #middle: [number, number]
  /** The width of the world in miles of the plane. */
  readonly #world_mi: number
  readonly #north: number

  constructor(geography: Geography) {
    this.isGlobe = geography.isGlobe
    const box = boxOf(geography.places)
    this.#middle = [(box.west + box.east) / 2, (box.south + box.north) / 2]
    this.#world_mi = AROUND_MI * Math.cos(this.#middle[1] * RADIANS)
    this.#north = mercator(this.#middle[1])
    this.vertiports = new Float64Array(geography.places.length)
    this.write(geography.places, this.vertiports)
  }

  /** Converts positions of a geography to positions in the plane. */
  write(places: ArrayLike<number>, to: Float64Array): void {
    for (let one = 0; one < places.length; one += 2) {
      const [east, north] = [at(places, one), at(places, one + 1)]
      to[one] = this.x(east)
      to[one + 1] = this.y(north)
    }
  }

  x(east: number): number {
    const difference = east - this.#middle[0]
    return this.isGlobe ? (difference / 360) * this.#world_mi : difference
  }

  y(north: number): number {
    if (!this.isGlobe) return north - this.#middle[1]
    return (mercator(north) - this.#north) * this.#world_mi
  }

  longitude(x: number): number {
    return this.#middle[0] + (this.isGlobe ? (x / this.#world_mi) * 360 : x)
  }

  latitude(y: number): number {
    if (!this.isGlobe) return this.#middle[1] + y
    const exponent = (y / this.#world_mi + this.#north) * 2 * Math.PI
    return (2 * Math.atan(Math.exp(exponent)) - Math.PI / 2) / RADIANS
  }

  /** Miles on the ground per mile of the plane, at a given y. */
  milesAt(y: number): number {
    return this.isGlobe ? Math.cos(this.latitude(y) * RADIANS) / Math.cos(this.#middle[1] * RADIANS) : 1
  }

  /** The width of the world in pixels at a scale, from which other maps compute their zoom. */
  worldWidth(scale: number): number {
    return this.#world_mi * scale
  }
}

/** The smallest rectangle around positions; one around the origin if there are none. */
export function boxOf(places: ArrayLike<number>): Box {
  const box: Box = { west: Infinity, south: Infinity, east: -Infinity, north: -Infinity }
  for (let one = 0; one + 1 < places.length; one += 2) {
    const [east, north] = [at(places, one), at(places, one + 1)]
    box.west = Math.min(box.west, east)
    box.east = Math.max(box.east, east)
    box.south = Math.min(box.south, north)
    box.north = Math.max(box.north, north)
  }
  return places.length === 0 ? { west: 0, south: 0, east: 0, north: 0 } : box
}

/** The Mercator y of a latitude, in widths of the world. */
function mercator(latitude: number): number {
  const bounded = Math.max(-NORTHERNMOST, Math.min(NORTHERNMOST, latitude))
  return Math.log(Math.tan(Math.PI / 4 + (bounded * RADIANS) / 2)) / (2 * Math.PI)
}
