// Where things of a scene are in a picture, in pixels.

import { at } from '../model/arrays'
import { NONE, Phase } from '../model/motion'
import { pixelX, pixelY, type Camera, type Size } from './camera'
import { visibilityNear } from './painters/painter'
import { radiusOf } from './rings'
import type { Scene } from './scene'

export interface Viewpoint {
  scene: Scene
  camera: Camera
  size: Size
}

export interface Pixel {
  x: number
  y: number
}

/** How far outside of the ring an aircraft stands that may not take off yet, pixels. */
const APRON_PX = 9

export function vertiportPixel({ scene, camera, size }: Viewpoint, vertiport: number): Pixel {
  const places = scene.plane.vertiports
  return {
    x: pixelX(camera, size, at(places, 2 * vertiport)),
    y: pixelY(camera, size, at(places, 2 * vertiport + 1)),
  }
}

/** Where an aircraft is drawn. One that is delayed stands beside its vertiport, on the side of its destination. */
export function aircraftPixel(viewpoint: Viewpoint, aircraft: number): Pixel {
  const { scene, camera, size } = viewpoint
  const x = pixelX(camera, size, at(scene.aircraft, 2 * aircraft))
  const y = pixelY(camera, size, at(scene.aircraft, 2 * aircraft + 1))
  if (at(scene.frame.phases, aircraft) !== Phase.delayed) return { x, y }
  const to = vertiportPixel(viewpoint, scene.destination(aircraft))
  const away = Math.max(1, Math.hypot(to.x - x, to.y - y))
  const aside = (radiusOf(scene, at(scene.frame.stands, aircraft), camera.scale) + APRON_PX) / away
  return { x: x + (to.x - x) * aside, y: y + (to.y - y) * aside }
}

/** How visible an aircraft is at a pixel, 0 to 1. */
export function visibility(viewpoint: Viewpoint, aircraft: number, { x, y }: Pixel): number {
  const { scene, camera } = viewpoint
  const near = (vertiport: number) => {
    if (vertiport === NONE) return 1
    const place = vertiportPixel(viewpoint, vertiport)
    return visibilityNear(Math.hypot(place.x - x, place.y - y), radiusOf(scene, vertiport, camera.scale))
  }
  return Math.min(near(scene.origin(aircraft)), near(scene.destination(aircraft)))
}

/** The direction in which an aircraft points, radians clockwise from up. */
export function direction(viewpoint: Viewpoint, aircraft: number, { x, y }: Pixel): number {
  const { scene } = viewpoint
  if (at(scene.frame.phases, aircraft) !== Phase.delayed)
    return (at(scene.frame.headings, aircraft) * Math.PI) / 180
  const to = vertiportPixel(viewpoint, scene.destination(aircraft))
  return Math.atan2(to.x - x, y - to.y)
}

/** Where the way begins that an aircraft has flown: at the ring of its origin. Undefined for one that has not left it. */
export function wayBegin(viewpoint: Viewpoint, aircraft: number, { x, y }: Pixel): Pixel | undefined {
  const origin = viewpoint.scene.origin(aircraft)
  if (origin === NONE) return undefined
  const from = vertiportPixel(viewpoint, origin)
  const share = radiusOf(viewpoint.scene, origin, viewpoint.camera.scale) / Math.hypot(x - from.x, y - from.y)
  return share < 1 ? { x: from.x + (x - from.x) * share, y: from.y + (y - from.y) * share } : undefined
}
