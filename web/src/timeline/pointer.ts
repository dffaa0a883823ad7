// How a user moves a timeline with a pointer. The browser handles vertical scrolling; this module
// handles movement along the day.

import { listen as listenToPointers, type PointerActions } from '../parts/pointers'

interface TimelineMoves extends Pick<PointerActions, 'point' | 'press'> {
  /** Moves the day by pixels. */
  pan: (dx: number) => void
  /** Scrolls the rows by pixels, if the browser does not. */
  scroll: (dy: number) => void
  zoom: (factor: number, x: number) => void
}

const WHEEL_RATE = 0.01

/** Listens on an element until the returned function is called. */
export function listen(element: HTMLElement, { point, press, pan, scroll, zoom }: TimelineMoves): () => void {
  return listenToPointers(element, {
    point,
    press,
    drag: (from, to, isTouch) => {
      pan(to.x - from.x)
      if (!isTouch) scroll(from.y - to.y)
    },
    pinch: (other, from, to) => {
      const [before, after] = [Math.abs(from.x - other.x), Math.abs(to.x - other.x)]
      if (before > 4 && after > 4) zoom(after / before, (to.x + other.x) / 2)
      pan((to.x - from.x) / 2)
    },
    // With Ctrl, and thus when pinching on a trackpad, a wheel zooms. Sideways or with Shift it
    // moves the day.
    wheel: (event, { x }, pixels) => {
      const sideways = event.shiftKey && event.deltaX === 0 ? event.deltaY : event.deltaX
      if (event.ctrlKey || event.metaKey) {
        event.preventDefault()
        zoom(Math.exp(-event.deltaY * pixels * WHEEL_RATE), x)
      } else if (Math.abs(sideways) > Math.abs(event.shiftKey ? 0 : event.deltaY)) {
        event.preventDefault()
        pan(-sideways * pixels)
      }
    },
  })
}
