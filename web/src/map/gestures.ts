// How a user moves the map: drag, wheel, two fingers, double click. This module reports gestures;
// the map decides what they mean.

import { listen as listenToPointers, type Pixel, type PointerActions } from '../parts/pointers'

export interface Moves extends Pick<PointerActions, 'point' | 'press'> {
  pan: (dx: number, dy: number) => void
  /** Zooms by a factor around a pixel. */
  zoom: (factor: number, at: Pixel) => void
}

/** How much one notch of a wheel zooms; trackpads send many small steps. */
const WHEEL_RATE = 0.0016
const PINCH_WHEEL_RATE = 0.01

/** Listens on an element until the returned function is called. */
export function listen(element: HTMLElement, { pan, zoom, point, press }: Moves): () => void {
  return listenToPointers(element, {
    point,
    press,
    drag: (from, to) => pan(to.x - from.x, to.y - from.y),
    // The picture follows the midpoint and the distance of both fingers.
    pinch: (other, from, to) => {
      const before = Math.hypot(from.x - other.x, from.y - other.y)
      pan((to.x - from.x) / 2, (to.y - from.y) / 2)
      const middle = { x: (to.x + other.x) / 2, y: (to.y + other.y) / 2 }
      if (before > 0) zoom(Math.hypot(to.x - other.x, to.y - other.y) / before, middle)
    },
    wheel: (event, at, pixels) => {
      event.preventDefault()
      const rate = event.ctrlKey ? PINCH_WHEEL_RATE : WHEEL_RATE
      zoom(Math.exp(-event.deltaY * pixels * rate), at)
    },
    doubleClick: (event, at) => zoom(event.shiftKey ? 0.5 : 2, at),
  })
}
