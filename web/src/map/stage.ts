// The map's layers over the ground: objects, names, and marks for overdue aircraft. They are
// painted together, so they always show the same time from the same camera.

import { CanvasPainter } from './painters/canvas'
import { NamesPainter } from './painters/names'
import { OverduePainter } from './painters/overdue'
import type { Picture } from './painters/painter'

export class Stage {
  readonly #network = new CanvasPainter()
  readonly #names = new NamesPainter()
  readonly #overdue = new OverduePainter()
  readonly elements = [...this.#network.elements, this.#names.element, this.#overdue.element]

  paint(picture: Picture): void {
    this.#network.paint(picture)
    this.#names.paint(picture)
    this.#overdue.paint(picture)
  }
}
