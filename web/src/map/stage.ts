// The layers of the map, one over the other: what lies beneath, what is on the map, names, and what is overdue. They are put into an element and
// painted together, so that they always show the same moment from the same camera.

import { Underlay } from './ground/underlay'
import { CanvasPainter } from './painters/canvas'
import { NamesPainter } from './painters/names'
import { OverduePainter } from './painters/overdue'
import type { Painter, Picture } from './painters/painter'

export class Stage {
  readonly underlay = new Underlay()
  readonly #names = new NamesPainter()
  readonly #overdue = new OverduePainter()
  #painter: Painter = new CanvasPainter()
  #picture: Picture | undefined

  constructor(private readonly element: HTMLElement) {
    element.append(this.underlay.element, this.#painter.element, this.#names.element, this.#overdue.element)
  }

  /** Takes another painter in place of the one so far. */
  use(painter: Painter): void {
    this.#painter.element.replaceWith(painter.element)
    this.#painter.destroy()
    this.#painter = painter
    if (this.#picture !== undefined) this.paint(this.#picture)
  }

  paint(picture: Picture): void {
    this.#picture = picture
    const { scene, camera, size, colours } = picture
    this.underlay.paint({ plane: scene.plane, camera, size, colours })
    this.#painter.paint(picture)
    this.#names.paint(picture)
    this.#overdue.paint(picture)
  }

  destroy(): void {
    this.#painter.destroy()
    this.underlay.destroy()
    this.element.replaceChildren()
  }
}
