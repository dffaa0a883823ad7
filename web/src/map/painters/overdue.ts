// Marks overdue aircraft on top of the map with a ring and the number of minutes.

import { at } from '../../model/arrays'
import { NONE } from '../../model/motion'
import { css } from '../../parts/colours'
import { Sheet } from '../../parts/sheet'
import { text } from '../../text/text'
import { TURN } from '../rings'
import { aircraftPixel, vertiportPixel } from '../where'
import { looksOf, type Picture } from './painter'

const LETTERS_PX = 11
const RING_PX = 4
const RIM_PX = 3

export class OverduePainter {
  readonly #sheet = new Sheet()
  #isEmpty = true

  get element(): HTMLElement {
    return this.#sheet.canvas
  }

  paint(picture: Picture): void {
    const { scene, size, colours } = picture
    if (this.#isEmpty && scene.counts.overdue === 0) return
    this.#isEmpty = scene.counts.overdue === 0
    const context = this.#sheet.begin(size)
    context.font = `600 ${LETTERS_PX}px ${getComputedStyle(this.#sheet.canvas).fontFamily}`
    context.textBaseline = 'middle'
    context.lineJoin = 'round'
    const radius = looksOf(picture).aircraft_px + RING_PX
    scene.record.aircraft.forEach((_, aircraft) => {
      if (!scene.isOverdue(aircraft)) return
      const { x, y } = aircraftPixel(picture, aircraft)
      const words = text.map.late(at(scene.frame.overdue_min, aircraft))
      context.strokeStyle = css(colours.bad)
      context.lineWidth = 2
      context.beginPath()
      context.arc(x, y, radius, 0, TURN)
      context.stroke()
      const isLeft = isLeftOfVertiport(picture, aircraft, x)
      context.textAlign = isLeft ? 'right' : 'left'
      const from = x + (isLeft ? -1 : 1) * (radius + RIM_PX)
      context.lineWidth = RIM_PX
      context.strokeStyle = css(colours.land, 0.85)
      context.strokeText(words, from, y)
      context.fillStyle = css(colours.bad)
      context.fillText(words, from, y)
    })
  }
}

/**
 * Whether an aircraft is to the left of the vertiport where it was last reported or is expected.
 * Its minutes are then on the other side.
 */
function isLeftOfVertiport(picture: Picture, aircraft: number, x: number): boolean {
  const { scene } = picture
  const stands = at(scene.frame.stands, aircraft)
  return x < vertiportPixel(picture, stands === NONE ? scene.destination(aircraft) : stands).x
}
