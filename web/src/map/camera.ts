// The part of the plane that a picture shows. Cameras are values: moving one returns another, so a
// picture can compare cameras to decide whether to redraw.

import type { ColourName, Rgb } from '../parts/colours'
import type { Size } from '../parts/sheet'
import type { Box } from './plane'

export type { Size }

export interface Camera {
  /** The middle of the picture in the plane, miles. */
  readonly x: number
  readonly y: number
  /** Pixels per mile. */
  readonly scale: number
}

/** A point of the plane, miles. */
export type Point = Pick<Camera, 'x' | 'y'>

/** The part of the plane that a map shows, and the colours of the theme. */
export interface MapView {
  camera: Camera
  size: Size
  colours: Record<ColourName, Rgb>
}

/** At this scale a few stands fill the picture. */
const MOST_SCALE = 3000
/**
 * The minimum scale, as a share of the scale that fits the whole network. Distant areas are of no
 * use and slow to draw.
 */
const LEAST_SHARE = 1 / 10
/** The free margin around the content in pixels, for rings and names. */
const MARGIN = { x: 70, y: 56 }
/** A network of one vertiport is shown with this span around it. */
const LEAST_SPAN_MI = 1

/** The camera that shows all of a box. */
export function fit(box: Box, size: Size): Camera {
  const margin = { x: Math.min(MARGIN.x, size.width / 7), y: Math.min(MARGIN.y, size.height / 8) }
  const [width, height] = [
    Math.max(box.east - box.west, LEAST_SPAN_MI),
    Math.max(box.north - box.south, LEAST_SPAN_MI),
  ]
  const scale = Math.min((size.width - 2 * margin.x) / width, (size.height - 2 * margin.y) / height)
  return { x: (box.west + box.east) / 2, y: (box.south + box.north) / 2, scale: Math.min(MOST_SCALE, scale) }
}

/** Moves the picture by pixels, so that the point under the pointer stays under it. */
export function pan(camera: Camera, dx: number, dy: number): Camera {
  return { ...camera, x: camera.x - dx / camera.scale, y: camera.y + dy / camera.scale }
}

/**
 * Zooms by a factor around a pixel. Zooming out is limited relative to the camera that shows
 * everything.
 */
export function zoom(
  camera: Camera,
  factor: number,
  size: Size,
  px = size.width / 2,
  py = size.height / 2,
  whole = camera,
): Camera {
  const scale = Math.max(whole.scale * LEAST_SHARE, Math.min(MOST_SCALE, camera.scale * factor))
  const [right, down] = [px - size.width / 2, py - size.height / 2]
  return {
    x: camera.x + right / camera.scale - right / scale,
    y: camera.y - down / camera.scale + down / scale,
    scale,
  }
}

/**
 * Moves the picture so that a point is in its middle. Within some pixels of the middle the picture
 * stays, because each move redraws the ground.
 */
export function keepNear(camera: Camera, size: Size, { x, y }: Point, most_px: number): Camera {
  const right = pixelX(camera, size, x) - size.width / 2
  const down = pixelY(camera, size, y) - size.height / 2
  return Math.hypot(right, down) <= most_px ? camera : { ...camera, x, y }
}

export function pixelX(camera: Camera, size: Size, x: number): number {
  return (x - camera.x) * camera.scale + size.width / 2
}

export function pixelY(camera: Camera, size: Size, y: number): number {
  return (camera.y - y) * camera.scale + size.height / 2
}

/** The part of the plane that a picture shows. */
export function view(camera: Camera, size: Size): Box {
  const [x, y] = [size.width / 2 / camera.scale, size.height / 2 / camera.scale]
  return { west: camera.x - x, south: camera.y - y, east: camera.x + x, north: camera.y + y }
}

/** Whether a point is in the picture. */
export function shows(camera: Camera, size: Size, x: number, y: number, margin = 0): boolean {
  const [px, py] = [pixelX(camera, size, x), pixelY(camera, size, y)]
  return px >= margin && py >= margin && px <= size.width - margin && py <= size.height - margin
}
