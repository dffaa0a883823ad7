// Finds the object under the pointer: an aircraft in the air takes precedence over a vertiport, and
// nearer ones come first.

import { NONE } from '../model/motion'
import type { Target } from '../model/target'
import type { Pixel } from '../parts/pointers'
import { radiusOf } from './rings'
import { aircraftPixel, vertiportPixel, visibility, type Viewpoint } from './where'

/** Maximum distance of the pointer from the middle of an aircraft, pixels; touch is less exact. */
const REACH = { mouse: 12, touch: 22 }

export function pick(viewpoint: Viewpoint, pointer: Pixel, isTouch = false): Target | undefined {
  const { scene, camera } = viewpoint
  const reach = isTouch ? REACH.touch : REACH.mouse
  const distance = ({ x, y }: Pixel) => Math.hypot(x - pointer.x, y - pointer.y)
  const aircraft = scene.record.aircraft.flatMap((_, one) => {
    if (scene.destination(one) === NONE) return []
    const place = aircraftPixel(viewpoint, one)
    const away = distance(place)
    const isThere = away <= reach && visibility(viewpoint, one, place) > 0.5
    return isThere ? [{ away, target: { kind: 'aircraft', aircraft: one } as const }] : []
  })
  if (aircraft.length > 0) return nearest(aircraft)
  const vertiports = scene.room.flatMap((_, one) => {
    const away = distance(vertiportPixel(viewpoint, one))
    const isThere = away <= Math.max(radiusOf(scene, one, camera.scale) + 4, reach)
    return isThere ? [{ away, target: { kind: 'vertiport', vertiport: one } as const }] : []
  })
  return nearest(vertiports)
}

function nearest(candidates: { away: number; target: Target }[]): Target | undefined {
  return candidates.sort((one, other) => one.away - other.away)[0]?.target
}
