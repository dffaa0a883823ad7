// The layers of a timeline: the rows, which are redrawn only when they change, and the parts that
// move with the time.

import { changed } from '../map/painters/changes'
import type { Seconds } from '../model/record'
import { Sheet } from '../parts/sheet'
import { GUTTER_PX, paintAxis, paintNames, paintNow } from './axis'
import { paintRows, type GanttPicture } from './paint'

export const AXIS_PX = 26

export interface Now {
  time: Seconds
  isLive: boolean
}

export class Sheets {
  readonly #axis = new Sheet()
  readonly #rows = new Sheet()
  readonly #now = new Sheet()
  readonly #hasChanged = changed((rows: GanttPicture) => Object.values(rows))

  /** Adds the layers to the elements of the axis and of the rows. */
  constructor(axis: HTMLElement, rows: HTMLElement) {
    axis.append(this.#axis.canvas)
    rows.append(this.#rows.canvas, this.#now.canvas)
  }

  paint(picture: GanttPicture, now: Now): void {
    const { size } = picture
    const whole = { width: GUTTER_PX + size.width, height: size.height }
    if (this.#hasChanged(picture)) this.#paintRows(picture, whole)
    paintNow(this.#now.begin(whole), { ...picture, ...now })
    const axis = { width: size.width, height: AXIS_PX }
    paintAxis(this.#axis.begin({ width: whole.width, height: AXIS_PX }), { ...picture, ...now, size: axis })
  }

  destroy(): void {
    for (const sheet of [this.#axis, this.#rows, this.#now]) sheet.canvas.remove()
  }

  /** Rows are drawn next to their names and never below them. */
  #paintRows(picture: GanttPicture, whole: { width: number; height: number }): void {
    const context = this.#rows.begin(whole)
    context.save()
    context.beginPath()
    context.rect(GUTTER_PX, 0, picture.size.width, picture.size.height)
    context.clip()
    context.translate(GUTTER_PX, 0)
    paintRows(context, picture)
    context.restore()
    paintNames(context, picture)
  }
}
