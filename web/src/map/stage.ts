// The layers of the map, one over the other: the ground, what is on the map, and names. They are put into an element and painted
// together, so that they always show the same moment from the same camera.

import type { Basemap } from './ground/basemap'
import { Ground } from './ground/ground'
import { CanvasPainter } from './painters/canvas'
import { changed } from './painters/changes'
import { NamesPainter } from './painters/names'
import type { Painter, Picture } from './painters/painter'
import { Sheet } from '../parts/sheet'

export class Stage {
  readonly #sheet = new Sheet()
  readonly #ground: Ground
  readonly #names = new NamesPainter()
  readonly #hasChanged = changed(({ scene, camera, size, colours }: Picture) => [
    scene,
    camera,
    size,
    colours,
  ])
  #painter: Painter = new CanvasPainter()
  #basemap: Basemap | undefined
  #picture: Picture | undefined
  /** More of the world can be drawn than when the ground was painted last. */
  #hasMore = false

  constructor(private readonly element: HTMLElement) {
    this.#ground = new Ground(() => {
      this.#hasMore = true
      if (this.#picture !== undefined) this.paint(this.#picture)
    })
    element.append(this.#sheet.canvas, this.#painter.element, this.#names.element)
  }

  /** Takes another painter in place of the one so far. */
  use(painter: Painter): void {
    this.#painter.element.replaceWith(painter.element)
    this.#painter.destroy()
    this.#painter = painter
    if (this.#picture !== undefined) this.paint(this.#picture)
  }

  /** Takes another base map in place of the bundled one; or the bundled one again. */
  lay(basemap: Basemap | undefined): void {
    this.#basemap?.destroy()
    this.#basemap = basemap
    this.#hasMore = true
    if (basemap !== undefined) this.#sheet.canvas.before(basemap.element)
    if (this.#picture !== undefined) this.paint(this.#picture)
  }

  paint(picture: Picture): void {
    this.#picture = picture
    if (this.#hasChanged(picture) || this.#hasMore) this.#paintGround(picture)
    this.#painter.paint(picture)
    this.#names.paint(picture)
  }

  destroy(): void {
    this.#painter.destroy()
    this.#basemap?.destroy()
    this.element.replaceChildren()
  }

  #paintGround({ size, camera, colours, scene }: Picture): void {
    this.#hasMore = false
    const picture = { size, camera, colours, plane: scene.plane }
    const context = this.#sheet.begin(size)
    if (this.#basemap === undefined) this.#ground.paint(context, picture)
    else this.#basemap.paint(picture)
  }
}
