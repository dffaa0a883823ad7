// Draws the text on the map: the name of each vertiport next to its ring, and the number of
// aircraft within it.

import { at } from '../../model/arrays'
import { css } from '../../parts/colours'
import { shows } from '../camera'
import { placeLabels, type LabelPlace, type Rectangle } from '../labels'
import { radiusOf } from '../rings'
import { vertiportPixel } from '../where'
import { changed } from './changes'
import { stillParts, type Picture } from './painter'
import { Sheet, type Size } from '../../parts/sheet'

const NAME_PX = 12
const NUMBER_PX = 10
/** A number in a smaller ring would be illegible. */
const LEAST_RADIUS_FOR_NUMBER = 12
const LINE_PX = 13

export class NamesPainter {
  readonly #sheet = new Sheet()
  readonly #hasChanged = changed(stillParts)

  get element(): HTMLElement {
    return this.#sheet.canvas
  }

  paint(picture: Picture): void {
    if (!this.#hasChanged(picture)) return
    const context = this.#sheet.begin(picture.size)
    const family = getComputedStyle(this.#sheet.canvas).fontFamily
    const fonts = { name: `600 ${NAME_PX}px ${family}`, number: `500 ${NUMBER_PX}px ${family}` }
    const visible = picture.scene.room.map((_, one) => one).filter((one) => isVisible(picture, one))
    const labels = visible.map((one) => labelOf(context, picture, one, fonts))
    const places = placeLabels(labels, picture.size, controls(picture.size))
    context.lineJoin = 'round'
    labels.forEach((label, index) => {
      if (label.radius >= LEAST_RADIUS_FOR_NUMBER) paintNumber(context, picture, label, fonts.number)
      const place = places[index]
      if (place !== undefined) paintName(context, picture, label, place, fonts)
    })
  }
}

/** The areas that the map's buttons and key cover; names there would be illegible. */
function controls({ width, height }: Size): Rectangle[] {
  return [
    { left: width - 48, top: 0, right: width, bottom: 148 },
    { left: 0, top: height - 64, right: 72, bottom: height },
  ]
}

interface Fonts {
  name: string
  number: string
}

interface Label {
  x: number
  y: number
  radius: number
  width: number
  height: number
  weight: number
  name: string
  taken: number
  detail: string
}

function isVisible({ scene, camera, size }: Picture, vertiport: number): boolean {
  const places = scene.plane.vertiports
  return shows(camera, size, at(places, 2 * vertiport), at(places, 2 * vertiport + 1), -30)
}

function labelOf(
  context: CanvasRenderingContext2D,
  picture: Picture,
  vertiport: number,
  fonts: Fonts,
): Label {
  const { scene, camera, hovered, selected } = picture
  const room = at(scene.room, vertiport)
  const name = at(scene.record.vertiports, vertiport).id
  const { taken, promised } = scene.counts.standsOf(vertiport)
  const detail = `${taken}${promised > 0 ? `+${promised}` : ''}/${room}`
  context.font = fonts.name
  const nameWidth = context.measureText(name).width
  context.font = fonts.number
  const isMarked = [hovered, selected].some((one) => one?.kind === 'vertiport' && one.vertiport === vertiport)
  return {
    ...vertiportPixel(picture, vertiport),
    radius: radiusOf(scene, vertiport, camera.scale),
    width: Math.max(nameWidth, context.measureText(detail).width),
    height: 2 * LINE_PX,
    weight: isMarked ? Infinity : room,
    ...{ name, taken, detail },
  }
}

function paintNumber(
  context: CanvasRenderingContext2D,
  { colours }: Picture,
  label: Label,
  font: string,
): void {
  context.font = font.replace(/\d+px/, `${Math.round(Math.min(13, label.radius * 0.8))}px`)
  context.textAlign = 'center'
  context.textBaseline = 'middle'
  context.fillStyle = css(colours.ink)
  context.fillText(String(label.taken), label.x, label.y + 0.5)
}

/**
 * Text has an outline in the colour of the ground, so that it is legible over routes and coasts.
 */
function paintName(
  context: CanvasRenderingContext2D,
  { colours }: Picture,
  label: Label,
  place: LabelPlace,
  fonts: Fonts,
): void {
  const isLeft = place.left + label.width / 2 < label.x - 1
  const isAside = Math.abs(place.left + label.width / 2 - label.x) > 1
  context.textAlign = isAside ? (isLeft ? 'right' : 'left') : 'center'
  context.textBaseline = 'middle'
  const x = isAside ? place.left + (isLeft ? label.width : 0) : label.x
  const lines = [
    { text: label.name, font: fonts.name, colour: colours.ink, y: place.top + LINE_PX / 2 },
    { text: label.detail, font: fonts.number, colour: colours['ink-soft'], y: place.top + 1.5 * LINE_PX },
  ]
  for (const { text, font, colour, y } of lines) {
    context.font = font
    context.lineWidth = 3
    context.strokeStyle = css(colours.land, 0.85)
    context.strokeText(text, x, y)
    context.fillStyle = css(colour)
    context.fillText(text, x, y)
  }
}
