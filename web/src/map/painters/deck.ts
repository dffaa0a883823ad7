// Draws the map on the graphics processor with deck.gl: a layer for each kind of thing. Everything is placed in pixels, by the same
// functions as for the plain canvas, so that both painters draw the same picture.

import { Deck, OrthographicView, type Layer } from '@deck.gl/core'
import { IconLayer, LineLayer, PathLayer, ScatterplotLayer } from '@deck.gl/layers'
import { at } from '../../model/arrays'
import { COUNTED } from '../../model/counts'
import { NONE } from '../../model/motion'
import { aircraftMeant } from '../../model/target'
import type { Rgb } from '../../parts/colours'
import { piecesOf, radiusOf, ringWidth } from '../rings'
import { aircraftPixel, direction, vertiportPixel, visibility, wayBegin, type Pixel } from '../where'
import { changed } from './changes'
import {
  aircraftSize,
  ARC_BEND,
  arcWidth,
  COLOUR_OF_STATE,
  looksOf,
  OPACITY_OF_STATE,
  stillParts,
  type Painter,
  type Picture,
} from './painter'
import { drawSprites, FILLED, LARGE_SPRITE, spriteName, toneOf, type Sprites, type Tone } from './sprites'

type Colour = [number, number, number, number]
type Point = [number, number]

/** Points of an arc, and of a piece of a ring. */
const ARC_POINTS = 24
const PIECE_STEP = 0.25
const TURN = 2 * Math.PI

export class DeckPainter implements Painter {
  readonly element = document.createElement('div')
  readonly #deck: Deck<OrthographicView>
  readonly #hasChanged = changed(stillParts)
  #still: Layer[] = []
  #sprites: { of: Picture['colours']; sprites: Sprites } | undefined

  constructor() {
    this.element.className = 'deck'
    this.#deck = new Deck({
      parent: this.element,
      views: new OrthographicView({ id: 'map', flipY: true }),
      viewState: { target: [0, 0, 0], zoom: 0 },
      controller: false,
      layers: [],
    })
  }

  paint(picture: Picture): void {
    const { width, height } = picture.size
    if (this.#hasChanged(picture)) this.#still = stillLayers(picture)
    this.#deck.setProps({
      width,
      height,
      viewState: { target: [width / 2, height / 2, 0], zoom: 0 },
      layers: [...this.#still, ...this.#movingLayers(picture)],
    })
  }

  destroy(): void {
    this.#deck.finalize()
    this.element.remove()
  }

  #movingLayers(picture: Picture): Layer[] {
    if (this.#sprites?.of !== picture.colours) {
      this.#sprites = { of: picture.colours, sprites: drawSprites(picture.colours, LARGE_SPRITE) }
    }
    return movingLayers(picture, this.#sprites.sprites)
  }
}

function rgba([red, green, blue]: Rgb, opacity = 1): Colour {
  return [red, green, blue, Math.round(255 * opacity)]
}

function point({ x, y }: Pixel): Point {
  return [x, y]
}

function stillLayers(picture: Picture): Layer[] {
  return [
    ...(picture.showsDemand ? [arcLayer(picture)] : []),
    closureLayer(picture),
    discLayer(picture),
    pieceLayer(picture),
    markLayer(picture),
  ]
}

function arcLayer(picture: Picture): Layer {
  const { scene, colours, selected } = picture
  const only = selected?.kind === 'vertiport' ? selected.vertiport : undefined
  const pairs = scene.pairs.filter(({ from, to }) => only === undefined || from === only || to === only)
  const arcs = pairs.map(({ from, to, passengers }) => ({
    path: arc(vertiportPixel(picture, from), vertiportPixel(picture, to)),
    width: arcWidth(passengers, picture.size),
  }))
  const fade = Array.from({ length: ARC_POINTS }, (_, step) =>
    rgba(colours.demand, 0.6 - (0.54 * step) / (ARC_POINTS - 1)),
  )
  return new PathLayer<(typeof arcs)[number]>({
    ...{ id: 'arcs', data: arcs, widthUnits: 'pixels' as const, capRounded: true, jointRounded: true },
    getPath: ({ path }) => path,
    getWidth: ({ width }) => width,
    getColor: () => fade,
  })
}

/** A quadratic curve that stands off to the left of the way. */
function arc(from: Pixel, to: Pixel): Point[] {
  const [x, y] = [
    (from.x + to.x) / 2 - (to.y - from.y) * ARC_BEND * 2,
    (from.y + to.y) / 2 + (to.x - from.x) * ARC_BEND * 2,
  ]
  return Array.from({ length: ARC_POINTS }, (_, step): Point => {
    const share = step / (ARC_POINTS - 1)
    const [before, middle, after] = [(1 - share) ** 2, 2 * share * (1 - share), share ** 2]
    return [before * from.x + middle * x + after * to.x, before * from.y + middle * y + after * to.y]
  })
}

interface Line {
  from: Point
  to: Point
}

function lineLayer(id: string, lines: Line[], color: Colour, width: number): Layer {
  return new LineLayer<Line>({
    ...{ id, data: lines, widthUnits: 'pixels' as const, getWidth: width, getColor: color },
    getSourcePosition: ({ from }) => from,
    getTargetPosition: ({ to }) => to,
    updateTriggers: { getColor: color },
  })
}

function dashes(from: Pixel, to: Pixel, dash: number, gap: number): Line[] {
  const length = Math.hypot(to.x - from.x, to.y - from.y)
  const along = (px: number): Point => {
    const share = Math.min(1, px / Math.max(length, 1e-9))
    return [from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share]
  }
  const count = Math.min(2000, Math.ceil(length / (dash + gap)))
  return Array.from({ length: count }, (_, one) => ({
    from: along(one * (dash + gap)),
    to: along(one * (dash + gap) + dash),
  }))
}

function closureLayer(picture: Picture): Layer {
  const lines = picture.scene.closures.flatMap((closure) => {
    if ('vertiport' in closure) return []
    const [from, to] = [vertiportPixel(picture, closure.from), vertiportPixel(picture, closure.to)]
    const [x, y] = [(from.x + to.x) / 2, (from.y + to.y) / 2]
    const cross: Line[] = [
      { from: [x - 5, y - 5], to: [x + 5, y + 5] },
      { from: [x + 5, y - 5], to: [x - 5, y + 5] },
    ]
    return [...dashes(from, to, 2, 6), ...cross]
  })
  return lineLayer('closures', lines, rgba(picture.colours.bad, 0.85), 2)
}

function vertiportPixels(picture: Picture): (Pixel & { radius: number })[] {
  const { scene, camera } = picture
  return scene.room.map((_, one) => ({
    ...vertiportPixel(picture, one),
    radius: radiusOf(scene, one, camera.scale),
  }))
}

function discLayer(picture: Picture): Layer {
  const discs = vertiportPixels(picture)
  const color = rgba(picture.colours.surface)
  return new ScatterplotLayer<(typeof discs)[number]>({
    ...{ id: 'discs', data: discs, radiusUnits: 'pixels' as const, getFillColor: color },
    getPosition: point,
    getRadius: ({ radius }) => radius + 1.5,
    updateTriggers: { getFillColor: color },
  })
}

function pieceLayer(picture: Picture): Layer {
  const { scene, colours } = picture
  const pieces = vertiportPixels(picture).flatMap((place, vertiport) => {
    const of = piecesOf(scene.counts.held, COUNTED * vertiport, at(scene.room, vertiport), place.radius)
    const width = ringWidth(place.radius)
    return of.map(({ begin, end, state }) => ({
      path: piece(place, place.radius - width / 2, begin - TURN / 4, end - TURN / 4),
      color: rgba(colours[COLOUR_OF_STATE[state]], OPACITY_OF_STATE[state]),
      width,
    }))
  })
  return new PathLayer<(typeof pieces)[number]>({
    ...{ id: 'pieces', data: pieces, widthUnits: 'pixels' as const, jointRounded: true },
    getPath: ({ path }) => path,
    getColor: ({ color }) => color,
    getWidth: ({ width }) => width,
  })
}

function piece({ x, y }: Pixel, radius: number, begin: number, end: number): Point[] {
  const steps = Math.max(1, Math.ceil((end - begin) / PIECE_STEP))
  return Array.from({ length: steps + 1 }, (_, step): Point => {
    const angle = begin + ((end - begin) * step) / steps
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)]
  })
}

interface Mark extends Pixel {
  radius: number
  color: Colour
  width: number
}

function rings(id: string, marks: Mark[]): Layer {
  return new ScatterplotLayer<Mark>({
    ...{
      id,
      data: marks,
      radiusUnits: 'pixels' as const,
      lineWidthUnits: 'pixels' as const,
      stroked: true,
      filled: false,
    },
    getPosition: point,
    getRadius: ({ radius }) => radius,
    getLineColor: ({ color }) => color,
    getLineWidth: ({ width }) => width,
  })
}

function markLayer(picture: Picture): Layer {
  const { scene, colours, hovered, selected } = picture
  const closed = new Set(scene.closures.flatMap((one) => ('vertiport' in one ? [one.vertiport] : [])))
  const marks = vertiportPixels(picture).flatMap((place, vertiport): Mark[] => {
    const isMarked = [hovered, selected].some(
      (one) => one?.kind === 'vertiport' && one.vertiport === vertiport,
    )
    if (!isMarked && !closed.has(vertiport)) return []
    return [
      { ...place, radius: place.radius + 4, color: rgba(isMarked ? colours.accent : colours.bad), width: 2 },
    ]
  })
  return rings('marks', marks)
}

interface Flying extends Pixel {
  aircraft: number
  isMarked: boolean
  tone: Tone
}

function movingLayers(picture: Picture, sprites: Sprites): Layer[] {
  const { scene, colours, hovered, selected } = picture
  const { aircraft_px, wayOpacity } = looksOf(picture)
  const flying = scene.record.aircraft.flatMap((_, aircraft): Flying[] => {
    if (scene.destination(aircraft) === NONE) return []
    const isMarked = aircraftMeant(hovered) === aircraft || aircraftMeant(selected) === aircraft
    const tone = toneOf(scene, aircraft, isMarked)
    return [{ ...aircraftPixel(picture, aircraft), aircraft, isMarked, tone }]
  })
  const size = ({ aircraft, isMarked }: Flying) =>
    aircraftSize(aircraft_px, at(scene.frame.lifts, aircraft)) * (isMarked ? 1.25 : 1)
  const halos = flying.filter(({ isMarked }) => isMarked)
  return [
    lineLayer(
      'ways',
      flying.flatMap((one) => flownWay(picture, one)),
      rgba(colours.flying, wayOpacity),
      1.25,
    ),
    ...selectedWay(
      picture,
      flying.find(({ aircraft }) => aircraft === aircraftMeant(selected)),
    ),
    rings(
      'halos',
      halos.map((one) => ({ ...one, radius: size(one) + 6, color: rgba(colours.accent), width: 1.5 })),
    ),
    new IconLayer<Flying>({
      ...{ id: 'fleet', data: flying, iconMapping: sprites.mapping, sizeUnits: 'pixels' as const },
      iconAtlas: sprites.image as unknown as string,
      getPosition: point,
      getIcon: ({ tone, aircraft }) => spriteName(tone, scene.load(aircraft)),
      getSize: (one) => (2 * size(one)) / FILLED,
      getAngle: (one) => (-direction(picture, one.aircraft, one) * 180) / Math.PI,
      getColor: (one) => [0, 0, 0, 255 * (one.isMarked ? 1 : visibility(picture, one.aircraft, one))],
    }),
  ]
}

function flownWay(picture: Picture, one: Flying): Line[] {
  const from = wayBegin(picture, one.aircraft, one)
  return from === undefined ? [] : [{ from: point(from), to: point(one) }]
}

function selectedWay(picture: Picture, one: Flying | undefined): Layer[] {
  if (one === undefined) return []
  const ahead = dashes(one, vertiportPixel(picture, picture.scene.destination(one.aircraft)), 5, 5)
  return [lineLayer('selected-way', [...flownWay(picture, one), ...ahead], rgba(picture.colours.accent), 2)]
}
