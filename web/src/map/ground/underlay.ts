// The element under everything else on a map: the bundled base map, or a custom one instead.

import { Sheet } from '../../parts/sheet'
import { text } from '../../text/text'
import { changed } from '../painters/changes'
import type { Basemap } from './basemap'
import { Ground, type GroundPicture } from './ground'

export class Underlay {
  readonly element = document.createElement('div')
  readonly #sheet = new Sheet()
  readonly #ground: Ground
  readonly #hasChanged = changed(({ plane, camera, size, colours }: GroundPicture) => [
    plane,
    camera,
    size,
    colours,
  ])
  #basemap: Basemap | undefined
  #picture: GroundPicture | undefined

  constructor() {
    this.#ground = new Ground(() => this.#paintAgain())
    this.element.append(this.#sheet.canvas)
  }

  /** Draws the ground of a picture, unless it is unchanged. */
  paint(picture: GroundPicture): void {
    const hasChanged = this.#hasChanged(picture)
    this.#picture = picture
    if (hasChanged) this.#paintAgain()
  }

  /**
   * Replaces the bundled base map once another one has loaded; if loading fails, the bundled one
   * stays. `onattribution` receives the attribution for the map. Returns a function that restores
   * the bundled one.
   */
  show(
    address: string,
    colours: GroundPicture['colours'],
    onattribution: (words: string) => void,
  ): () => void {
    let isWanted = true
    const back = () => {
      if (!isWanted) return
      onattribution(`${text.map.failedBasemap} ${text.map.attribution}`)
      this.#lay(undefined)
    }
    if (!__EMBEDDED__)
      void import('./basemap')
        .then(({ Basemap }) => Basemap.open({ address, colours, onattribution, onerror: back }))
        .then((made) => (isWanted ? this.#lay(made) : made.destroy()))
        .catch(back)
    return () => {
      isWanted = false
      onattribution(text.map.attribution)
      this.#lay(undefined)
    }
  }

  destroy(): void {
    this.#basemap?.destroy()
    this.element.remove()
  }

  #lay(basemap: Basemap | undefined): void {
    this.#basemap?.destroy()
    this.#basemap = basemap
    if (basemap !== undefined) this.element.prepend(basemap.element)
    this.#paintAgain()
  }

  #paintAgain(): void {
    if (this.#picture === undefined) return
    const context = this.#sheet.begin(this.#picture.size)
    if (this.#basemap === undefined) this.#ground.paint(context, this.#picture)
    else this.#basemap.paint(this.#picture)
  }
}
