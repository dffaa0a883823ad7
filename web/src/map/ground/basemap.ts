// A custom base map under everything else: a style or a PMTiles file at an address. MapLibre draws
// it and follows the map's camera. The map itself handles all gestures.

import { addProtocol, Map, setWorkerUrl, type StyleSpecification } from 'maplibre-gl'
import workerUrl from 'maplibre-gl/dist/maplibre-gl-worker.mjs?worker&url'
import { PMTiles, Protocol } from 'pmtiles'
import { css } from '../../parts/colours'
import type { GroundPicture } from './ground'
import { styleOf } from './tileStyle'

/** MapLibre's zoom 0 shows a world of this width in pixels. */
const WORLD_PX = 512

export interface BasemapOptions {
  address: string
  colours: GroundPicture['colours']
  /** Receives the attribution of the sources, once it is known. */
  onattribution: (text: string) => void
  onerror: () => void
}

export class Basemap {
  readonly element = document.createElement('div')
  readonly #map: Map

  private constructor(style: StyleSpecification | string, options: BasemapOptions) {
    this.element.className = 'basemap'
    this.#map = new Map({ container: this.element, style, interactive: false, attributionControl: false })
    this.#map.once('idle', () => options.onattribution(this.#attribution()))
    this.#map.on('error', () => {
      if (!this.#map.isStyleLoaded()) options.onerror()
    })
  }

  static async open(options: BasemapOptions): Promise<Basemap> {
    setWorkerUrl(workerUrl)
    if (!/\.pmtiles($|\?)/.test(options.address)) return new Basemap(options.address, options)
    const tiles = new PMTiles(options.address)
    // The metadata contains the attribution.
    const protocol = new Protocol({ metadata: true })
    protocol.add(tiles)
    addProtocol('pmtiles', protocol.tile)
    const [header, metadata] = await Promise.all([tiles.getHeader(), tiles.getMetadata()])
    const ink = (name: 'sea' | 'land' | 'coast' | 'border' | 'grid') => css(options.colours[name])
    return new Basemap(styleOf(options.address, header, metadata, ink), options)
  }

  paint({ plane, camera, size }: GroundPicture): void {
    if (this.element.clientWidth !== size.width || this.element.clientHeight !== size.height)
      this.#resize(size)
    this.#map.jumpTo({
      center: [plane.longitude(camera.x), plane.latitude(camera.y)],
      zoom: Math.log2(plane.worldWidth(camera.scale) / WORLD_PX),
    })
  }

  destroy(): void {
    this.#map.remove()
    this.element.remove()
  }

  #resize({ width, height }: GroundPicture['size']): void {
    this.element.style.width = `${width}px`
    this.element.style.height = `${height}px`
    this.#map.resize()
  }

  /** Sources may contain links in their attribution; only the words are shown. */
  #attribution(): string {
    // The style contains only its own attribution; the sources include that of their tiles.
    const sources = Object.keys(this.#map.getStyle().sources).map((name) => this.#map.getSource(name))
    const words = sources.map((one) =>
      new DOMParser().parseFromString(one?.attribution ?? '', 'text/html').body.textContent.trim(),
    )
    return [...new Set(words)].filter((one) => one !== '').join(' · ')
  }
}
