// Draws the network on two canvases: one for parts that change with decisions, one for parts that
// move. With 500 aircraft a frame takes less than 4 ms of scripting. WebGL layers, which are
// prepared again in each frame, took five times as long.

import { at } from '../../model/arrays'
import { COUNTED } from '../../model/counts'
import { NONE } from '../../model/motion'
import { aircraftMeant } from '../../model/target'
import type { Pixel } from '../../parts/pointers'
import { css } from '../../parts/colours'
import { piecesOf, radiusOf, ringWidth, TURN } from '../rings'
import { aircraftPixel, direction, vertiportPixel, visibility, wayBegin } from '../where'
import { changed } from './changes'
import {
  aircraftSize,
  ARC_BEND,
  arcWidth,
  COLOUR_OF_STATE,
  looksOf,
  OPACITY_OF_STATE,
  stillParts,
  type Picture,
} from './painter'
import { Sheet } from '../../parts/sheet'
import { drawSprites, FILLED, spriteName, toneOf, type Sprites } from './sprites'

/** The distance between the ring of the selected aircraft and that of the followed one, pixels. */
const FOLLOWED_PX = 4
/** Aircraft further outside the picture than this are not drawn. */
const BEYOND_PX = 20

export class CanvasPainter {
  readonly #still = new Sheet()
  readonly #moving = new Sheet()
  readonly #hasChanged = changed(stillParts)
  #sprites: { colours: Picture['colours']; side: number; sprites: Sprites } | undefined

  get elements(): HTMLElement[] {
    return [this.#still.canvas, this.#moving.canvas]
  }

  paint(picture: Picture): void {
    if (this.#hasChanged(picture)) {
      const context = this.#still.begin(picture.size)
      if (picture.showsDemand) paintArcs(context, picture)
      paintClosures(context, picture)
      paintRings(context, picture)
    }
    const { aircraft_px } = looksOf(picture)
    paintFleet(this.#moving.begin(picture.size), picture, this.#spritesFor(picture, aircraft_px))
  }

  /**
   * Sprites have the size at which the screen shows them, because a canvas scales them down poorly.
   */
  #spritesFor({ colours }: Picture, aircraft_px: number): Sprites {
    const side = 2 * Math.ceil((aircraft_px / FILLED) * devicePixelRatio)
    if (this.#sprites?.colours !== colours || this.#sprites.side !== side) {
      this.#sprites = { colours, side, sprites: drawSprites(colours, side) }
    }
    return this.#sprites.sprites
  }
}

function paintFleet(context: CanvasRenderingContext2D, picture: Picture, sprites: Sprites): void {
  const { scene, size, colours, selected } = picture
  const { aircraft_px, wayOpacity } = looksOf(picture)
  const places = scene.record.aircraft.map((_, one) => aircraftPixel(picture, one))
  context.strokeStyle = css(colours.flying, wayOpacity)
  context.lineWidth = 1.25
  context.beginPath()
  places.forEach((place, one) => addFlownWay(context, picture, one, place))
  context.stroke()
  const marked = aircraftMeant(selected)
  if (marked !== undefined) paintSelectedWay(context, picture, marked, at(places, marked))
  places.forEach((place, one) => {
    if (scene.destination(one) === NONE) return
    const { x, y } = place
    if (Math.min(x, y, size.width - x, size.height - y) < -BEYOND_PX) return
    paintAircraft(context, picture, one, place, aircraft_px, sprites)
  })
}

function addFlownWay(
  context: CanvasRenderingContext2D,
  picture: Picture,
  one: number,
  { x, y }: Pixel,
): void {
  const from = wayBegin(picture, one, { x, y })
  if (from === undefined) return
  context.moveTo(from.x, from.y)
  context.lineTo(x, y)
}

/** The whole route of the selected aircraft: flown and ahead. */
function paintSelectedWay(
  context: CanvasRenderingContext2D,
  picture: Picture,
  aircraft: number,
  place: Pixel,
): void {
  const destination = picture.scene.destination(aircraft)
  if (destination === NONE) return
  context.strokeStyle = css(picture.colours.accent)
  context.lineWidth = 2
  context.beginPath()
  addFlownWay(context, picture, aircraft, place)
  context.stroke()
  const to = vertiportPixel(picture, destination)
  context.setLineDash([5, 5])
  context.beginPath()
  context.moveTo(place.x, place.y)
  context.lineTo(to.x, to.y)
  context.stroke()
  context.setLineDash([])
}

function paintAircraft(
  context: CanvasRenderingContext2D,
  picture: Picture,
  one: number,
  place: Pixel,
  px: number,
  sprites: Sprites,
): void {
  const { scene, colours, hovered, selected, followed } = picture
  const isMarked = aircraftMeant(hovered) === one || aircraftMeant(selected) === one
  const half = (aircraftSize(px, at(scene.frame.lifts, one)) * (isMarked ? 1.25 : 1)) / FILLED
  const sprite = sprites.mapping[spriteName(toneOf(scene, one, isMarked), scene.load(one))]
  if (sprite === undefined) return
  context.globalAlpha = isMarked ? 1 : visibility(picture, one, place)
  context.translate(place.x, place.y)
  if (isMarked) paintHalo(context, half * FILLED, css(colours.accent))
  if (followed === one) paintHalo(context, half * FILLED + FOLLOWED_PX, css(colours.accent))
  const angle = direction(picture, one, place)
  context.rotate(angle)
  const { x, y, width, height } = sprite
  context.drawImage(sprites.image, x, y, width, height, -half, -half, 2 * half, 2 * half)
  context.rotate(-angle)
  context.translate(-place.x, -place.y)
  context.globalAlpha = 1
}

function paintHalo(context: CanvasRenderingContext2D, size: number, colour: string): void {
  disc(context, 0, 0, size + 6)
  context.strokeStyle = colour
  context.lineWidth = 1.5
  context.stroke()
}

function paintArcs(context: CanvasRenderingContext2D, picture: Picture): void {
  const { scene, colours, selected } = picture
  const only = selected?.kind === 'vertiport' ? selected.vertiport : undefined
  context.lineCap = 'round'
  for (const { from, to, passengers } of scene.pairs) {
    if (only !== undefined && from !== only && to !== only) continue
    const [start, end] = [vertiportPixel(picture, from), vertiportPixel(picture, to)]
    const [bendX, bendY] = [-(end.y - start.y) * ARC_BEND * 2, (end.x - start.x) * ARC_BEND * 2]
    const fade = context.createLinearGradient(start.x, start.y, end.x, end.y)
    fade.addColorStop(0, css(colours.demand, 0.6))
    fade.addColorStop(1, css(colours.demand, 0.06))
    context.strokeStyle = fade
    context.lineWidth = arcWidth(passengers, picture.size)
    context.beginPath()
    context.moveTo(start.x, start.y)
    context.quadraticCurveTo((start.x + end.x) / 2 + bendX, (start.y + end.y) / 2 + bendY, end.x, end.y)
    context.stroke()
  }
}

function paintClosures(context: CanvasRenderingContext2D, picture: Picture): void {
  context.strokeStyle = css(picture.colours.bad, 0.85)
  context.lineWidth = 2
  for (const closure of picture.scene.closures) {
    if ('vertiport' in closure) continue
    const [start, end] = [vertiportPixel(picture, closure.from), vertiportPixel(picture, closure.to)]
    context.setLineDash([2, 6])
    context.beginPath()
    context.moveTo(start.x, start.y)
    context.lineTo(end.x, end.y)
    context.stroke()
    context.setLineDash([])
    paintCross(context, (start.x + end.x) / 2, (start.y + end.y) / 2, 5)
  }
}

function paintCross(context: CanvasRenderingContext2D, x: number, y: number, size: number): void {
  context.beginPath()
  context.moveTo(x - size, y - size)
  context.lineTo(x + size, y + size)
  context.moveTo(x + size, y - size)
  context.lineTo(x - size, y + size)
  context.stroke()
}

function paintRings(context: CanvasRenderingContext2D, picture: Picture): void {
  const { scene, colours, hovered, selected } = picture
  const closed = new Set(scene.closures.flatMap((one) => ('vertiport' in one ? [one.vertiport] : [])))
  context.lineCap = 'butt'
  scene.room.forEach((_, vertiport) => {
    paintRing(context, picture, vertiport)
    const isMarked = [hovered, selected].some(
      (one) => one?.kind === 'vertiport' && one.vertiport === vertiport,
    )
    if (!isMarked && !closed.has(vertiport)) return
    const { x, y } = vertiportPixel(picture, vertiport)
    context.strokeStyle = css(isMarked ? colours.accent : colours.bad)
    context.lineWidth = 2
    disc(context, x, y, radiusOf(scene, vertiport, picture.camera.scale) + 4)
    context.stroke()
  })
}

function paintRing(context: CanvasRenderingContext2D, picture: Picture, vertiport: number): void {
  const { scene, camera, colours } = picture
  const { x, y } = vertiportPixel(picture, vertiport)
  const radius = radiusOf(scene, vertiport, camera.scale)
  context.fillStyle = css(colours.surface)
  disc(context, x, y, radius + 1.5)
  context.fill()
  context.lineWidth = ringWidth(radius)
  const line = radius - ringWidth(radius) / 2
  for (const { begin, end, state } of piecesOf(
    scene.counts.held,
    COUNTED * vertiport,
    at(scene.room, vertiport),
    radius,
  )) {
    context.strokeStyle = css(colours[COLOUR_OF_STATE[state]], OPACITY_OF_STATE[state])
    context.beginPath()
    context.arc(x, y, line, begin - TURN / 4, end - TURN / 4)
    context.stroke()
  }
}

function disc(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.beginPath()
  context.arc(x, y, radius, 0, TURN)
}
