// Sprites of aircraft: one for each colour and each number of quarters of the seats that are taken.
// Drawing a sprite costs a tenth of drawing the shape, which matters for some hundred aircraft a
// frame.

import { at } from '../../model/arrays'
import { Phase } from '../../model/motion'
import { css, type ColourName, type Rgb } from '../../parts/colours'
import type { Scene } from '../scene'
import { AIRCRAFT_SHAPE, fillOf } from './painter'

/** How much of the sprite the aircraft fills; the rest is margin. */
export const FILLED = 0.78
const LOADS = 5
const tones = ['flying', 'waiting', 'bad', 'accent'] as const

type Tone = (typeof tones)[number]

export interface Sprites {
  image: HTMLCanvasElement
  mapping: Record<string, { x: number; y: number; width: number; height: number }>
}

/** The colour of an aircraft. Being overdue takes precedence over whether it has taken off. */
export function toneOf(scene: Scene, aircraft: number, isMarked: boolean): Tone {
  if (isMarked) return 'accent'
  if (scene.isOverdue(aircraft)) return 'bad'
  return at(scene.frame.phases, aircraft) === Phase.delayed ? 'waiting' : 'flying'
}

export function spriteName(tone: Tone, load: number): string {
  return `${tone}-${load === 0 ? 0 : Math.max(1, Math.round(load * (LOADS - 1)))}`
}

/** Draws all sprites, each a square with this side in pixels. */
export function drawSprites(colours: Record<ColourName, Rgb>, side: number): Sprites {
  const image = document.createElement('canvas')
  image.width = LOADS * side
  image.height = tones.length * side
  const context = image.getContext('2d')
  if (context === null) throw new Error('every browser draws on a canvas')
  const mapping: Sprites['mapping'] = {}
  const shape = new Path2D(AIRCRAFT_SHAPE)
  tones.forEach((tone, row) => {
    for (let step = 0; step < LOADS; step++) {
      const [x, y] = [step * side, row * side]
      mapping[`${tone}-${step}`] = { x, y, width: side, height: side }
      context.setTransform((side / 2) * FILLED, 0, 0, (side / 2) * FILLED, x + side / 2, y + side / 2)
      drawAircraft(
        context,
        shape,
        { rim: css(colours.land), ground: css(colours.surface), line: css(colours[tone]) },
        step / (LOADS - 1),
      )
    }
  })
  return { image, mapping }
}

interface Inks {
  rim: string
  ground: string
  line: string
}

function drawAircraft(
  context: CanvasRenderingContext2D,
  shape: Path2D,
  { rim, ground, line }: Inks,
  load: number,
): void {
  context.lineJoin = 'round'
  context.globalAlpha = 1
  context.lineWidth = 0.45
  context.strokeStyle = rim
  context.stroke(shape)
  context.fillStyle = ground
  context.fill(shape)
  context.lineWidth = 0.14
  context.strokeStyle = line
  context.stroke(shape)
  context.globalAlpha = fillOf(load)
  context.fillStyle = line
  context.fill(shape)
}
