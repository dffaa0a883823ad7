// The positions of a scene's objects in a picture, in pixels.

import { at } from '../model/arrays'
import { NONE, Phase } from '../model/motion'
import type { Target } from '../model/target'
import type { Pixel } from '../parts/pointers'
import { pixelX, pixelY, type Camera, type Size } from './camera'
import { visibilityNear } from './painters/painter'
import { radiusOf } from './rings'
import type { Scene } from './scene'

export interface Viewpoint {
  scene: Scene
  camera: Camera
  size: Size
}

/** The distance from the ring of an aircraft that may not take off yet, or is overdue, pixels. */
const APRON_PX = 9
/** The distance between aircraft that are overdue on the same route. */
const LINE_PX = 26

export function vertiportPixel({ scene, camera, size }: Viewpoint, vertiport: number): Pixel {
  const places = scene.plane.vertiports
  return {
    x: pixelX(camera, size, at(places, 2 * vertiport)),
    y: pixelY(camera, size, at(places, 2 * vertiport + 1)),
  }
}

export function targetPixel(viewpoint: Viewpoint, target: Target): Pixel {
  return target.kind === 'vertiport'
    ? vertiportPixel(viewpoint, target.vertiport)
    : aircraftPixel(viewpoint, target.aircraft)
}

/**
 * The position at which an aircraft is drawn. A delayed one is next to its vertiport, on the side
 * of its destination. One that should have landed is outside the ring of its destination.
 */
export function aircraftPixel(viewpoint: Viewpoint, aircraft: number): Pixel {
  const { scene, camera, size } = viewpoint
  const x = pixelX(camera, size, at(scene.aircraft, 2 * aircraft))
  const y = pixelY(camera, size, at(scene.aircraft, 2 * aircraft + 1))
  const isOverdue = scene.isOverdue(aircraft)
  const isDelayed = at(scene.frame.phases, aircraft) === Phase.delayed
  if (!isDelayed && !isOverdue) return { x, y }
  const apron = APRON_PX + (isOverdue ? LINE_PX * beforeInLine(scene, aircraft) : 0)
  const destination = vertiportPixel(viewpoint, scene.destination(aircraft))
  if (isDelayed) {
    const radius = radiusOf(scene, at(scene.frame.stands, aircraft), camera.scale)
    return towards({ x, y }, destination, radius + apron)
  }
  const origin = vertiportPixel(viewpoint, scene.origin(aircraft))
  const flown = Math.hypot(x - destination.x, y - destination.y)
  const radius = radiusOf(scene, scene.destination(aircraft), camera.scale)
  return towards(destination, origin, Math.max(flown, radius + apron))
}

function towards(from: Pixel, to: Pixel, distance_px: number): Pixel {
  const share = distance_px / Math.max(1, Math.hypot(to.x - from.x, to.y - from.y))
  return { x: from.x + (to.x - from.x) * share, y: from.y + (to.y - from.y) * share }
}

/** How many other aircraft are overdue on the same route and come first in the queue there. */
function beforeInLine(scene: Scene, aircraft: number): number {
  const isSame = (other: number) =>
    scene.isOverdue(other) &&
    scene.destination(other) === scene.destination(aircraft) &&
    scene.origin(other) === scene.origin(aircraft)
  return scene.record.aircraft.reduce((sum, _, other) => sum + Number(other < aircraft && isSame(other)), 0)
}

/** The opacity of an aircraft at a pixel, 0 to 1. */
export function visibility(viewpoint: Viewpoint, aircraft: number, { x, y }: Pixel): number {
  const { scene, camera } = viewpoint
  if (scene.isOverdue(aircraft)) return 1
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

/**
 * The start of the part that an aircraft has flown: at the ring of its origin. Undefined if it has
 * not left the ring.
 */
export function wayBegin(viewpoint: Viewpoint, aircraft: number, { x, y }: Pixel): Pixel | undefined {
  const origin = viewpoint.scene.origin(aircraft)
  if (origin === NONE) return undefined
  const from = vertiportPixel(viewpoint, origin)
  const share = radiusOf(viewpoint.scene, origin, viewpoint.camera.scale) / Math.hypot(x - from.x, y - from.y)
  return share < 1 ? { x: from.x + (x - from.x) * share, y: from.y + (y - from.y) * share } : undefined
}
