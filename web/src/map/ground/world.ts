// The bundled base map. It finds the cells that a picture needs, loads them one sector at a time
// and keeps them. A page without a server embeds its cells.

import { addresses } from 'virtual:basemap'
import { decode } from './encoding'
import { CELL, SECTOR, squareName, squares, type Bounds, type CellText } from './grid'

/** A cell as it is drawn: rings and lines in degrees, two numbers a point. */
export interface Cell {
  west: number
  south: number
  land: Float64Array[]
  lakes: Float64Array[]
  borders: Float64Array[]
}

type Sector = Readonly<Record<string, CellText | undefined>>

/** The element with the cells that a page embeds. */
const CARRIED = 'vertifleet-basemap'

export class World {
  readonly #sectors = new Map<string, Sector | 'loading'>()
  readonly #cells = new Map<string, Cell>()
  readonly #carried: Sector

  /** `onload` is called when more of the world can be drawn. */
  constructor(private readonly onload: () => void) {
    const text = document.getElementById(CARRIED)?.textContent.trim() ?? ''
    this.#carried = text === '' ? {} : (JSON.parse(text) as Sector)
  }

  /** The loaded cells of a part of the world. Missing ones are requested. */
  cells(bounds: Bounds): Cell[] {
    for (const corner of squares(bounds, SECTOR)) this.#ask(squareName(corner, '_'))
    return squares(bounds, CELL).flatMap((corner) => this.#cell(corner) ?? [])
  }

  #ask(sector: string): void {
    const address = addresses[sector]
    if (address === undefined || this.#sectors.has(sector)) return
    this.#sectors.set(sector, 'loading')
    void fetch(address)
      .then((response) => (response.ok ? (response.json() as Promise<Sector>) : {}))
      .then((content) => {
        this.#sectors.set(sector, content)
        this.onload()
      })
      // The picture is usable without coasts. The next draw requests the sector again.
      .catch(() => this.#sectors.delete(sector))
  }

  #cell(corner: [number, number]): Cell | undefined {
    const [west, south] = corner
    const key = `${west},${south}`
    const kept = this.#cells.get(key)
    if (kept !== undefined) return kept
    const text = this.#text(corner)
    if (text === undefined) return undefined
    const of = (lines: string[] | undefined) => (lines ?? []).map((line) => decode(line, corner))
    const cell = { west, south, land: of(text.land), lakes: of(text.lakes), borders: of(text.borders) }
    this.#cells.set(key, cell)
    return cell
  }

  #text(corner: [number, number]): CellText | undefined {
    const name = squareName(corner, ',')
    const sector = this.#sectors.get(
      squareName([Math.floor(corner[0] / SECTOR) * SECTOR, Math.floor(corner[1] / SECTOR) * SECTOR], '_'),
    )
    return this.#carried[name] ?? (sector === undefined || sector === 'loading' ? undefined : sector[name])
  }
}
