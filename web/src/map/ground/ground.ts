// The ground under everything else: land and sea with a graticule if there are coordinates,
// otherwise a plain grid of miles. It is redrawn only when the camera moves, the theme changes or
// more of the world has loaded.

import { at } from '../../model/arrays'
import { css } from '../../parts/colours'
import { pixelX, pixelY, view, type MapView } from '../camera'
import type { Plane } from '../plane'
import { CELL } from './grid'
import { digitsOf, multiples, roundUp } from './steps'
import { World, type Cell } from './world'

/** Minimum distance between two grid lines in pixels. */
const GRID_PX = 110
const BORDER_DASH = [6, 4]

export interface GroundPicture extends MapView {
  plane: Plane
}

export class Ground {
  readonly #world: World

  constructor(onload: () => void) {
    this.#world = new World(onload)
  }

  paint(context: CanvasRenderingContext2D, picture: GroundPicture): void {
    const { size, colours, plane } = picture
    context.fillStyle = css(plane.isGlobe ? colours.sea : colours.land)
    context.fillRect(0, 0, size.width, size.height)
    if (plane.isGlobe) this.#paintWorld(context, picture)
    paintGrid(context, picture)
  }

  #paintWorld(context: CanvasRenderingContext2D, picture: GroundPicture): void {
    const { plane, camera, size, colours } = picture
    const box = view(camera, size)
    const bounds = {
      west: plane.longitude(box.west),
      east: plane.longitude(box.east),
      south: plane.latitude(box.south),
      north: plane.latitude(box.north),
    }
    const cells = this.#world.cells(bounds)
    context.lineJoin = 'round'
    for (const cell of cells) {
      fill(context, picture, cell.land, css(colours.land))
      fill(context, picture, cell.lakes, css(colours.sea))
    }
    context.strokeStyle = css(colours.coast)
    context.lineWidth = 1.25
    for (const cell of cells)
      for (const ring of [...cell.land, ...cell.lakes]) strokeCoast(context, picture, cell, ring)
    context.strokeStyle = css(colours.border)
    context.setLineDash(BORDER_DASH)
    for (const cell of cells) for (const line of cell.borders) strokeLine(context, picture, line)
    context.setLineDash([])
  }
}

/** Converts a point of the base map to pixels. */
function pointX({ plane, camera, size }: GroundPicture, ring: Float64Array, index: number): number {
  return pixelX(camera, size, plane.x(at(ring, index)))
}

function pointY({ plane, camera, size }: GroundPicture, ring: Float64Array, index: number): number {
  return pixelY(camera, size, plane.y(at(ring, index + 1)))
}

/**
 * Fills rings, except for rings within others. The stroke closes the hairlines between the cells of
 * the land.
 */
function fill(
  context: CanvasRenderingContext2D,
  picture: GroundPicture,
  rings: Float64Array[],
  colour: string,
): void {
  context.beginPath()
  for (const ring of rings) {
    context.moveTo(pointX(picture, ring, 0), pointY(picture, ring, 0))
    for (let one = 2; one < ring.length; one += 2)
      context.lineTo(pointX(picture, ring, one), pointY(picture, ring, one))
    context.closePath()
  }
  context.fillStyle = colour
  context.fill('evenodd')
  context.strokeStyle = colour
  context.lineWidth = 0.75
  context.stroke()
}

/** Draws the outline of a ring without the edges along which it was cut. */
function strokeCoast(
  context: CanvasRenderingContext2D,
  picture: GroundPicture,
  cell: Cell,
  ring: Float64Array,
): void {
  context.beginPath()
  const last = ring.length - 2
  let isDrawing = false
  for (let one = 0, former = last; one < ring.length; former = one, one += 2) {
    if (isCut(cell, ring, former, one)) {
      isDrawing = false
      continue
    }
    if (!isDrawing) context.moveTo(pointX(picture, ring, former), pointY(picture, ring, former))
    context.lineTo(pointX(picture, ring, one), pointY(picture, ring, one))
    isDrawing = true
  }
  context.stroke()
}

function isCut({ west, south }: Cell, ring: Float64Array, from: number, to: number): boolean {
  const isAlong = (bound: number, axis: 0 | 1) =>
    Math.abs(at(ring, from + axis) - bound) < 1e-6 && Math.abs(at(ring, to + axis) - bound) < 1e-6
  return isAlong(west, 0) || isAlong(west + CELL, 0) || isAlong(south, 1) || isAlong(south + CELL, 1)
}

function strokeLine(context: CanvasRenderingContext2D, picture: GroundPicture, line: Float64Array): void {
  context.beginPath()
  for (let one = 0; one < line.length; one += 2)
    context.lineTo(pointX(picture, line, one), pointY(picture, line, one))
  context.stroke()
}

/** Meridians and parallels with their degrees, or lines of whole miles. */
function paintGrid(context: CanvasRenderingContext2D, picture: GroundPicture): void {
  const { plane, camera, size, colours } = picture
  const box = view(camera, size)
  const unit = plane.isGlobe ? Math.abs(plane.x(plane.longitude(0) + 1)) : 1
  const step = roundUp(GRID_PX / camera.scale / unit)
  context.strokeStyle = css(colours.grid)
  context.fillStyle = css(colours['ink-soft'], 0.8)
  context.font = gridFont(context)
  context.lineWidth = 1
  context.beginPath()
  for (const east of multiples(plane.longitude(box.west), plane.longitude(box.east), step)) {
    const x = Math.round(pixelX(camera, size, plane.x(east))) + 0.5
    context.moveTo(x, 0)
    context.lineTo(x, size.height)
  }
  for (const north of multiples(plane.latitude(box.south), plane.latitude(box.north), step)) {
    const y = Math.round(pixelY(camera, size, plane.y(north))) + 0.5
    context.moveTo(0, y)
    context.lineTo(size.width, y)
  }
  context.stroke()
  nameGrid(context, picture, step)
}

function gridFont(context: CanvasRenderingContext2D): string {
  return `10px ${getComputedStyle(context.canvas).fontFamily}`
}

/** Labels are at the top and left edges, where they cover the least. */
function nameGrid(
  context: CanvasRenderingContext2D,
  { plane, camera, size }: GroundPicture,
  step: number,
): void {
  const box = view(camera, size)
  context.textAlign = 'left'
  context.textBaseline = 'top'
  for (const east of multiples(plane.longitude(box.west), plane.longitude(box.east), step)) {
    const x = pixelX(camera, size, plane.x(east))
    if (x > 60 && x < size.width - 60)
      context.fillText(nameOf(east, step, plane.isGlobe ? 'EW' : undefined), x + 4, 4)
  }
  for (const north of multiples(plane.latitude(box.south), plane.latitude(box.north), step)) {
    const y = pixelY(camera, size, plane.y(north))
    if (y > 30 && y < size.height - 60)
      context.fillText(nameOf(north, step, plane.isGlobe ? 'NS' : undefined), 4, y + 3)
  }
}

/** `73.8° W`, or `20 mi`. */
function nameOf(value: number, step: number, directions: 'EW' | 'NS' | undefined): string {
  if (directions === undefined) return `${value.toFixed(digitsOf(step)).replace('-', '−')} mi`
  return `${Math.abs(value).toFixed(digitsOf(step))}° ${directions.charAt(value < 0 ? 1 : 0)}`
}
