// Routes between vertiports: great circles if there are coordinates, otherwise straight lines in
// the plane of miles.
//
// A position is two numbers: degrees east and north, or miles east and north. Positions of a fleet
// are written into existing arrays, because pictures read every aircraft in every frame.

import { at } from './arrays'
import type { Place, VertiportRecord } from './record'

/** The mean radius of the earth, as in docs/src/concepts/model.md. */
const EARTH_MI = 3958.7613
/** Radians per degree. */
export const RADIANS = Math.PI / 180

type PlaceAndHeading = [east: number, north: number, heading: number]

/** The positions of vertiports, and the routes between them. */
export class Geography {
  /** Whether positions are degrees. Either all vertiports of a network have coordinates or none. */
  readonly isGlobe: boolean
  /** The positions of all vertiports, two numbers each. */
  readonly places: Float64Array
  /** Unit vectors from the centre of the earth, three numbers each; empty in the plane. */
  readonly #vectors: Float64Array

  constructor(vertiports: readonly Pick<VertiportRecord, 'place'>[]) {
    this.isGlobe = vertiports.length > 0 && vertiports.every(({ place }) => hasDegrees(place))
    const pairs = vertiports.map(({ place }) => position(place, this.isGlobe))
    this.places = Float64Array.from(pairs.flat())
    this.#vectors = Float64Array.from(this.isGlobe ? pairs.flatMap(unitVector) : [])
  }

  get size(): number {
    return this.places.length / 2
  }

  /** The length of the route between two vertiports, miles. */
  distance(from: number, to: number): number {
    if (this.isGlobe) return EARTH_MI * this.#angle(from, to)
    return Math.hypot(
      this.#coordinate(to, 0) - this.#coordinate(from, 0),
      this.#coordinate(to, 1) - this.#coordinate(from, 1),
    )
  }

  /**
   * Writes the position after a share of the route to `places`, and the direction of flight in
   * degrees from north to `headings`.
   */
  along(
    from: number,
    to: number,
    share: number,
    places: Float64Array,
    headings: Float32Array,
    index: number,
  ): void {
    const [east, north, heading] = this.isGlobe
      ? this.#alongGreatCircle(from, to, share)
      : this.#alongLine(from, to, share)
    places[2 * index] = east
    places[2 * index + 1] = north
    headings[index] = heading
  }

  #alongLine(from: number, to: number, share: number): PlaceAndHeading {
    const [x, y] = [this.#coordinate(from, 0), this.#coordinate(from, 1)]
    const [dx, dy] = [this.#coordinate(to, 0) - x, this.#coordinate(to, 1) - y]
    return [x + share * dx, y + share * dy, Math.atan2(dx, dy) / RADIANS]
  }

  /**
   * Spherical interpolation: p = (a sin((1 - s) w) + b sin(s w)) / sin w, and the bearing of b seen
   * from p.
   */
  #alongGreatCircle(from: number, to: number, share: number): PlaceAndHeading {
    const angle = this.#angle(from, to)
    const sine = Math.sin(angle)
    const ahead = sine < 1e-12 ? share : Math.sin(share * angle) / sine
    const behind = sine < 1e-12 ? 1 - share : Math.sin((1 - share) * angle) / sine
    const [f, t, vectors] = [3 * from, 3 * to, this.#vectors]
    const x = behind * at(vectors, f) + ahead * at(vectors, t)
    const y = behind * at(vectors, f + 1) + ahead * at(vectors, t + 1)
    const z = behind * at(vectors, f + 2) + ahead * at(vectors, t + 2)
    const east = Math.atan2(y, x) / RADIANS
    const north = Math.atan2(z, Math.hypot(x, y)) / RADIANS
    return [east, north, this.#bearing(x, y, z, f, t, share)]
  }

  /**
   * The direction of a great circle at one of its points, from its components to the east and to
   * the north.
   */
  #bearing(x: number, y: number, z: number, f: number, t: number, share: number): number {
    const vectors = this.#vectors
    const sign = share < 0.5 ? 1 : -1
    const other = share < 0.5 ? t : f
    const [ox, oy, oz] = [at(vectors, other), at(vectors, other + 1), at(vectors, other + 2)]
    const level = Math.max(Math.hypot(x, y), 1e-12)
    const east = (oy * x - ox * y) / level
    const north = (oz * (x * x + y * y) - z * (ox * x + oy * y)) / level
    return Math.atan2(sign * east, sign * north) / RADIANS
  }

  /**
   * The angle between two vertiports at the centre of the earth. It is exact even for close
   * vertiports.
   */
  #angle(from: number, to: number): number {
    const [f, t, vectors] = [3 * from, 3 * to, this.#vectors]
    const dx = at(vectors, f) - at(vectors, t)
    const dy = at(vectors, f + 1) - at(vectors, t + 1)
    const dz = at(vectors, f + 2) - at(vectors, t + 2)
    return 2 * Math.asin(Math.min(1, Math.hypot(dx, dy, dz) / 2))
  }

  #coordinate(vertiport: number, axis: 0 | 1): number {
    return at(this.places, 2 * vertiport + axis)
  }
}

function hasDegrees(place: Place): boolean {
  return place.latitude !== undefined && place.longitude !== undefined
}

function position(place: Place, isGlobe: boolean): [number, number] {
  return isGlobe ? [place.longitude ?? 0, place.latitude ?? 0] : [place.x_mi, place.y_mi]
}

function unitVector([longitude, latitude]: [number, number]): [number, number, number] {
  const level = Math.cos(latitude * RADIANS)
  return [
    level * Math.cos(longitude * RADIANS),
    level * Math.sin(longitude * RADIANS),
    Math.sin(latitude * RADIANS),
  ]
}
